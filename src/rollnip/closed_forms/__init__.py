"""Closed forms of rolling contact: exact or asymptotic solutions for checking a computation.

Pure functions in mm, N, MPa, s. x points to the leading edge, pressure is positive, shear is the
traction on the upper roller along +x, and T > 0 where the upper roller drives. Every formula names
its source and its range.
"""

from rollnip.closed_forms.dissimilar import (
    FullStick,
    VanishingFriction,
    free_rolling_full_stick,
    free_rolling_vanishing_friction,
)
from rollnip.closed_forms.hertz import (
    HertzEllipse,
    HertzLine,
    InteriorStress,
    contact_modulus,
    effective_radius,
    hertz_ellipse,
    hertz_line,
)
from rollnip.closed_forms.hetenyi import end_loaded_rollers
from rollnip.closed_forms.partial_slip import (
    Carter,
    Cattaneo,
    carter,
    carter_at_creepage,
    cattaneo,
)
from rollnip.closed_forms.plate import PlateContact, plate_on_foundation, plate_stiffness
from rollnip.closed_forms.simplified import (
    SimplifiedRolling,
    WinklerContact,
    simplified_rolling,
    simplified_rolling_at_creepage,
    winkler_contact,
)
from rollnip.closed_forms.strip import (
    ViscoelasticStrip,
    viscoelastic_strip,
    viscoelastic_strip_of_width,
)
from rollnip.closed_forms.thin_layer import (
    ThinLayer,
    thin_compressible_layer,
    thin_incompressible_layer,
)
from rollnip.closed_forms.viscoelastic import Hunter, hunter
from rollnip.closed_forms.waviness import WavyContact, wavy_contact

__all__ = [
    "Carter",
    "Cattaneo",
    "FullStick",
    "HertzEllipse",
    "HertzLine",
    "Hunter",
    "InteriorStress",
    "PlateContact",
    "SimplifiedRolling",
    "ThinLayer",
    "VanishingFriction",
    "ViscoelasticStrip",
    "WavyContact",
    "WinklerContact",
    "carter",
    "carter_at_creepage",
    "cattaneo",
    "contact_modulus",
    "effective_radius",
    "end_loaded_rollers",
    "free_rolling_full_stick",
    "free_rolling_vanishing_friction",
    "hertz_ellipse",
    "hertz_line",
    "hunter",
    "plate_on_foundation",
    "plate_stiffness",
    "simplified_rolling",
    "simplified_rolling_at_creepage",
    "thin_compressible_layer",
    "thin_incompressible_layer",
    "viscoelastic_strip",
    "viscoelastic_strip_of_width",
    "wavy_contact",
    "winkler_contact",
]
