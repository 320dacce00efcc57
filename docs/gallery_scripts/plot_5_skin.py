"""
A thin, stiff skin on a soft covering
=====================================

What does a stiff skin on soft rubber do to the pressure? The skin has to bend where the nip
begins and ends, and resists: the pressure rises at both edges and the nip gets narrower. In the
middle the pressure rises by about a tenth.
"""

import matplotlib.pyplot as plt

import rollnip as rn

soft = rn.Elastic(modulus=1.0, poisson=0.5)


def solution(modulus):
    """A skin of 0.3 mm and the modulus given, on 5 mm of soft rubber."""
    skin = rn.Elastic(modulus=modulus, poisson=0.4)
    return rn.solve(
        rn.Nip(
            upper=rn.Roller(radius=40, layers=[rn.Layer(0.3, skin), rn.Layer(5.0, soft)]),
            lower=rn.Roller(radius=40),
            normal=rn.LineLoad(2.0),
            friction=0.0,
        )
    )


figure, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for modulus in (1.0, 30.0, 300.0):
    one = solution(modulus)
    assert one.converged
    ax.plot(one.profiles.x, one.profiles.pressure, label=f"skin of {modulus:g} MPa")
    width, peak = one.nip_width, one.peak_pressure
    print(f"skin of {modulus:5g} MPa: nip width {width:.2f} mm, peak {peak:.3f} MPa")
ax.set(xlabel="x [mm]", ylabel="pressure [MPa]", xlim=(-8, 8))
ax.legend()
figure.show()

# %%
# In rolling each point of the surface passes both peaks. Under a thin skin hundreds of times
# stiffer than the layer below it the geometry models have their largest errors; the page on
# geometry says how large they are.
