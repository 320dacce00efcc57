"""Discrete problems to try the contact algorithms on."""

from discrete_problems import half_spaces, mesh, random_problem, unit_load, within

__all__ = ["half_spaces", "mesh", "random_problem", "unit_load", "within"]
