"""The list of validity warnings: each appears beyond its threshold and not before."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import rollnip as rn
from rollnip.model import Model
from rollnip.solver import solve
from rollnip.validity import CONTACT_ANGLE, NIP_STRAIN

RUBBER = rn.Elastic(modulus=0.91, poisson=0.5)


def nip(thickness=2.0, radius=50.0, load=0.74, material=RUBBER, **changes):
    upper = rn.Roller(radius=radius, layers=[rn.Layer(thickness, material)])
    return rn.Nip(
        upper=upper,
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(load),
        friction=2.7,
        speed=100.0,
        **changes,
    )


def warnings_of(problem, geometry="curved"):
    return " ".join(solve(problem, Model(geometry=geometry, tolerance=1e-2)).warnings)


def test_a_nip_like_those_compared_has_no_warning():
    assert warnings_of(nip()) == ""


def test_deep_indentation():
    assert "of their thickness" in warnings_of(nip(load=6.0))


def judged_nips():
    """Yield every nip of tests/data that was compared with finite elements."""
    for file in sorted((Path(__file__).parent / "data").glob("*finite_*.json")):
        found = json.loads(file.read_text("utf-8")).get("results", [])
        yield from (one for one in found if "approach" in one)


def test_no_nip_was_compared_beyond_the_limits_that_the_sentences_name():
    """And one nearly at the limit of the indentation: 15.9 % of the covering."""
    strains, angles = [], []
    for one in judged_nips():
        rollers = (one["upper"], one["lower"])
        covering = sum(layer["thickness"] for part in rollers for layer in part.get("layers", []))
        strains.append(one["approach"] / covering)
        low, high = one.get("contact_x", (0.0, 0.0))
        angles.append(0.5 * (high - low) / min(part["radius"] for part in rollers))
    assert len(strains) > 90
    assert NIP_STRAIN - 0.01 < max(strains) <= NIP_STRAIN
    assert 0.1 < max(angles) <= CONTACT_ANGLE


def test_thick_covering():
    thick = nip(thickness=10.0, load=0.2)
    assert "of its radius" in warnings_of(thick)
    assert "of its radius" not in warnings_of(thick, "second")
    assert "of its radius" in warnings_of(nip(thickness=22.0, load=0.1), "second")


def test_a_second_order_that_is_large_or_fails():
    assert "changes the indentation" in warnings_of(nip(load=20.0), "second")
    assert "changes the indentation" not in warnings_of(nip(load=20.0), "finite")
    beyond = solve(nip(load=60.0), Model(geometry="second", tolerance=1e-2))
    assert beyond.model.geometry == "curved"
    assert beyond.warnings[0].startswith(
        'No solution of geometry "second" was found: its second-order terms did not settle'
    )
    assert beyond.warnings[0].endswith('All figures are those of geometry "curved".')


def test_wide_nip():
    said = warnings_of(nip(thickness=7.0, load=9.0))
    # the widest nip compared has 22 degrees (docs/geometry.md), the limit lies above it
    assert "degrees of the smaller roller; beyond 29 the model was not compared" in said


def test_layers_on_a_half_space_are_flat_in_curved_geometry():
    core = rn.Roller(
        radius=50.0, layers=[rn.Layer(2.0, RUBBER)], core=rn.Elastic(modulus=100.0, poisson=0.3)
    )
    assert "half-space core" in warnings_of(replace(nip(), upper=core))
    flat = solve(replace(nip(), upper=core), Model(geometry="linear", tolerance=1e-2))
    assert not any("half-space" in line for line in flat.warnings)


def test_a_film_thinner_than_the_elements():
    film = rn.Layer(0.001, rn.Elastic(modulus=2.0, poisson=0.5))
    upper = rn.Roller(radius=50.0, layers=[film, rn.Layer(2.0, RUBBER)])
    assert "thinner than half an element" in warnings_of(replace(nip(), upper=upper))


@pytest.mark.parametrize(("time", "expected"), [(1e-2, False), (1e-6, True), (10.0, True)])
def test_prony_series_beyond_its_relaxation_times(time, expected):
    terms = ((0.5, time), (0.5, 3.0 * time))  # the dwell time is about 0.05 s
    material = rn.Prony(modulus=0.9, terms=terms, poisson=0.5)
    text = warnings_of(nip(material=material, thickness=3.0))
    assert ("beyond its data" in text) == expected


def test_far_temperature_and_constant_loss_factor():
    shift = rn.Arrhenius(activation_energy=60.0, reference=23.0)
    hot = rn.StandardLinearSolid(
        modulus=0.9,
        stiffening=0.5,
        relaxation_time=1e-2,
        poisson=0.5,
        temperature=100.0,
        shift=shift,
    )
    assert "shifted over 77 K" in warnings_of(nip(material=hot))
    lossy = rn.LossFactor(modulus=0.9, loss_factor=0.1, poisson=0.5)
    assert "constant loss factor" in warnings_of(nip(material=lossy))


def test_surface_strain_beside_a_slipping_edge():
    black = rn.Roller(radius=25.0, layers=[rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5))])
    driven = replace(nip(load=1.78), lower=black, tangential=rn.Traction(0.53))
    assert "surface is strained" in warnings_of(driven)
    assert "surface is strained" not in warnings_of(replace(driven, tangential=rn.Traction(0.0)))


def test_a_strain_energy_counts_only_in_full():
    stiffening = rn.Elastic(modulus=0.91, poisson=0.5, energy=rn.Yeoh(0.1))
    said = warnings_of(nip(material=stiffening), "second")
    assert "Material 1 (from the surface) of the upper roller has a strain energy (Yeoh)" in said
    assert warnings_of(nip(material=stiffening), "finite") == ""
    plain = rn.Elastic(modulus=0.91, poisson=0.5, energy=rn.NeoHookean())
    assert warnings_of(nip(material=plain), "second") == ""
