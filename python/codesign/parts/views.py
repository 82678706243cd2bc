"""Views of an exact solid with hidden lines, by OpenCASCADE's exact hidden-line removal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepLib import BRepLib
from OCP.GeomAbs import GeomAbs_CurveType
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS, TopoDS_Shape

from codesign.geometry.brep import explore
from codesign.geometry.profile import Vector

STRAIGHT = 1e-6  # mm: how far the points of a curve may lie from a line
COVERED = 1e-4  # mm: a hidden line this near to visible ones is not drawn
POINTS = 24  # of a quarter turn, at least of any curve


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line of a view, as points (n, 2) [mm], x right and y up. circle: center x, y and radius of a full one."""

    points: Vector
    circle: tuple[float, float, float] | None = None


@dataclass(frozen=True, eq=False)
class View:
    """A projection: towards: unit vector to the viewer; right: unit vector; visible and hidden lines in mm."""

    towards: Vector
    right: Vector
    visible: tuple[Stroke, ...]
    hidden: tuple[Stroke, ...]

    def place(self, xyz: Vector) -> Vector:
        """Points (..., 3) of the solid in the view (..., 2) [mm]."""
        return np.stack([xyz @ self.right, xyz @ np.cross(self.towards, self.right)], axis=-1)

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Lower left and upper right corner (2,) of all lines."""
        points = np.vstack([stroke.points for stroke in self.visible])
        return points.min(axis=0), points.max(axis=0)


def project(shape: TopoDS_Shape, towards: Vector, right: Vector, hidden: bool = True) -> View:
    """A view of a solid, seen from a direction (3,) with another to the right; hidden lines if wanted."""
    towards, right = (np.asarray(v, dtype=float) / np.linalg.norm(v) for v in (towards, right))
    algorithm = HLRBRep_Algo()
    algorithm.Add(shape, 0)
    algorithm.Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*towards), gp_Dir(*right))))
    algorithm.Update()
    algorithm.Hide()
    lines = HLRBRep_HLRToShape(algorithm)
    visible = _strokes(lines.VCompound(), lines.OutLineVCompound())
    behind = _strokes(lines.HCompound(), lines.OutLineHCompound()) if hidden else []
    seen = [(stroke.points.min(axis=0), stroke.points.max(axis=0), stroke.points) for stroke in visible]
    kept: list[Stroke] = []
    for stroke in behind:
        if not _covered(stroke.points, seen):
            kept.append(stroke)
            seen.append((stroke.points.min(axis=0), stroke.points.max(axis=0), stroke.points))
    return View(towards, right, tuple(visible), tuple(kept))


def _strokes(*compounds: TopoDS_Shape | None) -> list[Stroke]:
    strokes = []
    for compound in compounds:
        if compound is None or compound.IsNull():
            continue
        BRepLib.BuildCurves3d_s(compound)
        for edge in explore(compound, TopAbs_ShapeEnum.TopAbs_EDGE):
            strokes.append(_stroke(BRepAdaptor_Curve(TopoDS.Edge(edge))))
    return strokes


def _stroke(curve: BRepAdaptor_Curve) -> Stroke:
    first, last = curve.FirstParameter(), curve.LastParameter()
    kind = curve.GetType()
    circle = None
    count = POINTS
    if kind == GeomAbs_CurveType.GeomAbs_Line:
        count = 2
    elif kind in (GeomAbs_CurveType.GeomAbs_Circle, GeomAbs_CurveType.GeomAbs_Ellipse):
        count = max(POINTS // 2, int(np.ceil((last - first) / (np.pi / 2) * POINTS))) + 1
        if kind == GeomAbs_CurveType.GeomAbs_Circle and last - first > 2 * np.pi - 1e-6:
            center = curve.Circle().Location()
            circle = (center.X(), center.Y(), curve.Circle().Radius())
    points = np.array([(p.X(), p.Y()) for p in (curve.Value(t) for t in np.linspace(first, last, count))])
    chord = points[-1] - points[0]
    length = float(np.linalg.norm(chord))
    if count > 2 and length > 0.0:
        apart = points - points[0]
        off = np.abs(apart[:, 0] * chord[1] - apart[:, 1] * chord[0]) / length
        steps = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        if off.max() < STRAIGHT and steps < length + STRAIGHT:
            points = points[[0, -1]]
    return Stroke(points, circle)


def _covered(points: Vector, seen: list[tuple[Vector, Vector, Vector]]) -> bool:
    """Whether every point of a line, and those between, lies on lines drawn before."""
    samples = _resampled(points, 7)
    open_ = np.ones(len(samples), dtype=bool)
    low, high = samples.min(axis=0) - COVERED, samples.max(axis=0) + COVERED
    for other_low, other_high, line in seen:
        if (other_low > high).any() or (other_high < low).any():
            continue
        open_ &= _distances(samples, line) > COVERED
        if not open_.any():
            return True
    return False


def _resampled(points: Vector, count: int) -> Vector:
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0.0, along[-1], count)
    return np.column_stack([np.interp(at, along, points[:, k]) for k in range(2)])


def _distances(samples: Vector, line: Vector) -> Vector:
    """Distance (n,) of samples (n, 2) from a polyline (m, 2)."""
    start, step = line[:-1], np.diff(line, axis=0)
    squares = np.maximum((step * step).sum(axis=1), 1e-300)
    share = np.clip(((samples[:, None] - start) * step).sum(axis=2) / squares, 0.0, 1.0)
    return np.asarray(np.linalg.norm(samples[:, None] - (start + share[..., None] * step), axis=2).min(axis=1))
