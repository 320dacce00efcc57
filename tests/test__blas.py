"""BLAS threads: one inside, what the caller had outside."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest
from threadpoolctl import ThreadpoolController, threadpool_limits

import rollnip as rn
from rollnip import smooth, solution
from rollnip._blas import one_blas_thread


def threads():
    libraries = ThreadpoolController().select(user_api="blas").info()
    return {library["num_threads"] for library in libraries}


@pytest.fixture
def two():
    """A caller with two threads, where the machine has them."""
    with threadpool_limits(2, user_api="blas"):
        yield threads()


def test_one_inside_and_the_callers_own_outside(two):
    with one_blas_thread():
        assert threads() == {1}
        with one_blas_thread():
            assert threads() == {1}
        assert threads() == {1}
    assert threads() == two


def test_given_back_after_an_error(two):
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        raise ZeroDivisionError
    assert threads() == two


def test_given_back_when_the_last_of_many_leaves(two):
    together = Barrier(4)

    def enter(_):
        with one_blas_thread():
            together.wait()

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(enter, range(4)))
    assert threads() == two


def test_solve_leaves_them_as_they_were(two):
    rubber = rn.Elastic(modulus=1.0, poisson=0.5)
    roller = rn.Roller(radius=50.0, layers=[rn.Layer(3.0, rubber)])
    nip = rn.Nip(upper=roller, lower=rn.Roller(radius=25.0), normal=rn.LineLoad(1.0), friction=0.0)
    assert rn.solve(nip).converged
    assert threads() == two


def test_what_is_asked_of_a_solution_uses_one(two, monkeypatch):
    """Stresses on interfaces took ten times as long with two threads."""
    rubber = rn.Elastic(modulus=1.0, poisson=0.5)
    roller = rn.Roller(radius=50.0, layers=[rn.Layer(3.0, rubber)])
    pressed = {"normal": rn.LineLoad(1.0), "friction": 0.3, "speed": 100.0}
    found = rn.solve(rn.Nip(upper=roller, lower=rn.Roller(radius=25.0), **pressed))
    seen = {}

    def watched(module, name):
        inner = getattr(module, name)

        def call(*given, **named):
            seen[name] = threads()
            return inner(*given, **named)

        monkeypatch.setattr(module, name, call)

    for name in ("interior_field", "interface_stresses", "loss_below"):
        watched(solution, name)
    watched(smooth, "claims")
    found.interior("upper", [0.5, 1.0])
    found.heat_below("upper", 0.0)
    assert found.interfaces
    assert found.error
    assert seen.keys() == {"interior_field", "loss_below", "interface_stresses", "claims"}
    assert all(one == {1} for one in seen.values())
    assert threads() == two
