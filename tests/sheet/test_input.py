"""Wrong sheets are refused in one sentence; doubtful ones are solved with a warning."""

import re
from dataclasses import replace

import pytest
from sheet_nips import RIGID, SOFT, nip_with, paper

import rollnip as rn
from rollnip.nip import asked_of_friction, lever_ratio
from rollnip.sheet.checks import none_found
from rollnip.solver import geometry_for


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("thickness", 0.0),
        ("modulus", -1.0),
        ("poisson", 0.6),
        ("modulus_thickness", 0.0),
        ("tension_in", -0.1),
        ("tension_out", -0.1),
        ("friction_upper", 0.0),
        ("friction_lower", -0.3),
        ("friction_upper", 1e308),
        ("modulus", 1e308),
        ("modulus_thickness", 1e308),
    ],
)
def test_values_outside_their_range_are_refused(name, value):
    with pytest.raises(rn.InvalidInputError, match=rf"^`{name}` must .*got -?\d.*\.$"):
        replace(paper(), **{name: value})


@pytest.mark.parametrize(
    ("sheet", "more", "said"),
    [
        (paper(tension_in=2.0), {}, "slips through; lower the difference, or raise"),
        (
            paper(tension_in=1.0),
            {},
            "slides on the upper roller.*; lower the pull or the traction, or raise the load",
        ),
        (paper(), {"tangential": rn.Traction(0.9)}, "slides on the lower roller.*; lower it, or"),
        (paper(), {"friction": 0.0}, "`friction_upper` of the sheet must be given"),
        (
            replace(paper(), thickness=5.0),
            {},
            "smaller than the coverings are thick.*; take a thinner one",
        ),
        ("paper", {}, "`sheet` must be Sheet or None"),
        (paper(), {"upper": RIGID, "lower": RIGID}, "give one of them a `core`"),
    ],
)
def test_nips_that_cannot_hold_their_sheet_are_refused(sheet, more, said):
    with pytest.raises(rn.InvalidInputError, match=said) as caught:
        nip_with(sheet, **more)
    assert "\n" not in str(caught.value)


def test_friction_of_the_sheet_may_stand_in_for_that_of_the_nip():
    sheet = paper(friction_upper=0.4, friction_lower=0.4)
    solution = rn.solve(nip_with(sheet, friction=0.0), rn.Model(geometry="linear"))
    assert solution.converged


def test_a_friction_of_the_nip_that_no_side_has_changes_nothing():
    soft = replace(paper(friction_upper=0.4, friction_lower=0.3), modulus=5.0)
    one, two = (
        rn.solve(nip_with(soft, friction=mu), rn.Model(geometry="linear")) for mu in (0.0, 0.9)
    )
    assert one.sheet.feed_upper == two.sheet.feed_upper
    # errors are claimed over what friction carries on either side
    assert one.sheet.error == pytest.approx(two.sheet.error, nan_ok=True)


def test_a_torque_that_friction_cannot_hold_is_refused():
    nip = nip_with(paper(), friction=0.1, tangential=rn.Torque(-50.0))
    with pytest.raises(rn.InvalidInputError, match=r"^`torque_lower` asks the sheet"):
        rn.solve(nip, rn.Model(geometry="linear"))


def test_a_torque_and_tensions_that_the_upper_friction_cannot_hold_are_refused():
    # 44 N over 25 mm and a pull of 0.5 N/mm: 2.26 N/mm, where friction carries 1.78
    sheet = paper(tension_in=0.5, friction_upper=1.0, friction_lower=2.0)
    nip = nip_with(sheet, tangential=rn.Torque(-44.0))
    with pytest.raises(rn.InvalidInputError, match="tensions ask the upper roller for 2"):
        rn.solve(nip, rn.Model(geometry="linear"))
    # a little beyond what it carries
    nip = nip_with(sheet, tangential=rn.Torque(-33.0))
    with pytest.raises(rn.InvalidInputError, match="tensions ask the upper roller for 1"):
        rn.solve(nip, rn.Model(geometry="linear"))


