"""Identity of results: every module and library that decides a number counts, and a difference is named."""

import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from codesign.chain.study import load_study
from codesign.errors import ExecutionError, StoreError, StudyError
from codesign.execution.pool import Limits, LocalPool, StudyRef, Task
from codesign.problem.identity import Identity
from codesign.search.optimization import optimize, resume
from codesign.study import fingerprint, new_study
from codesign.study.fingerprint import DECIDING_PACKAGES, DECIDING_WINGS, library_versions
from codesign.study.imports import PACKAGE, imports_of, version_of_import
from codesign.study.loading import _load
from fake_study import study

CHAIN = PACKAGE / "chain" / "study.py"
# exact geometry for STEP files; ranking of finished evaluations; drawings of parts; meshes of packages and GLB files
NOT_LOADED = {"OCP", "pymoo", "matplotlib", "ezdxf", "trimesh"}


@pytest.fixture
def pretend(monkeypatch: pytest.MonkeyPatch):
    """A function that makes a package look as if it had another version."""
    true_version = metadata.version

    def fake(package: str, version: str) -> None:
        monkeypatch.setattr(metadata, "version", lambda name: version if name == package else true_version(name))
        forget()

    yield fake
    monkeypatch.undo()
    forget()


def forget() -> None:
    for cache in (library_versions, version_of_import):
        cache.cache_clear()
    _load.cache_clear()


def test_the_engine_is_all_that_the_chain_imports():
    places = [file.relative_to(PACKAGE).parts for file in imports_of({"codesign.chain.study": CHAIN}).files.values()]
    assert {parts[0] for parts in places if len(parts) > 1} - {"storage"} == set(DECIDING_WINGS)


def test_the_libraries_are_all_that_the_engine_imports():
    files = fingerprint.engine_files()
    modules = {f"codesign.{name.removesuffix('.py').replace('/', '.')}": file for name, file in files.items()}
    assert imports_of(modules).libraries - NOT_LOADED == set(DECIDING_PACKAGES)


