"""Figures and pages made from a run's store; nothing here computes physics."""
