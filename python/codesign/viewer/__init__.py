"""Three-dimensional view of a design in the browser."""