def test_a_library_left_out_is_not_even_loaded_by_an_evaluation():
    code = (
        "import sys; from codesign import load_study;"
        "assert load_study('gimbal_quad').evaluate({'reach': 200, 'height': 30}).status != 'failed';"
        f"print(sorted({NOT_LOADED} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_commands_start_without_what_they_do_not_need():
    loading = "import sys; from codesign import load_study; load_study('ironcub_paper')"
    helping = "import sys; sys.argv[1:] = ['--help']; from codesign.cli.main import main"
    ordering = "import sys, codesign.cli.export.design"  # of `codesign export`
    unneeded_by = {
        loading: NOT_LOADED | {"scipy", "urllib.request"},
        helping: NOT_LOADED | {"numpy"},
        ordering: NOT_LOADED | {"scipy"},
    }
    for code, unneeded in unneeded_by.items():
        ends = f"print(sorted({unneeded} & set(sys.modules)))"
        asked = "\ntry: main()\nexcept SystemExit: pass\n" if "main" in code else "\n"
        done = subprocess.run([sys.executable, "-c", code + asked + ends], capture_output=True, text=True, check=True)
        assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("package", DECIDING_PACKAGES)
def test_another_version_of_a_library_is_another_study_and_other_parts(pretend, package):
    first = load_study("gimbal_quad")
    installed = metadata.version(package)
    pretend(package, "0.0.1")
    second = load_study("gimbal_quad")
    assert first.hash != second.hash
    assert first.code_hash != second.code_hash
    assert first.identity.differences(second.identity) == f"{package} was {installed}, is 0.0.1"


def test_libraries_of_the_core_are_those_loaded():
    libraries = load_study("gimbal_quad").identity.libraries
    assert {"CHOLMOD", "OpenBLAS", "C library"} <= set(libraries)
    assert "unknown" not in " ".join(libraries.values())


def test_rows_and_sessions_name_the_libraries(tmp_path):
    loaded = load_study("gimbal_quad")
    evaluation = loaded.evaluate({"reach": 200, "height": 30})
    assert evaluation.provenance["libraries"] == dict(loaded.identity.libraries)
    fake = study(libraries={"manifold3d": "3.0.0"})
    run = optimize(fake, out=tmp_path, generations=1, cache=None, workers=1)
    packages = run.sessions[0]["provenance"]["packages"]
    assert packages["manifold3d"] == "3.0.0"
    assert packages["pymoo"] == metadata.version("pymoo")


def test_a_run_is_not_continued_with_another_library(tmp_path):
    old, new = (study(libraries={"manifold3d": version}, hash=version) for version in ("3.0.0", "3.5.4"))
    optimize(old, out=tmp_path, generations=1, cache=None, workers=1)
    with pytest.raises(StudyError, match=r"manifold3d was 3\.0\.0, is 3\.5\.4"):
        resume(tmp_path, study=new, evaluations=16)


def test_a_search_is_not_continued_with_another_optimizer(tmp_path, pretend):
    fake = study()
    optimize(fake, out=tmp_path, generations=1, cache=None, workers=1)
    installed = metadata.version("pymoo")
    pretend("pymoo", "0.5")
    with pytest.raises(StoreError, match=rf"pymoo was {installed}, is 0\.5"):
        resume(tmp_path, study=fake, evaluations=16)


def test_cached_rows_of_another_library_are_not_used_and_that_is_said_once(tmp_path, caplog):
    old, new = (study(libraries={"manifold3d": version}) for version in ("3.0.0", "3.5.4"))
    cache = tmp_path / "cache.sqlite"
    cached = []
    for number, fake in enumerate((old, old, new, new, old)):
        run = optimize(fake, out=tmp_path / str(number), generations=1, cache=cache, workers=1)
        cached.append(sum(record.cached for record in run.search_records))
    assert cached == [0, 8, 0, 8, 8]
    said = [message for message in caplog.messages if "another program" in message]
    assert len(said) == 1
    assert said[0].endswith("results of another program are not used: manifold3d was 3.0.0, is 3.5.4")


def test_a_worker_with_another_library_is_refused(tmp_path):
    there = study(libraries={"manifold3d": "3.5.4"})
    here = StudyRef(there.source, "another", there.loader, Identity({"source": there.hash}, {"manifold3d": "3.0.0"}))
    with LocalPool(here, 1, Limits(), None) as pool:
        pool.submit(Task(0, there.space.from_indices((0, 0, 0)).to_dict()))
        with pytest.raises(ExecutionError, match=r"manifold3d was 3\.0\.0, is 3\.5\.4"):
            while not pool.collect(5.0):
                pass


def test_what_was_stored_without_identity_says_so():
    assert "nothing but a hash" in Identity.from_document(None).differences(Identity({"robot": "a"}))


# --- modules beside the study file -----------------------------------------------------------------------------------


OBJECTIVES = 'minimize = ["momentum", "joint_velocity", "thrust"]'


def study_with_helper(folder: Path, factor: float, how: str = "from helpers import factor") -> Path:
    """The template study, its strut's density scaled by a number of a helper module."""
    new_study(folder)
    (folder / "helpers.py").write_text(f"def factor():\n    return {factor}\n")
    (folder / "unused.py").write_text("raise RuntimeError('nobody imports this')\n")
    (folder / "objective.py").write_text(f"{how}\n\n\ndef cost(document):\n    return {call(how)}\n")
    file = folder / "study.toml"
    text = file.read_text()
    assert OBJECTIVES in text
    file.write_text(text.replace(OBJECTIVES, 'minimize = ["objective:cost"]'))
    return folder


def call(how: str) -> str:
    return "helpers.factor()" if how.endswith("helpers") else "factor()"


WAYS = ["from helpers import factor", "import helpers", "from . import helpers", "from .helpers import factor"]


@pytest.mark.parametrize("how", WAYS)
def test_helpers_of_two_studies_do_not_meet(tmp_path, how):
    before = set(sys.modules)
    costs = [
        load_study(study_with_helper(tmp_path / name, value, how)).functions["objective:cost"]({})
        for name, value in (("first", 1.5), ("second", 2.5))
    ]
    assert costs == [1.5, 2.5]
    assert "helpers" not in set(sys.modules) - before


def test_helpers_are_found_when_a_function_imports_them(tmp_path):
    folders = [study_with_helper(tmp_path / name, value) for name, value in (("first", 1.0), ("second", 2.0))]
    for folder in folders:
        (folder / "objective.py").write_text("def cost(document):\n    import helpers\n\n    return helpers.factor()\n")
    functions = [load_study(folder).functions["objective:cost"] for folder in folders]
    assert [function({}) for function in functions] == [1.0, 2.0]


def test_helpers_are_hashed_if_imported_and_edits_count(tmp_path):
    folder = study_with_helper(tmp_path / "study", 1.0)
    first = load_study(folder)

    (folder / "unused.py").write_text("# edited\n")
    _load.cache_clear()
    assert load_study(folder).hash == first.hash

    (folder / "helpers.py").write_text("def factor():\n    return 7.0\n")
    _load.cache_clear()
    second = load_study(folder)
    assert second.functions["objective:cost"]({}) == 7.0
    assert first.identity.differences(second.identity) == "the code of the parts has changed"
    assert first.code_hash != second.code_hash


def test_where_a_study_lies_does_not_matter(tmp_path):
    hashes = {load_study(study_with_helper(tmp_path / name, 1.0)).hash for name in ("here", "there")}
    assert len(hashes) == 1


def test_a_package_beside_the_study_counts_wholly_as_far_as_imported(tmp_path):
    folder = study_with_helper(tmp_path / "study", 1.0, "from tools.maths import factor")
    (folder / "tools").mkdir()
    (folder / "tools" / "__init__.py").write_text("")
    (folder / "tools" / "maths.py").write_text("from .numbers import VALUE\n\n\ndef factor():\n    return VALUE\n")
    (folder / "tools" / "numbers.py").write_text("VALUE = 3.0\n")
    first = load_study(folder)
    assert first.functions["objective:cost"]({}) == 3.0
    (folder / "tools" / "numbers.py").write_text("VALUE = 4.0\n")
    _load.cache_clear()
    second = load_study(folder)
    assert second.functions["objective:cost"]({}) == 4.0
    assert second.hash != first.hash


def test_libraries_that_only_a_study_uses_count(tmp_path, pretend):
    folder = study_with_helper(tmp_path / "study", 1.0)
    (folder / "helpers.py").write_text("import plotly\n\n\ndef factor():\n    return 1.0\n")
    first = load_study(folder)
    assert first.identity.libraries["plotly"] == metadata.version("plotly")
    pretend("plotly", "0.0.1")
    assert load_study(folder).hash != first.hash
    assert fingerprint.engine_hash() == first.identity.sources["engine"]
