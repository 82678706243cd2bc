"""The checks of layering find what they are for; `make check` runs them on the sources themselves."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
LINT_IMPORTS = "from importlinter.cli import lint_imports_command as command; command()"


def test_an_import_of_a_higher_wing_is_found(tmp_path):
    package = tmp_path / "codesign"
    source = REPOSITORY / "python" / "codesign"
    shutil.copytree(source, package, ignore=lambda _, names: [n for n in names if n.endswith((".pyi", ".so", ".js"))])
    shutil.copy(REPOSITORY / "pyproject.toml", tmp_path)
    with (package / "geometry" / "mass.py").open("a") as file:
        file.write("\n\ndef shown():\n    from codesign.cli.console import out\n\n    return out\n")
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{':'.join(sys.path)}"}
    command = [sys.executable, "-S", "-c", LINT_IMPORTS, "--no-cache"]  # -S: not the installed package
    result = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert result.returncode != 0
    assert "codesign.geometry.mass -> codesign.cli.console" in result.stdout, result.stdout + result.stderr


@pytest.mark.parametrize(
    ("file", "include", "reason"),
    [
        ("fem/mesh/a.cpp", '"fem/meshing/b.hpp"', "fem/mesh/a.cpp:2: fem/mesh must not include fem/meshing/b.hpp"),
        ("fem/boundary/a.hpp", '"fem/la/b.hpp"', "fem/boundary must not include fem/la/b.hpp"),
        ("fem/meshing/a.cpp", '"fem/smoothing/b.hpp"', "fem/meshing must not include fem/smoothing/b.hpp"),
        ("fem/stress/a.cpp", '"fem/part_analysis.hpp"', "fem/stress must not include fem/part_analysis.hpp"),
        ("fem/a.cpp", '"dynamics/b.hpp"', "fem must not include dynamics/b.hpp"),
        ("dynamics/a.cpp", '"fem/mesh/b.hpp"', "dynamics must not include fem/mesh/b.hpp"),
        ("dynamics/a.hpp", '"dynamics/flight/b.hpp"', "dynamics must not include dynamics/flight/b.hpp"),
        (
            "dynamics/predictive/a.cpp",
            '"dynamics/flight/b.hpp"',
            "dynamics/predictive must not include dynamics/flight",
        ),
        ("errors.hpp", '"dynamics/b.hpp"', "cpp must not include dynamics/b.hpp"),
        ("fem/la/a.hpp", "<cholmod.h>", "cholmod.h belongs into sources of fem/la"),
        ("dynamics/a.cpp", "<CGAL/Mesh_3.h>", "CGAL/Mesh_3.h belongs into sources of"),
        ("fem/elasticity/a.cpp", '"fem/stress/b.hpp"', ""),
        ("fem/la/a.cpp", "<cholmod.h>", ""),
        ("bindings/a.hpp", "<pybind11/eigen.h>", ""),
        ("bindings/a.cpp", '"dynamics/b.hpp"', ""),
    ],
)
def test_an_include_of_a_higher_layer_is_found(tmp_path, file, include, reason):
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text(f"#pragma once\n#include {include}\n")
    command = [sys.executable, str(REPOSITORY / "scripts" / "check_includes.py"), str(tmp_path)]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == (1 if reason else 0)
    assert (reason in result.stdout) if reason else not result.stdout


def test_no_module_hides_a_name_that_its_package_offers():
    """`from codesign.geometry import plate` was the module once that was loaded."""
    root, hidden = REPOSITORY / "python", []
    for file in root.rglob("__init__.py"):
        package = ".".join(file.parent.relative_to(root).parts)
        modules = {path.stem for path in (*file.parent.glob("*.py"), *file.parent.glob("*/"))}
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{package}."):
                own = str(node.module).rpartition(".")[2]  # a name of its own module is bound after it is loaded
                offered = {alias.asname or alias.name for alias in node.names}
                hidden += [f"{package}.{name}" for name in (offered & modules) - {own}]
    assert hidden == []
