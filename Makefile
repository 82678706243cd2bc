# make run    set up what is missing, run the shipped study at a small size, print where its report is
# make test   set up what is missing, check the sources, run ctest and pytest
# make help   everything else
.DEFAULT_GOAL := help
.PHONY: help setup run check test test-lowest test-consumers coverage lock format stubs colcon docs wheel clean

PYTHON ?= python3
PYTHONS ?= $(PYTHON)
SHELL := /bin/bash
VENV := .venv
BIN := $(VENV)/bin
BUILD := build/python
JOBS ?= $(shell nproc)
PIP := $(BIN)/python -m pip --disable-pip-version-check
INSTALL := $(PIP) install --constraint constraints.txt
RUN_DIR ?= runs/quick-$(shell date +%Y%m%d-%H%M%S)
RUN_DIR := $(RUN_DIR)
CXX_SOURCES := $(shell find cpp cmake -type f) CMakeLists.txt
PYTEST := $(BIN)/python -m pytest -m 'not slow' -n $(JOBS) --dist loadfile
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
# Paths below this folder count as relative ones, so that clones share what any of them has compiled.
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_NOHASHDIR := 1
export BIN

help:
	@sed -n '1,3s/^# //p' Makefile
	@echo 'make setup  only the set-up: Debian packages, $(VENV), build'
	@echo 'make check  format, lint, types, stubs, layering (part of make test)'
	@echo 'make test-lowest  the main jobs with the lowest versions of all packages that pyproject.toml allows'
	@echo 'make test-consumers  exported robots in Drake, Newton and USD, parts of build123d, searches of numba (700 MB the first time)'
	@echo 'make coverage  the tests, with the share of the lines of Python and of the C++ libraries that they reach'
	@echo 'make lock   write the installed versions into constraints.txt, which the set-up uses'
	@echo 'make stubs  regenerate python/codesign/_core/*.pyi'
	@echo 'make format apply clang-format and ruff'
	@echo 'make colcon build and install as a colcon package into build/colcon'
	@echo 'make docs   build/docs: the documentation as a site; a warning or a broken link is an error'
	@echo 'make wheel  dist: wheels that need no compiler, for PYTHONS=$(PYTHONS)'
	@echo 'make clean  delete build/ and $(VENV)'

# --- set-up: each step leaves a stamp and is not done again; files in $(VENV) and build/ hold the folder's path, so a
# checkout that has been moved is set up again --------------------------------------------------------------------------
MADE_IN := $(shell cat $(VENV)/folder 2>/dev/null)
ifneq ($(filter-out help clean,$(MAKECMDGOALS)),)
ifneq ($(filter-out $(CURDIR),$(MADE_IN)),)
$(info $(VENV) and build were made in $(MADE_IN): setting up again)
$(shell rm -rf $(VENV) build)
endif
endif

$(VENV)/system.stamp: apt-packages.txt scripts/install_system_packages
	@echo '== set-up: Debian packages'
	scripts/install_system_packages apt-packages.txt
	$(PYTHON) -m venv $(VENV)
	@echo '$(CURDIR)' > $(VENV)/folder
	@touch $@

$(VENV)/runtime.stamp: pyproject.toml constraints.txt $(CXX_SOURCES) | $(VENV)/system.stamp
	@echo '== set-up: Python packages (about 400 MB the first time)'
	$(INSTALL) --requirement <($(BIN)/python scripts/dependencies.py view cluster analysis)
	@echo '== set-up: compiling (some minutes the first time)'
	$(INSTALL) --verbose --no-deps --no-build-isolation --editable .
	@touch $@

$(VENV)/test.stamp: apt-packages-test.txt $(VENV)/runtime.stamp
	@echo '== set-up: packages of the tests'
	scripts/install_system_packages apt-packages-test.txt
	$(INSTALL) 'setuptools>=70.1' # that of Python 3.11's venv makes no wheels of packages that come as source
	$(INSTALL) --no-build-isolation --requirement <($(BIN)/python scripts/dependencies.py test)
	@touch $@

setup: $(VENV)/runtime.stamp

# --- the two commands ----------------------------------------------------------------------------------------------------
run: setup
	$(BIN)/codesign optimize --algorithm surrogate --evaluations 40 --seed 1 --out $(RUN_DIR)
	$(BIN)/codesign report $(RUN_DIR)

test: check
	cmake -S . -B $(BUILD) -DCODESIGN_BUILD_TESTS=ON >/dev/null
	cmake --build $(BUILD)
	ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)
	$(PYTEST)

check: $(VENV)/test.stamp
	scripts/check

# --- for developers ------------------------------------------------------------------------------------------------------
test-lowest: setup
	$(BIN)/python scripts/test_lowest.py

test-consumers: $(VENV)/test.stamp
	$(INSTALL) --requirement <($(BIN)/python scripts/dependencies.py consumers)
	$(BIN)/python -m pytest tests/consumers tests/python/robot/test_mjcf.py tests/python/robot/test_sdf.py

coverage: $(VENV)/test.stamp
	cmake --preset coverage >/dev/null
	cmake --build --preset coverage
	ctest --preset coverage -j $(JOBS) >/dev/null
	$(PYTEST) --cov --cov-report=term:skip-covered --cov-report=html:build/coverage/python
	$(BIN)/python scripts/cpp_coverage.py build/coverage

lock: $(VENV)/test.stamp
	$(BIN)/python -m pip install --requirement <($(BIN)/python scripts/dependencies.py docs) # versions that suit both
	scripts/lock > build/constraints.txt
	mv build/constraints.txt constraints.txt

stubs: $(VENV)/test.stamp
	$(BIN)/python scripts/make_stubs.py

format: $(VENV)/test.stamp
	find cpp tests/cpp -name '*.[ch]pp' | xargs $(BIN)/clang-format -i
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

colcon: $(VENV)/test.stamp
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/colcon --log-base build/colcon/log build --base-paths . \
	  --build-base build/colcon/build --install-base build/colcon/install

docs: setup
	$(INSTALL) --requirement <($(BIN)/python scripts/dependencies.py docs)
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs build/docs
	@echo build/docs/index.html

wheel: setup
	$(INSTALL) --requirement <($(BIN)/python scripts/dependencies.py wheel)
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python scripts/make_wheel.py --python $(PYTHONS)

clean:
	rm -rf build $(VENV)
