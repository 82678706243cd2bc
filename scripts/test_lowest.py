"""Runs the main jobs with the lowest version of every package that pyproject.toml allows, on the core already compiled.

Usage: test_lowest.py [FOLDER]. The environment is made in FOLDER/venv (default build/lowest) if its packages changed.
Every lower bound must name a version that exists; packages that only others need are left to pip, as for a user.
"""

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import codesign
from codesign import _core

REPOSITORY = Path(__file__).resolve().parents[1]
EXTRAS = ("view", "cluster", "analysis")
DESIGN = ("--study", "gimbal_quad", "--set", "reach=200", "--set", "height=30")
SOLID_CUBE = "solid cube\n{}endsolid cube\n"


def lowest(project: dict) -> list[str]:
    """`name==version` of every direct dependency at its lower bound; a dependency without one is an error."""
    wanted = [*project["dependencies"], *(r for extra in EXTRAS for r in project["optional-dependencies"][extra])]
    pinned = []
    for requirement in wanted:
        match = re.match(r"([\w.-]+(?:\[[\w,]+\])?)\s*>=\s*([\w.]+)", requirement)
        if match is None:
            raise SystemExit(f"pyproject.toml: {requirement}: no lower bound")
        pinned.append(f"{match[1]}=={match[2]}")
    return sorted(pinned)


def make_environment(folder: Path, requirements: list[str]) -> Path:
    """A virtual environment with these packages and with codesign as it is here; returns its interpreter."""
    python, record = folder / "bin" / "python", folder / "requirements.txt"
    text = "\n".join(requirements) + "\n"
    if not record.is_file() or record.read_text() != text:
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "--disable-pip-version-check", *requirements], check=True)
        record.write_text(text)
    query = [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    site = Path(subprocess.run(query, check=True, capture_output=True, text=True).stdout.strip())
    for old in site.glob("codesign*"):
        shutil.rmtree(old)
    shutil.copytree(Path(codesign.__file__).parent, site / "codesign")
    core = Path(_core.__file__)
    shutil.copy(core, site / "codesign")
    for metadata in core.parents[1].glob("codesign-*.dist-info"):
        shutil.copytree(metadata, site / metadata.name)
    return python


def cube(size: float) -> str:
    """A cube as ASCII STL [mm]."""
    corners = [(x * size, y * size, z * size) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    facets = ""
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            points = "".join(f"vertex {' '.join(map(str, corners[i]))}\n" for i in triangle)
            facets += f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n"
    return SOLID_CUBE.format(facets)


def jobs(folder: Path) -> list[tuple[str, ...]]:
    """Arguments of the commands, in their order."""
    run = str(folder / "run")
    (folder / "cube.stl").write_text(cube(40.0))
    options = ("--study", "gimbal_quad", "--population", "4", "--generations", "2", "--workers", "1")
    return [
        ("doctor",),
        ("evaluate", *DESIGN),
        ("optimize", *options, "--out", run),
        ("resume", run, "--evaluations", "12", "--workers", "1"),
        ("optimize", *options[:-2], "--cluster", "local:1", "--out", f"{run}-cluster"),
        ("runs", str(folder)),
        ("validate", run, "--designs", "best", "--seeds", "1", "--workers", "1"),
        ("report", run),
        ("export", *DESIGN, "--out", str(folder / "design")),
        ("view", *DESIGN, "--record", str(folder / "flight.html")),
        ("stress", str(folder / "cube.stl"), "--fix", "normal:0,0,-1", "--load", "normal:0,0,1: 0 0 -250"),
    ]


def main() -> int:
    """Exit code 0 if every command ends with 0."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else REPOSITORY / "build" / "lowest").resolve()
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    python = make_environment(folder / "venv", lowest(project))
    work = folder / "jobs"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    failed = []
    for arguments in jobs(work):
        print("codesign", *arguments, flush=True)
        environment = {"PATH": "/usr/bin:/bin", "CODESIGN_CACHE": str(work / "cache"), "HOME": str(work)}
        done = subprocess.run(
            [python, "-m", "codesign.cli", *arguments], cwd=work, env=environment, capture_output=True, text=True
        )
        if done.returncode != 0:
            print(done.stdout[-3000:] + done.stderr[-3000:])
            failed.append(arguments[0])
    print(f"failed: {', '.join(failed)}" if failed else "all commands work at the lowest allowed versions")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
