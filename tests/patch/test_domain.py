"""The room around a patch does not matter, and memory grows as the number of rectangles."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import pytest

import rollnip as rn
from rollnip.patch import Grid
from rollnip.patch.level import solve_level
from rollnip.patch.measures import figures_of
from rollnip.patch.tables import PairTables

RUBBER = rn.Elastic(modulus=5.0, poisson=0.49)
LOSSY = rn.StandardLinearSolid(modulus=4.0, stiffening=6.0, relaxation_time=0.01, poisson=0.49)
STEEL = rn.Elastic(modulus=206e3, poisson=0.3)


def wheel(**kwargs: object) -> rn.Patch:
    given: dict[str, object] = {
        "upper": rn.Roller(radius=50.0, layers=[rn.Layer(8.0, RUBBER)]),
        "lower": rn.Roller(radius=float("inf")),
        "across_upper": rn.Across(radius=60.0),
        "normal": rn.Force(100.0),
        "friction": 0.5,
        "along": rn.Creepage(0.01),
        "speed": 300.0,
    }
    return rn.Patch(**(given | kwargs))


@pytest.mark.parametrize(
    ("upper", "room"),
    [
        (rn.Roller(radius=50.0, layers=[rn.Layer(8.0, RUBBER)]), 2e-4),
        pytest.param(
            rn.Roller(radius=50.0, layers=[rn.Layer(8.0, LOSSY)]), 5e-4, marks=pytest.mark.slow
        ),
        pytest.param(rn.Roller(radius=50.0, core=STEEL), 2e-4, marks=pytest.mark.slow),
    ],
    ids=["layer", "viscoelastic", "half-space"],
)
def test_more_room_around_the_patch_changes_nothing(upper, room):
    """The same rectangles with three times the room: no image of the patch acts on it.

    What is left are the iterations, 1e-6, and delays that are fitted anew for a longer grid.
    """
    patch = wheel(upper=upper)
    tables = PairTables.of(patch)
    grid = rn.solve_patch(patch, grid=(10, 10)).grid
    wide = replace(grid, x0=grid.x0 - 10 * grid.hx, y0=grid.y0 - 10 * grid.hy, nx=30, ny=30)
    one, other = (figures_of(solve_level(patch, g, 1e-6, None, tables)) for g in (grid, wide))
    assert isinstance(wide, Grid)
    for name in ("approach", "peak_pressure", "area", "traction_x", "load_centre"):
        assert other[name] == pytest.approx(one[name], rel=room, abs=1e-9), name


@pytest.mark.slow
def test_memory_grows_as_the_number_of_rectangles():
    used = []
    for n in (64, 128):
        tracemalloc.start()
        rn.solve_patch(wheel(), grid=(n, n))
        used.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    # Four times the rectangles; all pairs of them would be sixteen times as much.
    assert used[1] < 5.0 * used[0]
    assert used[1] < 4000 * 128 * 128
