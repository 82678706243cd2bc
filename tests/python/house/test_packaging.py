"""The package as others use it: built and installed by colcon, found by a C++ project, imported from there."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]


def run(*command: str, cwd: Path, **environment: str) -> str:
    env = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"} | environment
    result = subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, check=False)
    assert result.returncode == 0, f"{' '.join(command[:4])} …\n{result.stdout[-4000:]}{result.stderr[-4000:]}"
    return result.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install prefix of `colcon build`, hardly optimized: what is tested is where things go."""
    if shutil.which("colcon", path=f"{Path(sys.executable).parent}:{os.environ['PATH']}") is None:
        pytest.fail("colcon is missing: install the extra 'test'")
    base = tmp_path_factory.mktemp("colcon")
    run(
        *("colcon", "--log-base", str(base / "log"), "build", "--paths", str(REPOSITORY)),
        *("--build-base", str(base / "build"), "--install-base", str(base / "install")),
        *("--cmake-args", "-GNinja", "-DCMAKE_BUILD_TYPE=None", f"-DPython_EXECUTABLE={sys.executable}"),
        cwd=base,
        MAKEFLAGS=f"-j{os.cpu_count()}",  # colcon's own choice waits while the machine is busy
    )
    return base / "install" / "codesign"


def test_cpp_consumer_finds_and_links_the_libraries(installed, tmp_path):
    source = REPOSITORY / "tests" / "cmake_project"
    run("cmake", "-S", str(source), "-B", str(tmp_path), f"-DCMAKE_PREFIX_PATH={installed}", cwd=tmp_path)
    run("cmake", "--build", str(tmp_path), cwd=tmp_path)
    assert run(str(tmp_path / "consumer"), cwd=tmp_path).split() == ["2", "0.166667"]


def test_installed_python_package_imports(installed):
    site = next(installed.glob("lib*/**/site-packages"))
    code = "import codesign._core, codesign; print(codesign.__version__, codesign._core.__file__)"
    printed = run(sys.executable, "-S", "-c", code, cwd=installed, PYTHONPATH=f"{site}:{':'.join(sys.path)}")
    assert str(installed) in printed
