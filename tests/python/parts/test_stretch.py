"""Parts whose mesh is that of another length, stretched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.errors import GeometryError, MemoryLimitError
from codesign.geometry.mass import volume_moments
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import box
from codesign.geometry.solid import Solid, build_solid
from codesign.parts import part as part_module
from codesign.parts.load_case import held_faces, native_case, part_case
from codesign.parts.part import COARSE_RESOLUTION, Part, _made, _moments
from codesign.parts.stretch import RATIO, meshed_length, require_prism, stretch_mm
from codesign.parts.surface import surface_mesh
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

LONG_AND_SHORT = [
    JetpackBracket(15.0, 40.0),
    JetpackBracket(60.0, 118.0),
    JetpackBracket(30.0, 40.0, seat_analyzed=True),
    ForearmJetSupport(80.0, 50.0),
    ForearmJetSupport(120.0, 150.0),
]


def _case(part: Part) -> _core.PartCase:
    config = codesign.load_study("ironcub_paper").config
    return part_case(part, stress_settings(config, part.name))


def test_meshed_length_is_near_by_ratio() -> None:
    for length in np.geomspace(0.5, 3000.0, 200):
        assert RATIO**-0.5 <= meshed_length(length, 54.0) / length <= RATIO**0.5 * (1.0 + 1e-12)
    assert meshed_length(54.0, 54.0) == 54.0


@pytest.mark.parametrize("part", LONG_AND_SHORT, ids=lambda part: part.title)
def test_the_stretched_mesh_is_the_parts_own_body(part: Part) -> None:
    case = _case(part)
    assert case.stretch is not None
    mesh = _core.analyze_part(case).mesh
    settings = stress_settings(codesign.load_study("ironcub_paper").config, part.name)
    direct = part_case(part, replace(settings, accuracy="fine")).surface
    a, b, c = np.moveaxis(direct.points[direct.triangles], 1, 0)
    volume = float(np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0)
    assert mesh.quality.volume == pytest.approx(volume, rel=0.015)  # between corners: without the bulge of curved sides
    assert mesh.quality.min_dihedral_deg > 3.0
    assert np.allclose(mesh.nodes.min(axis=0), direct.points.min(axis=0), atol=2e-4)
    assert np.allclose(mesh.nodes.max(axis=0), direct.points.max(axis=0), atol=2e-4)


def test_a_result_does_not_depend_on_what_was_analyzed_before() -> None:
    _core.forget_meshes()
    first = _core.analyze_part(_case(JetpackBracket(20.0, 60.0))).result
    for distance in (44.0, 100.0):  # the same mesh
        _core.analyze_part(_case(JetpackBracket(20.0, distance)))
    again = _core.analyze_part(_case(JetpackBracket(20.0, 60.0))).result
    assert _core.forget_meshes()
    assert not _core.forget_meshes()
    alone = _core.analyze_part(_case(JetpackBracket(20.0, 60.0))).result
    for other in (again, alone):
        assert np.array_equal(first.displacement, other.displacement)
        assert first.peak_stress == other.peak_stress


def test_a_material_has_its_own_factor() -> None:
    _core.forget_meshes()
    settings = stress_settings(codesign.load_study("ironcub_paper").config, "jetpack_bracket")
    ergal = settings.material
    soft = replace(settings, material=fem.Material("soft", 1e9, ergal.poisson_ratio, ergal.density, 1e6))
    stiff, other = (_core.analyze_part(part_case(JetpackBracket(20.0, 60.0), s)).result for s in (settings, soft))
    assert other.max_displacement == pytest.approx(stiff.max_displacement * ergal.young_modulus / 1e9)


def test_a_part_that_single_precision_does_not_resolve_is_solved_as_a_whole() -> None:
    """A rod 330 times as long as it is thick, against the formula for its deflection."""
    length, side, force, young = 0.7, 0.0021, 0.01, 70e9
    rod = box((0.0, 0.0, 0.0), (1e3 * length, 1e3 * side, 1e3 * side), x0="root", x1="tip")
    settings = stress_settings(codesign.load_study("ironcub_paper").config, "jetpack_bracket")
    case = native_case(
        replace(settings, cases=(), flown=(), material=fem.Material("aluminium", young, 0.0, 2700.0, 4e8)),
        surface_mesh(build_solid(rod, Resolution(24))),
        fem.SizeField(0.006, []),
        held_faces(["root"]),
        [fem.LoadCase("side", [fem.Force(fem.select_names("tip"), [0.0, 0.0, force])], 1.0)],
        stretch=stretch_mm(np.zeros(3), np.array([1.0, 0.0, 0.0]), 200.0, 500.0, 0.0),
    )
    found = _core.analyze_part(case).result
    assert found.residual < 1e-9
    assert found.max_displacement == pytest.approx(force * length**3 / (3.0 * young * side**4 / 12.0), rel=5e-3)


def test_a_limit_of_nothing_keeps_results() -> None:
    kept = _core.analyze_part(_case(ForearmJetSupport(90.0, 70.0))).result
    _core.limit_kept_meshes(0.0)
    try:
        for _ in range(2):
            assert _core.analyze_part(_case(ForearmJetSupport(90.0, 70.0))).result.peak_stress == kept.peak_stress
    finally:
        _core.limit_kept_meshes(256e6)


def test_a_part_that_needs_more_memory_than_its_limit_is_refused() -> None:
    settings = stress_settings(codesign.load_study("ironcub_paper").config, "forearm_support")
    case = part_case(ForearmJetSupport(90.0, 70.0), replace(settings, memory_limit=70e6))
    case.settings.solver = _core.fem.LinearSolver.direct
    for _ in range(2):  # with nothing kept, and with its mesh
        with pytest.raises(MemoryLimitError):
            _core.analyze_part(case)


def test_whatever_is_meshed_for_a_valid_part_is_one() -> None:
    config = codesign.load_study("ironcub_paper").config
    for angle in np.arange(5.0, 80.0, 5.0):
        for distance in [*np.arange(15.0, 45.0, 0.5), 120.0, 399.0]:
            try:
                bracket = JetpackBracket(angle, distance)
            except GeometryError:
                continue
            for part in (bracket, replace(bracket, seat_analyzed=True)):
                part._stretched_from(stress_settings(config, part.name))  # raises where it is none
    for length in [*np.arange(9.0, 40.0, 0.5), 120.0, 500.0]:
        ForearmJetSupport(90.0, length)._stretched_from(stress_settings(config, "forearm_support"))


def test_a_refined_mesh_is_of_the_parts_own_surface() -> None:
    settings = stress_settings(codesign.load_study("ironcub_paper").config, "forearm_support")
    assert part_case(ForearmJetSupport(90.0, 70.0), replace(settings, accuracy="converged")).stretch is None
    case = _case(ForearmJetSupport(90.0, 70.0))
    case.max_refinements = 1
    with pytest.raises(ValueError, match="own surface"):
        _core.analyze_part(case)


@pytest.mark.parametrize("part", [JetpackBracket(37.0, 56.0), *LONG_AND_SHORT], ids=lambda part: part.title)
def test_masses_and_solids_of_stretched_parts_are_their_own(part: Part, monkeypatch: pytest.MonkeyPatch) -> None:
    assert part.stretched_from() is not None
    found, solid = part.mass_properties(), part.shared_solid(COARSE_RESOLUTION)
    monkeypatch.setattr(type(part), "stretched_from", Part.stretched_from)
    _moments.cache_clear()
    direct, own = part.mass_properties(), part.shared_solid(COARSE_RESOLUTION)
    assert found.mass == pytest.approx(direct.mass, rel=1e-12)
    assert np.allclose(found.com, direct.com, rtol=0.0, atol=1e-13)
    assert np.allclose(found.inertia, direct.inertia, rtol=0.0, atol=1e-12 * np.trace(direct.inertia))
    assert solid.names == own.names and len(solid.points) == len(own.points)
    assert np.allclose(np.sort(solid.points, axis=0), np.sort(own.points, axis=0), rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("part", [JetpackBracket(37.0, 56.0), *LONG_AND_SHORT], ids=lambda part: part.title)
def test_surface_of_a_stretched_part_is_its_own(part: Part) -> None:
    assert part.stretched_from() is not None
    surface, own = part.shared_solid(), part.solid()
    assert set(surface.names) == set(own.names) == set(part.faces)
    edges = surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    assert {tuple(edge) for edge in edges} == {tuple(edge) for edge in edges[:, ::-1]}  # closed
    for name in part.faces:
        found, expected = _area(surface, name), _area(own, name)
        assert found == pytest.approx(expected, rel=1e-9)
    moments, expected = (volume_moments(mesh.points, mesh.triangles) for mesh in (surface, own))
    assert np.allclose(moments, expected, rtol=0.0, atol=1e-9 * np.abs(expected[[0, 1, 1, 1, 4, 4, 4, 4, 4, 4]]))


def _area(solid: Solid, name: str) -> float:
    faces = [k for k, other in enumerate(solid.face_names) if other == name]
    a, b, c = solid.points[solid.triangles[np.isin(solid.face, faces)]].swapaxes(0, 1)
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def test_a_mesh_serves_all_lengths_and_what_was_made_before_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def results(distance: float) -> list[bytes]:
        bracket = JetpackBracket(23.5, distance)
        mass, mirrored = bracket.mass_properties(), bracket.mirrored("y", "left").shared_solid(COARSE_RESOLUTION)
        arrays = [np.array(mass.mass), mass.com, mass.inertia, mirrored.points, bracket.surface().points]
        return [array.tobytes() for array in arrays]

    alone = []
    for distance in (63.0, 118.0):
        for made in (_made, _moments):
            made.cache_clear()
        alone.append(results(distance))
    _moments.cache_clear()
    monkeypatch.setattr(part_module, "build_solid", None)  # no other is made
    assert [results(distance) for distance in (63.0, 118.0)] == alone


def test_a_zone_whose_sections_differ_is_refused() -> None:
    wedge = build_solid(
        box((0.0, 0.0, 0.0), (30.0, 10.0, 10.0)) - box((0.0, 0.0, 8.0), (30.0, 10.0, 20.0)).rotated("y", 3.0),
        Resolution(24),
    )
    zone = stretch_mm(np.zeros(3), np.array([1.0, 0.0, 0.0]), 10.0, 20.0, 5.0)
    require_prism(build_solid(box((0.0, 0.0, 0.0), (30.0, 10.0, 10.0)), Resolution(24)), zone)
    with pytest.raises(GeometryError, match="from 10 to 20 mm, has cross sections that differ"):
        require_prism(wedge, zone)
