"""
How thick should a covering be?
===============================

How much does a thinner covering of the same rubber narrow the nip and raise the pressure? That
depends on Poisson's ratio: rubber hardly changes its volume, so a thin layer of it can give way
only sideways.
"""

import matplotlib.pyplot as plt
import numpy as np

import rollnip as rn

thicknesses = np.geomspace(1.0, 10.0, 9)


def solution(thickness, poisson):
    """A roller of 80 mm radius covered with rubber of 2 MPa, on a bare steel roller."""
    rubber = rn.Elastic(modulus=2.0, poisson=poisson)
    return rn.solve(
        rn.Nip(
            upper=rn.Roller(radius=80, layers=[rn.Layer(thickness, rubber)]),
            lower=rn.Roller(radius=80),
            normal=rn.LineLoad(3.0),
            friction=0.0,
        )
    )


figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
for poisson in (0.5, 0.49, 0.45):
    solved = [solution(thickness, poisson) for thickness in thicknesses]
    left.plot(thicknesses, [one.nip_width for one in solved], "o-", label=f"Poisson {poisson}")
    right.plot(thicknesses, [one.peak_pressure for one in solved], "o-")
left.set(xlabel="thickness [mm]", ylabel="nip width [mm]")
right.set(xlabel="thickness [mm]", ylabel="peak pressure [MPa]")
left.legend()
figure.show()

# %%
# Solid rubber is near 0.5. In the thinnest layer 0.49 widens the nip by two per cent:

for poisson in (0.5, 0.49, 0.45):
    thin, thick = solution(1.0, poisson), solution(10.0, poisson)
    print(
        f"Poisson {poisson}: 1 mm gives {thin.nip_width:.2f} mm and {thin.peak_pressure:.2f} MPa, "
        f"10 mm gives {thick.nip_width:.2f} mm and {thick.peak_pressure:.2f} MPa"
    )
