"""Processes: local workers with limits, clusters. Nothing of search."""
