"""Surface to peak stress against gmsh and CalculiX: the same parts, sizes, supports and loads; tables of docs/fem.md.

python benchmarks/fem/vs_calculix.py

CPU seconds (children included), one thread. CalculiX (`ccx`, Debian calculix-ccx) solves C3D10 with its default
direct solver; gmsh meshes the part's exact STEP file. Nodal forces are this project's, so that both solve one system.
The peak is read from nodal stress, farther than the exclusion distance from clamps and borders of loaded faces.
"""

from __future__ import annotations

import os
import re
import resource
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.geometry.brep import build_brep
from codesign.geometry.shape import Shape
from codesign.parts.step import write_step
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

Array = NDArray[np.float64]
native: Any = _core.fem
MILLI, MEGA = 1e-3, 1e6
REFERENCE = {"jetpack_bracket": 4.61, "forearm_support": 33.24}  # MPa, benchmarks/fem/stress_error.py


@dataclass
class Solution:
    """displacement: (n, 3) m. stress: (n, 6) Pa, xx yy zz xy yz zx."""

    displacement: Array
    stress: Array
    seconds: float


def cpu_seconds() -> float:
    """Of this process and of the children that have ended."""
    return sum(
        u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


def write_deck(path: Path, mesh: fem.TetMesh, case: Any, procedure: list[str], output: list[str]) -> None:
    """CalculiX input of one step, numbers of at most 20 characters; procedure and output: its keyword lines."""
    held = sorted(
        {
            (node, axis)
            for support in case.supports
            for node in native.selected_nodes(mesh, support.where)
            for axis in range(3)
            if support.fixed[axis]
        }
    )
    force = native.load_vector(mesh, case.material, case.cases[0].loads).reshape(-1, 3)
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1},{x:.13e},{y:.13e},{z:.13e}" for i, (x, y, z) in enumerate(np.asarray(mesh.nodes).tolist())]
    lines.append("*ELEMENT, TYPE=C3D10, ELSET=PART")
    lines += [
        ",".join(map(str, [e + 1, *(n + 1 for n in tet)])) for e, tet in enumerate(np.asarray(mesh.tets).tolist())
    ]
    material = case.material
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{material.young_modulus:.10e},{material.poisson_ratio:.10e}"]
    lines += ["*SOLID SECTION, ELSET=PART, MATERIAL=M", "*BOUNDARY"]
    lines += [f"{node + 1},{axis + 1}" for node, axis in held]
    lines += ["*STEP", *procedure, "*CLOAD"]
    lines += [f"{n + 1},{a + 1},{force[n, a]:.13e}" for n, a in zip(*np.nonzero(force), strict=True)]
    lines += [*output, "*END STEP", ""]
    path.write_text("\n".join(lines))


def run_deck(folder: str) -> None:
    """Runs part.inp in a folder on one thread."""
    run = subprocess.run(
        ["ccx", "part"], cwd=folder, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"}
    )
    if run.returncode:
        raise RuntimeError(run.stdout[-2000:])


def read_stress(text: str) -> Array:
    """Nodal stress of a .frd file, whose columns are fixed."""
    block = text[text.index(" -4  STRESS") :]
    rows = re.findall(r"^ -1.{10}(.+)$", block[: block.index("\n -3")], re.MULTILINE)
    return np.array([[float(row[12 * k : 12 * k + 12]) for k in range(6)] for row in rows])


def calculix(mesh: fem.TetMesh, case: Any) -> Solution:
    """One static step; reading and writing of files counted."""
    start = cpu_seconds()
    with tempfile.TemporaryDirectory() as folder:
        write_deck(Path(folder) / "part.inp", mesh, case, ["*STATIC"], ["*NODE PRINT, NSET=ALL", "U", "*EL FILE", "S"])
        run_deck(folder)
        stress = read_stress((Path(folder) / "part.frd").read_text())
        # eight digits, against six in the .frd file
        displacement = np.loadtxt(Path(folder) / "part.dat", skiprows=3)[:, 1:]
    return Solution(displacement, stress, cpu_seconds() - start)


