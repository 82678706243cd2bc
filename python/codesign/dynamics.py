"""Rigid-body dynamics of robots described by URDF."""

from codesign._core.dynamics import (
    Model,
    bias_forces,
    center_of_mass,
    centroidal_momentum,
    centroidal_momentum_matrix,
    frame_jacobian,
    frame_pose,
    load_urdf,
    mass_matrix,
)

__all__ = [
    "Model",
    "bias_forces",
    "center_of_mass",
    "centroidal_momentum",
    "centroidal_momentum_matrix",
    "frame_jacobian",
    "frame_pose",
    "load_urdf",
    "mass_matrix",
]
