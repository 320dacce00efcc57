"""Pictures are what they were: compared without texts and blurred, so that fonts do not count.

After a change that is meant: look at the new pictures, then `python tests/plots/test_images.py`.
"""

import io
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text
from PIL import Image

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

BASELINE = Path(__file__).parent / "baseline"
DPI, BLOCK = 72, 3
TOLERANCE = 4.0  # of 255, root mean square: other lines or colours make more, smoothing less

PICTURES = {
    "pressure": ("driven", lambda s, style: plot_pressure(s, new_axes(style=style))),
    "pressure of a skin": ("skin", lambda s, style: plot_pressure(s, new_axes(style=style))),
    "strain": ("driven", lambda s, style: plot_strain(s, new_axes(style=style))),
    "speed": ("viscoelastic", lambda s, style: plot_speed(s, new_axes(style=style))),
    "gap": ("driven", lambda s, style: plot_gap(s, new_axes(style=style))),
    "surfaces": ("skin", lambda s, style: plot_deformed_surfaces(s, new_axes(style=style))),
    "field": ("driven", lambda s, style: plot_field(s, ax=new_axes(style=style))),
    "field to scale": (
        "viscoelastic",
        lambda s, style: plot_field(s, "von_mises", ax=new_axes(style=style), scale="equal"),
    ),
    "overview": ("driven", lambda s, style: plot_overview(s, style=style)),
}
PARAMETERS = [(name, style) for name in PICTURES for style in ("light", "dark")]


def seen(drawn):
    """The picture without texts and legends, averaged over blocks of pixels."""
    figure = drawn if hasattr(drawn, "axes") and hasattr(drawn, "savefig") else drawn.figure
    for ax in [child for parent in figure.axes for child in (parent, *parent.child_axes)]:
        ax.tick_params(labelleft=False, labelbottom=False)
        if ax.get_legend() is not None:
            ax.get_legend().set_visible(False)
    for text in figure.findobj(Text):
        text.set_visible(False)
    for _ in range(4):  # until the layout has forgotten the texts
        figure.draw_without_rendering()
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=DPI, facecolor=figure.get_facecolor())
    return blurred(np.asarray(Image.open(buffer).convert("RGB"), dtype=float))


def blurred(pixels):
    rows, columns = (size - size % BLOCK for size in pixels.shape[:2])
    blocks = pixels[:rows, :columns].reshape(rows // BLOCK, BLOCK, columns // BLOCK, BLOCK, 3)
    return blocks.mean(axis=(1, 3))


def path_of(name, style):
    return BASELINE / f"{name.replace(' ', '-')}-{style}.png"


def baseline(name, style):
    return np.asarray(Image.open(path_of(name, style)).convert("RGB"), dtype=float)


def difference(one, other):
    return float(np.sqrt(np.mean((one - other) ** 2)))


@pytest.mark.parametrize(("name", "style"), PARAMETERS)
def test_looks_as_it_did(name, style, solution_of):
    case, draw = PICTURES[name]
    picture, before = seen(draw(solution_of(case), style)), baseline(name, style)
    assert picture.shape == before.shape
    assert difference(picture, before) < TOLERANCE


def test_what_is_missing_is_seen(driven):
    """The tolerance is small enough: a curve left out, a wrong colour, another field."""
    ax = plot_pressure(driven, new_axes())
    shear = next(line for line in ax.lines if line.get_label().startswith("shear"))
    shear.set_color("black")
    assert difference(seen(ax), baseline("pressure", "light")) > 1.5 * TOLERANCE
    shear.remove()
    assert difference(seen(ax), baseline("pressure", "light")) > 1.5 * TOLERANCE
    other = seen(plot_field(driven, "s_xz", ax=new_axes()))
    assert difference(other, baseline("field", "light")) > 3.0 * TOLERANCE


def write_baselines(solution_of):
    """Draw all pictures anew."""
    BASELINE.mkdir(exist_ok=True)
    for name, style in PARAMETERS:
        case, draw = PICTURES[name]
        pixels = np.round(seen(draw(solution_of(case), style))).astype(np.uint8)
        Image.fromarray(pixels).save(path_of(name, style), optimize=True)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    from conftest import solved

    write_baselines(solved)
