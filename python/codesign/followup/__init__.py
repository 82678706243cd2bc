"""Studies of a finished run: robust variants, sensitivities, validation."""
