"""Measurements: shapes, sums, the nips they ask for."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.identification import Approaches, Creepages, NipWidths, Strains, Torques, Velocities
from rollnip.lda import profile_from_means

WIDTHS = NipWidths(at={"nip.load": [1.0, 2.0]}, measured=[4.0, 5.0], standard_error=0.1)


def test_sets_add_up_and_weights_multiply():
    other = Approaches(at={"nip.load": 3.0}, measured=0.4)
    both = WIDTHS + 3 * other
    assert [part.quantity for part in both.parts] == ["nip width", "approach"]
    assert [part.weight for part in both.parts] == [1.0, 3.0]
    assert [part.weight for part in (2 * both).parts] == [2.0, 6.0]
    assert (both + WIDTHS).parts[2] is WIDTHS


def test_each_value_is_a_nip_of_its_own():
    one = Creepages(
        at={"nip.traction": [0.1, 0.2], "nip.load": 4.0, "nip.speed": "20 m/min"},
        measured=[0.01, 0.02],
    )
    assert one.conditions == [
        {"nip.traction": 0.1, "nip.load": 4.0, "nip.speed": "20 m/min"},
        {"nip.traction": 0.2, "nip.load": 4.0, "nip.speed": "20 m/min"},
    ]
    assert one.abscissa[0] == "nip.traction"


def test_numbers_of_the_result_are_read_from_each_solution(solution):
    assert WIDTHS.predict([solution, solution]).tolist() == [solution.nip_width] * 2
    torque = Torques(at={}, measured=1.0, roller="lower")
    assert torque.predict([solution]).tolist() == [solution.torque_lower]


def test_a_result_that_is_not_defined_is_not_a_number(solution):
    from dataclasses import replace

    none = replace(solution, creepage=None)
    assert np.isnan(Creepages(at={}, measured=0.1).predict([none])[0])


def test_one_error_holds_for_all_values():
    assert WIDTHS.errors.tolist() == [0.1, 0.1]
    assert WIDTHS.with_values([7.0, 8.0]).values.tolist() == [7.0, 8.0]


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: NipWidths(at={"nip.load": [1.0]}, measured=[1.0, 2.0]), "one number for each"),
        (lambda: NipWidths(at={}, measured=[]), "list of finite numbers"),
        (lambda: NipWidths(at={}, measured=[np.nan]), "list of finite numbers"),
        (lambda: NipWidths(at={"nip.load": np.inf}, measured=[1.0]), "nip.load"),
        (lambda: NipWidths(at={}, measured=[1.0], standard_error=0.0), "standard_error"),
        (lambda: NipWidths(at={}, measured=[1.0, 2.0], standard_error=[1.0] * 3), "one for each"),
        (lambda: NipWidths(at={}, measured=[1.0], weight=-1.0), "weight"),
        (lambda: -1.0 * WIDTHS, "weight"),
        (lambda: Torques(at={}, measured=[1.0], roller="left"), "roller"),
        (lambda: Strains(x=[0.0], measured=[0.1], roller="left"), "roller"),
        (lambda: Strains(x=[0.0], measured=[0.1, 0.2]), "one place for each"),
        (lambda: Strains(at={"nip.load": [1.0]}, x=[0.0], measured=[0.1]), "single value"),
    ],
)
def test_what_does_not_fit_together_is_refused(make, said):
    with pytest.raises(InvalidInputError, match=said):
        make()


def test_a_velocity_profile_brings_its_errors():
    x = np.linspace(-2.0, 2.0, 5)
    profile = profile_from_means(x, 100.0 + x, np.full(5, 0.3))
    one = Velocities(profile=profile)
    assert one.values.tolist() == (100.0 + x).tolist()
    assert one.errors.tolist() == pytest.approx([0.3] * 5)
    assert one.nuisances == 2
    assert one.with_values(x).values.tolist() == x.tolist()
    assert one.abscissa[0] == "x"
    assert one.conditions == [{}]
