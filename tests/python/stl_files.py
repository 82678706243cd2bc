"""Small STL files, rebuilt where a test needs them."""

import struct

import numpy as np

BOX = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6]])
BOX = np.concatenate([BOX, [[0, 6, 4], [1, 5, 7], [1, 7, 3]]])


def box(lower, upper, inside_out=False):
    """Facets (12, 3, 3) mm of a box."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    facets = (np.asarray(lower) + corners * (np.asarray(upper) - lower))[BOX]
    return facets[:, ::-1] if inside_out else facets


def stl(path, *facets):
    """Binary STL of facets in millimeters."""
    all_facets = np.concatenate(facets)
    record = np.zeros(len(all_facets), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    record["corners"] = all_facets
    path.write_bytes(bytes(80) + struct.pack("<I", len(record)) + record.tobytes())
    return path


def facets_of(body):
    """Facets (m, 3, 3) of a body of manifold3d."""
    mesh = body.to_mesh64()
    return np.asarray(mesh.vert_properties)[np.asarray(mesh.tri_verts, dtype=int)]