def ours(mesh: fem.TetMesh, case: Any) -> tuple[Solution, _core.fem.StaticResult]:
    """The same with this project's solver."""
    start = cpu_seconds()
    result = native.StaticSystem(mesh, case.material, case.supports, case.settings).solve(case.cases[0].loads)
    return Solution(np.array(result.displacement), np.array(result.stress), cpu_seconds() - start), result


def nodal_peak(mesh: fem.TetMesh, case: Any, solution: Solution) -> float:
    """Largest von Mises stress [MPa] of the nodes outside the exclusion zone."""
    corners, points = mesh.boundary[:, :3], np.asarray(mesh.nodes)
    clamped = {t for s in case.supports if not s.symmetry for t in native.selected_triangles(mesh, s.where)}
    loaded = {
        t for load in case.cases[0].loads if load.region is None for t in native.selected_triangles(mesh, load.where)
    }
    weights = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8
    near = [np.einsum("wk,tkd->twd", weights, points[corners[sorted(clamped)]]).reshape(-1, 3)]
    if loaded:
        edges = np.sort(np.concatenate([corners[sorted(loaded)][:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
        border, count = np.unique(edges, axis=0, return_counts=True)
        ends = points[border[count == 1]]
        near.append(np.concatenate([(1 - w) * ends[:, 0] + w * ends[:, 1] for w in np.linspace(0, 1, 9)]))
    distance, _ = cKDTree(np.concatenate(near)).query(points)
    s = solution.stress[distance > case.settings.exclusion_distance]
    xx, yy, zz, xy, yz, zx = s.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return float(np.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + zx**2)).max() / MEGA)


def face_of_point(surface: fem.SurfaceMesh) -> Callable[[Array], str]:
    """Finds the face of a surface on which most of some points (n, 3) [m] lie, by dense random samples."""
    generator = np.random.default_rng(1)
    corners = surface.points[surface.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    triangle = generator.choice(len(area), 200_000, p=area / area.sum())
    tree = cKDTree(np.einsum("nk,nkd->nd", generator.dirichlet(np.ones(3), len(triangle)), corners[triangle]))

    def name(points: Array) -> str:
        found = surface.face[triangle[tree.query(points)[1]]]
        return surface.face_names[np.bincount(found).argmax()]

    return name


def gmsh_mesh(step: Path, size: fem.SizeField, face: Callable[[Array], str]) -> tuple[fem.TetMesh, float]:
    """Ten-node tetrahedra of a STEP file with the sizes of our field; CPU seconds. face: names points of a face."""
    start = cpu_seconds()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.SecondOrderLinear", 1)  # its curved elements are inverted at the forearm's fillets
    for name in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.{name}", 0)
    gmsh.model.occ.importShapes(str(step))
    gmsh.model.occ.synchronize()
    fields = [threshold(source, size.base) for source in size.sources]
    least = gmsh.model.mesh.field.add("Min")
    gmsh.model.mesh.field.setNumbers(least, "FieldsList", fields)
    gmsh.model.mesh.field.setAsBackgroundMesh(least)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, flat = gmsh.model.mesh.getElementsByType(11)
    tets = flat.reshape(-1, 10)[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]  # gmsh swaps the last two edges
    used, tets = np.unique(tets, return_inverse=True)
    order = np.argsort(tags)
    points = coordinates.reshape(-1, 3)[order[np.searchsorted(tags, used, sorter=order)]] * MILLI
    seconds = cpu_seconds() - start
    named: dict[str, list[NDArray[np.int64]]] = {}
    for dimension, tag in gmsh.model.getEntities(2):
        triangles = np.searchsorted(used, gmsh.model.mesh.getElements(dimension, tag)[2][0].reshape(-1, 6)[:, :3])
        named.setdefault(face(points[triangles].mean(axis=1)), []).append(triangles)
    gmsh.finalize()
    faces = {name: np.concatenate(found).astype(np.int32) for name, found in named.items() if name}
    return fem.TetMesh(np.ascontiguousarray(points), tets.reshape(-1, 10).astype(np.int32), faces), seconds


def threshold(source: fem.SizeSource, base: float) -> int:
    """Our size around a polyline as a field of gmsh, mm."""
    pieces = zip(source.points[:-1], source.points[1:], strict=True)
    points = [(1 - w) * a + w * b for a, b in pieces for w in np.linspace(0, 1, 40)]
    tags = [gmsh.model.occ.addPoint(*(p / MILLI)) for p in points]
    gmsh.model.occ.synchronize()
    distance, field = gmsh.model.mesh.field.add("Distance"), gmsh.model.mesh.field.add("Threshold")
    gmsh.model.mesh.field.setNumbers(distance, "PointsList", tags)
    values = {
        "InField": distance,
        "SizeMin": source.size / MILLI,
        "SizeMax": base / MILLI,
        "DistMin": source.radius / MILLI,
        "DistMax": (source.radius + (base - source.size) / source.growth) / MILLI,
    }
    for name, value in values.items():
        gmsh.model.mesh.field.setNumber(field, name, value)
    return int(field)


def compare(part: Any, shape: Shape, facet_angle: float) -> None:
    """Prints the rows of one part."""
    config = codesign.load_study("ironcub_paper").config
    case = part.stress_case(stress_settings(config, part.name))
    start = time.process_time()
    mesh = fem.tetrahedralize(case.surface, case.size, facet_angle_deg=facet_angle)
    mesh_seconds = time.process_time() - start
    here, result = ours(mesh, case)
    there = calculix(mesh, case)
    with tempfile.TemporaryDirectory() as folder:
        step = Path(folder) / "part.step"
        write_step(part, step, brep=build_brep(shape))
        other, other_seconds = gmsh_mesh(step, case.size, face_of_point(case.surface))
    both = calculix(other, case)
    mixed, mixed_result = ours(other, case)
    title = part.title

    def row(tools: str, m: fem.TetMesh, seconds: float, solution: Solution, peak: float) -> None:
        largest = np.linalg.norm(solution.displacement, axis=1).max() / MILLI
        error = 100 * (peak / REFERENCE[part.name] - 1)
        print(
            f"| {title} | {tools} | {len(m.tets)} | {seconds:.2f} | {solution.seconds:.2f} "
            f"| {seconds + solution.seconds:.2f} | {peak:.2f} ({error:+.1f} %) | {largest:.4f} |",
            flush=True,
        )

    row("codesign", mesh, mesh_seconds, here, result.peak_stress / MEGA)
    row("codesign mesh, CalculiX", mesh, mesh_seconds, there, nodal_peak(mesh, case, there))
    row("gmsh, CalculiX", other, other_seconds, both, nodal_peak(other, case, both))
    row("gmsh, codesign solver", other, other_seconds, mixed, mixed_result.peak_stress / MEGA)
    straight = fem.tetrahedralize(case.surface, case.size, facet_angle_deg=facet_angle, curved=False)
    on_straight = difference(ours(straight, case)[0], calculix(straight, case))
    print(
        f"largest difference of displacement: straight codesign mesh {on_straight:.1e}, gmsh's "
        f"{difference(mixed, both):.1e}, curved codesign mesh {difference(here, there):.1e}",
        flush=True,
    )


def difference(a: Solution, b: Solution) -> float:
    """Of displacements, relative to the largest."""
    return float(np.abs(a.displacement - b.displacement).max() / np.abs(b.displacement).max())


def main() -> None:
    bracket, forearm = JetpackBracket(15, 42), ForearmJetSupport(88, 50)
    print("| part | mesh, solver | tetrahedra | mesh CPU s | solver CPU s | sum | peak, MPa | largest u, mm |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    compare(bracket, bracket.fem_shape(), 25.0)
    compare(forearm, forearm.fem_shape(), 20.0)


if __name__ == "__main__":
    main()
