#!/bin/sh
# A joint that mimics another one in Pinocchio.
#
# Guess, written first: whether a robot with a mimic joint loads depends on what follows what, not on how the joints are
# called: two fingers on one hand, of which one mimics the other, load with mimic=True under any names.
# Seen (pin 4.1.0): the children of a link are visited in the order of their names, and a joint that is visited before the
# one that it mimics is refused: "The parent joint of the mimic joint is not in the kinematic tree". With the joints
# "a" and "b" the robot loads if b mimics a, and is refused if a mimics b. Without mimic=True both load. Talos
# (talos_full_v2 of example-robot-data 6.0.0) and JVRC (jvrc-description 1.1.1) are refused so.
#
# Exit code 0 while that is so. Needs python3 with venv and the network.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check pin==4.1.0
"$folder/venv/bin/python" - <<'PYTHON'
import pinocchio as pin

BODY = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'


def hand(leader, follower):
    """Two fingers on one link, the leader first in the file."""
    text = f'<link name="palm">{BODY}</link>'
    for name, mimic in ((leader, ""), (follower, f'<mimic joint="{leader}"/>')):
        text += f'<link name="{name}">{BODY}</link><joint name="{name}" type="continuous"><parent link="palm"/>'
        text += f'<child link="{name}"/><axis xyz="0 0 1"/>{mimic}</joint>'
    return f'<robot name="hand">{text}</robot>'


assert pin.buildModelFromXML(hand("a", "b"), mimic=True).nv == 1, "changed: b mimics a"
assert pin.buildModelFromXML(hand("b", "a")).nv == 2
try:
    pin.buildModelFromXML(hand("b", "a"), mimic=True)
except ValueError as error:
    print("as found: a mimics b is refused:", error)
else:
    raise SystemExit("changed: a robot in which a mimics b loads")
PYTHON