def test_the_corrected_geometry_is_refused():
    with pytest.raises(rn.InvalidInputError, match="with a sheet"):
        rn.solve(nip_with(paper()), rn.Model(geometry="corrected"))


def test_a_sheet_that_is_pushed_is_warned_of():
    # Below free tension a rubber that bulges pushes the slipping sheet at the trailing edge.
    solution = rn.solve(nip_with(paper(), friction=0.15), rn.Model(geometry="linear"))
    assert solution.sheet.tension_min < -1e-3
    assert any("pushed" in line for line in solution.warnings)


@pytest.mark.parametrize("geometry", ["curved", "second"])
def test_a_plate_without_tension_on_one_side_is_not_called_pushed(geometry):
    # Its bending moment at an edge takes a little tension there, less than the error of it.
    sheet = rn.Sheet(
        thickness=0.1, modulus=3000.0, poisson=0.3, tension_in=0.05, tension_out=0.0, bending=True
    )
    solution = rn.solve(nip_with(sheet, lower=RIGID), rn.Model(geometry=geometry))
    assert solution.converged
    assert -solution.sheet.error["tension_min"] < solution.sheet.tension_min < -1e-6
    assert not any("pushed" in line for line in solution.warnings)


def test_a_thick_sheet_is_said_to_slip_through_just_below_what_friction_carries():
    # On a radius of 10 mm the shears of the upper face pull by R/(R + h/2) of themselves: 0.2927.
    sheet = rn.Sheet(
        thickness=0.5, modulus=2000.0, poisson=0.3, bending=False, tension_in=0.294, tension_out=0.0
    )
    nip = nip_with(
        sheet, upper=rn.Roller(radius=10.0), lower=SOFT, normal=rn.LineLoad(1.0), friction=0.3
    )
    with pytest.raises(rn.ConvergenceError, match="slips through at a little less"):
        rn.solve(nip, rn.Model(geometry="curved"))
    held = replace(nip, sheet=replace(sheet, tension_in=0.29))
    assert rn.solve(held, rn.Model(geometry="curved")).converged


def test_a_plate_that_slides_on_both_sides_all_over_has_no_speed():
    sheet = rn.Sheet(thickness=0.5, modulus=2000.0, poisson=0.3, bending=True)
    nip = nip_with(
        sheet,
        upper=rn.Roller(radius=10.0),
        lower=SOFT,
        normal=rn.LineLoad(1.0),
        friction=0.05,
        tangential=rn.Creepage(0.3),
    )
    with pytest.raises(rn.ConvergenceError, match="at any speed"):
        rn.solve(nip, rn.Model(geometry="curved"))


def test_what_friction_is_asked_for_is_stated_once():
    # with the limits at which a nip is refused, and below them by the lever of the shears
    sheet = paper(tension_in=0.3, tension_out=0.1, friction_upper=0.4, friction_lower=0.2)
    nip = nip_with(sheet, normal=rn.LineLoad(2.0), tangential=rn.Traction(0.1))
    assert lever_ratio(nip) == pytest.approx(0.5 * 0.1 / 25.0)
    assert asked_of_friction(nip, 2.0, None) == {"both": pytest.approx((0.2, 1.2))}
    asked = asked_of_friction(nip, 2.0, 0.1)
    assert list(asked) == ["both", "lower", "upper"]
    assert asked["lower"] == pytest.approx((0.1, 0.4))
    assert asked["upper"] == pytest.approx((0.3, 0.8))


