"""How the feed depends on each quantity: laws of dimensions, and what the command prints."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip._results.case import case_tree
from rollnip.cli.app import app
from rollnip.io import value_at

EXAMPLES = Path(__file__).parents[1] / "examples"
PAPER = rn.Sheet(thickness=0.1, modulus=500.0, poisson=0.3, tension_in=0.05, tension_out=0.02)
UPPER = rn.Roller(radius=50, layers=[rn.Layer(2.0, rn.Elastic(modulus=0.91, poisson=0.5))])
LOWER = rn.Roller(radius=25, layers=[rn.Layer(2.7, rn.Elastic(modulus=2.04, poisson=0.5))])
NIP = rn.Nip(upper=UPPER, lower=LOWER, normal=rn.LineLoad(1.0), friction=0.4, sheet=PAPER)
LINEAR = rn.Model(geometry="linear", tolerance=1e-4)
NIP_CASE = case_tree(NIP, LINEAR)
FORCES = ("nip.load", "sheet.tension_in", "sheet.tension_out")


@pytest.fixture(scope="module")
def changes():
    told = []
    found = rn.feed_sensitivity(
        NIP, LINEAR, share=0.02, progress=lambda *counts: told.append(counts)
    )
    assert told == [(number, len(found)) for number in range(1, len(found) + 1)]
    assert all(one.converged for one in found)
    return {one.path: one for one in found}


def test_all_that_the_feed_depends_on_is_there(changes):
    assert set(changes) == {
        *FORCES,
        *("sheet.thickness", "sheet.modulus"),
        *(f"{side}.radius" for side in ("upper", "lower")),
        *(f"{side}.layers[0].thickness" for side in ("upper", "lower")),
        *(f"{side}.layers[0].material.modulus" for side in ("upper", "lower")),
    }


@pytest.mark.parametrize("side", ["upper", "lower"])
@pytest.mark.parametrize("what", ["modulus", "length"])
def test_the_feed_is_a_matter_of_ratios(changes, side, what):
    """All moduli and line loads together change nothing; nor all lengths and line loads."""
    lengths = [path for path in changes if path.endswith(("thickness", "radius"))]
    moduli = [path for path in changes if path.endswith("modulus")]
    paths = [*FORCES, *(moduli if what == "modulus" else lengths)]
    total = sum(getattr(changes[path], side) for path in paths)
    largest = max(abs(getattr(changes[path], side)) for path in paths)
    assert abs(total) <= sum(changes[path].error for path in paths)
    assert abs(total) < 0.02 * largest


def test_a_larger_load_feeds_what_two_solutions_say(changes):
    feeds = []
    for load in (0.99, 1.01):
        nip = rn.Nip(upper=UPPER, lower=LOWER, normal=rn.LineLoad(load), friction=0.4, sheet=PAPER)
        feeds.append(rn.solve(nip, LINEAR).sheet.feed_upper)
    found = changes["nip.load"]
    assert found.upper == pytest.approx((feeds[1] - feeds[0]) / 0.02, abs=0.2 * found.error)


def test_a_larger_roller_feeds_more_in_a_turn(changes):
    found = changes["upper.radius"]
    assert found.per_turn == pytest.approx(1.0 + found.upper, rel=2e-3)


def test_gears_stay_where_a_diameter_changes():
    """Equal rollers, geared one to one: the sheet runs at the mean speed of both surfaces.

    With one roller 1 % larger it is fed half of that farther in a turn, whichever roller it is.
    With the creepage kept instead, as by other gears, it would be all and nothing.
    """
    nip = rn.Nip(
        upper=LOWER,
        lower=LOWER,
        normal=rn.LineLoad(1.0),
        tangential=rn.Creepage(0.0),
        friction=1.2,
        sheet=rn.Sheet(thickness=0.1, modulus=500.0, poisson=0.3),
    )
    found = {one.path: one for one in rn.feed_sensitivity(nip, LINEAR)}
    upper, lower = found["upper.radius"], found["lower.radius"]
    assert upper.converged
    assert lower.converged
    assert upper.per_turn == pytest.approx(0.5, abs=0.01)  # up to its change at the same creepage
    assert lower.per_turn == pytest.approx(upper.per_turn, rel=1e-3)
    assert upper.upper == pytest.approx(lower.lower, rel=1e-3)  # by symmetry


def test_the_creepage_of_geared_rollers_follows_their_diameters():
    """V_u/V_l of 1.1 at a creepage of 2/21; a lower roller 1.1 times as large makes it 1."""
    from rollnip.feed import _turned_by_the_same_gears as turned

    nip = rn.Nip(
        upper=UPPER,
        lower=LOWER,
        normal=rn.LineLoad(1.0),
        friction=0.4,
        tangential=rn.Creepage(2.0 / 21.0),
    )
    assert turned(nip, "lower", 1.1).tangential.creepage == pytest.approx(0.0, abs=1e-12)
    assert turned(nip, "upper", 1.0 / 1.1).tangential.creepage == pytest.approx(0.0, abs=1e-12)
    free = rn.Nip(upper=UPPER, lower=LOWER, normal=rn.LineLoad(1.0), friction=0.4)
    assert turned(free, "upper", 1.1) == free


def test_the_command_says_that_gears_stay(tmp_path):
    file = tmp_path / "case.toml"
    text = (EXAMPLES / "sheet-web-pull.toml").read_text("utf-8")
    file.write_text(text.replace("[sheet]", "[sheet]\nbending = false"), "utf-8")
    found = CliRunner().invoke(app, ["feed", str(file), "--geometry", "linear"])
    assert found.exit_code == 0
    assert "a diameter changes at the same gears, and the creepage with it." in found.stdout


def test_each_path_is_a_key_of_the_case(changes):
    """With the value that stands there, and a name in plain words."""
    for path, one in changes.items():
        assert value_at(NIP_CASE, path) == pytest.approx(one.value), path
    assert changes["sheet.tension_in"].quantity == "tension at the inlet"


def test_a_nip_without_a_sheet_is_refused():
    with pytest.raises(rn.InvalidInputError, match=r"^`nip` must be a Nip, got None\."):
        rn.feed_sensitivity(None)
    nip = rn.Nip(upper=UPPER, lower=LOWER, normal=rn.LineLoad(1.0), friction=0.4)
    with pytest.raises(rn.InvalidInputError, match=r"^`sheet` must be given"):
        rn.feed_sensitivity(nip)
    with pytest.raises(rn.InvalidInputError, match=r"^`share` must be at most 0\.2, got 0\.5"):
        rn.feed_sensitivity(NIP, share=0.5)


@pytest.fixture
def feed_nip(tmp_path):
    """The example without the stiffness of its paper, which takes twenty times as long."""
    text = (EXAMPLES / "sheet-feed-nip.toml").read_text("utf-8")
    file = tmp_path / "case.toml"
    file.write_text(text.replace("[sheet]", "[sheet]\nbending = false"), "utf-8")
    return file


def test_the_command(feed_nip):
    given = ["feed", str(feed_nip), "--geometry", "linear"]
    text = CliRunner().invoke(app, given)
    assert text.exit_code == 0
    assert "modulus of the upper covering" in text.stdout
    rows = json.loads(CliRunner().invoke(app, [*given, "--json"]).stdout)
    assert abs(rows[0]["upper"]) == max(abs(row["upper"]) for row in rows)
    other = str(EXAMPLES / "press-driven.toml")
    refused = CliRunner().invoke(app, ["feed", other])
    assert refused.exit_code == 2
    assert "add a table [sheet]" in refused.output


def test_the_command_says_that_a_strain_energy_is_left_out(feed_nip):
    text = feed_nip.read_text("utf-8")
    energy = 'poisson = 0.5, energy = { model = "gent", limit = 9 } }'
    feed_nip.write_text(text.replace("poisson = 0.5 }", energy), "utf-8")
    found = CliRunner().invoke(app, ["feed", str(feed_nip), "--geometry", "linear"])
    assert found.exit_code == 0
    assert "the upper roller has a strain energy (Gent)" in found.stderr


@pytest.mark.slow
def test_the_feed_of_a_sheet_that_bends():
    """The example as it is: every changed nip is verified with the stiffness counted."""
    given = ["feed", str(EXAMPLES / "sheet-feed-nip.toml"), "--geometry", "linear", "--json"]
    found = CliRunner().invoke(app, given)
    assert found.exit_code == 0
    assert all(row["converged"] for row in json.loads(found.stdout))


def test_bending_is_counted_in_all_changed_nips_or_in_none(monkeypatch):
    # Left to each nip, it would be counted in some of them only: a jump, not a derivative.
    import rollnip.feed

    asked = []

    def solved(nip, model, *, cache):
        asked.append(nip.sheet.bending)
        return rn.solve(nip, model, cache=cache)

    monkeypatch.setattr(rollnip.feed, "solve", solved)
    sheet = rn.Sheet(thickness=0.1, modulus=3500.0)
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    upper = rn.Roller(radius=50, layers=[rn.Layer(2.0, rubber)])
    lower = rn.Roller(radius=25, layers=[rn.Layer(2.7, rubber)])
    nip = rn.Nip(upper=upper, lower=lower, normal=rn.LineLoad(1.78), friction=0.5, sheet=sheet)
    rn.feed_sensitivity(nip, rn.Model(geometry="linear"))
    assert asked[0] is None
    assert len(set(asked[1:])) == 1
    assert asked[1] is not None
