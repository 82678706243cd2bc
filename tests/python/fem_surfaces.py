"""Closed surfaces for tests, written as STL files in millimeters."""

from pathlib import Path

import manifold3d as m3
import numpy as np


def box(size, corner=(0.0, 0.0, 0.0)):
    """A box with one corner given."""
    return m3.Manifold.cube(size).translate(corner)


def l_bracket(chords=16):
    """Legs of 60 x 5 x 20 along x and z, the inner corner filleted with radius 8."""
    turn = np.linspace(-np.pi / 2, -np.pi, chords + 1)
    fillet = [(13.0 + 8.0 * np.cos(t), 13.0 + 8.0 * np.sin(t)) for t in turn]
    outline = [(0.0, 0.0), (60.0, 0.0), (60.0, 5.0), *fillet, (5.0, 60.0), (0.0, 60.0)]
    # extruded along z: (x, y) -> (x, z), height -> -y
    return m3.Manifold.extrude(m3.CrossSection([outline]), 20.0).rotate((90, 0, 0)).translate((0, 20, 0))


def filleted_tray():
    """A tray of 60 x 60 x 8, its pocket 44 wide down to z = 1.5, all its edges rounded with radius 2."""
    corners = [(x, y) for x in (10.0, 50.0) for y in (10.0, 50.0)]
    low = [m3.Manifold.sphere(2.0, 28).translate((x, y, 3.5)) for x, y in corners]
    high = [m3.Manifold.cylinder(6.0, 2.0, 2.0, 28).translate((x, y, 3.5)) for x, y in corners]
    return box((60, 60, 8)) - m3.Manifold.batch_hull([*low, *high])


def sharp_tray(floor=1.0):
    """A tray of 60 x 60 x 8 with a sharp pocket of 44 x 44."""
    return box((60, 60, 8)) - box((44, 44, 8), (8, 8, floor))


def holed_strip():
    """A strip of 200 x 60 x 5 about the origin with a hole of 30."""
    return box((200, 60, 5), (-100, -30, -2.5)) - m3.Manifold.cylinder(9.0, 15.0, 15.0, 64).translate((0, 0, -4.5))


def hollow_cube():
    """A cube of 40 about the origin with a cubic cavity of 20."""
    return box((40, 40, 40), (-20, -20, -20)) - box((20, 20, 20), (-10, -10, -10))


def windowed_bar(lip_top):
    """A bar of 10.3 x 18 x 6.8 with a bore along it whose mouth a lip closes but for a gap below it, and a window above
    it where `lip_top` is less than 4.224."""
    bore = m3.Manifold.cylinder(12.3067, 1.4241, 1.4241, 32).rotate((0, 90, 0)).translate((-1.0, 12.9746, 2.8))
    return box((10.3067, 18, 6.8445)) - bore + box((5.1534, 18, lip_top - 2.7343), (9.8067, 0, 2.7343))


def write_stl(solid, path: Path) -> Path:
    """Binary STL of a solid."""
    mesh = solid.to_mesh()
    corners = np.asarray(mesh.vert_properties[:, :3], dtype="<f4")[np.asarray(mesh.tri_verts)]
    record = np.zeros(len(corners), dtype=np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("tag", "<u2")]))
    record["corners"] = corners
    path.write_bytes(bytes(80) + np.uint32(len(record)).tobytes() + record.tobytes())
    return path
