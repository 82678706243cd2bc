"""The example of a user's part runs and says what it should."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

from codesign.errors import GeometryError
from codesign.geometry.brep import build_brep

EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "part.py"


def test_example_writes_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE), str(tmp_path)])
    module = runpy.run_path(str(EXAMPLE), run_name="__main__")
    assert {file.name for file in tmp_path.iterdir()} == {"motor_angle.stl", "motor_angle.step"}
    printed = capsys.readouterr().out
    assert printed.startswith("motor_angle width=60 height=70 bore=22: ")
    assert "faces: mount, seat;" in printed
    part = module["MotorAngle"](60, 70, 22)
    exact = build_brep(part.shape())
    assert part.mass_properties().volume * 1e9 == pytest.approx(exact.volume, rel=1e-5)
    assert exact.area("mount") == pytest.approx(45 * 60 - 2 * np.pi * 2.75**2)
    with pytest.raises(GeometryError, match=r"motor_angle: width = 40 mm is below its limit 41\.2 mm"):
        module["MotorAngle"](40, 70, 22)
