"""Clearances of bodies and jet plumes; distances of convex hulls against independent references."""

from pathlib import Path
from types import SimpleNamespace

import manifold3d
import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from codesign.dynamics import hull_distances
from codesign.errors import MeshError, StudyError, UrdfError
from codesign.robot.assembly import PartPlacement, Pose, place_points
from codesign.robot.clearance import (
    InterferenceSettings,
    PlumeSettings,
    check_interference,
    flown_interference,
    link_pieces,
    range_postures,
    telling_samples,
)
from codesign.robot.description import RobotDescription
from codesign.robot.hulls import axis_angle, convex_pieces, hull_vertices, smallest_axis_angle
from codesign.studies import ironcub
from codesign.studies.ironcub.forearm import ForearmJetSupport

# A base box, and a bar on a revolute joint that swings over it; a jet at the bar's end that blows along +z.
SWING = """<robot name="swing">
<link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="post"><visual><origin xyz="0 0 0.5"/>
<geometry><cylinder radius="0.01" length="1"/></geometry></visual></link>
<link name="bar"><visual><origin xyz="0.5 0 0"/><geometry><box size="1 0.02 0.02"/></geometry></visual></link>
<link name="ball"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
<link name="jet"/>
<joint name="up" type="fixed"><origin xyz="0 0 0.5"/><parent link="base"/><child link="post"/></joint>
<joint name="turn" type="continuous"><origin xyz="0 0 1"/>
<parent link="post"/><child link="bar"/><axis xyz="0 1 0"/></joint>
<joint name="end" type="fixed"><origin xyz="1 0 0"/><parent link="bar"/><child link="jet"/></joint>
<joint name="aside" type="fixed"><origin xyz="2 0 0"/><parent link="base"/><child link="ball"/></joint>
</robot>"""


@pytest.fixture(scope="module")
def swing():
    return RobotDescription.from_text(SWING)


def clearance(report, first, second):
    return next(c for c in report.clearances if {c.first, c.second} == {first, second})


def random_pairs(count, spread):
    generator = np.random.default_rng(2)
    hulls = [generator.normal(size=(30, 3)) * generator.uniform(0.02, 0.1, 3) for _ in range(8)]
    first, second = generator.integers(0, 8, (2, count))
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = Rotation.random(count, rng=generator).as_matrix()
    poses[:, :3, 3] = generator.normal(size=(count, 3)) * spread
    return hulls, first, second, poses


def placed(hull, pose):
    return hull @ pose[:3, :3].T + pose[:3, 3]


def test_distances_agree_with_constrained_least_squares():
    hulls, first, second, poses = random_pairs(150, 0.3)
    checked = 0
    for i, d in enumerate(hull_distances(hulls, first, second, poses)):
        if d <= 0.0:
            continue
        A, B = hulls[first[i]], placed(hulls[second[i]], poses[i])
        one, zero = np.full(len(A), 1e3), np.zeros(len(A))
        weights, _ = nnls(np.vstack([np.hstack([A.T, -B.T]), np.r_[one, zero], np.r_[zero, one]]), [0, 0, 0, 1e3, 1e3])
        a, b = weights[: len(A)], weights[len(A) :]
        assert d == pytest.approx(np.linalg.norm(a @ A / a.sum() - b @ B / b.sum()), abs=1e-10)
        checked += 1
    assert checked > 100


def test_depths_agree_with_the_facets_of_the_minkowski_difference():
    hulls, first, second, poses = random_pairs(60, 0.05)
    depths = hull_distances(hulls, first, second, poses)
    for i, d in enumerate(depths):
        difference = (hulls[first[i]][:, None] - placed(hulls[second[i]], poses[i])[None]).reshape(-1, 3)
        nearest_facet = ConvexHull(difference).equations[:, 3].max()
        assert (d < 0.0) == (nearest_facet < 0.0)
        if d < 0.0:
            assert d == pytest.approx(nearest_facet, abs=1e-9)
    assert np.count_nonzero(depths < 0.0) > 30


