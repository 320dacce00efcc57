"""The discrete contact problem: which nodes touch, stick or slip, and where the zones end."""

from rollnip.contact.complementarity import Complementary, Inequalities, interior_point
from rollnip.contact.coupled import CoupledActiveSet, next_slip, next_states
from rollnip.contact.features import ContactZone, contact_intervals, contact_zones
from rollnip.contact.free_ends import NEAR_ENOUGH, Layout
from rollnip.contact.mesh import (
    CREEP_TO_EDGE,
    Subdivision,
    carry,
    cosine_nodes,
    crowding_of,
    cubic_error,
    elements_of_zones,
    more_elements,
    subdivided,
)
from rollnip.contact.methods import GivenStates, Safeguarded
from rollnip.contact.problem import (
    ContactProblem,
    ContactState,
    Control,
    State,
    States,
    creep,
    gap,
    influence_of,
)

__all__ = [
    "CREEP_TO_EDGE",
    "NEAR_ENOUGH",
    "Complementary",
    "ContactProblem",
    "ContactState",
    "ContactZone",
    "Control",
    "CoupledActiveSet",
    "GivenStates",
    "Inequalities",
    "Layout",
    "Safeguarded",
    "State",
    "States",
    "Subdivision",
    "carry",
    "contact_intervals",
    "contact_zones",
    "cosine_nodes",
    "creep",
    "crowding_of",
    "cubic_error",
    "elements_of_zones",
    "gap",
    "influence_of",
    "interior_point",
    "more_elements",
    "next_slip",
    "next_states",
    "subdivided",
]
