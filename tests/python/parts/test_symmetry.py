"""One half of a symmetric part stands for the whole, under symmetric and antisymmetric loads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.errors import SolverError
from codesign.geometry.profile import Path, Resolution
from codesign.geometry.shape import Extrusion
from codesign.geometry.solid import build_solid
from codesign.parts.load_case import PartLoad, PressedFace, PushedFace, StressSettings, native_case, part_case
from codesign.parts.surface import surface_mesh
from codesign.parts.symmetry import Parity, is_symmetric, parity
from codesign.studies.ironcub.bracket import JetpackBracket

SYMMETRIC: list[PartLoad] = [
    PressedFace("seat", 250.0),
    PushedFace("seat", (1.0, 0.0, 2.0)),
    fem.Acceleration([9.81, 0.0, -1.0]),
    fem.AffineTraction("seat", (1.0, 0.0, 3.0), (0.1, 1e-18, 0.2), (0.0, 5.0, 0.0)),
]
ANTISYMMETRIC: list[PartLoad] = [
    PushedFace("seat", (0.0, 3.0, 0.0)),
    fem.Acceleration([0.0, 49.05, 0.0]),
    fem.AffineTraction("seat", (0.0, 1.0, 0.0), (0.1, 0.0, 0.2), (1.0, 0.0, 2.0)),
]
NEITHER: list[PartLoad] = [
    PushedFace("seat", (1.0, 3.0, 0.0)),
    fem.AffineTraction("seat", (0.0, 0.0, 1.0), (0.0, 0.01, 0.0)),
    fem.AffineTraction("seat", (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    fem.Acceleration([1.0, 0.0, 0.0], np.eye(3)),
]


def test_parity_of_loads() -> None:
    for kind, loads in (
        (Parity.SYMMETRIC, SYMMETRIC),
        (Parity.ANTISYMMETRIC, ANTISYMMETRIC),
        (Parity.NEITHER, NEITHER),
    ):
        for load in loads:
            assert parity([load]) is kind, load
    assert parity(SYMMETRIC) is Parity.SYMMETRIC
    assert parity([SYMMETRIC[0], ANTISYMMETRIC[0]]) is Parity.NEITHER


def test_symmetry_of_masses() -> None:
    assert is_symmetric(fem.RemoteMass("seat", 2.0, (0.1, 1e-19, 0.2), np.diag([1.0, 2.0, 3.0])))
    assert not is_symmetric(fem.RemoteMass("seat", 2.0, (0.1, 1e-3, 0.2)))
    skewed = np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 3.0]])
    assert not is_symmetric(fem.RemoteMass("seat", 2.0, (0.1, 0.0, 0.2), skewed))


def test_a_half_bracket_takes_every_case_as_the_whole_does() -> None:
    """The default study's cases, with the turbine's mass; the whole is what modes with masses ask for."""
    config = codesign.load_study("ironcub").config
    part = JetpackBracket(20.0, 60.0)
    settings = stress_settings(config, part.name)
    half = part_case(part, settings)
    whole = part_case(part, replace(settings, modes=1))
    assert (half.settings.copies, whole.settings.copies) == (2, 1)
    assert [case.antisymmetric for case in half.cases] == [case.name == "handling_y" for case in half.cases]
    a, b = _core.analyze_part(half), _core.analyze_part(whole)
    assert len(a.mesh.tets) < 0.7 * len(b.mesh.tets)
    assert a.case_names == b.case_names
    for name, one, other in zip(a.case_names, a.results, b.results, strict=True):
        assert one.max_displacement == pytest.approx(other.max_displacement, rel=5e-3), name
        assert one.work == pytest.approx(other.work, rel=5e-3), name
        assert abs(one.peak_stress - other.peak_stress) <= one.stress_error + other.stress_error, name
    assert a.case_names[a.governing] == b.case_names[b.governing]


def test_an_antisymmetric_case_needs_a_half() -> None:
    config = codesign.load_study("ironcub_paper").config
    case = part_case(JetpackBracket(20.0, 60.0), stress_settings(config, "jetpack_bracket"))
    whole = _core.PartCase(
        surface=case.surface,
        size=case.size,
        material=case.material,
        supports=[support for support in case.supports if not support.symmetry],
        cases=[_core.LoadCase(c.name, c.loads, c.least_safety_factor, antisymmetric=True) for c in case.cases],
        settings=case.settings,
    )
    with pytest.raises(ValueError, match="no half model"):
        _core.analyze_part(whole)


def test_antisymmetric_cases_alone_need_no_symmetric_supports() -> None:
    """A bar of 200 x 12 x 20 mm bent along y: nothing holds its half along z, and no case asks for that."""
    outline = (
        Path(0.0, 0.0).line(200.0, 0.0, face="cut").line(200.0, 6.0, face="tip").line(0.0, 6.0)
        .line(0.0, 0.0, face="root").close()
    )  # fmt: skip
    surface = surface_mesh(build_solid(Extrusion(outline, -10.0, 10.0), Resolution(48)))
    supports = [fem.Support("root", axes="xy"), fem.Support("cut", axes="y", symmetry=True)]
    steel = fem.Material("steel", 210e9, 0.3, 7850.0, 250e6)

    def bent(antisymmetric: bool) -> _core.PartCase:
        cases = [fem.LoadCase("bent", [fem.Force("tip", [0.0, 50.0, 0.0])], antisymmetric=antisymmetric)]
        return native_case(StressSettings(steel, [], []), surface, fem.SizeField(6e-3), supports, cases, copies=2)

    found = _core.analyze_part(bent(True)).result.max_displacement
    assert found == pytest.approx(100.0 * 0.2**3 / (3 * 210e9 * 0.02 * 0.012**3 / 12), rel=0.01)
    with pytest.raises(SolverError, match="translation along z"):
        _core.analyze_part(bent(False))
