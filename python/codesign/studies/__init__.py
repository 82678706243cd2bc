"""Shipped studies: data (TOML, URDF) and small part definitions."""
