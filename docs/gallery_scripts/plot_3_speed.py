"""
A viscoelastic covering at all speeds
=====================================

At which speed does a viscoelastic covering lose most? A standard linear solid is soft when it
has time to relax and stiff when it has none. In between it costs power: the pressure is shifted
towards the inlet and resists the rolling.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import rollnip as rn

rubber = rn.StandardLinearSolid(modulus=2.0, stiffening=3.0, relaxation_time=0.007, poisson=0.5)
nip = rn.Nip(
    upper=rn.Roller(radius=50, layers=[rn.Layer(4.0, rubber)]),
    lower=rn.Roller(radius=50),
    normal=rn.LineLoad(3.0),
    friction=0.5,
    speed=100,
)
speeds = np.geomspace(10, 1e5, 13)
solutions = [rn.solve(replace(nip, speed=speed)) for speed in speeds]
assert all(one.converged for one in solutions)

figure, axes = plt.subplots(1, 3, figsize=(9, 3.2), layout="constrained")
for ax, name, values in (
    (axes[0], "nip width [mm]", [one.nip_width for one in solutions]),
    (axes[1], "rolling resistance", [one.rolling_resistance for one in solutions]),
    (axes[2], "creepage [%]", [100 * one.creepage for one in solutions]),
):
    ax.semilogx(speeds, values, "o-")
    ax.set(xlabel="speed [mm/s]", ylabel=name)
figure.show()

# %%
# The resistance is largest where the dwell time is a few times the relaxation time of 7 ms:

worst = max(solutions, key=lambda one: one.rolling_resistance)
print(f"at {worst.nip.speed:.0f} mm/s: dwell time {1e3 * worst.dwell_time:.1f} ms,")
print(
    f"rolling resistance {worst.rolling_resistance:.4f}, heat {worst.dissipation_viscous:.0f} mW/mm"
)

# %%
# The pressure at the slowest, the worst and the fastest:

figure, ax = plt.subplots(figsize=(7, 3.8), layout="constrained")
for one in (solutions[0], worst, solutions[-1]):
    inside = one.profiles.pressure > 0
    label = f"{one.nip.speed:.0f} mm/s"
    ax.plot(one.profiles.x[inside], one.profiles.pressure[inside], label=label)
ax.set(xlabel="x [mm], the inlet to the right", ylabel="pressure [MPa]")
ax.legend()
figure.show()
