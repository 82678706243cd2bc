"""Parametric parts: one description, evaluated as a triangulated solid or as an exact B-rep."""
