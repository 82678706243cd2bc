"""Recovered stress and the plain average of the elements' own, against exact values, on free meshes; docs/fem.md.

    python benchmarks/fem/recovery.py

NAFEMS LE10 (thick plate, stress yy at D, where edges of the body meet), a thick cylinder and a thick sphere under inner
pressure (von Mises stress on the inner face, root mean square over the corner nodes of each kind of place).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray

from codesign import fem

Array = NDArray[np.float64]
STEEL = fem.Material("steel", 210e9, 0.3)
PRESSURE, INNER, OUTER, HEIGHT = 1e6, 1.0, 2.0, 0.8  # Pa, m
NEAR = 1e-6  # m
EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]  # of the mid-edge nodes


def von_mises(s: Array) -> Array:
    """Of rows xx yy zz xy yz zx."""
    normal = (s[:, 0] - s[:, 1]) ** 2 + (s[:, 1] - s[:, 2]) ** 2 + (s[:, 2] - s[:, 0]) ** 2
    return np.sqrt(0.5 * normal + 3.0 * (s[:, 3:] ** 2).sum(axis=1))


def averaged(mesh: fem.TetMesh, displacement: Array) -> Array:
    """(n, 6) Pa: mean over the elements of a corner node of the stress that each has there; 0 at mid-edge nodes."""
    tets, total, count = np.asarray(mesh.tets), np.zeros((len(mesh.nodes), 6)), np.zeros(len(mesh.nodes))
    places, moved = np.asarray(mesh.nodes)[tets], displacement[tets]
    slopes = np.vstack([-np.ones((1, 3)), np.eye(3)])  # of the barycentric coordinates
    lame, shear = (210e9 * 0.3 / (1.3 * 0.4), 210e9 / 2.6)
    for corner in range(4):
        at = np.eye(4)[corner]
        shape = [(4.0 * at[i] - 1.0) * slopes[i] for i in range(4)]
        shape += [4.0 * (at[i] * slopes[j] + at[j] * slopes[i]) for i, j in EDGES]
        jacobian = np.einsum("eni,nk->eik", places, np.array(shape))
        gradient = np.einsum("enc,nk,eki->eci", moved, np.array(shape), np.linalg.inv(jacobian))
        strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
        stress = 2.0 * shear * strain + lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
        rows = stress[:, [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
        np.add.at(total, tets[:, corner], rows)
        np.add.at(count, tets[:, corner], 1.0)
    return total / np.maximum(count, 1.0)[:, None]


def thick_plate(across: int = 48, along: int = 96, high: int = 8) -> fem.SurfaceMesh:
    """Quarter of the plate between two ellipses of LE10; the outer face in two halves, held on the line between."""
    index: dict[tuple[int, int, int], int] = {}
    quads: list[list[int]] = []
    faces: list[int] = []

    def point(i: int, j: int, k: int) -> int:
        return index.setdefault((i, j, k), len(index))

    def add(face: int, corners: Iterable[tuple[int, int, int]]) -> None:
        quads.append([point(*c) for c in corners])
        faces.append(face)

    for j in range(along):
        for k in range(high):
            add(2, [(0, j, k), (0, j, k + 1), (0, j + 1, k + 1), (0, j + 1, k)])
            add(3 + (2 * k >= high), [(across, j, k), (across, j + 1, k), (across, j + 1, k + 1), (across, j, k + 1)])
        for i in range(across):
            add(5, [(i, j, 0), (i, j + 1, 0), (i + 1, j + 1, 0), (i + 1, j, 0)])
            add(6, [(i, j, high), (i + 1, j, high), (i + 1, j + 1, high), (i, j + 1, high)])
    for i in range(across):
        for k in range(high):
            add(0, [(i, 0, k), (i + 1, 0, k), (i + 1, 0, k + 1), (i, 0, k + 1)])
            add(1, [(i, along, k), (i, along, k + 1), (i + 1, along, k + 1), (i + 1, along, k)])
    i, j, k = np.array(list(index)).T
    s, angle = i / across, j / along * np.pi / 2
    points = np.column_stack([(2 + 1.25 * s) * np.cos(angle), (1 + 1.75 * s) * np.sin(angle), 0.6 * k / high])
    points[j == along, 0] = 0.0
    corners = np.array(quads)
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]).astype(np.int32)
    names = ["y0", "x0", "inner", "lower", "upper", "bottom", "top"]
    return fem.SurfaceMesh(points, triangles, np.array(faces * 2, np.int32), names)


def solved_plate(edge_length: float) -> tuple[fem.TetMesh, fem.StaticResult]:
    mesh = fem.tetrahedralize(thick_plate(), edge_length)
    x, y, z = np.asarray(mesh.nodes).T
    middle = (np.abs((x / 3.25) ** 2 + (y / 2.75) ** 2 - 1.0) < 2e-3) & (np.abs(z - 0.3) < NEAR)
    supports = [fem.Support("y0", axes="y"), fem.Support("x0", axes="x"), fem.Support("lower", axes="xy")]
    supports += [fem.Support("upper", axes="xy"), fem.Support(fem.select_nodes(np.flatnonzero(middle)), axes="z")]
    return mesh, fem.solve_static(mesh, STEEL, supports, [fem.Pressure("top", PRESSURE)], exclusion_distance=0.0)


def eighth(solid: manifold3d.Manifold, far: float, radius: Callable[[Array], Array]) -> fem.SurfaceMesh:
    """What of a solid lies at positive x, y and z; faces x0, y0, z0, inner and rest."""
    cut = solid ^ manifold3d.Manifold.cube([far, far, far], False)
    made = cut.to_mesh()
    body = trimesh.Trimesh(np.asarray(made.vert_properties)[:, :3].astype(float), np.asarray(made.tri_verts))
    points = np.array(body.vertices)
    points[np.abs(points) < NEAR] = 0.0
    centers, normals = points[body.faces].mean(axis=1), np.asarray(body.face_normals)
    face = np.where(radius(centers) < 1.02 * INNER, 3, 4)
    for axis in range(3):
        face[(normals[:, axis] < -0.999) & (centers[:, axis] < NEAR)] = axis
    names = ["x0", "y0", "z0", "inner", "rest"]
    return fem.SurfaceMesh(points, np.asarray(body.faces, np.int32), face.astype(np.int32), names)


def pressed(surface: fem.SurfaceMesh, edge_length: float) -> tuple[fem.TetMesh, fem.StaticResult]:
    mesh = fem.tetrahedralize(surface, edge_length)
    supports = [fem.Support(f"{axis}0", axes=axis, symmetry=True) for axis in "xyz"]
    return mesh, fem.solve_static(mesh, STEEL, supports, [fem.Pressure("inner", PRESSURE)], exclusion_distance=0.0)


def row(
    name: str, mesh: fem.TetMesh, result: fem.StaticResult, exact: float, radius: Callable[[Array], Array], top: float
) -> None:
    """Errors on the inner face, by the number of flat faces that a node lies on."""
    nodes = np.asarray(mesh.nodes)
    corner = np.zeros(len(nodes), bool)
    corner[np.unique(np.asarray(mesh.tets)[:, :4])] = True
    inner = corner & (np.abs(radius(nodes) - INNER) < 2e-3)
    flat = (nodes < NEAR).sum(axis=1) + (np.abs(nodes[:, 2] - top) < NEAR)
    recovered, mean = von_mises(np.asarray(result.stress)), von_mises(averaged(mesh, np.asarray(result.displacement)))
    cells = []
    for kind in range(3):
        errors = [v[inner & (flat == kind)] / exact - 1.0 for v in (recovered, mean)]
        cells += [f"{100 * np.sqrt((e**2).mean()):.2f} %" if len(e) else "-" for e in errors]
    print("|", " | ".join([name, str(len(nodes)), *cells]), "|", flush=True)


def main() -> None:
    """Prints both tables."""
    print("| LE10: nodes | elements at D | recovered | averaged |\n| --- | --- | --- | --- |")
    for edge_length in (0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.12, 0.09):
        mesh, result = solved_plate(edge_length)
        at = int(np.argmin(np.linalg.norm(np.asarray(mesh.nodes) - [2.0, 0.0, 0.6], axis=1)))
        values = (np.asarray(result.stress)[at, 1], averaged(mesh, np.asarray(result.displacement))[at, 1])
        cells = [f"{100 * (value / -5.38e6 - 1.0):+.2f} %" for value in values]
        count = int((np.asarray(mesh.tets)[:, :4] == at).sum())
        print("|", " | ".join([str(len(mesh.nodes)), str(count), *cells]), "|", flush=True)
    print("\n| body | nodes | smooth: recovered | averaged | edges: recovered | averaged | corners: recovered", end="")
    print(" | averaged |")
    print("|" + " --- |" * 8)
    a, b = INNER, OUTER
    ratio = (b**2 + a**2) / (b**2 - a**2)
    ring = manifold3d.Manifold.cylinder(HEIGHT, b, b, 128) - manifold3d.Manifold.cylinder(HEIGHT, a, a, 128)
    exact = PRESSURE * np.sqrt(((ratio + 1.0) ** 2 + ratio**2 + 1.0) / 2.0)
    from_axis: Callable[[Array], Array] = lambda x: np.linalg.norm(x[:, :2], axis=1)  # noqa: E731
    surface = eighth(ring, 2.0 * b, from_axis)
    for edge_length in (0.8, 0.6, 0.45, 0.35, 0.25, 0.18):
        row("cylinder", *pressed(surface, edge_length), float(exact), from_axis, HEIGHT)
    ball = manifold3d.Manifold.sphere(b, 96) - manifold3d.Manifold.sphere(a, 96)
    exact = PRESSURE * ((2.0 * a**3 + b**3) / (2.0 * (b**3 - a**3)) + 1.0)
    from_center: Callable[[Array], Array] = lambda x: np.linalg.norm(x, axis=1)  # noqa: E731
    surface = eighth(ball, 2.0 * b, from_center)
    for edge_length in (0.6, 0.45, 0.35, 0.28, 0.22, 0.18):
        row("sphere", *pressed(surface, edge_length), float(exact), from_center, np.inf)


if __name__ == "__main__":
    main()
