#!/bin/sh
# A body with two hinges in an MJCF, read by Drake.
#
# Guess, written first: a body 1 m in front of its parent with two hinges through its origin has the same poses and gravity
# torques in Drake as in MuJoCo: the origin stays where it is, whichever hinge turns.
# Seen (drake 1.51.1 and 1.58.0, mujoco 4.0.0): as long as all joints are at zero all poses agree. But all hinges except the
# last turn about the origin of the parent: the first one at 90 degrees moves the body by 1.41 m, and holding it takes
# 9.81 Nm for 1 kg at the hinge where it takes none. The axes of slides before the last joint are the parent's as well. A
# body with one joint is right. Pinocchio 4.1.0 is right with all. In the humanoid.xml of pybullet 3.2.7 (three hinges a
# hip) a foot is 12 cm off with joints within 0.5 rad. No warning is given.
#
# Exit code 0 while that is so. Needs python3 with venv and the network.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps \
    drake==1.51.1 mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6 absl-py
cd "$folder"
venv/bin/python - <<'PYTHON'
import math

import mujoco
import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

GRAVITY = 9.81  # m/s^2, the default of both
FIRST, LAST = '<joint name="first" axis="0 1 0"/>', '<joint name="last" axis="0 0 1"/>'


def robot(joints):
    body = f'<body name="b" pos="1 0 0">{joints}<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>'
    return f'<mujoco model="r"><worldbody>{body}</worldbody></mujoco>'


def in_mujoco(text, angles):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for name, angle in angles.items():
        data.joint(name).qpos = angle
    mujoco.mj_forward(model, data)
    return data.body("b").xpos, {name: float(data.joint(name).qfrc_bias[0]) for name in angles}


def in_drake(text, angles):
    plant = MultibodyPlant(time_step=0.0)
    Parser(plant).AddModelsFromString(text, "xml")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    for name, angle in angles.items():
        plant.GetJointByName(name).set_angle(context, angle)
    torques = -plant.CalcGravityGeneralizedForces(context)
    place = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("b")).translation()
    return place, {name: float(torques[plant.GetJointByName(name).velocity_start()]) for name in angles}


# A hinge through the origin of the body moves no origin and holds no weight: 1 0 0 and no torque, without any library.
for joints, angles, place, torque in (
    (FIRST, {"first": math.pi / 2}, (1, 0, 0), 0.0),
    (FIRST + LAST, {"first": 0.0, "last": 0.0}, (1, 0, 0), -GRAVITY),
    (FIRST + LAST, {"first": 0.0, "last": math.pi / 2}, (1, 0, 0), -GRAVITY),
    (FIRST + LAST, {"first": math.pi / 2, "last": 0.0}, (0, 0, -1), 0.0),
):
    right, no_torques = in_mujoco(robot(joints), angles)
    assert np.allclose(right, (1, 0, 0), atol=1e-12) and max(map(abs, no_torques.values())) < 1e-12, "changed: MuJoCo"
    found, torques = in_drake(robot(joints), angles)
    assert np.allclose(found, place, atol=1e-12), f"changed: the body is at {found} for {angles}"
    assert abs(torques["first"] - torque) < 1e-12, f"changed: {torques['first']} Nm for {angles}"
print("as found: the first of two hinges turns the body about its parent: at", found.round(12) + 0.0, "not at [1 0 0]")
PYTHON
