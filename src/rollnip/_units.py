"""Quantities with their units, as industry writes them, into mm, N, MPa, s."""
