"""codesign.dynamics as Python sees it: names, shapes, refusals. The physics is tested in C++ and against references."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from codesign import dynamics as dyn
from codesign.errors import SolverError, UnknownNameError, UrdfError
from codesign.robot.description import RobotDescription
from codesign.transforms import quaternion as quaternion_of
from codesign.transforms import rotation_from_rpy

INERTIAL = "<inertial><mass value='2'/><inertia ixx='0.2' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.2'/></inertial>"
ARM = f"""<robot name="arm">
  <link name="base">{INERTIAL}</link>
  <link name="upper">{INERTIAL}</link>
  <link name="lower">{INERTIAL}</link>
  <link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.5"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="30" velocity="4"/><dynamics damping="9"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="lower"/><origin xyz="0.4 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.3" effort="100" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.2 0 0"/></joint>
</robot>"""
POSE = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
S = np.array([0.3, 0.1])
WRIST = {"trunk": INERTIAL, "first": "", "second": "", "hand": INERTIAL}
NU = np.arange(1.0, 9.0)
TAU = np.array([3.0, -2.0])

SHAPES = {
    "mass_matrix": ((), (8, 8)),
    "bias_forces": ((NU,), (8,)),
    "gravity_forces": ((), (8,)),
    "inverse_dynamics": ((NU, 2 * NU), (8,)),
    "forward_dynamics": ((NU, TAU), (8,)),
    "center_of_mass": ((), (3,)),
    "center_of_mass_velocity": ((NU,), (3,)),
    "center_of_mass_jacobian": ((), (3, 8)),
    "centroidal_momentum": ((NU,), (6,)),
    "centroidal_momentum_matrix": ((), (6, 8)),
    "centroidal_momentum_bias": ((NU,), (6,)),
    "locked_inertia": ((), (3, 3)),
    "kinetic_energy": ((NU,), ()),
    "potential_energy": ((), ()),
    "frame_pose": (("tip",), (4, 4)),
    "frame_jacobian": (("tip",), (6, 8)),
    "frame_velocity": ((NU, "tip"), (6,)),
    "frame_bias_acceleration": ((NU, "tip"), (6,)),
}


@pytest.fixture(scope="module")
def arm() -> dyn.Model:
    return dyn.load_urdf(ARM)


def test_model(arm: dyn.Model) -> None:
    assert arm.name == "arm"
    assert arm.joint_names == ["shoulder", "slide"]
    assert arm.frame_names == ["base", "upper", "lower", "tip"]
    assert arm.base_link == "base"
    assert arm.total_mass == 6.0
    assert arm.dofs == 8
    assert not arm.fixed_base
    assert arm.joint_limits["slide"] == {"lower": 0.0, "upper": 0.3, "velocity": 1.0, "effort": 100.0}
    assert repr(arm) == '<Model "arm": 2 joints, floating base, 6.0 kg>'


def test_every_function_is_public() -> None:
    assert set(SHAPES) | {"Model", "load_urdf"} <= set(dyn.__all__)


@pytest.mark.parametrize("name", SHAPES)
def test_shapes(arm: dyn.Model, name: str) -> None:
    arguments, shape = SHAPES[name]
    result = np.asarray(getattr(dyn, name)(arm, POSE, S, *arguments))
    assert result.shape == shape
    assert result.dtype == np.float64
    assert result.flags.c_contiguous
    assert np.isfinite(result).all()


@pytest.mark.parametrize("name", SHAPES)
def test_wrong_shapes_are_refused_by_name(arm: dyn.Model, name: str) -> None:
    function, arguments = getattr(dyn, name), SHAPES[name][0]
    with pytest.raises(ValueError, match=r"base_pose must have shape \(4, 4\), got \(3, 3\)"):
        function(arm, np.eye(3), S, *arguments)
    with pytest.raises(ValueError, match=r"s must have shape \(2,\), got \(3,\)"):
        function(arm, POSE, np.zeros(3), *arguments)
    with pytest.raises(ValueError, match=r"s must have shape \(2,\), got \(2, 1\)"):
        function(arm, POSE, np.zeros((2, 1)), *arguments)
    with pytest.raises(ValueError, match="s must be finite"):
        function(arm, POSE, [0.0, np.nan], *arguments)
    if arguments and arguments[0] is NU:
        with pytest.raises(ValueError, match=r"nu must have shape \(8,\), got \(2,\)"):
            function(arm, POSE, S, np.zeros(2), *arguments[1:])
    if arguments and isinstance(arguments[-1], str):
        with pytest.raises(UnknownNameError, match=r'no frame "hand"; it has: base, upper, lower, tip'):
            function(arm, POSE, S, *arguments[:-1], "hand")


def test_base_pose_must_be_a_pose(arm: dyn.Model) -> None:
    for bad in (2 * POSE, -POSE, POSE @ np.diag([1, 1, -1, 1]), POSE.T, np.full((4, 4), np.inf)):
        with pytest.raises(ValueError, match="base_pose must be"):
            dyn.mass_matrix(arm, bad, S)


def test_lists_integers_and_strided_arrays_are_taken(arm: dyn.Model) -> None:
    expected = dyn.bias_forces(arm, POSE, S, NU)
    pose = np.asfortranarray(POSE)
    assert np.array_equal(dyn.bias_forces(arm, pose.tolist(), S.tolist(), NU.astype(int)), expected)
    assert np.array_equal(dyn.bias_forces(arm, pose, np.repeat(S, 2)[::2], np.repeat(NU, 3)[::3]), expected)


def test_wrenches(arm: dyn.Model) -> None:
    wrench = np.array([1.0, -2, 3, 0.4, 0.5, -0.6])
    M, b = dyn.mass_matrix(arm, POSE, S), dyn.bias_forces(arm, POSE, S, NU)
    J = dyn.frame_jacobian(arm, POSE, S, "tip")
    free = dyn.forward_dynamics(arm, POSE, S, NU, TAU)
    pushed = dyn.forward_dynamics(arm, POSE, S, NU, TAU, wrenches={"tip": wrench, "base": np.zeros(6)})
    assert np.allclose(M @ free + b, np.r_[np.zeros(6), TAU], atol=1e-10)
    assert np.allclose(M @ (pushed - free), J.T @ wrench, atol=1e-10)
    assert np.array_equal(dyn.forward_dynamics(arm, POSE, S, NU, TAU), free)  # nothing is left over
    with pytest.raises(ValueError, match=r"wrench on tip must have shape \(6,\), got \(3,\)"):
        dyn.forward_dynamics(arm, POSE, S, NU, TAU, {"tip": np.zeros(3)})
    with pytest.raises(UnknownNameError, match='no frame "hand"'):
        dyn.forward_dynamics(arm, POSE, S, NU, TAU, {"hand": wrench})


def test_fixed_base() -> None:
    fixed = dyn.load_urdf(ARM, fixed_base=True)
    assert fixed.dofs == 2
    floating = dyn.load_urdf(ARM)
    assert np.array_equal(dyn.mass_matrix(fixed, POSE, S), dyn.mass_matrix(floating, POSE, S)[6:, 6:])
    acceleration = dyn.forward_dynamics(fixed, POSE, S, [0.5, 0.1], TAU)
    assert np.allclose(dyn.inverse_dynamics(fixed, POSE, S, [0.5, 0.1], acceleration), TAU)


def test_joint_order_and_locked_joints() -> None:
    swapped = dyn.load_urdf(ARM, joints=["slide", "shoulder"])
    assert swapped.joint_names == ["slide", "shoulder"]
    order = [*range(6), 7, 6]
    whole = dyn.load_urdf(ARM)
    M = dyn.mass_matrix(whole, POSE, S)
    assert np.allclose(dyn.mass_matrix(swapped, POSE, S[::-1]), M[np.ix_(order, order)], rtol=0, atol=1e-15)
    locked = dyn.load_urdf(ARM, joints=["shoulder"])
    full = dyn.mass_matrix(whole, POSE, [0.3, 0.0])
    assert np.allclose(dyn.mass_matrix(locked, POSE, [0.3]), full[:7, :7], rtol=0, atol=1e-14)
    assert dyn.load_urdf(ARM, joints=[]).dofs == 6


def test_text_path_and_string_path(tmp_path: Path) -> None:
    path = tmp_path / "arm äöü.urdf"
    path.write_text(ARM)
    for source in (ARM, "\n  " + ARM, path, str(path)):
        assert dyn.load_urdf(source).joint_names == ["shoulder", "slide"]
    with pytest.raises(UrdfError, match=r"nowhere\.urdf"):
        dyn.load_urdf(tmp_path / "nowhere.urdf")
    with pytest.raises(TypeError):
        dyn.load_urdf(7)


def test_errors_are_typed_and_name_the_element() -> None:
    with pytest.raises(UrdfError, match='link "lower": negative mass'):
        dyn.load_urdf(ARM.replace(f'"lower">{INERTIAL}', '"lower">' + INERTIAL.replace("'2'", "'-2'")))
    with pytest.raises(UrdfError, match='robot "arm" has no joint "wrist"') as caught:
        dyn.load_urdf(ARM, joints=["wrist"])
    assert isinstance(caught.value, UnknownNameError)
    assert isinstance(caught.value, ValueError)
    broken = ARM.replace(INERTIAL, INERTIAL.replace("ixx='0.2'", "ixx='-0.2'"), 1)
    with pytest.raises(UrdfError, match='link "base": non-physical inertia'):
        dyn.load_urdf(broken)
    assert dyn.load_urdf(broken, as_published=True).total_mass == 6.0


def test_singular_dynamics_are_a_solver_error() -> None:
    """Roll, pitch, roll through crosses without mass: regular but for a straight wrist, whose rolls are one."""
    links = "".join(f'<link name="{name}">{inside}</link>' for name, inside in WRIST.items())
    joints = "".join(
        f'<joint name="{child}" type="continuous"><parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
        "</joint>"
        for (parent, child), axis in zip(pairwise(WRIST), ("1 0 0", "0 1 0", "1 0 0"), strict=True)
    )
    model = dyn.load_urdf(f'<robot name="wrist">{links}{joints}</robot>')
    with pytest.raises(SolverError, match="singular"):
        dyn.forward_dynamics(model, np.eye(4), np.zeros(3), np.zeros(9), np.ones(3))
    bent = np.array([0.1, 0.7, -0.2])
    nu_dot = dyn.forward_dynamics(model, np.eye(4), bent, np.zeros(9), np.ones(3))
    forces = dyn.inverse_dynamics(model, np.eye(4), bent, np.zeros(9), nu_dot)
    np.testing.assert_allclose(forces, [0, 0, 0, 0, 0, 0, 1, 1, 1], atol=1e-12)


def test_motions_without_mass_are_refused_with_their_joint() -> None:
    with pytest.raises(UrdfError, match='joint "slide" can move without anything that has mass'):
        dyn.load_urdf(ARM.replace(INERTIAL, "").replace('<link name="base">', f'<link name="base">{INERTIAL}'))
    point = INERTIAL.replace("'0.2'", "'0'")
    text = ARM.replace(f'"lower">{INERTIAL}', f'"lower">{point}').replace("prismatic", "revolute")
    with pytest.raises(UrdfError, match='joint "slide" can move without anything that has mass'):
        dyn.load_urdf(text, as_published=True)
    root = ARM.replace(f'<link name="base">{INERTIAL}', '<link name="base">')
    with pytest.raises(UrdfError, match=r'link "base" can move without .*; fixed_base=True, which holds link "base"'):
        dyn.load_urdf(root)
    assert len(dyn.load_urdf(root, fixed_base=True).joint_names) == 2


def test_all_faults_are_named_at_once() -> None:
    text = ARM.replace('xyz="0 0 0.5"', 'xyz="0 0 x"').replace('xyz="1 0 0"', 'xyz="0 0 0"').replace('"30"', '"a"')
    with pytest.raises(UrdfError) as caught:
        dyn.load_urdf(text)
    for words in ('"x" is not a number', "an axis of length zero", 'limit effort: "a" is not'):
        assert words in str(caught.value)
    bad = INERTIAL.replace("ixx='0.2'", "ixx='-0.2'")
    with pytest.raises(UrdfError, match=r'"base": non-phys.*"upper": non-phys.*"lower" with those fixed'):
        dyn.load_urdf(ARM.replace(INERTIAL, bad))


def test_masses_are_judged_as_they_move() -> None:
    """A marker of a microgram with a wrong tensor costs no robot; a body as a whole must be one."""
    numbers = " ".join(f"i{key}='1e-6'" for key in ("xx", "xy", "xz", "yy", "yz", "zz"))
    marker = f"<inertial><mass value='1e-6'/><inertia {numbers}/></inertial>"
    text = ARM.replace('<link name="tip"/>', f'<link name="tip">{marker}</link>')
    assert dyn.load_urdf(text).total_mass == pytest.approx(6.000001)
    assert RobotDescription.from_text(text).total_mass == pytest.approx(6.000001)


def test_a_quaternion_places_as_its_angles_do() -> None:
    rpy, quaternion = 'rpy="0.3 1.5707963 -2"', "{0!r} {1!r} {2!r} {3!r}"
    R = rotation_from_rpy([0.3, 1.5707963, -2.0])
    w, x, y, z = (2.0 * quaternion_of(R)).tolist()  # of any length
    origin = '<origin xyz="0.4 0 0"'
    turned = ARM.replace(origin, f"{origin} {rpy}")
    text = ARM.replace(origin, f'{origin} quat_xyzw="{quaternion.format(x, y, z, w)}"')
    for read in (dyn.load_urdf, RobotDescription.from_text):
        a, b = (read(one) for one in (turned, text))
        if isinstance(a, RobotDescription):
            a, b = (one.frame_poses()["tip"] for one in (a, b))
        else:
            a, b = (dyn.frame_pose(one, np.eye(4), np.zeros(2), "tip") for one in (a, b))
        np.testing.assert_allclose(a, b, atol=1e-15)
    with pytest.raises(UrdfError, match="both rpy and quat_xyzw"):
        dyn.load_urdf(ARM.replace(origin, f'{origin} {rpy} quat_xyzw="0 0 0 1"'))


def test_threads_share_a_model(arm: dyn.Model) -> None:
    states = [np.array([0.01 * k, 0.02 * k]) for k in range(200)]
    expected = [dyn.mass_matrix(arm, POSE, s) for s in states]
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda s: dyn.mass_matrix(arm, POSE, s), states))
    assert all(np.array_equal(a, b) for a, b in zip(found, expected, strict=True))


def test_numbers_are_read_alike_under_a_decimal_comma_locale(tmp_path: Path) -> None:
    command = ["localedef", "-i", "de_DE", "-f", "UTF-8", str(tmp_path / "de_DE.UTF-8")]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (tmp_path / "de_DE.UTF-8").is_dir(), f"apt: locales: {made.stderr}"
    script = """
import locale, sys
locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
assert locale.str(0.5) == "0,5"
from codesign import dynamics as dyn
model = dyn.load_urdf(sys.argv[1])
print(dyn.mass_matrix(model, [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], [0.3, 0.1]).tobytes().hex())
"""
    environment = os.environ | {"LOCPATH": str(tmp_path), "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    run = subprocess.run(
        [sys.executable, "-c", script, ARM], env=environment, capture_output=True, text=True, check=True
    )
    expected = dyn.mass_matrix(dyn.load_urdf(ARM), np.eye(4), S)
    assert run.stdout.strip() == expected.tobytes().hex()


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(UrdfError, match="defined twice"):
        dyn.load_urdf(ARM.replace('"tip"', '"upper"'))
    assert capfd.readouterr() == ("", "")
