"""Weights of a predictive controller alone, on the body of the Original."""
