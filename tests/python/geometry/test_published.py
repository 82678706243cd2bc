"""Both parts over their grids, and against the authors' designs and STL files (all of them: benchmarks/)."""

import csv
from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import trimesh

from codesign.geometry.brep import build_brep
from codesign.parts.part import EXPORT_RESOLUTION, Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

RANDOM = np.random.default_rng(20241014)
BRACKETS = [*product((1, 79), (40, 100)), *zip(RANDOM.uniform(1, 79, 6), RANDOM.uniform(40, 100, 6), strict=True)]
FOREARMS = [*product((80, 120), (50, 150)), *zip(RANDOM.uniform(80, 120, 4), RANDOM.uniform(50, 150, 4), strict=True)]
PARTS = [JetpackBracket(*theta) for theta in BRACKETS] + [ForearmJetSupport(*theta) for theta in FOREARMS]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.title)
def test_corners_and_random_designs_build_closed_in_both_evaluators(part: Part) -> None:
    for surface in (part.surface(), part.fem_surface("simplified")):
        triangles = np.asarray(surface.triangles)
        directed = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        assert len(np.unique(directed, axis=0)) == len(directed)
        assert len(np.unique(np.vstack([directed, directed[:, ::-1]]), axis=0)) == len(directed)
    assert part.mass_properties().volume * 1e9 == pytest.approx(build_brep(part.shape()).volume, rel=5e-6)


def published_rows(folder: Path, every: int) -> list[dict[str, str]]:
    with (folder / "published" / "designs.csv").open() as file:
        return [row for row in csv.DictReader(file) if row["error"] == "0"][::every]


@pytest.mark.parametrize(
    ("kind", "keys", "build", "mass_tolerance", "moment_tolerance"),
    [
        ("bracket", ("angle_paper_deg", "distance_mm"), JetpackBracket, 5e-4, 1e-3),
        ("bracket", ("angle_paper_deg", "distance_mm"), JetpackBracket.as_published, 3e-5, 6e-5),
        ("forearm", ("offset_mm", "length_mm"), ForearmJetSupport.as_published, 1e-5, 4e-5),
        ("forearm", ("offset_mm", "length_mm"), ForearmJetSupport, 1e-3, 1.5e-3),
    ],
    ids=["bracket", "bracket as published", "forearm as published", "forearm with fillets"],
)
def test_masses_and_moments_of_published_designs(
    kind: str,
    keys: tuple[str, str],
    build: Callable[[float, float], Part],
    mass_tolerance: float,
    moment_tolerance: float,
    shared_data: Path,
) -> None:
    for row in published_rows(shared_data, every=50):
        properties = build(float(row[keys[0]]), float(row[keys[1]])).mass_properties()
        assert properties.mass == pytest.approx(float(row[f"mass_{kind}_kg"]), rel=mass_tolerance)
        moments = [float(row[f"{axis}_{kind}_kgmm2"]) for axis in ("ixx", "iyy", "izz")]
        np.testing.assert_allclose(properties.principal_moments * 1e6, moments, rtol=moment_tolerance)


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("optim1_bracket", JetpackBracket.as_published(1, 47.9133)),
        ("optim1_l_forearm", ForearmJetSupport.as_published(88, 50)),
        ("optim3_l_forearm", ForearmJetSupport.as_published(100, 130)),
    ],
)
def test_published_shapes_lie_on_our_surfaces(name: str, part: Part, shared_data: Path) -> None:
    mesh = trimesh.load(shared_data / "parts" / f"{name}.stl")
    solid = part.solid(EXPORT_RESOLUTION)
    corners = solid.points[solid.triangles]
    for vertex in mesh.vertices[::5]:
        nearest = trimesh.triangles.closest_point(corners, np.broadcast_to(vertex, (len(corners), 3)))
        assert np.linalg.norm(nearest - vertex, axis=1).min() < 0.012  # chords of 0.01 mm
    assert mesh.volume == pytest.approx(part.mass_properties().volume * 1e9, rel=0.025)  # 8 to 20 chords a circle
