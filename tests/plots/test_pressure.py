from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import rollnip as rn
from rollnip.plots import plot_pressure


def labels(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_draws_what_it_says(solution):
    ax = plot_pressure(solution)
    assert labels(ax) == [
        "pressure p",
        "shear q on the upper roller",
        "traction bound ±µp, µ = 2.8",
        "stick",
        "slip, upper faster",
    ]
    assert ax.get_xlabel() == "x [mm]"
    assert ax.get_ylabel() == "stress [MPa]"
    first, last = ax.get_xlim()
    assert first < -3.5
    assert last > 3.72
    assert ax.get_title(loc="left") == "Made by hand"
    assert {"inlet", "outlet"} <= {text.get_text() for text in ax.texts}


def test_the_curves_are_the_profiles(driven):
    curves = {line.get_label(): line for line in plot_pressure(driven).lines}
    np.testing.assert_array_equal(curves["pressure p"].get_ydata(), driven.profiles.pressure)
    shear = curves["shear q on the upper roller"]
    np.testing.assert_array_equal(shear.get_xydata().T, [driven.profiles.x, driven.profiles.shear])


def test_uses_the_axes_it_is_given(solution):
    ax = Figure().subplots()
    assert plot_pressure(solution, ax) is ax


def test_without_friction_there_is_only_pressure(solution):
    nip = replace(solution.nip, friction=0.0, tangential=rn.Traction(0.0))
    ax = plot_pressure(replace(solution, nip=nip, zones=()))
    assert labels(ax) == ["pressure p", "contact"]


def test_slip_says_which_surface_is_faster(solution):
    zones = (solution.zones[1], replace(solution.zones[0], direction=1))
    assert labels(plot_pressure(replace(solution, zones=zones)))[-1] == "slip, lower faster"


def test_a_solution_that_did_not_converge_says_so(solution):
    ax = plot_pressure(replace(solution, converged=False))
    assert ax.get_title(loc="left").startswith("NOT CONVERGED")


def test_a_title_is_text_and_no_formula(solution):
    strange = replace(solution, nip=replace(solution.nip, title="50 $ per nip, $x_"))
    ax = plot_pressure(strange)
    ax.figure.draw_without_rendering()
    assert ax.get_title(loc="left") == "50 $ per nip, $x_"


def test_a_long_title_is_cut_to_the_width_of_the_picture(solution):
    long = replace(solution, nip=replace(solution.nip, title="A nip of the third press " * 40))
    title = plot_pressure(long).get_title(loc="left")
    assert title.count("\n") == 1
    assert title.endswith("...")