@pytest.mark.parametrize("side", ["both", "lower", "upper"])
def test_what_may_slip_through_begins_a_lever_below_what_is_refused(side):
    """By a thickness of 0.5 mm on 10 mm, 2.5 %: both statements of a limit are one."""
    tensions = {"both": (1.0, 0.0), "lower": (0.0, 0.3), "upper": (0.4, 0.0)}[side]
    traction = {"both": None, "lower": 0.3, "upper": 0.0}[side]
    sheet = rn.Sheet(thickness=0.5, modulus=2000.0, friction_upper=0.4, friction_lower=0.3)
    if side == "both":
        sheet = replace(sheet, friction_upper=0.7)

    def nip(share):
        given = dict(zip(("tension_in", "tension_out"), (share * t for t in tensions), strict=True))
        driven = rn.Creepage(0.0) if traction is None else rn.Traction(share * traction)
        of = {"upper": rn.Roller(radius=10.0), "lower": SOFT, "normal": rn.LineLoad(1.0)}
        return nip_with(replace(sheet, **given), **of, tangential=driven)

    assert none_found(nip(0.974), "other") == "other"
    assert "slips through at a little less" in none_found(nip(0.976), "other")
    with pytest.raises(rn.InvalidInputError, match="must"):
        nip(1.001)


def test_geared_rollers_between_the_levers_may_slide_at_any_speed():
    # The pull is half of the 0.0012 N/mm that the levers take of frictions that pull both ways: on
    # a straight path one roller would hold the sheet, on this one the other.
    sheet = rn.Sheet(
        thickness=0.5,
        modulus=2000.0,
        poisson=0.3,
        tension_in=0.1006,
        tension_out=0.1,
        bending=False,
    )
    nip = nip_with(
        sheet,
        upper=rn.Roller(radius=10.0, layers=[rn.Layer(2.0, rn.Elastic(modulus=2.0, poisson=0.49))]),
        lower=rn.Roller(radius=10.0),
        normal=rn.LineLoad(1.0),
        friction=0.05,
        tangential=rn.Creepage(0.3),
    )
    with pytest.raises(rn.ConvergenceError, match="at any speed"):
        rn.solve(nip, rn.Model(geometry="curved"))
    apart = replace(nip, sheet=replace(sheet, tension_in=0.103))
    assert none_found(apart, "other") == "other"


def test_a_stiff_sheet_is_warned_of():
    board = replace(rn.Sheet.usual("board"), bending=False)
    solution = rn.solve(nip_with(board), rn.Model(geometry="linear"))
    length = solution.sheet.bending_length
    # (D d/E)^(1/4) on the softer covering, by hand
    stiffness = 4500.0 * 0.4**3 / (12.0 * (1.0 - 0.3**2))
    assert length == pytest.approx((stiffness * 2.0 / 0.91) ** 0.25, rel=1e-12)
    assert any("bending stiffness" in line for line in solution.warnings)
    foil = replace(rn.Sheet.usual("aluminium foil"), thickness=0.001)
    thin = rn.solve(nip_with(foil), rn.Model(geometry="linear"))
    assert not any("bending stiffness" in line for line in thin.warnings)


def test_stiffness_that_shows_and_cannot_be_counted_leaves_a_nip_unverified(monkeypatch):
    monkeypatch.setattr("rollnip.sheet.solve.solve_plate", lambda *_: None)
    nip = nip_with(replace(rn.Sheet.usual("board"), tension_in=0.05))
    solution = rn.solve(nip, rn.Model(geometry="linear"))
    said = "No solution with the sheet's bending stiffness was found."
    assert said in solution.warnings
    assert not solution.converged
    assert solution.status == said
    freely = replace(nip, sheet=replace(nip.sheet, bending=False))
    assert said not in rn.solve(freely, rn.Model(geometry="linear")).warnings


def test_a_bare_roller_on_either_side():
    sheet = paper(tension_in=0.05)
    for side in ("upper", "lower"):
        nip = nip_with(sheet, friction=0.3, **{side: RIGID})
        solution = rn.solve(nip, rn.Model(geometry="curved"))
        assert solution.converged, side


def test_an_unknown_usual_sheet_is_refused():
    with pytest.raises(rn.InvalidInputError, match="`name` must be one of office paper"):
        rn.Sheet.usual("ofice paper")


def test_the_default_takes_all_orders_but_on_half_space_cores():
    rubber = SOFT.layers[0]
    steel = rn.Roller(radius=50, layers=[rubber], core=rn.Elastic(modulus=206e3, poisson=0.3))
    assert geometry_for(nip_with(paper()), rn.Model()) == "finite"
    assert geometry_for(nip_with(paper(), upper=steel), rn.Model()) == "second"
    assert rn.solve(nip_with(paper())).model.geometry == "finite"
    assert rn.solve(nip_with(paper(), upper=steel)).model.geometry == "second"


