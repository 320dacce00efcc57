from dataclasses import replace

import numpy as np
import pytest

import rollnip as rn
from rollnip.plots import plot_field
from rollnip.plots.section import QUANTITIES, section_pieces


def colour_bar(ax):
    return next(child for child in ax.child_axes if child.get_xlabel())


def texts(ax) -> list[str]:
    return [text.get_text() for text in ax.texts]


@pytest.mark.parametrize("component", QUANTITIES)
def test_every_component_is_drawn_with_its_unit(viscoelastic, component):
    ax = plot_field(viscoelastic, component)
    assert colour_bar(ax).get_xlabel() == QUANTITIES[component].label
    assert QUANTITIES[component].label.endswith("]")
    assert ax.get_xlabel() == "x [mm]"
    assert ax.get_ylabel() == "lower ← depth [mm] → upper"


def test_the_stress_power_is_said_to_be_linear_at_finite_strain(viscoelastic):
    finite = replace(viscoelastic, model=rn.Model(geometry="finite"))
    name = colour_bar(plot_field(finite, "loss_density")).get_xlabel()
    assert name == "stress power, loss density [mW/mm³], linear theory"


def test_layers_are_named(skin):
    names = texts(plot_field(skin))
    assert {"0.1 mm\n5500 MPa", "4 mm\n2 MPa", "rigid core", "rigid roller", "inlet"} <= set(names)


def test_a_viscoelastic_layer_shows_both_moduli(viscoelastic):
    assert "4 mm\n2 to 5 MPa" in texts(plot_field(viscoelastic))


def test_one_roller_alone(driven):
    ax = plot_field(driven, "von_mises", rollers="lower")
    assert colour_bar(ax).get_xlabel() == "von Mises stress [MPa], lower roller"
    low, high = ax.get_ylim()
    assert high == 0.0
    assert low < -2.7


def test_to_scale_it_is_round_and_the_surfaces_meet(driven):
    ax = plot_field(driven, scale="equal")
    assert ax.get_aspect() == 1.0
    upper, lower = (
        next(p for p in section_pieces(driven, ("upper", "lower"), "s_zz", "equal", 0.3)
             if p.name == name)
        for name in ("upper", "lower")
    )  # fmt: skip
    for piece, sign in ((upper, 1.0), (lower, -1.0)):
        assert sign * piece.y[-1, 0] > sign * piece.y[-1, piece.x.shape[1] // 2]
    x = np.linspace(-3.0, 3.0, 13)
    gap = np.interp(x, upper.x[0], upper.y[0]) - np.interp(x, lower.x[0], lower.y[0])
    # circles, where the model has parabolas: x^4/(8 R^3), and u_z along the radius
    assert np.max(np.abs(gap)) < 0.02 * driven.approach


def test_stress_is_continuous_across_the_nip(driven):
    """Both rollers in one frame: s_zz = -p and s_xz = -q on either surface."""
    for component in ("s_zz", "s_xz"):
        upper, lower = section_pieces(driven, ("upper", "lower"), component, "stretched", 0.3)[::2]
        assert upper.values is not None
        assert lower.values is not None
        np.testing.assert_allclose(upper.values[0], lower.values[0], atol=2e-3)
    q = np.interp(upper.x[0], driven.nodes, driven.shear)
    inside = np.abs(upper.x[0]) < 2.5
    np.testing.assert_allclose(upper.values[0][inside], -q[inside], atol=2e-3)


def test_each_layer_has_its_own_value_at_an_interface(skin):
    top, below = section_pieces(skin, ("upper",), "s_xx", "stretched", 0.3)[:2]
    assert top.y[-1, 0] == pytest.approx(below.y[0, 0])
    assert np.max(np.abs(top.values[-1])) > 5.0 * np.max(np.abs(below.values[0]))


def test_colours_are_about_nought_unless_one_sign_is_all(driven):
    for component, low in (("s_zz", -1.0), ("von_mises", 0.0)):
        filled = next(
            c for c in plot_field(driven, component).collections if c.get_array() is not None
        )
        assert filled.norm.vmin == pytest.approx(low * filled.norm.vmax)


def test_a_limit_holds(driven):
    filled = plot_field(driven, limit=0.1).collections[0]
    assert np.max(np.abs(filled.levels)) <= 0.125
    assert filled.extend in ("min", "both")


def test_what_is_nought_everywhere_is_drawn(driven):
    plot_field(driven, "loss_density").figure.draw_without_rendering()


def test_a_half_space_is_drawn_some_way_down(plane):
    ax = plot_field(plane, rollers="lower")
    assert "core\n50 MPa" in texts(ax)
    assert "rigid core" not in texts(ax)
    plot_field(plane, "u_z", scale="equal").figure.draw_without_rendering()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"component": "szz"}, '`component` must be one of .*got "szz". Did you mean "s_zz"'),
        ({"component": "von-mises"}, 'Did you mean "von_mises"'),
        ({"component": 3}, "`component` must be one of u_x, .*, got 3"),
        ({"rollers": "uper"}, '`rollers` must be .*Did you mean "upper"'),
        ({"scale": "equl"}, '`scale` must be one of stretched, equal, got "equl". .*"equal"'),
        ({"limit": 0.0}, "`limit` must be positive and finite"),
        ({"rollers": "lower"}, '`rollers` must name one that deforms, got "lower"'),
    ],
)
def test_wrong_names(skin, arguments, message):
    with pytest.raises(rn.InvalidInputError, match=message):
        plot_field(skin, **arguments)


def test_a_power_of_ten_of_the_colours_stands_with_the_unit(viscoelastic):
    slow = rn.solve(replace(viscoelastic.nip, speed=1e-3), viscoelastic.model)
    ax = plot_field(slow, "loss_density")
    ax.figure.draw_without_rendering()
    bar = colour_bar(ax)
    power = bar.xaxis.get_offset_text()
    assert power.get_text().startswith("1e")
    assert not power.get_visible()
    assert bar.get_xlabel() == f"stress power, loss density [{power.get_text()} mW/mm³]"


def test_an_elastic_roller_does_not_choose_the_colours_of_a_loss():
    rubber = rn.StandardLinearSolid(modulus=2, stiffening=3, relaxation_time=0.007, poisson=0.49)
    soft = rn.Elastic(modulus=2, poisson=0.49)
    nip = rn.Nip(
        upper=rn.Roller(radius=80, layers=[rn.Layer(20, soft)]),
        lower=rn.Roller(radius=50, layers=[rn.Layer(1, rubber)]),
        normal=rn.LineLoad(2),
        friction=0.3,
        speed=500,
    )
    solution = rn.solve(nip)
    loss = np.abs(solution.interior("lower", np.linspace(0, 1, 9)).loss_density)
    highest = colour_bar(plot_field(solution, "loss_density")).get_xlim()[1]
    assert np.mean(loss > highest) < 0.1
