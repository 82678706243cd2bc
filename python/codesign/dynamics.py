"""Rigid-body dynamics of robots described by URDF.

Every function takes the model, the base pose (4, 4) in the world and the joint positions s (n,). Velocities nu (6+n,)
stack the linear velocity of the base origin and the angular velocity, both in world axes, then the joint velocities
("mixed" convention); Jacobians and matrices refer to this nu. With a fixed base the six base coordinates are absent.
SI units. Wrong shapes raise ValueError, unknown names UnknownNameError.
"""

from codesign._core.dynamics import (
    Model,
    bias_forces,
    center_of_mass,
    center_of_mass_jacobian,
    center_of_mass_velocity,
    centroidal_momentum,
    centroidal_momentum_bias,
    centroidal_momentum_matrix,
    forward_dynamics,
    frame_bias_acceleration,
    frame_jacobian,
    frame_pose,
    frame_velocity,
    gravity_forces,
    inverse_dynamics,
    kinetic_energy,
    load_urdf,
    locked_inertia,
    mass_matrix,
    potential_energy,
)

__all__ = [
    "Model",
    "bias_forces",
    "center_of_mass",
    "center_of_mass_jacobian",
    "center_of_mass_velocity",
    "centroidal_momentum",
    "centroidal_momentum_bias",
    "centroidal_momentum_matrix",
    "forward_dynamics",
    "frame_bias_acceleration",
    "frame_jacobian",
    "frame_pose",
    "frame_velocity",
    "gravity_forces",
    "inverse_dynamics",
    "kinetic_energy",
    "load_urdf",
    "locked_inertia",
    "mass_matrix",
    "potential_energy",
]
