"""The engine: from design variables to objectives and constraints."""
