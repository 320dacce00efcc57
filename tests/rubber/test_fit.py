"""Strain energies from tests: closed forms, known constants found again, stability, Treloar."""

from pathlib import Path

import numpy as np
import pytest

import rollnip as rn
from rollnip.io import parse_case
from rollnip.rubber import (
    RubberData,
    fit_dict,
    fit_rubber,
    nominal_stress,
    plot_rubber,
    read_rubber,
    rubber_toml,
    unstable_from,
)

TRELOAR = Path(__file__).parents[2] / "examples" / "rubber" / "treloar.csv"
KNOWN = {
    "neo-hookean": (0.4, rn.NeoHookean()),
    "yeoh": (0.5, rn.Yeoh(-0.05, 0.004)),
    "gent": (0.3, rn.Gent(30.0)),
    "ogden": (0.4095, rn.Ogden(((0.63, 1.3), (-0.05, -2.0)))),
}
RANGES = {
    "tension": (1.05, 2.5),
    "compression": (0.6, 0.98),
    "equibiaxial": (1.05, 1.8),
    "planar": (1.05, 2.5),
    "shear": (0.05, 1.5),
}


def simulated(law, tests=tuple(RANGES), noise=0.0, count=15, seed=7):
    shear, energy = KNOWN[law]
    draw = np.random.default_rng(seed)
    names, stretches, stresses = [], [], []
    for test in tests:
        at = np.linspace(*RANGES[test], count)
        names += [test] * count
        stretches.append(at)
        stresses.append(shear * nominal_stress(energy, test, at))
    stress = np.concatenate(stresses)
    stress = stress * (1.0 + noise * draw.standard_normal(stress.size))
    return RubberData("simulated", tuple(names), np.concatenate(stretches), stress)


def test_neo_hookean_stresses_are_those_of_the_textbook():
    at = np.array([0.7, 1.0, 1.4])
    soft = rn.NeoHookean()
    expected = {
        "tension": at - at**-2,
        "compression": at - at**-2,
        "equibiaxial": at - at**-5,
        "planar": at - at**-3,
        "shear": at,
    }
    for test, stress in expected.items():
        np.testing.assert_allclose(nominal_stress(soft, test, at), stress, atol=1e-14)
    np.testing.assert_allclose(nominal_stress(soft, "shear", -at), -at, atol=1e-14)


@pytest.mark.parametrize("law", KNOWN)
def test_stress_is_the_derivative_of_the_energy_along_the_test(law):
    """Work of simple shear and of planar tension over the same stretches is the same."""
    _, energy = KNOWN[law]
    stretch = np.linspace(1.0, 1.6, 4001)
    shear = stretch - 1.0 / stretch
    planar = np.trapezoid(nominal_stress(energy, "planar", stretch), stretch)
    sheared = np.trapezoid(nominal_stress(energy, "shear", shear), shear)
    assert sheared == pytest.approx(planar, rel=1e-6)


@pytest.mark.parametrize("law", KNOWN)
def test_known_constants_are_found_again(law):
    shear, energy = KNOWN[law]
    fit = fit_rubber(simulated(law), law)
    assert fit.shear_modulus == pytest.approx(0.5 * fit.material.modulus / 1.5)
    if law != "ogden":
        assert fit.shear_modulus == pytest.approx(shear, rel=1e-6)
    at = np.linspace(0.6, 2.0, 9)
    expected = shear * nominal_stress(energy, "planar", at)
    found = fit.shear_modulus * nominal_stress(fit.energy, "planar", at)
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-7)
    assert fit.warnings == ()


@pytest.mark.parametrize(
    ("law", "name"),
    [("yeoh", "second"), pytest.param("gent", "limit", marks=pytest.mark.slow)],
)
def test_intervals_hold_the_truth_of_noisy_tests(law, name):
    """Nineteen times in twenty, for stresses that scatter by 3 %; 33 or more of 40 by chance."""
    shear, energy = KNOWN[law]
    held, values = {"G": 0, name: 0}, []
    for seed in range(40):
        fit = fit_rubber(simulated(law, ("tension", "shear"), 0.03, 10, seed), law)
        truth = {"G": shear, name: getattr(energy, name)}
        for one in fit.constants:
            if one.name in truth:
                held[one.name] += one.low < truth[one.name] < one.high
        values.append(fit.shear_modulus)
    assert all(33 <= count <= 40 for count in held.values()), held
    assert np.mean(values) == pytest.approx(shear, rel=0.01)
    assert 0.005 < fit.rms["tension"] < 0.04


