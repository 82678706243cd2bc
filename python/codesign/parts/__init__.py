"""What a study author subclasses: parametric parts, their surfaces, load cases and CAD files."""
