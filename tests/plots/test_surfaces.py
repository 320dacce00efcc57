from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.plots import plot_deformed_surfaces, plot_gap, plot_speed, plot_strain


def labels(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def curve(ax, label):
    return next(line for line in ax.lines if line.get_label() == label).get_ydata()


@pytest.mark.parametrize(
    ("plot", "unit"),
    [
        (plot_strain, "surface strain [%]"),
        (plot_speed, "surface speed [mm/s]"),
        (plot_gap, "gap [mm]"),
        (plot_deformed_surfaces, "height [mm], stretched"),
    ],
)
def test_axes_carry_units(driven, plot, unit):
    ax = plot(driven)
    assert ax.get_xlabel() == "x [mm]"
    assert ax.get_ylabel().startswith(unit)
    assert {"inlet", "outlet"} <= {text.get_text() for text in ax.texts}
    assert ax.get_title(loc="left") == "Configuration II, driven"


def test_strain_in_percent_reaches_outside_the_nip(driven):
    ax = plot_strain(driven)
    assert labels(ax) == ["upper roller", "lower roller", "stick", "slip, upper faster"]
    np.testing.assert_allclose(curve(ax, "upper roller"), 100.0 * driven.profiles.strain_upper)
    first, last = ax.get_xlim()
    assert first < driven.contact[0][0] - 0.5 * driven.nip_width
    assert last > driven.contact[-1][1] + 0.5 * driven.nip_width


def test_a_rigid_roller_is_named_so(skin):
    assert labels(plot_strain(skin)) == ["upper roller", "lower roller (rigid)", "contact"]


def test_speeds_agree_where_the_surfaces_stick(driven):
    """What is drawn: both speeds, and the rims V (1 +- xi/2)."""
    ax = plot_speed(driven)
    x = driven.profiles.x
    stick = next(zone for zone in driven.zones if zone.state == "stick")
    inside = (x > stick.start + 0.2) & (x < stick.stop - 0.2)
    upper, lower = curve(ax, "upper roller"), curve(ax, "lower roller")
    np.testing.assert_allclose(upper[inside], lower[inside], rtol=5e-3)
    rims = [line.get_ydata()[0] for line in ax.lines if len(line.get_ydata()) == 2][:2]
    half = 0.5 * driven.creepage
    assert 100.0 * (1.0 + half) == pytest.approx(rims[0])
    assert 100.0 * (1.0 - half) == pytest.approx(rims[1])


def test_no_speed_no_picture_of_it(skin, solution):
    with pytest.raises(rn.InvalidInputError, match="got a nip without `speed`"):
        plot_speed(skin)
    without = replace(solution.profiles, speed_upper=None, speed_lower=None)
    with pytest.raises(rn.InvalidInputError, match="without friction: its creepage is free"):
        plot_speed(replace(solution, profiles=without))


def test_gap_and_what_it_would_be(driven):
    ax = plot_gap(driven)
    apart = curve(ax, "undeformed rollers (< 0: overlap)")
    assert float(apart.min()) == pytest.approx(-driven.approach, rel=1e-3)
    assert ax.get_ylim()[0] < -driven.approach


@pytest.mark.parametrize("geometry", ["linear", "corrected", "curved", "second", "finite"])
def test_a_rigid_roller_covers_its_undeformed_outline(geometry):
    rubber = rn.Elastic(modulus=2.0, poisson=0.4)
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(rn.Layer(4.0, rubber),)),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.0),
        friction=0.0,
    )
    ax = plot_deformed_surfaces(rn.solve(nip, rn.Model(geometry=geometry)))
    lower = curve(ax, "lower roller (rigid)")
    ink = ax.lines[-1].get_color()
    outlines = [line.get_ydata() for line in ax.lines if line.get_color() == ink]
    assert min(np.max(np.abs(lower - outline)) for outline in outlines) < 1e-12


def test_heights_say_how_much_they_are_stretched(driven):
    ax = plot_deformed_surfaces(driven)
    assert ax.get_ylabel() == f"height [mm], stretched {ax.get_aspect():g} times"
    assert ax.get_aspect() > 1.0
    assert plot_deformed_surfaces(driven, exaggeration=1.0).get_ylabel() == "height [mm], to scale"
    assert plot_deformed_surfaces(driven, exaggeration=20.0).get_aspect() == 20.0


def test_drawing_says_nothing(driven, caplog, capfd):
    plot_deformed_surfaces(driven).figure.draw_without_rendering()
    assert caplog.text == ""
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("wrong", [0.0, -2.0, float("inf"), "3"])
def test_a_wrong_exaggeration(driven, wrong):
    with pytest.raises(rn.InvalidInputError, match="`exaggeration` must be positive and finite"):
        plot_deformed_surfaces(driven, exaggeration=wrong)


def test_a_half_space_has_no_undeformed_height(plane):
    assert labels(plot_deformed_surfaces(plane)) == ["upper roller", "lower roller"]
    assert labels(plot_gap(plane))[0] == "gap"
    assert not any("undeformed" in label for label in labels(plot_gap(plane)))