def test_treloar_as_ogden_found_it():
    """Three terms follow natural rubber to a stretch of 7.6, as in Ogden 1972."""
    data = read_rubber(TRELOAR)
    assert data.tests == ("tension", "equibiaxial")
    assert data.stress.max() == pytest.approx(64.4 * 0.0980665, abs=1e-4)
    fit = fit_rubber(data, "ogden", terms=3)
    assert fit.rms["equibiaxial"] < 0.01
    assert fit.rms["tension"] < 0.025
    assert fit.shear_modulus == pytest.approx(0.41, rel=0.05)
    exponents = sorted(one.value for one in fit.constants if one.name.startswith("exponent"))
    np.testing.assert_allclose(exponents, [-2.0, 1.3, 5.0], rtol=0.25)
    published = rn.Ogden(((0.63, 1.3), (0.0012, 5.0), (-0.01, -2.0)))
    for test, limit in (("tension", 0.04), ("equibiaxial", 0.05)):
        rows = data.rows(test)
        stress = 0.4225 * nominal_stress(published, test, data.stretch[rows])
        assert np.abs(stress - data.stress[rows])[:-4].max() < limit * data.stress[rows].max()
    soft = fit_rubber(data, "neo-hookean")
    assert soft.rms["tension"] > 5.0 * fit.rms["tension"]


def test_the_table_is_one_of_a_case():
    fit = fit_rubber(read_rubber(TRELOAR).up_to(1.0), "ogden", poisson=0.49)
    text = rubber_toml(fit, "cover")
    case = parse_case(
        "[nip]\nload = 1\nfriction = 1\n[upper]\nradius = 50\nlayers = [{thickness = 2, "
        'material = "cover"}]\n[lower]\nradius = 25\n' + text
    )
    found = case.nip.upper.layers[0].material
    assert found.energy == fit.energy
    assert found.modulus == pytest.approx(fit.material.modulus)
    assert "# tension: rms deviation" in text
    tree = fit_dict(fit)
    assert tree["constants"]["share 1"]["low"] < tree["constants"]["share 1"]["value"]
    assert tree["material"]["poisson"] == 0.49


def test_stability():
    """W' of Yeoh's energy falls: planar stress d(l^2 w')/dl turns around; Ogden's never does."""
    assert unstable_from(rn.NeoHookean(), "tension") == (None, None)
    assert unstable_from(rn.Gent(10.0), "planar") == (None, None)
    low, high = unstable_from(rn.Yeoh(-0.2), "planar")
    assert low == pytest.approx(1.0 / high, rel=1e-9)
    # closed form: tau = (l^2 - l^-2) (1 - 0.4 I), I = (l - 1/l)^2, is largest there or before
    at = np.linspace(1.0, 3.0, 20001)
    stress = (at**2 - at**-2) * (1.0 - 0.4 * (at - 1.0 / at) ** 2)
    assert 1.0 < high <= at[np.argmax(stress)] + 0.01
    fit = fit_rubber(
        RubberData(
            "soft",
            ("planar",) * 6,
            np.linspace(1.1, 2.6, 6),
            np.array([0.1, 0.25, 0.32, 0.34, 0.33, 0.29]),
        ),
        "yeoh",
    )
    assert "not stable in plane strain beyond a stretch of" in " ".join(fit.warnings)
    assert "One kind of test alone (planar)" in " ".join(fit.warnings)


@pytest.mark.parametrize("style", ["light", "dark"])
def test_the_picture_shows_measurements_and_curves(style, faint_words):
    figure = plot_rubber(fit_rubber(simulated("yeoh", ("tension", "shear")), "yeoh"), style)
    assert faint_words(figure) == []
    stress, deviation = figure.axes
    assert [text.get_text() for text in stress.get_legend().get_texts()] == ["tension", "shear"]
    assert stress.get_legend().get_title().get_text() == "curves: yeoh"
    assert len(stress.lines) == 4
    assert deviation.get_ylabel().startswith("deviation")