@pytest.mark.parametrize(
    ("hulls", "first", "second", "poses", "message"),
    [
        ([np.zeros((0, 3))], [0], [0], np.eye(4)[None], "shape"),
        ([np.full((1, 3), np.nan)], [0], [0], np.eye(4)[None], "finite"),
        ([np.zeros((1, 3))], [0], [1], np.eye(4)[None], "no hull 1"),
        ([np.zeros((1, 3))], [0], [-1], np.eye(4)[None], "no hull -1"),
        ([np.zeros((1, 3))], [0, 0], [0], np.eye(4)[None], "same shape"),
        ([np.zeros((1, 3))], [0], [0], np.eye(4), r"\(m, 4, 4\)"),
        ([np.zeros((1, 3))], [0], [0], np.full((1, 4, 4), np.inf), "finite"),
    ],
)
def test_wrong_distance_queries_are_refused(hulls, first, second, poses, message):
    with pytest.raises(ValueError, match=message):
        hull_distances(hulls, first, second, poses)


def test_no_pairs_give_no_distances():
    assert hull_distances([], [], [], np.zeros((0, 4, 4))).shape == (0,)


def test_a_swinging_bar_is_nearest_where_it_hangs_lowest(swing):
    postures = {"turn": np.deg2rad([0.0, 20.0, -20.0, 30.0, 10.0])}
    report = check_interference(swing, InterferenceSettings(bodies=("bar",), report_below_mm=2000), postures)
    found = clearance(report, "bar", "base")
    below = np.array([-np.sin(np.deg2rad(30)), -np.cos(np.deg2rad(30))])  # (x, z), out of the bar's lower side
    edge = np.array([0.5, 0.5]) - np.array([0.0, 1.5])  # of the base, from the joint
    assert found.posture == 3
    assert found.distance == pytest.approx(below @ edge - 0.01, abs=1e-12)


def test_a_bar_inside_the_base_reports_its_depth():
    robot = RobotDescription.from_text(SWING.replace('<origin xyz="0 0 1"/>', '<origin xyz="0 0 0.6"/>'))
    report = check_interference(robot, InterferenceSettings(bodies=("bar",)), {"turn": np.array([np.pi / 2])})
    # it hangs down the middle, its end 0.4 m below the base's top: the shortest way out is up
    assert clearance(report, "bar", "base").distance == pytest.approx(-0.4, abs=1e-9)
    assert report.min_clearance == pytest.approx(-0.4, abs=1e-9)


def test_neighbors_and_ignored_pairs_are_not_reported(swing):
    settings = InterferenceSettings(bodies=("bar", "post"), report_below_mm=5000)
    pairs = {(c.first, c.second) for c in check_interference(swing, settings, {}).clearances}
    assert pairs == {("base", "bar"), ("post", "ball"), ("bar", "ball")}
    settings = InterferenceSettings(bodies=("bar",), ignore=(("ball", "bar"),), report_below_mm=5000)
    assert [c.second for c in check_interference(swing, settings, {}).clearances] == ["bar"]


def test_what_stays_beyond_the_reporting_distance_is_left_out(swing):
    report = check_interference(swing, InterferenceSettings(bodies=("bar",), report_below_mm=100), {})
    assert report.clearances == ()
    assert report.min_clearance == report.min_plume_clearance == 0.1


@pytest.mark.parametrize(("turn_deg", "hit"), [(0, False), (155, True)])
def test_plumes_meet_what_they_point_at(swing, turn_deg, hit):
    # at 155° the bar points to −x and the jet blows down and towards the base's side
    plumes = PlumeSettings(jets=("jet",), half_angle_deg=10, radius_mm=10, start_mm=0, length_mm=3000)
    postures = {"turn": np.deg2rad([turn_deg])}
    report = check_interference(swing, InterferenceSettings(bodies=(), plumes=plumes), postures)
    base = [c for c in report.plumes if c.second == "base"]
    assert len(base) == hit
    for found in base:
        assert found.first == "jet"
        assert found.distance < -0.05
        assert found.angle == 0.0


