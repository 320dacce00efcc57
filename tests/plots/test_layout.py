"""No text touches another or leaves the picture, narrow or wide."""

import pytest
from matplotlib import rc_context
from matplotlib.text import Text

from rollnip.plots import (
    new_axes,
    plot_deformed_surfaces,
    plot_field,
    plot_gap,
    plot_overview,
    plot_pressure,
    plot_speed,
    plot_strain,
)

PICTURES = {
    "pressure": plot_pressure,
    "strain": plot_strain,
    "speed": plot_speed,
    "gap": plot_gap,
    "surfaces": plot_deformed_surfaces,
    "s_zz": lambda solution, ax: plot_field(solution, ax=ax),
    "s_xx of one": lambda solution, ax: plot_field(solution, "s_xx", "upper", ax),
    "von Mises to scale": lambda solution, ax: plot_field(
        solution, "von_mises", ax=ax, scale="equal"
    ),
}
CASES = ("driven", "skin", "viscoelastic", "plane")
CLOSE = 0.5  # px that boxes may overlap: they hold the line's full height


def boxes(figure, monkeypatch):
    """Text -> bounding box of every text that is drawn."""
    drawn = {}
    draw = Text.draw

    def record(self, renderer):
        if self.get_visible() and self.get_text().strip():
            drawn[self] = None
        draw(self, renderer)

    with monkeypatch.context() as patch:
        patch.setattr(Text, "draw", record)
        figure.draw_without_rendering()
    renderer = figure._get_renderer()
    return [(text.get_text(), Text.get_window_extent(text, renderer)) for text in drawn]


def check(figure, monkeypatch):
    found = boxes(figure, monkeypatch)
    assert len(found) > 5
    width, height = figure.bbox.size
    for text, box in found:
        inside = box.x0 >= -CLOSE and box.y0 >= -CLOSE
        inside &= box.x1 <= width + CLOSE and box.y1 <= height + CLOSE
        assert inside, f"{text!r} leaves the picture: {box}"
    for i, (one, a) in enumerate(found):
        for other, b in found[:i]:
            apart = min(a.x1, b.x1) - max(a.x0, b.x0) < CLOSE
            apart |= min(a.y1, b.y1) - max(a.y0, b.y0) < CLOSE
            assert apart, f"{one!r} touches {other!r}: {a}, {b}"


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("picture", PICTURES)
def test_in_a_column(picture, case, solution_of, monkeypatch):
    solution = solution_of(case)
    if picture == "speed" and solution.nip.speed is None:
        pytest.skip("no speed")
    ax = new_axes(85.0)
    PICTURES[picture](solution, ax=ax)
    check(ax.figure, monkeypatch)


@pytest.mark.parametrize("picture", PICTURES)
def test_wide(picture, driven, monkeypatch):
    ax = new_axes()
    PICTURES[picture](driven, ax=ax)
    check(ax.figure, monkeypatch)


@pytest.mark.parametrize("case", CASES)
def test_overview(case, solution_of, monkeypatch):
    check(plot_overview(solution_of(case)), monkeypatch)


def test_the_page_does_not_follow_the_users_size_of_type(driven, monkeypatch):
    with rc_context({"font.size": 16.0}):
        check(plot_overview(driven), monkeypatch)


def test_large_type_in_a_picture_of_ones_own(driven, monkeypatch):
    with rc_context({"font.size": 15.0}):
        check(plot_field(driven).figure, monkeypatch)
        check(plot_pressure(driven).figure, monkeypatch)
