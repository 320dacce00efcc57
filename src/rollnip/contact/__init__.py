"""The discrete contact problem: which nodes touch, stick or slip, and where the zones end."""

from rollnip.contact.complementarity import Inequalities, interior_point
from rollnip.contact.coupled import active_set, next_states, stick_and_slip
from rollnip.contact.edge_exponents import left_out_of_creep, left_out_of_tractions
from rollnip.contact.ends import ZoneEnd
from rollnip.contact.features import ContactZone, contact_intervals, contact_zones
from rollnip.contact.layout import NEAR_ENOUGH, Layout
from rollnip.contact.mesh import (
    Crowding,
    Subdivision,
    carry,
    cosine_nodes,
    crowding_of,
    cubic_error,
    elements_of_zones,
    more_elements,
    subdivided,
    uncrowded,
)
from rollnip.contact.methods import solve_nodes
from rollnip.contact.missing_slip import TurningSlip, slip_by_turning, slipping_at_edges
from rollnip.contact.problem import (
    ContactProblem,
    ContactState,
    Control,
    State,
    States,
)

__all__ = [
    "NEAR_ENOUGH",
    "ContactProblem",
    "ContactState",
    "ContactZone",
    "Control",
    "Crowding",
    "Inequalities",
    "Layout",
    "State",
    "States",
    "Subdivision",
    "TurningSlip",
    "ZoneEnd",
    "active_set",
    "carry",
    "contact_intervals",
    "contact_zones",
    "cosine_nodes",
    "crowding_of",
    "cubic_error",
    "elements_of_zones",
    "interior_point",
    "left_out_of_creep",
    "left_out_of_tractions",
    "more_elements",
    "next_states",
    "slip_by_turning",
    "slipping_at_edges",
    "solve_nodes",
    "stick_and_slip",
    "subdivided",
    "uncrowded",
]
