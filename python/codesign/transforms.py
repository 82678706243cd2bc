"""Poses as 4×4 matrices and their URDF form, xyz and fixed-axis roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Matrix = NDArray[np.float64]
Axis = Literal["x", "y", "z"]


def rotation_from_rpy(rpy: Sequence[float] | Matrix) -> Matrix:
    """Rotation matrix (3, 3) of roll, pitch, yaw [rad]; exact at multiples of a right angle."""
    (cr, cp, cy), (sr, sp, sy) = (_snapped(f(np.asarray(rpy, dtype=float))) for f in (np.cos, np.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rpy_from_rotation(R: Matrix) -> Matrix:
    """Roll, pitch, yaw (3,) [rad] of a rotation matrix; accurate at and near pitch = ±90°, where yaw is taken as found.

    Roll is computed after undoing the yaw found, so that an ill-conditioned yaw (pitch near ±90°) is made up for by it.
    """
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s = np.cos(yaw), np.sin(yaw)
    pitch = np.arctan2(-R[2, 0], c * R[0, 0] + s * R[1, 0])
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, pitch, yaw])


def pose(xyz: Sequence[float] | Matrix = (0.0, 0.0, 0.0), rpy: Sequence[float] | Matrix = (0.0, 0.0, 0.0)) -> Matrix:
    """a_T_b (4, 4) from the position of b in a [m] and the roll, pitch, yaw of b in a [rad]."""
    a_T_b = np.eye(4)
    a_T_b[:3, :3] = rotation_from_rpy(rpy)
    a_T_b[:3, 3] = xyz
    return a_T_b


def quaternion(R: Matrix) -> Matrix:
    """Unit quaternions w, x, y, z (..., 4) of rotation matrices (..., 3, 3), w ≥ 0; exact to rounding for all angles.

    The largest component is taken from the diagonal, the others follow from it (Shepperd, 1978).
    """
    R = np.asarray(R, dtype=float)
    trace = np.trace(R, axis1=-2, axis2=-1)[..., None]
    squares = np.concatenate([1.0 + trace, 1.0 - trace + 2.0 * np.diagonal(R, axis1=-2, axis2=-1)], axis=-1)  # 4 q²
    skew = [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]]
    products = np.zeros((*R.shape[:-2], 4, 4))  # 4 q_i q_j
    for i in range(3):
        products[..., 0, i + 1] = products[..., i + 1, 0] = skew[i]
        for j in range(i):
            products[..., i + 1, j + 1] = products[..., j + 1, i + 1] = R[..., i, j] + R[..., j, i]
    diagonal = np.arange(4)
    products[..., diagonal, diagonal] = squares
    row = squares.argmax(axis=-1)[..., None, None]
    q = np.take_along_axis(products, row, axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.asarray(np.where(q[..., :1] < 0.0, -q, q))


def rotation_from_quaternion(wxyz: Sequence[float] | Matrix) -> Matrix:
    """Rotation matrix (3, 3) of a quaternion w, x, y, z of any length but zero."""
    w, x, y, z = np.asarray(wxyz, dtype=float) / np.linalg.norm(wxyz)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def inverse(a_T_b: Matrix) -> Matrix:
    """b_T_a (..., 4, 4) of poses a_T_b (..., 4, 4)."""
    b_T_a = np.zeros_like(a_T_b)
    b_R_a = np.swapaxes(a_T_b[..., :3, :3], -1, -2)
    b_T_a[..., :3, :3] = b_R_a
    b_T_a[..., :3, 3] = -np.einsum("...ij,...j->...i", b_R_a, a_T_b[..., :3, 3])
    b_T_a[..., 3, 3] = 1.0
    return b_T_a


def rotation_about(axis: Matrix, angle: ArrayLike) -> Matrix:
    """Rotation matrices (..., 3, 3) by angles (...) [rad] about a unit axis (Rodrigues)."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.asarray(angle, dtype=float)[..., None, None]
    R: Matrix = np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K)
    return R


def reflection(axis: Axis) -> Matrix:
    """Reflection (3, 3) that changes the sign of one coordinate."""
    S = np.eye(3)
    S["xyz".index(axis), "xyz".index(axis)] = -1.0
    return S


def mirrored_pose(a_T_b: Matrix, axis: Axis) -> Matrix:
    """Pose of the mirror image of frame b when everything in a is reflected along `axis` of a.

    The image of a right-handed frame is left-handed; the image's y axis is turned round to make it right-handed again,
    so x and z (in an interface frame: the reference direction and the normal of the face) are true mirror images.
    """
    image = np.eye(4)
    image[:3, :3] = reflection(axis) @ a_T_b[:3, :3] @ reflection("y")
    image[:3, 3] = reflection(axis) @ a_T_b[:3, 3]
    return image


def require_pose(a_T_b: ArrayLike, name: str) -> Matrix:
    """`a_T_b` as a (4, 4) array; ValueError if it is not a finite rigid motion (to 1e-9)."""
    T = np.array(a_T_b, dtype=float)
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise ValueError(f"{name}: a pose is a finite 4 × 4 matrix, not an array of shape {T.shape}")
    R = T[:3, :3]
    rigid = np.allclose(R @ R.T, np.eye(3), rtol=0.0, atol=1e-9) and np.linalg.det(R) > 0.0
    if not rigid or not np.array_equal(T[3], [0.0, 0.0, 0.0, 1.0]):
        raise ValueError(f"{name}: not a rigid motion (rotation matrix with determinant 1, last row 0 0 0 1)")
    return T


def _snapped(values: Matrix) -> Matrix:
    """Sines and cosines with the round-off of π/2 and π removed."""
    return np.where(np.abs(values) < 1e-15, 0.0, values)
