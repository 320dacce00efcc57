"""Pictures of studies: what is drawn, in which style, and what cannot be."""

import matplotlib.collections
import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.plots import (
    new_axes,
    plot_curves,
    plot_distribution,
    plot_map,
    plot_pareto,
    plot_shares,
    save_figure,
)
from rollnip.plots.style import DARK, LIGHT

X, Y = np.linspace(1.0, 10.0, 6), np.linspace(1.0, 6.0, 5)
FIELD = np.add.outer(Y, X)  # x + y
NAN = float("nan")


def legend_texts(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_map_has_the_values_where_they_belong():
    ax = plot_map(X, Y, FIELD, names=("load [N/mm]", "thickness [mm]", "width [mm]"), wanted=8.0)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("load [N/mm]", "thickness [mm]")
    assert ax.figure.axes[1].get_ylabel() == "width [mm]"
    assert legend_texts(ax) == ["width [mm] = 8"]
    wanted = ax.collections[-1].get_paths()[0].vertices
    np.testing.assert_allclose(wanted.sum(axis=1), 8.0)


def test_values_of_contours_stand_on_them_and_not_over_the_frame():
    """Steps of a half for x + y from 2 to 16: the contours in two corners are short."""
    ax = plot_map(X, Y, FIELD)
    assert len(ax.texts) >= 6
    for text in ax.texts:
        x, y = text.get_position()
        assert x + y == pytest.approx(float(text.get_text()), abs=0.02)
        for share in ((x - X[0]) / (X[-1] - X[0]), (y - Y[0]) / (Y[-1] - Y[0])):
            assert 0.05 < share < 0.95


def test_a_map_leaves_out_what_is_not_there_and_says_what_is_not_reached():
    field = FIELD.copy()
    field[0, 0] = NAN
    ax = plot_map(X, Y, field, wanted=99.0)
    assert legend_texts(ax) == ["value = 99 (not reached here)"]
    filled = np.concatenate(
        [path.vertices for path in ax.collections[0].get_paths() if len(path.vertices)]
    )
    assert not np.any((filled[:, 0] < 1.5) & (filled[:, 1] < 1.5))


def test_a_map_of_samples():
    generator = np.random.default_rng(0)
    x, y = generator.uniform(size=(2, 40))
    values = x + y
    values[3] = NAN
    ax = plot_map(x, y, values, wanted=1.0)
    vertices = ax.collections[-1].get_paths()[0].vertices
    np.testing.assert_allclose(vertices.sum(axis=1), 1.0, atol=1e-9)
    assert isinstance(ax.collections[0], matplotlib.collections.Collection)


def test_curves_rise_along_x_and_keep_gaps():
    ax = plot_curves(
        [3.0, 1.0, 2.0], {"a": [9.0, 1.0, NAN], "b": [1.0, 2.0, 3.0]}, wanted=2.0, names=("x", "y")
    )
    first = ax.lines[0]
    np.testing.assert_array_equal(first.get_xdata(), [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(first.get_ydata(), [1.0, NAN, 9.0])
    assert legend_texts(ax) == ["a", "b", "wanted 2"]
    looks = {(line.get_color(), line.get_marker()) for line in ax.lines[:2]}
    assert len(looks) == 2


def test_one_curve_needs_no_legend():
    assert plot_curves([1.0, 2.0], {"a": [1.0, 2.0]}).get_legend() is None


def test_shares_with_their_intervals():
    ax = plot_shares(["a", "b"], [[0.3, 0.2, 0.4], [0.6, 0.5, 0.7]], [[0.4, 0.3, 0.5]] * 2)
    widths = [bar.get_width() for bar in ax.patches]
    assert widths == [0.3, 0.6, 0.4, 0.4]
    assert legend_texts(ax)[-1] == "confidence"
    assert [text.get_text() for text in ax.get_yticklabels()] == ["a", "b"]
    low, high = ax.collections[0].get_segments()[0][:, 0]
    assert (low, high) == (0.2, 0.4)
    assert "confidence" not in legend_texts(plot_shares(["a"], [0.3]))


def test_long_paths_leave_room_for_the_bars():
    ax = plot_shares(["upper.layers[0].material.modulus", "nip.load"], [0.3, 0.5])
    assert [text.get_text() for text in ax.get_yticklabels()] == [
        "upper.layers[0].material.\nmodulus",
        "nip.load",
    ]


def test_a_front_is_told_from_the_rest():
    ax = plot_pareto([1.0, 2.0, 3.0, NAN], [3.0, 4.0, 1.0, 0.0], [2, 0], names=("p", "q"))
    assert legend_texts(ax) == ["beaten by another (2)", "Pareto front (2)"]
    np.testing.assert_array_equal(ax.lines[1].get_xdata(), [1.0, 3.0])


def test_a_distribution_counts_every_sample():
    values = np.random.default_rng(1).normal(size=300)
    ax = plot_distribution(values, limits=(-1.0, 1.5), quantiles=[(0.5, np.median(values))])
    assert sum(bar.get_height() for bar in ax.containers[0]) == 300
    (cumulative,) = ax.figure.axes[1].lines
    assert cumulative.get_ydata()[-1] == 100.0
    assert np.all(np.diff(cumulative.get_ydata()) >= 0.0)
    assert "out of specification" in legend_texts(ax)
    low, high = ax.get_xlim()
    assert low < min(-1.0, values.min())
    assert high > max(1.5, values.max())


def test_limits_far_away_stay_in_the_picture():
    ax = plot_distribution([1.0, 1.1, 1.2], limits=(None, 5.0))
    assert ax.get_xlim()[1] > 5.0
    assert plot_distribution([1.0, 1.1, 1.2]).get_xlim()[1] < 1.3


def test_samples_that_are_all_alike_can_be_drawn():
    assert plot_distribution([2.0] * 30).get_xlim()[0] < 2.0


@pytest.mark.parametrize(("style", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_styles(style, palette, tmp_path):
    for index, draw in enumerate(
        (
            lambda ax: plot_map(X, Y, FIELD, ax, wanted=8.0),
            lambda ax: plot_curves(X, {"a": X, "b": 2 * X}, ax),
            lambda ax: plot_shares(["a"], [[0.5, 0.4, 0.6]], ax=ax),
            lambda ax: plot_pareto(X, X, [0], ax),
            lambda ax: plot_distribution(X, ax, limits=(2.0, 9.0)),
        )
    ):
        ax = draw(new_axes(style=style))
        assert ax.xaxis.label.get_color() == palette.ink
        save_figure(ax.figure, tmp_path / f"{index}.png")
    assert draw(None).xaxis.label.get_color() == LIGHT.ink


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda: plot_map(X, Y, FIELD.T), "`values` must have shape"),
        (lambda: plot_map(X, Y, np.full_like(FIELD, NAN)), "`values` must hold at least one"),
        (lambda: plot_map([1.0, NAN], Y, FIELD), "`x` must be a row of finite numbers"),
        (lambda: plot_map(X, X, X), "3 or more places not on a line"),
        (lambda: plot_map(X, X, X[:-1]), "`values` must be as many as x and y"),
        (lambda: plot_curves(X, {}), "`curves` must hold 1 to 12 curves, got 0"),
        (lambda: plot_curves(X, {"a": Y}), "as many values as x, 6; a has shape"),
        (lambda: plot_curves([1.0], {"a": [NAN]}), "`curves of a` must hold"),
        (lambda: plot_shares(["a", "b"], [0.5]), "`first` must hold finite numbers"),
        (lambda: plot_shares(["a"], [[0.5, NAN, 1.0]]), "`first` must hold finite numbers"),
        (lambda: plot_shares([], []), "`first` must hold"),
        (lambda: plot_pareto(X, Y, [0]), "`x` and `y` must be alike"),
        (lambda: plot_pareto([NAN], [1.0], []), "`x and y` must hold"),
        (lambda: plot_pareto(X, X, [6]), "`front` must hold numbers of cases from 0 to 5"),
        (lambda: plot_distribution([1.0]), "at least 2 samples, got 1"),
        (lambda: plot_distribution([]), "`values` must be a row of finite numbers"),
        (lambda: plot_distribution([1.0, NAN]), "`values` must be a row of finite numbers"),
        (lambda: plot_distribution([1.0, 2.0], style="pink"), "`style` must be one of"),
    ],
)
def test_what_cannot_be_drawn(draw, message):
    with pytest.raises(InvalidInputError, match=message):
        draw()
