"""The law of honest error estimates: no figure is further off than 3 times what is claimed."""

import pytest
from claims import judge, reference, solved
from population import numbers, random_case

import rollnip as rn

# Least errors and allowances were set with numbers below 10 000: these have not been seen.
UNSEEN = 100_000, 1_000_000
OTHERS = 1_000_000, 2**31
MOST = 1000  # elements of a reference, for time; most nips take less than 150


def check_claims(case):
    """True error against a solution on ten times as many elements; doubt: of that solution."""
    solution = solved(case)
    if not (isinstance(solution, rn.Solution) and solution.converged):
        return False
    pair = reference(solution, most=MOST)
    if pair is None:
        return False
    figures = judge(solution, pair)
    for figure in figures:
        assert not figure.is_under_claimed, (case.number, case.geometry, figure)
    return all(figure.is_certain for figure in figures)


@pytest.mark.parametrize("examples", [4, pytest.param(24, marks=pytest.mark.slow)])
def test_no_error_is_claimed_smaller_than_a_third_of_it(examples):
    judged = [check_claims(random_case(number)) for number in numbers(examples, *UNSEEN)]
    assert sum(judged) >= int(0.9 * len(judged))


@pytest.mark.slow
def test_claims_of_other_nips():
    """Nips that no number was set with; other ones for each `population.SEED`.

    About one random nip in 300 has a figure beyond 3 claims (docs/decisions/0012). So one of 30
    may; two have a chance of one in 200.
    """
    judged, beyond = 0, []
    for number in (drawn := numbers(30, *OTHERS)):
        try:
            judged += check_claims(random_case(number))
        except AssertionError as broken:
            beyond.append(str(broken).splitlines()[0])
    assert judged >= 0.8 * len(drawn) - len(beyond)
    assert len(beyond) <= 1, beyond


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_claims_are_kept_where_much_is_of_second_order(tolerance):
    """Of "second" the second order, a quarter of the peak here, is that of each mesh itself."""
    case = random_case(1120, "second")
    found, fine = solved(case, tolerance), solved(case, 1e-4)
    assert found.model.geometry == fine.model.geometry == "second"
    for name in ("creepage", "nip_width", "peak_pressure", "approach"):
        apart = abs(getattr(found, name) - getattr(fine, name))
        assert apart <= 1.5 * (found.error[name] + fine.error[name]), name


@pytest.mark.parametrize("number", [1044, 1054])
def test_figures_of_linear_elements_converge_with_a_second_order(number):
    """Many zones on few elements; what the terms still move counts where the pressure peaks."""
    solution = solved(random_case(number, "second"), 1e-4)
    assert solution.model.geometry == "second"
    # of the mesh: the second order itself leaves more
    assert solution.final.error_ratio <= 1.0
    assert solution.solver.residual <= 1e-4


def test_terms_that_run_away_are_no_fault_of_the_input():
    """A torque is prescribed: where tractions overflow on the way, no traction belongs to it."""
    case = random_case(920246, "curved")
    assert isinstance(case.nip.tangential, rn.Torque)
    solution = rn.solve(case.nip, rn.Model(geometry="curved"))
    assert solution.nip_width > 0.0
