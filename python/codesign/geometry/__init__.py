"""Parametric parts: one description, evaluated as a triangulated solid or as an exact B-rep."""

from codesign.geometry.edges import chamfer, fillet
from codesign.geometry.profile import Loop, Path, Profile, Resolution, circle, polygon, rectangle
from codesign.geometry.shape import (
    Extrusion,
    Frame,
    Revolution,
    Shape,
    at_points,
    box,
    cone,
    cylinder,
    plate,
    polar,
    stepped_hole,
    union,
)

__all__ = [
    "Extrusion",
    "Frame",
    "Loop",
    "Path",
    "Profile",
    "Resolution",
    "Revolution",
    "Shape",
    "at_points",
    "box",
    "chamfer",
    "circle",
    "cone",
    "cylinder",
    "fillet",
    "plate",
    "polar",
    "polygon",
    "rectangle",
    "stepped_hole",
    "union",
]
