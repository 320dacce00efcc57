"""Rollers and bare nips of the cases that a judge wrote to tests/data, as `rollnip` has them."""

import rollnip as rn


def judged_roller(of):
    """The roller of a case: its radius and the layers on it; bare without layers."""
    layers = tuple(
        rn.Layer(one["thickness"], rn.Elastic(modulus=one["modulus"], poisson=one["poisson"]))
        for one in of.get("layers", ())
    )
    return rn.Roller(radius=of["radius"], layers=layers)


def judged_nip(case):
    """The nip of a case without a sheet, under its load; it rolls freely if it has no traction."""
    return rn.Nip(
        upper=judged_roller(case["upper"]),
        lower=judged_roller(case["lower"]),
        normal=rn.LineLoad(case["load"]),
        friction=case["friction"],
        tangential=rn.Traction(case.get("traction", 0.0)),
    )
