"""Sections of a study that decide how predictive control flies: configuration, checks, meanings."""
