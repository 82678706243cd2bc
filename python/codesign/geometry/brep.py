"""Second evaluator of the part language: the same expression as an exact boundary representation, by OpenCASCADE.

Imported only when a STEP file is wanted: loading OpenCASCADE takes longer than meshing a part.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeVertex,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.collections import List_TopoDS_Shape
from OCP.gp import gp_Ax1, gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Shape, TopoDS_Wire

from codesign.errors import GeometryError
from codesign.geometry.exact import Exact
from codesign.geometry.profile import FULL_TURN, Loop
from codesign.geometry.shape import Difference, Extrusion, Frame, Intersection, Moved, Revolution, Shape, Triple, Union


@dataclass(frozen=True, slots=True)
class Brep:
    """A solid and those of its faces that have a name; lengths in mm."""

    shape: TopoDS_Shape
    named_faces: tuple[tuple[TopoDS_Shape, str], ...] = ()

    @property
    def volume(self) -> float:
        """Exact volume [mm³]."""
        properties = GProp_GProps()
        BRepGProp.VolumeProperties_s(self.shape, properties)
        return float(properties.Mass())

    def area(self, name: str) -> float:
        """Exact area [mm²] of all faces called `name`."""
        total = 0.0
        for face, face_name in self.named_faces:
            if face_name == name:
                properties = GProp_GProps()
                BRepGProp.SurfaceProperties_s(face, properties)
                total += float(properties.Mass())
        return total


def build_brep(shape: Shape) -> Brep:
    """Exact solid of a shape, without the seams that booleans leave in its faces.

    Raises: GeometryError if the result is not one valid closed solid (checked by BRepCheck).
    """
    result = _evaluate(shape)
    solids = explore(result.shape, TopAbs_ShapeEnum.TopAbs_SOLID)
    if len(solids) != 1:
        raise GeometryError(f"the shape has {len(solids)} bodies as a B-rep")
    brep = _without_seams(Brep(solids[0], result.named_faces))
    if not BRepCheck_Analyzer(brep.shape).IsValid() or brep.volume <= 0.0:
        raise GeometryError("the shape is not a valid solid as a B-rep")
    return brep


def explore(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    """Sub-shapes of a kind (solids, faces …) in order."""
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def _without_seams(brep: Brep) -> Brep:
    """The same solid with one face where several of the same name, or without one, lie on one surface."""
    names = {hash(face): name for face, name in brep.named_faces}  # shapes hash by identity and place
    beside: dict[int, set[str]] = {}
    for face in explore(brep.shape, TopAbs_ShapeEnum.TopAbs_FACE):
        for edge in explore(face, TopAbs_ShapeEnum.TopAbs_EDGE):
            beside.setdefault(hash(edge), set()).add(names.get(hash(face), ""))
    unify = ShapeUpgrade_UnifySameDomain(brep.shape, True, True, False)
    for edge in explore(brep.shape, TopAbs_ShapeEnum.TopAbs_EDGE):
        if len(beside[hash(edge)]) > 1:  # the border of a named face
            unify.KeepShape(edge)
    unify.Build()
    (solid,) = explore(unify.Shape(), TopAbs_ShapeEnum.TopAbs_SOLID)
    united: dict[int, tuple[TopoDS_Shape, str]] = {}
    for face, name in brep.named_faces:
        for piece in list(unify.History().Modified(face)) or [face]:
            united[hash(piece)] = (piece, name)
    return Brep(solid, tuple(united.values()))


def _evaluate(shape: Shape) -> Brep:
    if isinstance(shape, Extrusion):
        return _extrusion(shape)
    if isinstance(shape, Revolution):
        return _revolution(shape)
    if isinstance(shape, Moved):
        return moved(_evaluate(shape.shape), np.array(shape.matrix))
    if isinstance(shape, Difference):
        return _boolean(BRepAlgoAPI_Cut(), [_evaluate(shape.base)], [_evaluate(tool) for tool in shape.tools])
    if isinstance(shape, Union):
        first, *others = (_evaluate(part) for part in shape.shapes)
        return _boolean(BRepAlgoAPI_Fuse(), [first], others)
    if isinstance(shape, Intersection):
        result, *others = (_evaluate(part) for part in shape.shapes)
        for other in others:
            result = _boolean(BRepAlgoAPI_Common(), [result], [other])
        return result
    if isinstance(shape, Exact):
        return Brep(shape.solid, shape.named_faces)
    raise TypeError(f"{type(shape).__name__} is not a shape of the part language")


def _boolean(operation: BRepAlgoAPI_Cut, arguments: list[Brep], tools: list[Brep]) -> Brep:
    """Runs a boolean and follows the named faces through it."""
    for add, solids in ((operation.SetArguments, arguments), (operation.SetTools, tools)):
        shapes = List_TopoDS_Shape()
        for solid in solids:
            shapes.Append(solid.shape)
        add(shapes)
    operation.SetRunParallel(False)
    operation.Build()
    if not operation.IsDone():
        raise GeometryError(f"{type(operation).__name__} failed")
    named: list[tuple[TopoDS_Shape, str]] = []
    for face, name in (item for solid in (*arguments, *tools) for item in solid.named_faces):
        pieces = list(operation.Modified(face))
        if not pieces and not operation.IsDeleted(face):
            pieces = [face]
        named += [(piece, name) for piece in pieces]
    return Brep(operation.Shape(), tuple(named))


def moved(brep: Brep, matrix: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> Brep:
    """A solid under a rigid motion or reflection (4, 4) [mm]."""
    motion = gp_Trsf()
    motion.SetValues(*matrix[:3].ravel().tolist())
    transform = BRepBuilderAPI_Transform(brep.shape, motion, True)
    named = tuple((transform.ModifiedShape(face), name) for face, name in brep.named_faces)
    return Brep(transform.Shape(), named)


def _extrusion(extrusion: Extrusion) -> Brep:
    frame = extrusion.frame
    base = frame.at(0.0, 0.0, extrusion.start)
    wires = [_wire(loop, base) for loop in extrusion.profile.loops]
    plane = gp_Pln(gp_Pnt(*base.origin), gp_Dir(*base.z))
    maker = BRepBuilderAPI_MakeFace(plane, wires[0][0])
    for wire, _ in wires[1:]:
        maker.Add(TopoDS.Wire(wire.Reversed()))
    height = extrusion.end - extrusion.start
    # With a copy: else the end is a located twin of the start, and STEP files had no name for ends of moved cylinders.
    prism = BRepPrimAPI_MakePrism(maker.Face(), gp_Vec(*(height * c for c in base.z)), True)
    named = [(prism.FirstShape(), extrusion.start_face), (prism.LastShape(), extrusion.end_face)]
    for loop, (_, edges) in zip(extrusion.profile.loops, wires, strict=True):
        for edge, swept in zip(loop.edges, edges, strict=True):
            named += [(face, edge.face) for face in prism.Generated(swept)]
    return Brep(prism.Shape(), tuple((face, name) for face, name in named if name))


def _revolution(revolution: Revolution) -> Brep:
    frame, loop = revolution.frame, revolution.profile.outer
    wire, _ = _wire(loop, frame)
    face = BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(*frame.origin), gp_Dir(*frame.z)), wire).Face()
    solid = BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(*frame.origin), gp_Dir(*frame.x))).Shape()
    # The history of a revolution omits its plane faces, so the face of an edge is the one its middle lies on.
    faces = explore(solid, TopAbs_ShapeEnum.TopAbs_FACE)
    named: list[tuple[TopoDS_Shape, str]] = []
    for start, edge in zip(loop.starts, loop.edges, strict=True):
        if edge.face:
            middle = BRepBuilderAPI_MakeVertex(gp_Pnt(*frame.point(*edge.middle(start)))).Vertex()
            named += [(f, edge.face) for f in faces if BRepExtrema_DistShapeShape(middle, f).Value() < 1e-7]
    return Brep(solid, tuple(named))


def _wire(loop: Loop, frame: Frame) -> tuple[TopoDS_Wire, list[TopoDS_Edge]]:
    """A profile loop as lines and circular arcs in a frame, and its edges in order."""
    corners = loop.starts
    vertices = [BRepBuilderAPI_MakeVertex(gp_Pnt(*frame.point(u, v))).Vertex() for u, v in corners]
    edges: list[TopoDS_Edge] = []
    for k, edge in enumerate(loop.edges):
        here, there = vertices[k], vertices[(k + 1) % len(vertices)]
        if edge.center is None:
            edges.append(BRepBuilderAPI_MakeEdge(here, there).Edge())
            continue
        axis: Triple = frame.z if edge.sweep > 0.0 else (-frame.z[0], -frame.z[1], -frame.z[2])
        center = frame.point(*edge.center)
        start = frame.point(*corners[k])
        towards = gp_Dir(*(s - c for s, c in zip(start, center, strict=True)))
        radius = float(np.hypot(corners[k][0] - edge.center[0], corners[k][1] - edge.center[1]))
        circle = gp_Circ(gp_Ax2(gp_Pnt(*center), gp_Dir(*axis), towards), radius)
        if abs(edge.sweep) == FULL_TURN:
            edges.append(BRepBuilderAPI_MakeEdge(circle, here, here).Edge())
        else:
            edges.append(BRepBuilderAPI_MakeEdge(circle, here, there).Edge())
    maker = BRepBuilderAPI_MakeWire()
    for made in edges:
        maker.Add(made)
    return maker.Wire(), edges
