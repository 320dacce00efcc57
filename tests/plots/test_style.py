"""Colours that anyone tells apart, sizes, and no global state."""

import numpy as np
import pytest
from matplotlib import rcParams
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import rollnip as rn
from rollnip.plots import new_axes, plot_field, plot_overview, plot_pressure
from rollnip.plots.style import DARK, LIGHT

# Machado, Oliveira & Fernandes (2009): vision without one kind of cone, on linear RGB
SIGHTS = {
    "all cones": np.eye(3),
    "protanope": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranope": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanope": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
PALETTES = pytest.mark.parametrize("palette", [LIGHT, DARK], ids=["light", "dark"])
VISION = pytest.mark.parametrize("sight", SIGHTS)


def linear(colours):
    rgb = np.atleast_2d([to_rgb(colour) for colour in colours])
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(colours, sight):
    seen = np.clip(linear(colours) @ np.array(SIGHTS[sight]).T, 0.0, 1.0)
    xyz = seen @ TO_XYZ.T / (TO_XYZ @ np.ones(3))
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0)
    return np.stack(
        [116.0 * f[:, 1] - 16.0, 500.0 * (f[:, 0] - f[:, 1]), 200.0 * (f[:, 1] - f[:, 2])], axis=-1
    )


@PALETTES
@VISION
@pytest.mark.parametrize(
    ("one", "other", "apart"),
    [
        ("pressure", "shear", 25.0),
        ("upper", "lower", 12.0),  # told apart by their dashes too
        ("stick", "slip", 6.0),  # and by hatching
    ],
)
def test_pairs_are_told_apart(palette, sight, one, other, apart):
    pair = lab([getattr(palette, one), getattr(palette, other)], sight)
    assert np.linalg.norm(pair[0] - pair[1]) > apart


@PALETTES
@VISION
def test_a_sign_is_told_from_the_other_and_from_nought(palette, sight):
    ends = lab([palette.diverging(part) for part in (0.1, 0.5, 0.9)], sight)
    assert np.linalg.norm(ends[0] - ends[2]) > 40.0
    assert min(np.linalg.norm(ends[1] - ends[i]) for i in (0, 2)) > 30.0


@PALETTES
@VISION
def test_more_is_always_darker_or_always_lighter(palette, sight):
    lightness = lab([palette.sequential(part) for part in np.linspace(0, 1, 21)], sight)[:, 0]
    steps = np.diff(lightness)
    assert np.all(steps < 0.0) or np.all(steps > 0.0)


@PALETTES
@pytest.mark.parametrize("name", ["ink", "muted", "pressure", "shear", "upper", "lower", "alert"])
def test_contrast_with_the_ground(palette, name):
    """The ratio that WCAG 2 asks for text, 4.5."""
    light, dark = sorted(linear([getattr(palette, name), palette.ground]) @ TO_XYZ[1])[::-1]
    assert (light + 0.05) / (dark + 0.05) > (4.5 if name != "shear" else 4.0)


def test_width_and_height_of_new_axes():
    assert new_axes(85.0, 50.0).figure.get_size_inches() == pytest.approx([85 / 25.4, 50 / 25.4])
    assert new_axes().figure.get_figwidth() == pytest.approx(180 / 25.4)


@pytest.mark.parametrize("arguments", [{"width": -1.0}, {"height": float("nan")}, {"width": "85"}])
def test_a_wrong_size(arguments):
    with pytest.raises(rn.InvalidInputError, match="must be positive and finite"):
        new_axes(**arguments)


def test_a_wrong_style_is_told_the_nearest(solution):
    for draw in (lambda: plot_pressure(solution, style="drak"), lambda: new_axes(style="drak")):
        with pytest.raises(rn.InvalidInputError, match=r'got "drak"\. Did you mean "dark"'):
            draw()


def test_ink_follows_the_ground_of_given_axes(solution):
    for ground, palette in (("white", LIGHT), ("none", LIGHT), ("#101010", DARK)):
        ax = Figure(facecolor=ground).subplots()
        plot_pressure(solution, ax)
        assert ax.xaxis.label.get_color() == palette.ink


def test_a_style_that_is_asked_for_paints_given_axes(solution):
    ax = Figure().subplots()
    plot_pressure(solution, ax, style="dark")
    assert to_rgb(ax.get_facecolor()) == to_rgb(ax.figure.get_facecolor()) == to_rgb(DARK.ground)


def test_type_is_smaller_in_a_column(solution):
    sizes = [plot_pressure(solution, new_axes(width)).xaxis.label.get_size() for width in (85, 180)]
    assert 6.5 <= sizes[0] < 0.8 * sizes[1] <= 10.0


def test_no_global_setting_changes(driven):
    before = dict(rcParams)
    plot_field(driven, style="dark")
    plot_overview(driven, style="dark")
    assert dict(rcParams) == before


def test_a_legend_lies_inside_where_no_layout_gives_it_room(solution):
    inside = plot_pressure(solution, Figure().subplots())
    inside.figure.draw_without_rendering()
    box, frame = inside.get_legend().get_window_extent(), inside.get_window_extent()
    assert frame.y0 < box.y0 < box.y1 < frame.y1
    below = plot_pressure(solution, Figure(layout="constrained").subplots())
    below.figure.draw_without_rendering()
    assert below.get_legend().get_window_extent().y1 < below.get_window_extent().y0