def test_usual_sheets_have_sources():
    from rollnip.sheets import SHEET_SOURCES, SHEETS

    assert list(SHEETS) == list(SHEET_SOURCES)
    for name, sheet in SHEETS.items():
        source = SHEET_SOURCES[name]
        for key in ("thickness", "modulus", "modulus_thickness"):
            value, usual = getattr(sheet, key), getattr(source, key)
            assert (value is None) == (usual is None), (name, key)
            assert value is None or usual[0] <= value <= usual[1], (name, key)
        # every value is in what a source states or is called typical
        for word in ("thickness", "modulus", "Poisson's ratio"):
            assert word in source.text or any(word in value for value in source.typical), name
        if sheet.modulus_thickness is not None:
            assert any("across the thickness" in value for value in source.typical), name


def test_friction_of_the_nip_may_be_left_out_where_the_sheet_has_its_own():
    own = paper(friction_upper=0.3, friction_lower=0.2)
    given = {"upper": SOFT, "lower": RIGID, "normal": rn.LineLoad(1.0)}
    nip = rn.Nip(**given, sheet=own)
    assert nip == rn.Nip(**given, sheet=own, friction=0.3)
    assert replace(nip, title="again").friction == 0.3


@pytest.mark.parametrize("sheet", [None, paper(), paper(friction_upper=0.3)])
def test_friction_that_is_missing_is_asked_for_in_one_sentence(sheet):
    with pytest.raises(rn.InvalidInputError, match=r"^`friction` must be given, .*0.5.*\.$"):
        rn.Nip(upper=SOFT, lower=RIGID, normal=rn.LineLoad(1.0), sheet=sheet)


@pytest.mark.parametrize(
    ("thickness", "said", "not_said"),
    [
        (0.15, "may be up to .* % off.* Without `bending = false` they are counted", "far off"),
        (1.5, "Both may be far off. Without `bending = false` they are counted", "may be up to"),
    ],
)
def test_stiffness_that_is_forbidden_where_it_shows_is_said_to_be(thickness, said, not_said):
    # 468 % of the nip width: "may be up to 936 % off"
    stiff = replace(paper(bending=False), thickness=thickness)
    solution = rn.solve(nip_with(stiff), rn.Model(geometry="linear"))
    (warning,) = [one for one in solution.warnings if "bending stiffness" in one]
    assert re.search(said, warning)
    assert not_said not in warning


@pytest.mark.parametrize(
    ("friction_lower", "tension_out", "said"),
    [
        (0.05, 0.1, "at any speed"),  # both pull with 0.05 N/mm, one forwards, one backwards
        (0.07, 0.12, "at any speed"),
        (0.07, 0.08, None),  # the lower side holds more and sticks
        (0.06, 0.1, None),
    ],
)
def test_a_sheet_that_slides_on_both_sides_all_over_has_no_speed(friction_lower, tension_out, said):
    """Whose speed is open is said to be so; with a little more on one side it is that of stick."""
    roller = rn.Roller(radius=50, layers=[rn.Layer(8.0, rn.Elastic(modulus=3.6, poisson=0.5))])
    sheet = rn.Sheet(
        thickness=0.05,
        modulus=4000.0,
        tension_in=0.1,
        tension_out=tension_out,
        friction_lower=friction_lower,
        bending=False,
    )
    geared = rn.Nip(
        upper=roller,
        lower=roller,
        normal=rn.LineLoad(1.0),
        friction=0.05,
        tangential=rn.Creepage(0.03),
        sheet=sheet,
    )
    if said is not None:
        with pytest.raises(rn.ConvergenceError, match=said):
            rn.solve(geared, rn.Model(geometry="linear"))
        return
    found = rn.solve(geared, rn.Model(geometry="linear")).sheet
    assert found.slip_share_upper == 1.0
    assert found.slip_share_lower < 1.0
