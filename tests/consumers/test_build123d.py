"""Parts drawn in build123d have mass, faces, files and strength as own parts."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from codesign.fem.step import load_step

EXAMPLE = Path(__file__).parents[2] / "examples" / "imported" / "build123d_clip.py"


def test_the_example(tmp_path):
    done = subprocess.run([sys.executable, EXAMPLE, tmp_path], capture_output=True, text=True, check=True)
    assert "clip width=50 height=25: 26.00 g" in done.stdout
    assert "faces: mount, seat" in done.stdout
    faces = {face.name: face for face in load_step(tmp_path / "clip.step").faces}
    assert faces["seat"].area == pytest.approx(np.pi * 36e-6)


def test_the_page_on_cad_files_makes_a_study(tmp_path):
    """Its two files as they stand, and the safety factor that it names."""
    page = (Path(__file__).parents[2] / "docs" / "howto" / "cad.md").read_text()
    for text in re.findall(r"^```(?:python|toml)\n# clip/(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        name, _, content = text.partition("\n")
        (tmp_path / name).write_text(content)
    evaluate = ("evaluate", "--study", tmp_path, "--set", "width=50", "--set", "height=25", "--no-cache", "--json")
    for command in (("check", tmp_path), evaluate):
        done = subprocess.run(
            [sys.executable, "-m", "codesign.cli", *command], capture_output=True, text=True, check=True
        )
    factor = json.loads(done.stdout)["parts"]["clip"]["safety_factor"]
    assert f"# safety factor {factor:.1f}" in page
