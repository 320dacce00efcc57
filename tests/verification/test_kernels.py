"""The stored compliances of a stack, recomputed with 40 digits.

Independent of the engine: the layer equations of y = (u_x, u_z, s_xz, s_zz) e^{ikx} as a constant
4x4 matrix, integrated from the core upwards by its exponential, layer by layer.
"""

import mpmath
import pytest

from rollnip.verification.kernels import STACK, STACK_COMPLIANCE


def stack_compliance(k, stack, digits=40):
    """C_xx, C_zz and |C_xz| of layers (thickness, modulus, poisson), from the surface down."""
    with mpmath.workdps(3 * digits):
        k = mpmath.mpf(k)
        # at the core u = 0: the two solutions with unit stresses there
        state = mpmath.matrix([[0, 0], [0, 0], [1, 0], [0, 1]])
        for thickness, modulus, poisson in reversed(stack):
            h, young, nu = (mpmath.mpf(repr(v)) for v in (thickness, modulus, poisson))
            state = mpmath.expm(-h * _equations(k, young, nu), method="taylor") * state
        displacements, stresses = state[0:2, :], state[2:4, :]
        # t_x = -s_xz, t_z = -s_zz
        compliance = -displacements * stresses**-1
        return (
            float(compliance[0, 0].real),
            float(compliance[1, 1].real),
            float(abs(compliance[0, 1])),
        )


def _equations(k, young, nu):
    shear = young / (2 * (1 + nu))
    share = nu / (1 - nu)
    i = mpmath.mpc(0, 1) * k
    return mpmath.matrix(
        [
            [0, -i, 1 / shear, 0],
            [-i * share, 0, 0, (1 - 2 * nu) / (2 * shear * (1 - nu))],
            [2 * shear / (1 - nu) * k**2, 0, 0, -i * share],
            [0, 0, -i, 0],
        ]
    )


@pytest.mark.parametrize("k", STACK_COMPLIANCE)
def test_stored_compliances(k):
    """Ten digits are stored."""
    assert stack_compliance(k, STACK) == pytest.approx(STACK_COMPLIANCE[k], rel=3e-10)


@pytest.mark.parametrize(
    ("poisson", "expected"),
    [
        (0.5, (1.24815829, 0.3608725218, 0.4436428842)),
        (0.3, (1.425051666, 0.7566682732, 0.00133904674)),
    ],
)
def test_stored_compliances_of_one_layer(poisson, expected):
    """One bonded layer, E = h = k = 1: nine to ten digits are stored."""
    assert stack_compliance(1.0, ((1.0, 1.0, poisson),)) == pytest.approx(expected, rel=3e-9)
