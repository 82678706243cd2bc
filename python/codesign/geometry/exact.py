"""Solids of other CAD tools as shapes of the part language: build123d and CadQuery objects, OpenCASCADE solids.

OpenCASCADE is loaded when a solid is wrapped or evaluated.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any

import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Difference, Intersection, Moved, Shape, Union
from codesign.geometry.tessellate import PrimitiveMesh

ANGLE = 0.2  # rad between neighboring chords: 8 on a quarter turn
Faces = Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Exact(Shape):
    """A solid that another tool made, in mm. Made by `imported`; combines with others as every shape does.

    solid: TopoDS_Shape of one solid. named_faces: (face, name). digest: of both; shapes with the same are equal.
    """

    solid: Any = field(repr=False)
    named_faces: tuple[tuple[Any, str], ...] = field(repr=False)
    digest: str

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Exact) and other.digest == self.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of faces, each once."""
        return tuple(dict.fromkeys(name for _, name in self.named_faces))

    def mesh(self, resolution: Resolution) -> PrimitiveMesh:
        """A closed mesh whose triangles know their faces."""
        from OCP.TopAbs import TopAbs_ShapeEnum
        from OCP.TopoDS import TopoDS

        from codesign.geometry.brep import explore
        from codesign.geometry.triangulate import triangulate

        chord = resolution.chord_mm or 0.06 * (48.0 / resolution.segments) ** 2
        faces = [TopoDS.Face(face) for face in explore(self.solid, TopAbs_ShapeEnum.TopAbs_FACE)]
        points, triangles, owner = triangulate(
            self.solid, faces, chord / resolution.refine**2, ANGLE / resolution.refine
        )
        names = tuple(next((name for other, name in self.named_faces if other.IsSame(face)), "") for face in faces)
        return PrimitiveMesh(points, triangles.astype(np.uint64), owner.astype(np.uint64), names)


def imported(solid: Any, faces: Faces | None = None) -> Exact:
    """A solid of build123d, CadQuery or OpenCASCADE (mm) as a shape.

    Args:
        solid: an object with `.wrapped` (build123d, CadQuery shapes), a builder with `.part`, or a TopoDS_Shape, that
            holds exactly one solid.
        faces: name -> faces that get it: one or several faces of the object, or a function of the object that gives
            them, such as `lambda part: part.faces().sort_by(Axis.Z)[0]`.
    Raises: GeometryError: no or several solids, an object of another OpenCASCADE kernel, a name without face.
    """
    from OCP.BinTools import BinTools
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.TopAbs import TopAbs_ShapeEnum

    from codesign.geometry.brep import explore

    solids = explore(_wrapped(solid), TopAbs_ShapeEnum.TopAbs_SOLID)
    if len(solids) != 1:
        raise GeometryError(f"the imported object has {len(solids)} solids instead of one")
    if not BRepCheck_Analyzer(solids[0]).IsValid():
        raise GeometryError("the imported object is no valid solid (BRepCheck)")
    own = explore(solids[0], TopAbs_ShapeEnum.TopAbs_FACE)
    named = []
    for name, chosen in (faces or {}).items():
        found = [_wrapped(face) for face in _listed(chosen(solid) if callable(chosen) else chosen)]
        mine = [face for face in own if any(face.IsSame(other) for other in found)]
        if not mine or len(mine) != len(found):
            raise GeometryError(f"face {name!r}: {len(found)} faces were chosen, {len(mine)} of them are the solid's")
        named += [(face, name) for face in mine]
    content = BytesIO()
    BinTools.Write_s(solids[0], content)
    numbers = [(name, next(k for k, other in enumerate(own) if other.IsSame(face))) for face, name in named]
    digest = hashlib.sha256(content.getvalue() + repr(numbers).encode()).hexdigest()[:16]
    return Exact(solids[0], tuple(named), digest)


def has_exact(shape: Shape) -> bool:
    """Whether a solid of another tool is in a shape, whose mass properties are then those of its B-rep."""
    if isinstance(shape, Moved):
        return has_exact(shape.shape)
    if isinstance(shape, Difference):
        return any(map(has_exact, (shape.base, *shape.tools)))
    if isinstance(shape, Union | Intersection):
        return any(map(has_exact, shape.shapes))
    return isinstance(shape, Exact)


def exact_moments(shape: Shape) -> Vector:
    """(10,) integrals of 1, x, y, z, xx, yy, zz, xy, yz, zx over the exact solid of a shape, in mm."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    from codesign.geometry.brep import build_brep

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(build_brep(shape).shape, properties, EXACTNESS)
    volume, center, tensor = properties.Mass(), properties.CentreOfMass(), properties.MatrixOfInertia()
    com = np.array([center.X(), center.Y(), center.Z()])
    about_com = np.array([[tensor.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)])
    second = 0.5 * np.trace(about_com) * np.eye(3) - about_com + volume * np.outer(com, com)
    i, j = [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]
    return np.concatenate(([volume], volume * com, second[i, j]))


EXACTNESS = 1e-9  # relative, of the integrals


def _wrapped(thing: Any) -> Any:
    """The OpenCASCADE shape of an object."""
    from OCP.TopoDS import TopoDS_Shape

    inner = getattr(thing, "part", None) if not hasattr(thing, "wrapped") else thing
    inner = thing.val() if inner is None and callable(getattr(thing, "val", None)) else inner
    shape = getattr(inner, "wrapped", thing)
    if isinstance(shape, TopoDS_Shape):
        return shape
    kind = f"{type(thing).__module__}.{type(thing).__qualname__}"
    raise GeometryError(
        f"{kind} holds no OpenCASCADE shape of this program's kernel (cadquery-ocp-novtk 8): write a STEP or BREP file "
        "where it is made, and name that file (imported_file)"
    )


def _listed(chosen: Any) -> Iterable[Any]:
    return chosen if isinstance(chosen, Iterable) and not hasattr(chosen, "wrapped") else [chosen]
