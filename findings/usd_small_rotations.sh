#!/bin/sh
# A frame that a URDF turns by a small angle, converted to USD.
#
# Guess, written first: urdf-usd-converter writes orientations as quaternions in single precision, whose small imaginary
# part is as exact as its real one (1e-7 of itself): a joint turned by 1e-3 rad or by 2e-4 rad comes back within 1e-7 rad.
# Seen (urdf-usd-converter 0.3.4, usd-exchange 3.0.1, OpenUSD 26.8): 1e-3 rad come back as 9.77e-4, 2e-4 rad as 0: the
# angle is taken from the real part, the cosine of its half, which single precision rounds to 6e-8. 1 degree is 2.4e-6
# rad off, 90 degrees 1e-7.
#
# Exit code 0 while that is so. Needs python3 with venv and the network.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check urdf-usd-converter==0.3.4 usd-exchange==3.0.1
cd "$folder"
venv/bin/python - <<'PYTHON' 2>log || { tail -n 5 log; exit 1; }
import math
from pathlib import Path

from pxr import Usd
from urdf_usd_converter import Converter

INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'


def there_and_back(angle):
    links = "".join(f'<link name="{name}">{INERTIAL}</link>' for name in ("base", "tip"))
    joint = f'<joint name="j" type="fixed"><parent link="base"/><child link="tip"/><origin rpy="0 {angle!r} 0"/></joint>'
    Path("robot.urdf").write_text(f'<robot name="r">{links}{joint}</robot>')
    stage = Usd.Stage.Open(Converter().convert("robot.urdf", f"usd_{angle}").path)
    (tip,) = (prim for prim in stage.Traverse() if prim.GetName() == "tip")
    turn = tip.GetAttribute("xformOp:orient").Get()
    return 2.0 * math.atan2(turn.GetImaginary()[1], turn.GetReal())


found = {angle: there_and_back(angle) for angle in (2e-4, 1e-3, math.pi / 180, math.pi / 2)}
print({angle: f"{back - angle:.1e}" for angle, back in found.items()})
assert found[2e-4] == 0.0, f"changed: 2e-4 rad come back as {found[2e-4]}"
assert 2e-5 < abs(found[1e-3] - 1e-3) < 3e-5, f"changed: 1e-3 rad come back as {found[1e-3]}"
assert 2e-6 < abs(found[math.pi / 180] - math.pi / 180) < 3e-6, "changed: 1 degree"
assert abs(found[math.pi / 2] - math.pi / 2) < 2e-7, "changed: 90 degrees"
print(f"as found: 1e-3 rad come back as {found[1e-3]:.3g}, 2e-4 rad as {found[2e-4]:g}")
PYTHON