def test_a_plume_that_blows_away_is_as_far_as_its_nozzle(swing):
    plumes = PlumeSettings(jets=("jet",), half_angle_deg=30, radius_mm=0.001, start_mm=0, length_mm=10000)
    settings = InterferenceSettings(bodies=(), plumes=plumes, report_below_mm=5000)
    report = check_interference(swing, settings, {"turn": np.array([0.0])})
    found = next(c for c in report.plumes if c.second == "ball")
    distance = np.hypot(1.0, 1.5)  # from the nozzle at (1, 0, 1.5) to the ball at (2, 0, 0); the jet blows up
    assert found.distance == pytest.approx(distance - 0.1, rel=2e-3)  # a ball of 32 × 17 points
    assert found.angle == pytest.approx(np.pi - np.arctan2(1.0, 1.5) - np.arcsin(0.1 / distance), rel=2e-3)


def test_the_angle_to_a_box_is_that_to_its_nearest_edge():
    box = np.array(np.meshgrid([-1.0, 1.0], [0.5, 2.0], [1.0, 3.0])).reshape(3, -1).T
    assert axis_angle(box) == pytest.approx(np.arctan2(0.5, 3.0), abs=1e-15)  # top edge, between its corners
    assert axis_angle(box - [0.0, 1.0, 0.0]) == 0.0
    behind = np.pi / 2 + np.arctan2(1.0, np.hypot(2.0, 1.0))  # its farthest corners from the axis
    assert axis_angle(box * [1.0, 1.0, -1.0]) == pytest.approx(behind, abs=1e-15)


def test_the_smallest_angle_is_that_of_all_pieces():
    generator = np.random.default_rng(8)
    for _ in range(40):
        pieces = [generator.normal(size=(12, 3)) * 0.3 + generator.normal(size=3) for _ in range(7)]
        pose = np.eye(4)
        pose[:3, :3] = Rotation.random(rng=generator).as_matrix()
        pose[:3, 3] = 2.0 * generator.normal(size=3)
        assert smallest_axis_angle(pieces, pose) == min(axis_angle(piece, pose) for piece in pieces)


def test_convex_pieces_cover_the_part_and_nothing_far_from_it():
    surface = ForearmJetSupport(90, 100).surface()
    pieces = convex_pieces(surface.points, surface.triangles, 8)
    assert len(pieces) == 8
    halfspaces = [ConvexHull(piece).equations for piece in pieces]
    inside = [(surface.points @ h[:, :3].T + h[:, 3]).max(axis=1) <= 1e-9 for h in halfspaces]
    assert np.any(inside, axis=0).all()
    volume = sum(ConvexHull(piece).volume for piece in pieces)
    assert volume < 0.45 * ConvexHull(surface.points).volume


def test_convex_pieces_are_the_hulls_of_slices_that_a_boolean_cuts():
    surface = ForearmJetSupport(90, 100).surface(24)
    body = manifold3d.Manifold(
        manifold3d.Mesh64(np.array(surface.points, dtype=float), np.array(surface.triangles, dtype=np.uint64))
    )
    axis = int(np.argmax(np.ptp(surface.points, axis=0)))
    x = surface.points[:, axis]
    cuts = np.linspace(x.max(), x.min() - 1e-3, 6)
    cuts[1:-1] = np.linspace(x.max(), x.min(), 6)[1:-1]
    for piece, cut in zip(convex_pieces(surface.points, surface.triangles, 5), cuts[1:], strict=True):
        above, body = body.split_by_plane(np.eye(3)[axis], float(cut))
        wanted = ConvexHull(above.to_mesh64().vert_properties[:, :3])
        found = ConvexHull(piece)
        assert found.volume == pytest.approx(wanted.volume, rel=1e-12)
        assert found.area == pytest.approx(wanted.area, rel=1e-12)


def test_a_gap_between_two_bodies_is_in_no_piece():
    box = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 0.1) for z in (0.0, 0.1)])
    triangles = outward(box, ConvexHull(box).simplices)
    points = np.vstack([box, box + np.array([3.0, 0.0, 0.0])])
    pieces = convex_pieces(points, np.vstack([triangles, triangles + len(box)]), 4)
    assert [sorted({*piece[:, 0]}) for piece in pieces] == [[3.0, 4.0], [0.0, 1.0]]


