"""Rollers of the cases that a judge wrote to tests/data, as `rollnip` has them."""

import rollnip as rn


def judged_roller(of):
    """The roller of a case: its radius and the layers on it; bare without layers."""
    layers = tuple(
        rn.Layer(one["thickness"], rn.Elastic(modulus=one["modulus"], poisson=one["poisson"]))
        for one in of.get("layers", ())
    )
    return rn.Roller(radius=of["radius"], layers=layers)
