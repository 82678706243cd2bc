# make run    set up what is missing, run the shipped study at a small size, print where its report is
# make test   set up what is missing, run ctest, pytest and the linters
# make help   everything else
.DEFAULT_GOAL := help
.PHONY: help setup run test format stubs colcon clean

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
BUILD := build/python
JOBS ?= $(shell nproc)
PIP := $(BIN)/python -m pip --disable-pip-version-check
RUN_DIR ?= runs/quick-$(shell date +%Y%m%d-%H%M%S)
RUN_DIR := $(RUN_DIR)
CXX_SOURCES := $(shell find cpp cmake -type f) CMakeLists.txt
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)

help:
	@sed -n '1,3s/^# //p' Makefile
	@echo 'make setup  only the set-up: Debian packages, $(VENV), build'
	@echo 'make stubs  regenerate python/codesign/_core.pyi'
	@echo 'make format apply clang-format and ruff'
	@echo 'make colcon build and install as a colcon package into build/colcon'
	@echo 'make clean  delete build/ and $(VENV)'

# --- set-up: each step leaves a stamp and is not done again -----------------------------------------------------------
$(VENV)/system.stamp: apt-packages.txt scripts/install_system_packages
	scripts/install_system_packages apt-packages.txt
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/runtime.stamp: pyproject.toml $(CXX_SOURCES) | $(VENV)/system.stamp
	$(PIP) install --quiet 'scikit-build-core>=0.10' 'pybind11>=2.12'
	$(PIP) install --quiet --no-build-isolation --editable '.[view,cluster,analysis]'
	@touch $@

$(VENV)/test.stamp: apt-packages-test.txt $(VENV)/runtime.stamp pyproject.toml
	scripts/install_system_packages apt-packages-test.txt
	$(PIP) install --quiet 'setuptools>=70.1' # that of Python 3.11's venv makes no wheels of packages that come as source
	$(PIP) install --quiet --no-build-isolation --editable '.[view,cluster,analysis,test]'
	@touch $@

setup: $(VENV)/runtime.stamp

# --- the two commands ----------------------------------------------------------------------------------------------------
run: setup
	$(BIN)/codesign optimize --population 12 --generations 3 --seed 1 --out $(RUN_DIR)
	$(BIN)/codesign report $(RUN_DIR)

test: $(VENV)/test.stamp
	cmake -S . -B $(BUILD) -DCODESIGN_BUILD_TESTS=ON >/dev/null
	cmake --build $(BUILD)
	ctest --test-dir $(BUILD) --output-on-failure -j $(JOBS)
	$(BIN)/python -m pytest -m 'not slow' -n $(JOBS) --dist loadfile

# --- for developers ------------------------------------------------------------------------------------------------------
stubs: $(VENV)/test.stamp
	$(BIN)/python scripts/make_stubs.py

format: $(VENV)/test.stamp
	find cpp tests/cpp -name '*.[ch]pp' | xargs $(BIN)/clang-format -i
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

colcon: $(VENV)/test.stamp
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/colcon --log-base build/colcon/log build --base-paths . \
	  --build-base build/colcon/build --install-base build/colcon/install

clean:
	rm -rf build $(VENV)