def test_open_surfaces_have_no_convex_pieces():
    with pytest.raises(MeshError, match="not closed"):
        convex_pieces(np.eye(3), np.array([[0, 1, 2]]), 2)


def test_hull_vertices_leave_out_what_is_inside():
    points = np.vstack([np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T, np.full((5, 3), 0.5)])
    assert len(hull_vertices(points)) == 8


def test_flat_points_are_their_own_hull():
    flat = np.array([[x, y, 2.0] for x in (1.0, 2.0, 3.0) for y in (-1.0, 1.0)])
    np.testing.assert_array_equal(hull_vertices(flat), flat)
    for points in (flat, flat[:1]):
        with pytest.raises(MeshError, match="without volume"):
            axis_angle(points)


def test_hulls_are_those_of_qhull():
    generator = np.random.default_rng(2)
    for scale in (1e-3, 1.0, 1e3):
        points = generator.normal(size=(60, 3)) * scale
        wanted = points[ConvexHull(points).vertices]
        found = hull_vertices(points)
        np.testing.assert_array_equal(np.unique(found, axis=0), np.unique(wanted, axis=0))


def test_postures_cover_the_ranges():
    postures = range_postures({"a": (-1.0, 1.0), "b": (0.0, 2.0)}, 10)
    assert {len(q) for q in postures.values()} == {15}
    assert (postures["a"].min(), postures["a"].max()) == (-1.0, 1.0)
    assert (postures["b"].min(), postures["b"].max()) == (0.0, 2.0)
    assert (postures["a"][0], postures["b"][0]) == (0.0, 1.0)


def test_telling_samples_of_a_flight_hold_every_joints_extremes():
    history = np.sin(np.outer(np.arange(500), [0.013, 0.1, 0.7]))
    chosen = telling_samples(history, 20)
    assert len(chosen) <= 26
    assert {0, 499} <= set(chosen)
    np.testing.assert_array_equal(history[chosen].min(axis=0), history.min(axis=0))
    np.testing.assert_array_equal(history[chosen].max(axis=0), history.max(axis=0))


def test_a_flown_part_is_reported_with_the_time_of_its_nearest_approach(swing):
    surface = SimpleNamespace(
        points=np.array([[x, y, z] for x in (0.0, 1.0) for y in (-0.01, 0.01) for z in (-0.01, 0.01)]),
        triangles=ConvexHull(np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])).simplices,
    )
    pieces = convex_pieces(surface.points, outward(surface.points, surface.triangles), 3)
    history = np.deg2rad(np.r_[np.linspace(0, 30, 100), np.linspace(30, 0, 100)])[:, None]
    settings = InterferenceSettings(bodies=("bar",), report_below_mm=2000, postures=5)
    report = flown_interference(
        swing, settings, {"bar": ([PartPlacement("bar")], pieces)}, ["turn"], history, 0.01 * np.arange(len(history))
    )
    nearest = report["bodies"][0]
    assert nearest["links"] == ["base", "bar"]
    assert nearest["time"] == pytest.approx(0.99)
    assert nearest["clearance"] == report["body_clearance"]
    whole = check_interference(swing, settings, {"turn": np.deg2rad([30.0])})
    assert nearest["clearance"] == pytest.approx(whole.min_clearance, abs=1e-12)


