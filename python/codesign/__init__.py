"""codesign: parametric parts, robot, controller and task in; the best buildable designs out."""

__version__ = "0.1.0"
