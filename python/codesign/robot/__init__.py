"""The robot as data: URDF, packages, parts placed in links, clearances."""