def outward(points, triangles):
    """Triangles of a convex solid, turned counter-clockwise seen from outside."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - points.mean(axis=0)) < 0.0
    return np.where(inward[:, None], triangles[:, ::-1], triangles)


def test_unknown_links_and_meshes_without_pieces_are_refused(swing):
    with pytest.raises(StudyError, match="nose"):
        check_interference(swing, InterferenceSettings(bodies=("nose",)), {})
    with pytest.raises(StudyError, match="jet frame 'nozzle'"):
        check_interference(swing, InterferenceSettings(bodies=(), plumes=PlumeSettings(jets=("nozzle",))), {})
    meshed = swing.set_mesh("ball", "ball.stl", np.eye(4))
    with pytest.raises(UrdfError, match=r"link ball: .*mesh"):
        check_interference(meshed, InterferenceSettings(bodies=("bar",)), {})
    pieces = {"ball": [np.array([[0, 0, 0.5]])]}
    settings = InterferenceSettings(bodies=("bar",), report_below_mm=5000)
    found = clearance(check_interference(meshed, settings, {}, pieces), "bar", "ball")
    assert found.distance == pytest.approx(np.hypot(1.0, 0.99), rel=1e-12)


def test_the_shipped_robot_with_real_parts_is_left_right_symmetric():
    robot = RobotDescription.load(Path(ironcub.__file__).with_name("robot.urdf"))
    surface = ForearmJetSupport(90, 108).surface()
    slices = convex_pieces(surface.points, surface.triangles, 8)
    left, right = PartPlacement("l_forearm", Pose((-6, -15, 0))), PartPlacement("r_forearm", Pose((-6, -15, 0)), "z")
    pieces = {place.link: [place_points(place, points) for points in slices] for place in (left, right)}
    settings = InterferenceSettings(bodies=("l_forearm", "r_forearm"))
    arms = {f"{s}_{j}": np.deg2rad(v) for s in "lr" for j, v in [("shoulder_pitch", [9.6] * 2), ("elbow", [5.0, 40.0])]}
    arms |= {f"{s}_shoulder_roll": np.deg2rad([16.0, 16.0]) for s in "lr"}
    report = check_interference(robot, settings, arms, pieces)
    swap = {"l": "r", "r": "l"}
    assert {c.second for c in report.clearances} >= {"l_forearm", "r_forearm"}
    for found in report.clearances:
        twin = clearance(report, *(f"{swap[name[0]]}{name[1:]}" for name in (found.first, found.second)))
        assert twin.distance == pytest.approx(found.distance, abs=1e-3)  # the robot's own sides differ by 0.3 mm


def test_culling_changes_no_result():
    robot = RobotDescription.load(Path(ironcub.__file__).with_name("robot.urdf"))
    joints = ["torso_yaw", "l_shoulder_pitch", "l_shoulder_roll", "l_shoulder_yaw", "l_elbow"]
    postures = range_postures(dict.fromkeys(joints, (-0.5, 0.7)), 16)
    settings = InterferenceSettings(bodies=("l_arm_jet_turbine",), report_below_mm=300)
    report = check_interference(robot, settings, postures)
    pieces, poses = link_pieces(robot, {}), robot.frame_poses(postures)
    count = len(postures["l_elbow"])
    reported = 0
    for link in pieces:
        if link in ("l_arm_jet_turbine", "l_forearm"):
            continue
        turbine_T_link = np.linalg.inv(poses["l_arm_jet_turbine"]) @ poses[link]
        hulls = [*pieces["l_arm_jet_turbine"], *pieces[link]]
        first = len(pieces["l_arm_jet_turbine"])
        pairs = [(i, j, k) for i in range(first) for j in range(first, len(hulls)) for k in range(count)]
        i, j, k = np.array(pairs).T
        nearest = hull_distances(hulls, i, j, turbine_T_link[k]).min()
        if nearest < 0.3:
            assert clearance(report, "l_arm_jet_turbine", link).distance == pytest.approx(nearest, abs=1e-9)
            reported += 1
    assert reported == len(report.clearances) > 10


def test_a_long_rod_keeps_the_turbine_off_the_upper_arm_and_a_short_one_does_not():
    base = RobotDescription.load(Path(ironcub.__file__).with_name("robot.urdf"))
    settings = InterferenceSettings(bodies=("l_arm_jet_turbine",))
    gaps = []
    for offset, length in [(88, 50), (80, 108), (100, 130)]:
        turbine = ForearmJetSupport(offset, length).interfaces()["turbine"]
        robot = base.set_joint_origin("l_elbow_turbine", Pose((-6, -15, 0)).matrix() @ turbine)
        report = check_interference(robot, settings, {"l_elbow": np.deg2rad([3.0, 30.0])})
        gaps.append(clearance(report, "l_upper_arm", "l_arm_jet_turbine").distance)
    assert gaps[0] < -0.015 < 0.003 < gaps[1] < gaps[2]