@pytest.mark.parametrize(
    ("text", "test", "said"),
    [
        ("stretch, stress [MPa]\n1.1, 0.1\n", None, 'must have a column "test"'),
        ("stretch, stress\n1.1, 0.1\n", "tension", 'column "stress" must say its unit'),
        ("stretch, strain, stress [MPa]\n1.1, 0.1, 0.1\n", "tension", "exactly one of the columns"),
        ("stretch, stress [mm]\n1.1, 0.1\n", "tension", 'unit of column "stress"'),
        ("stretch, force, stress [MPa]\n1.1, 1, 0.1\n", "tension", 'a column "force"'),
        ("test, stretch, stress [MPa]\npull, 1.1, 0.1\n", None, 'line 2: "test" must be one of'),
        ("stretch, stress [MPa]\n-0.2, 0.1\n", "tension", "must be positive and finite, got -0.2"),
        ("stretch, stress [MPa]\n1.2, 0.1\n", "compression", "at most 1 in compression"),
        ("stretch, stress [MPa]\n1.2, 0.1\n", "shear", "name the column strain"),
        ("stretch, stress [MPa]\n1.2, 0.1\n", "pull", "`test` must be one of"),
        ("test, stretch, stress [MPa]\ntension, 1.2, 0.1\n", "shear", "must not be given"),
    ],
)
def test_what_is_wrong_with_a_table_is_said(tmp_path, text, test, said):
    file = tmp_path / "data.csv"
    file.write_text(text, "utf-8")
    with pytest.raises(rn.InvalidInputError) as error:
        read_rubber(file, test=test)
    assert said in str(error.value)


def test_compression_may_be_written_positive(tmp_path):
    file = tmp_path / "data.csv"
    file.write_text("strain [%]; stress [kPa]\n10; 250\n20,5; 500\n", "utf-8")
    data = read_rubber(file, test="compression")
    np.testing.assert_allclose(data.stretch, [0.9, 0.795])
    np.testing.assert_allclose(data.stress, [-0.25, -0.5])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"law": "mooney"}, "`law` must be one of"),
        ({"law": "ogden", "terms": 5}, "`terms` must lie between 1 and 4"),
        ({"law": "ogden", "terms": 3}, "more than 6 measurements"),
        ({"law": "neo-hookean", "turned": -1.0}, "must go the way of the strains"),
    ],
)
def test_what_cannot_be_fitted_is_said(changes, said):
    data = simulated("neo-hookean", ("tension",), count=5)
    turned = changes.pop("turned", 1.0)
    data = RubberData("few", data.test, data.stretch, turned * data.stress)
    with pytest.raises(rn.InvalidInputError) as error:
        fit_rubber(data, **changes)
    assert said in str(error.value)


@pytest.mark.parametrize("law", ["neo-hookean", "yeoh", "gent", "ogden"])
@pytest.mark.parametrize(
    ("stretch", "stress", "said"),
    [
        (np.ones(6), np.linspace(0.1, 0.6, 6), "few: must hold a measurement of tension with a st"),
        (np.linspace(1.1, 2.0, 6), np.zeros(6), "a measurement of tension with a stress; all of"),
        (np.linspace(1.1, 2.0, 6), -np.linspace(0.1, 0.6, 6), "must go the way of the strains"),
    ],
    ids=["no strain", "no stress", "turned"],
)
def test_tests_without_strain_or_stress_are_said(law, stretch, stress, said):
    with pytest.raises(rn.InvalidInputError) as error:
        fit_rubber(RubberData("few", ("tension",) * 6, stretch, stress), law)
    assert said in str(error.value)


def test_a_modulus_known_to_its_own_size_only_is_said_to_be_open():
    """The interval of G is wider than twice G, though narrower than 2 MPa."""
    data = RubberData(
        "rough", ("tension",) * 3, np.array([1.1, 1.2, 1.3]), np.array([0.3, 0.1, 0.05])
    )
    fit = fit_rubber(data, "neo-hookean")
    (shear,) = fit.constants
    assert 2.0 * shear.value < shear.high - shear.low < 2.0
    assert any("leave G open" in line for line in fit.warnings)


@pytest.mark.parametrize(
    ("stretch", "stress", "said"),
    [
        (2.0, 1e300, r"`stress\[0\]` must be at most 1e\+12 MPa in size"),
        (1e200, 1.0, r"`stretch\[0\]` must lie between 0.001 and 1000"),
        (2.0, 1e-300, "a measurement of tension with a stress"),
    ],
)
def test_numbers_of_no_rubber_are_said(stretch, stress, said):
    """They overflowed, and ended in a traceback."""
    with pytest.raises(rn.InvalidInputError, match=said):
        fit_rubber(RubberData("here", ("tension",) * 5, [stretch] * 5, [stress] * 5))
