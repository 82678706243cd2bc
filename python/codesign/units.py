"""Conversions between SI and the units of files and people; used only where a file or a person is read or written."""

import math

MILLIMETER = 1e-3  # m
DEGREE = math.pi / 180.0  # rad
MEGA, GIGA = 1e6, 1e9
MEBIBYTE = float(1 << 20)  # bytes
