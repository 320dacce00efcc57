"""
Where does the covering suffer?
===============================

A driven nip strains its covering most at the surface, where it slips, and the bond to the core
carries shear of both signs in every revolution. Both come from the same solution.
"""

import matplotlib.pyplot as plt
import numpy as np

import rollnip as rn
from rollnip.plots import plot_field

nip = rn.Nip(
    upper=rn.Roller(radius=60, layers=[rn.Layer(6.0, rn.Elastic(modulus=3.0, poisson=0.5))]),
    lower=rn.Roller(radius=60),
    normal=rn.LineLoad(6.0),
    tangential=rn.Traction(0.8),
    friction=0.6,
)
solution = rn.solve(nip)
assert solution.converged

figure, ax = plt.subplots(figsize=(8, 3.8), layout="constrained")
plot_field(solution, "von_mises", "upper", ax)
figure.show()

# %%
# The same field as numbers, at depths and places of your choice:

field = solution.interior("upper", z=np.linspace(0, 6, 61), x=np.linspace(-10, 10, 201))
row, column = np.unravel_index(np.argmax(field.von_mises), field.von_mises.shape)
print(f"largest von Mises stress {field.von_mises[row, column]:.3f} MPa")
print(f"at a depth of {field.z[row]:.1f} mm, x = {field.x[column]:.1f} mm")

# %%
# And what the bond has to carry:

bond = solution.interfaces[-1]
print(f"bond at {bond.depth:g} mm: shear from {bond.shear_min:.3f} to {bond.shear_max:.3f} MPa,")
print(f"peel (tension positive) from {bond.peel_min:.3f} to {bond.peel_max:.3f} MPa")

figure, ax = plt.subplots(figsize=(7, 3.6), layout="constrained")
ax.plot(bond.x, bond.shear, label="shear")
ax.plot(bond.x, bond.peel, label="peel, tension positive")
ax.set(xlabel="x [mm], the inlet to the right", ylabel="stress on the bond [MPa]")
ax.legend()
figure.show()
