"""Jet interfaces of the flying humanoid iRonCub."""
