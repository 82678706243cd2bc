"""Searches on the design grid: ask and tell, resume, progress. Nothing of physics."""
