"""Tables of dynamic-mechanical data: heads, units, conversions."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.dma import DmaData, read_dma

ROWS = "-10;1;200;0,5\n-10;10;250;0,4\n20;1;4;0,2\n20;10;5;0,2\n"
HEAD = "temperature [degC];frequency [Hz];storage modulus [MPa];tan delta\n"


@pytest.fixture
def table(tmp_path):
    def write(text):
        path = tmp_path / "sweep.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_tan_delta_and_storage_give_the_loss_modulus(table):
    data = read_dma(table(HEAD + ROWS), modulus="E")
    np.testing.assert_allclose(data.loss, [100.0, 100.0, 0.8, 1.0])
    np.testing.assert_allclose(data.temperature, [-10.0, -10.0, 20.0, 20.0])


def test_shear_moduli_become_youngs_moduli(table):
    text = HEAD.replace("storage modulus", "G'") + ROWS
    data = read_dma(table(text), poisson=0.5)
    np.testing.assert_allclose(data.storage, [600.0, 750.0, 12.0, 15.0])
    np.testing.assert_allclose(data.loss / data.storage, [0.5, 0.4, 0.2, 0.2])


@pytest.mark.parametrize(
    ("head", "scale"),
    [
        ("Temp [K];Angular Frequency [rad/s];E' [Pa];E'' [Pa];Force [N]\n", 1.0 / (2.0 * np.pi)),
        ("T [K];f [rad/s];E\u2032 [Pa];E\u2033 [Pa];note\n", 1.0 / (2.0 * np.pi)),
        ("T [K];f [mHz];E' [Pa];E'' [Pa];note\n", 1e-3),
    ],
)
def test_units_are_those_of_the_heads_and_other_columns_are_passed_over(table, head, scale):
    rows = "".join(f"300;{w};{1e6 * w};2e5;3\n" for w in (1, 2, 3, 4))
    data = read_dma(table(head + rows))
    np.testing.assert_allclose(data.frequency, scale * np.arange(1, 5))
    np.testing.assert_allclose(data.storage, [1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(data.loss, 0.2)
    np.testing.assert_allclose(data.temperature, 26.85)


def test_a_sweep_without_a_column_of_temperatures(table):
    text = "frequency [Hz];E' [MPa];E'' [MPa]\n" + "".join(f"{f};2;1\n" for f in (1, 2, 3, 4))
    assert read_dma(table(text), temperature=23.0).temperature.tolist() == [23.0] * 4


@pytest.mark.parametrize(
    ("text", "given", "said"),
    [
        (HEAD + ROWS, {}, 'Young\'s modulus ("E") or the shear modulus'),
        (HEAD.replace("storage modulus", "E'") + ROWS, {"modulus": "G"}, "the heads say E"),
        (HEAD.replace(" [MPa]", "") + ROWS, {"modulus": "E"}, "must say its unit"),
        (HEAD.replace(" [degC]", "") + ROWS, {"modulus": "E"}, "must say its unit"),
        (HEAD.replace("frequency [Hz]", "omega [Hz]") + ROWS, {"modulus": "E"}, "in rad/s"),
        (HEAD.replace("frequency [Hz]", "frequency [1/s]") + ROWS, {"modulus": "E"}, "radians"),
        (HEAD.replace("tan delta", "shift") + ROWS, {"modulus": "E"}, "tan delta"),
        (HEAD.replace("tan delta", "phase") + ROWS, {"modulus": "E"}, '"phase [deg]"'),
        (HEAD.replace("storage", "stiff") + ROWS, {"modulus": "E"}, "storage modulus"),
        (HEAD.replace("temperature [degC]", "note") + ROWS, {"modulus": "E"}, "temperature"),
        (HEAD + ROWS.replace("0,5", "-0,5"), {"modulus": "E"}, "`loss` must be positive"),
        (HEAD + "20;1;2;0,1\n", {"modulus": "E"}, "at least 4"),
        (HEAD + ROWS, {"modulus": "E", "temperature": 20.0}, "`temperature` must not be given"),
        (HEAD + ROWS, {"modulus": "E", "frequency": 1.0}, "`frequency` must not be given"),
        ("E' [MPa];G'' [MPa];f [Hz];t [degC]\n" + ROWS, {}, "of one kind"),
    ],
)
def test_what_is_missing_or_doubtful_is_refused(table, text, given, said):
    with pytest.raises(InvalidInputError) as error:
        read_dma(table(text), **given)
    assert said in str(error.value)


def test_near_temperatures_are_one_isotherm():
    t = np.array([20.3, -5.0, 19.8, -4.6, 30.0])
    data = DmaData(np.ones(5), t, np.ones(5), np.ones(5))
    assert [group.tolist() for group in data.isotherms(1.0)] == [[1, 3], [2, 0], [4]]
    assert len(data.isotherms(0.1)) == 5
