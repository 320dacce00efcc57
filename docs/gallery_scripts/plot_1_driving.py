"""
From free rolling to the limit of friction
==========================================

How much creepage does a traction cost? Two coated rollers (configuration II of Braat & Kalker,
1993) are driven harder and harder in both directions. The friction is 0.5 here, so that the
limit can be reached: at a traction of friction times load the whole nip slides.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import rollnip as rn

upper = rn.Roller(radius=50, layers=[rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5))])
lower = rn.Roller(radius=25, layers=[rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5))])
free = rn.Nip(upper=upper, lower=lower, normal=rn.LineLoad(1.78), friction=0.5, speed=100)

# %%
# A variant of a nip is made with ``replace``; the limit of traction is friction times load.

limit = free.friction * 1.78
shares = np.array([-0.95, -0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8, 0.95])
solutions = [rn.solve(replace(free, tangential=rn.Traction(s * limit))) for s in shares]
assert all(one.converged for one in solutions)

figure, ax = plt.subplots(figsize=(7, 4), layout="constrained")
ax.plot([100 * one.creepage for one in solutions], shares, "o-")
ax.axhline(0, color="0.7", linewidth=0.8)
ax.set(xlabel="creepage [%]", ylabel="traction / (friction x load)")
figure.show()

# %%
# The curve does not pass through zero: in free rolling the upper roller turns slower than the
# lower one, because its softer covering is stretched more.

print(f"free rolling: creepage {100 * solutions[5].creepage:.2f} %")

# %%
# The slip zone begins at the trailing edge and grows until nothing sticks.

for share, one in zip(shares, solutions, strict=True):
    stick = sum(zone.stop - zone.start for zone in one.zones if zone.state == "stick")
    part = 100 * stick / one.nip_width
    print(f"traction {share:+.2f} of the limit: {part:3.0f} % of the nip sticks")
