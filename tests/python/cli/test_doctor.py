"""`codesign doctor`, and what other commands say where a library is missing, too old or broken."""

import sys
from importlib import metadata

import pytest

import codesign
from codesign.cli import doctor
from codesign.cli.commands.doctor import doctor as doctor_command
from codesign.cli.main import main
from codesign.errors import LibraryError
from codesign.parts import write_step
from codesign.study import load
from codesign.study.study import StudyData

REQUIRES = [
    "numpy>=1.26",
    "scipy>=1.15.0",
    "pymoo>=0.6.1.6,<0.7",
    "cadquery-ocp-novtk>=8.0",
    'viser>=1.1.0; extra == "view"',
    'no-such-package>=2; extra == "view"',
    'pytest>=8; extra == "test"',
]


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch):
    """A function that pretends versions of installed packages (None: not installed)."""
    true_version = metadata.version

    def pretend(**versions: str | None) -> None:
        def version(name: str) -> str:
            if name not in versions:
                return true_version(name)
            if versions[name] is None:
                raise metadata.PackageNotFoundError(name)
            return str(versions[name])

        monkeypatch.setattr(metadata, "requires", lambda name: REQUIRES)
        monkeypatch.setattr(metadata, "version", version)

    return pretend


@pytest.mark.parametrize(
    ("versions", "kind", "line"),
    [
        ({"scipy": "1.14"}, "too old", "scipy 1.14 (>=1.15.0 needed)"),
        ({"pymoo": "0.6.1"}, "too old", "pymoo 0.6.1 (<0.7,>=0.6.1.6 needed)"),
        ({"pymoo": "0.7.0"}, "too new", "pymoo 0.7.0 (<0.7,>=0.6.1.6 needed)"),
        ({"viser": "1.0.0"}, "too old", "viser 1.0.0 (>=1.1.0 needed)"),
        ({"numpy": None}, "missing", "numpy"),
    ],
)
def test_versions_that_do_not_fit_fail(installed, capsys, versions, kind, line):
    installed(**versions)
    assert doctor.diagnose()["problems"] == {kind: [line]}
    assert doctor_command() == 1
    assert f"{kind}: {line}" in capsys.readouterr().out


def test_what_fits_passes_and_optional_packages_may_be_missing(installed):
    installed()
    report = doctor.diagnose()
    assert report["problems"] == {}
    assert report["optional, missing"] == ["no-such-package (codesign view)"]
    assert "pytest" not in report["packages"]
    assert doctor_command() == 0


@pytest.fixture
def broken_opencascade(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.startswith("OCP")]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("codesign.parts.step", "codesign.parts.drawing", "codesign.geometry.brep"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.setattr(sys, "meta_path", [_NoOpenCascade(), *sys.meta_path])


class _NoOpenCascade:
    def find_spec(self, name, path=None, target=None):
        if name.startswith("OCP"):
            raise ImportError("libGL.so.1: cannot open shared object file:\n No such file or directory")


def test_a_library_that_cannot_be_loaded_is_named_in_one_line(installed, broken_opencascade):
    installed()
    problem = "cadquery-ocp-novtk: ImportError: libGL.so.1: cannot open shared object file: No such file or directory"
    assert doctor.diagnose()["problems"] == {"cannot be loaded": [problem]}


def test_export_without_opencascade_is_a_typed_error(broken_opencascade, tmp_path, monkeypatch, capsys):
    study = load("gimbal_quad", StudyData)
    part = study.part_classes["strut"](reach=200, height=30, density=2700.0)
    with pytest.raises(LibraryError, match=r"STEP needs a library .*libGL\.so\.1"):
        write_step(part, tmp_path / "strut.step")
    design = ["--study", "gimbal_quad", "--set", "reach=200", "--set", "height=30"]
    monkeypatch.setattr(sys, "argv", ["codesign", "export", *design, "--out", str(tmp_path / "out")])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    said = "LibraryError: a drawing needs a library that cannot be loaded: libGL.so.1"
    assert capsys.readouterr().err.startswith(said)


def test_version(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["codesign", "--version"])
    with pytest.raises(SystemExit) as end:
        main()
    assert (end.value.code, capsys.readouterr().out) == (0, f"codesign {codesign.__version__}\n")


def test_any_missing_library_ends_a_command_in_one_line(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "codesign.storage.runs", None)
    monkeypatch.setattr(sys, "argv", ["codesign", "runs", str(tmp_path)])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1
