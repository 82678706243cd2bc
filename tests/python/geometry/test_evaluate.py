"""Manifolds of tools are kept from one design to the next; no mesh depends on which were."""

import numpy as np
import pytest

from codesign.geometry import evaluate
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import Frame, at_points, box, cylinder, union
from codesign.geometry.solid import build_solid
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

RESOLUTION = Resolution(16)
DESIGNS = {
    "bracket": (JetpackBracket(15, 42), JetpackBracket(31, 60)),
    "forearm": (ForearmJetSupport(80, 108), ForearmJetSupport(100, 60)),
}


def forget():
    evaluate._kept.cache_clear()
    evaluate._primitive.cache_clear()


def assert_same(solid, other):
    np.testing.assert_array_equal(solid.points, other.points)
    np.testing.assert_array_equal(solid.triangles, other.triangles)
    np.testing.assert_array_equal(solid.face, other.face)
    assert solid.face_names == other.face_names


@pytest.mark.parametrize("name", DESIGNS)
def test_a_mesh_is_the_same_whatever_was_built_before(name):
    part, other = DESIGNS[name]
    forget()
    alone = build_solid(part.shape(), RESOLUTION)
    forget()
    build_solid(other.shape(), RESOLUTION)
    assert_same(build_solid(part.shape(), RESOLUTION), alone)
    evaluate._primitive.cache_clear()  # kept tools of primitives that are made anew beside them
    assert_same(build_solid(part.fem_shape("full"), RESOLUTION), build_solid(part.fem_shape("full"), RESOLUTION))
    assert_same(build_solid(part.shape(), RESOLUTION), alone)


def test_a_primitive_made_anew_keeps_its_faces():
    forget()
    pin = cylinder(2.0, -1.0, 11.0, face="bore")
    plate = box((0.0, 0.0, 0.0), (60.0, 20.0, 10.0), z0="floor")
    holes = at_points(pin, [(10.0, 10.0), (20.0, 10.0)])
    shape = union(plate - holes, pin.placed(Frame((50.0, 10.0, 5.0))))
    known = build_solid(shape, RESOLUTION)
    evaluate._primitive.cache_clear()
    evaluate._kept(pin.placed(Frame((50.0, 10.0, 5.0))), RESOLUTION)
    assert_same(build_solid(shape, RESOLUTION), known)


def test_a_primitive_made_anew_keeps_its_number_beside_kept_tools():
    bolted = [part.fem_shape(support="bolted", half=False) for part in DESIGNS["bracket"]]  # its pad is tool and body
    forget()
    alone = build_solid(bolted[1], RESOLUTION)
    forget()
    build_solid(bolted[0], RESOLUTION)
    evaluate._primitive.cache_clear()
    evaluate._primitive(bolted[0].base.shapes[1], RESOLUTION)
    assert_same(build_solid(bolted[1], RESOLUTION), alone)


def test_tools_are_kept_from_one_design_to_the_next():
    forget()
    for part in DESIGNS["bracket"]:
        build_solid(part.shape(), RESOLUTION)
    assert evaluate._kept.cache_info().hits == 2  # the straight tools and those of the slab
