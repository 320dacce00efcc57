"""The discrete rolling contact problem and its solution, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
States = NDArray[np.int8]

MOST_ITERATIONS = 40
"""Most steps of an active set, an interior point, or a fixed-point iteration on one mesh."""


class State(IntEnum):
    """State of a node of the mesh; slip is named after the sign of the shear q."""

    FREE = 0
    STICK = 1
    SLIP_PLUS = 2
    SLIP_MINUS = 3


# Plain integers: comparing an array with these takes a tenth of the time of enum members.
FREE, STICK, SLIP_PLUS, SLIP_MINUS = (int(state) for state in State)


@dataclass(frozen=True, slots=True)
class Control:
    """The prescribed quantities: exactly one of each pair is a number, the other None.

    load [N/mm] or approach [mm]; traction [N/mm] or creepage.
    """

    load: float | None
    approach: float | None
    traction: float | None
    creepage: float | None


@dataclass(frozen=True, slots=True)
class ContactProblem:
    """Steady rolling contact on n nodes x_1 < ... < x_n (trailing to leading), theory section 5.

    The gap at node i and the creep of the interval from node i to node i + 1 (towards the leading
    edge, where the material comes from) are linear in the nodal pressures p and shears q:

        gap   = clearance - delta + normal_pressure p + normal_shear q      >= 0, p >= 0
        creep = creep_offset + xi creep_length + creep_pressure p + creep_shear q

    The creep is the length by which the upper surface outruns the lower over the interval; the
    slip velocity is -V creep/length. Stick: creep = 0, |q| <= mu p. Slip: q = mu p sign(creep).

    Attributes
    ----------
    x : (n,) nodes [mm].
    weights : (n,) load of a unit nodal pressure [mm].
    clearance : (n,) gap between the undeformed rollers at first touch [mm].
    influence : (2 n, 2 n) block matrix [[normal_pressure, normal_shear],
        [creep_pressure, creep_shear]] [mm/MPa].
    creep_length, creep_offset : (n,) factor of xi in the creep, and part without tractions [mm].
    friction : Coulomb coefficient mu >= 0.
    control : the prescribed quantities.
    """

    x: Array
    weights: Array
    clearance: Array
    influence: Array
    creep_length: Array
    creep_offset: Array
    friction: float
    control: Control

    def gap_and_creep(self, state: ContactState) -> tuple[Array, Array]:
        """Return gaps at nodes and creeps of intervals [mm]; the slip velocity is -V creep/length.

        The pressure and shear of ``state`` may be any.
        """
        made = self.influence @ np.concatenate([state.pressure, state.shear])
        n = self.x.size
        rigid = self.creep_offset + state.creepage * self.creep_length
        return self.clearance - state.approach + made[:n], rigid + made[n:]

    @property
    def normal_pressure(self) -> Array:
        """Gap per nodal pressure, (n, n) [mm/MPa]."""
        return self.influence[: self.x.size, : self.x.size]

    @property
    def normal_shear(self) -> Array:
        """Gap per nodal shear, (n, n) [mm/MPa]."""
        return self.influence[: self.x.size, self.x.size :]

    @property
    def creep_pressure(self) -> Array:
        """Creep per nodal pressure, (n, n) [mm/MPa]."""
        return self.influence[self.x.size :, : self.x.size]

    @property
    def creep_shear(self) -> Array:
        """Creep per nodal shear, (n, n) [mm/MPa]."""
        return self.influence[self.x.size :, self.x.size :]


@dataclass(frozen=True, slots=True)
class ContactState:
    """A solution of the discrete problem, or the last iterate of a solver.

    Attributes
    ----------
    states : (n,) State of each node.
    pressure, shear : (n,) nodal tractions [MPa].
    approach, creepage : delta [mm], xi; xi is nan if there is no friction and it is not prescribed.
    steps : number of linear systems solved.
    settled : whether the solver converged: the solution implies the states that it was solved with,
        or these were given.

    """

    states: States
    pressure: Array
    shear: Array
    approach: float
    creepage: float
    steps: int
    settled: bool


def shear_signs(states: States) -> Array:
    """Return the sign of the shear, +1 or -1, where a node slips, and 0 elsewhere."""
    return np.array([0.0, 0.0, 1.0, -1.0]).take(states)
