"""Parts drawn in build123d have mass, faces, files and strength as own parts."""

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
