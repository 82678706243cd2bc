#!/bin/sh
# A cube of ten-node tetrahedra, pulled in OpenSees.
#
# Guess, written first: TenNodeTetrahedron takes the order of Gmsh or that of VTK; in the right one a cube that is pulled
# passes the patch test, that is it needs the force E A u / L, as one of FourNodeTetrahedron does.
# Seen (openseespylinux 3.7.1.2 and 3.8.0.0): the order is Gmsh's, the displacements are those of the patch test, and the
# force is a sixth: 1/3 instead of 2. A part under a given load moves six times too far. Nothing else tells, as mass and
# body forces are a sixth, too: the lowest frequency and the sag under its own weight are right, reactions are not. The
# source scales the volume by 1/6 twice, in the weights of the integration points and in the determinant.
#
# Exit code 0 while that is so. Needs python3 with venv and the network.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check openseespylinux==3.7.1.2 numpy==2.4.6
cd "$folder"
venv/bin/python - <<'PYTHON' 2>log || { tail -n 5 log; exit 1; }
import itertools

import numpy as np
import openseespylinux.opensees as ops

YOUNG, POISSON, DENSITY, STRETCH = 200.0, 0.3, 3.0, 0.01
CUBE = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
TETRAHEDRA = ((0, 4, 2, 1), (6, 2, 4, 7), (5, 1, 7, 4), (3, 7, 1, 2), (1, 4, 2, 7))
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3))  # Gmsh's order of a tetrahedron's middle nodes


def build(kind, poisson, sideways, force=()):
    """Nodes of the cube, held at x = 0 and, if wanted, at all nodes in y and z."""
    points, elements = [tuple(corner) for corner in CUBE], []
    for corners in TETRAHEDRA:
        a, b, c, d = CUBE[list(corners)]
        nodes = list(corners if np.linalg.det((b - a, c - a, d - a)) > 0.0 else (corners[1], corners[0], *corners[2:]))
        for i, j in EDGES if kind == "TenNodeTetrahedron" else ():
            middle = tuple((np.array(points[nodes[i]]) + points[nodes[j]]) / 2.0)
            if middle not in points:
                points.append(middle)
            nodes.append(points.index(middle))
        elements.append(nodes)
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    for number, point in enumerate(points, 1):
        ops.node(number, *point)
        ops.fix(number, int(point[0] == 0.0), int(sideways or point[1] == 0.0), int(sideways or point[2] == 0.0))
    ops.nDMaterial("ElasticIsotropic", 1, YOUNG, poisson, DENSITY)
    for number, nodes in enumerate(elements, 1):
        ops.element(kind, number, *[node + 1 for node in nodes], 1, *force)
    return np.array(points)


def solve(points):
    """Displacements and the force that holds x = 0."""
    ops.system("UmfPack")
    ops.numberer("RCM")
    ops.constraints("Transformation")
    ops.algorithm("Linear")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    assert ops.analyze(1) == 0
    ops.reactions()
    moved = np.array([ops.nodeDisp(number) for number in range(1, len(points) + 1)])
    return moved, sum(ops.nodeReaction(number, 1) for number, point in enumerate(points, 1) if point[0] == 0.0)


for kind, share in (("FourNodeTetrahedron", 1.0), ("TenNodeTetrahedron", 1.0 / 6.0)):
    points = build(kind, POISSON, sideways=False)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for number in 1 + np.flatnonzero(points[:, 0] == 1.0):
        ops.sp(int(number), 1, STRETCH)
    moved, pull = solve(points)
    assert np.allclose(moved, points * STRETCH * np.array((1.0, -POISSON, -POISSON)), atol=1e-12), "no patch test"
    assert abs(-pull / (YOUNG * STRETCH) - share) < 1e-9, f"changed: {kind} pulls {-pull}, not {share} of E A u / L"
points = build("TenNodeTetrahedron", 0.0, sideways=True)  # a bar: frequency and sag in closed form
assert abs(ops.eigen("-fullGenLapack", 1)[0] / ((np.pi / 2) ** 2 * YOUNG / DENSITY) - 1.0) < 0.01, "changed: frequency"
moved, hold = solve(build("TenNodeTetrahedron", 0.0, sideways=True, force=(6.0, 0.0, 0.0)))
assert abs(moved[:, 0].max() - 6.0 / (2.0 * YOUNG)) < 1e-9 and abs(hold + 1.0) < 1e-9, "changed: body force"
print(f"as found: stretching the cube takes {-pull:.4f}, not {YOUNG * STRETCH:g}; a weight of 6 is held by {-hold:.4f}")
PYTHON
