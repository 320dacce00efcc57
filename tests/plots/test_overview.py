import io
import time
from dataclasses import replace

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from rich.console import Console

import rollnip as rn
from rollnip.cli.summary import print_summary
from rollnip.plots import plot_overview, save_figure
from rollnip.reservation import Reservation


def words(figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def test_pictures_and_key_figures(driven):
    text = words(plot_overview(driven))
    for wanted in (
        "Configuration II, driven",
        "Pressure and shear",
        "Normal stress inside",
        "Deformed surfaces",
        "Strain of the surfaces",
        "nip width",
        "7.320",
        "creepage",
        f"{driven.torque_lower:.2f}".replace("-", "−"),
        "N mm/mm",
        "2.7 mm, 2.04 MPa",
        "verified; geometry curved",
    ):
        assert wanted in text


def test_the_bond_is_that_of_the_summary(driven):
    """One figure has one name and one value, in the picture and in the summary."""
    stream = io.StringIO()
    print_summary(driven, Console(file=stream, width=100, highlight=False))
    lines = stream.getvalue().splitlines()
    texts = [text.get_text() for text in plot_overview(driven).findobj(Text)]
    bonds = [one for one in driven.interfaces if one.is_bond]
    assert len(bonds) == 2
    for bond in bonds:
        shown = texts[texts.index(f"largest pull, {bond.roller}") + 1]
        (line,) = [line for line in lines if line.strip().startswith(f"{bond.roller} bond")]
        assert f"largest pull {shown} MPa" in line
        assert bond.pull == max(0.0, bond.peel.max())


def test_a_sheet_has_its_feed_tension_and_grip_among_the_figures():
    rubber = rn.Roller(radius=50.0, layers=[rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5))])
    paper = rn.Sheet(thickness=0.1, modulus=3500.0, tension_in=0.2, bending=False)
    nip = rn.Nip(upper=rubber, lower=rubber, normal=rn.LineLoad(1.78), friction=0.5, sheet=paper)
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    texts = [text.get_text() for text in plot_overview(solution).findobj(Text)]
    sheet = solution.sheet
    shown = {
        "feed over upper roller": 100.0 * sheet.feed_upper,
        "feed over lower roller": 100.0 * sheet.feed_lower,
        "largest tension": sheet.tension_max,
        "smallest tension": sheet.tension_min,
        "grip reserve": sheet.grip_reserve,
    }
    for name, value in shown.items():
        number = float(texts[texts.index(name) + 1].replace("−", "-"))
        assert number == pytest.approx(value, rel=1e-3, abs=1e-8), name
    assert "slides first where pulled: upper side" in texts


def test_the_legend_of_a_sheet_that_resists_bending_leaves_the_picture_below_free():
    """Six entries with the longest names, as in the web pull of the examples."""
    rubber = rn.Roller(radius=75.0, layers=[rn.Layer(10.0, rn.Elastic(modulus=5.5, poisson=0.5))])
    paper = replace(rn.Sheet.usual("newsprint"), tension_in=0.5, tension_out=0.25, bending=True)
    nip = rn.Nip(upper=rubber, lower=rubber, normal=rn.LineLoad(4.0), friction=0.35, sheet=paper)
    figure = plot_overview(rn.solve(nip, rn.Model(geometry="linear")))
    figure.canvas.draw()
    legend = figure.axes[0].get_legend()
    assert len(legend.get_texts()) == 6
    (below,) = [one for one in figure.findobj(Text) if one.get_text() == "Deformed surfaces"]
    assert legend.get_window_extent().y0 > below.get_window_extent().y1


def test_what_is_not_defined_is_a_dash(skin):
    assert "–" in words(plot_overview(skin))


def test_a_solution_that_did_not_converge_says_so(driven):
    reservations = (Reservation("long", "One." * 200),)
    failed = replace(driven, converged=False, status="The mesh ran out.", reservations=reservations)
    text = words(plot_overview(failed))
    assert "NOT CONVERGED" in text
    assert "The mesh ran out." in text


def test_nothing_is_rigid(plane, tmp_path):
    save_figure(plot_overview(plane, style="dark"), tmp_path / "a.png")


def test_a_wrong_style(driven):
    with pytest.raises(rn.InvalidInputError, match="`style` must be one of light, dark"):
        plot_overview(driven, style="sepia")


def test_many_layers_still_fit():
    rubber = rn.Elastic(modulus=2.0, poisson=0.5)
    plies = rn.Roller(radius=50.0, layers=tuple(rn.Layer(0.5, rubber) for _ in range(8)))
    nip = rn.Nip(upper=plies, lower=plies, normal=rn.LineLoad(2.0), friction=0.5)
    figure = plot_overview(rn.solve(nip))
    assert "and 4 more" in words(figure)


@pytest.mark.slow
def test_it_takes_little_more_than_its_pictures(viscoelastic, tmp_path):
    """Compared in processor time with an empty page of four pictures that is written as well."""

    def empty():
        figure = Figure(figsize=(11.7, 7.3), layout="constrained")
        figure.subplots(2, 2)
        save_figure(figure, tmp_path / "b.png")

    def page():
        save_figure(plot_overview(viscoelastic), tmp_path / "a.png")

    def cpu_seconds(work):
        start = time.process_time()
        work()
        return time.process_time() - start

    pairs = [(cpu_seconds(page), cpu_seconds(empty)) for _ in range(3)]
    assert min(one for one, _ in pairs) < 5.0 * min(other for _, other in pairs)


def test_long_numbers_leave_the_names_of_the_axes_on_the_page():
    steel = rn.Roller(radius=5.0, core=rn.Elastic(modulus=210000.0, poisson=0.3))
    nip = rn.Nip(
        upper=steel,
        lower=steel,
        normal=rn.LineLoad(500.0),
        tangential=rn.Traction(30.0),
        friction=0.1,
    )
    figure = plot_overview(rn.solve(nip))
    figure.draw_without_rendering()
    millimetre = figure.dpi / 25.4
    for ax in figure.axes:
        if ax.get_ylabel():
            assert ax.yaxis.label.get_window_extent().x0 > millimetre
