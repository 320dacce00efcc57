"""Materials: isotropic linear solids given by their complex modulus E*(s) and Poisson ratio."""

from rollnip.materials.base import Material
from rollnip.materials.elastic import Elastic
from rollnip.materials.energy import Energy, Gent, NeoHookean, Ogden, Slopes, Volumetric, Yeoh
from rollnip.materials.passivity import is_passive
from rollnip.materials.relaxation import (
    creep_compliance,
    exponential_terms,
    memory_integral,
    relaxation_modulus,
    stiffness_of_hardness,
    with_shore_a,
)
from rollnip.materials.scaling import with_stiffness
from rollnip.materials.shift import WLF, Arrhenius, Shift, TabulatedShift
from rollnip.materials.shore import (
    ShoreBand,
    shore_a_band,
    shore_a_modulus,
    shore_a_modulus_log_linear,
    shore_a_of_modulus,
)
from rollnip.materials.thermal import SOURCES, TYPICAL, Thermal
from rollnip.materials.viscoelastic import (
    FractionalZener,
    LossFactor,
    Prony,
    StandardLinearSolid,
    Viscoelastic,
)

__all__ = [
    "SOURCES",
    "TYPICAL",
    "WLF",
    "Arrhenius",
    "Elastic",
    "Energy",
    "FractionalZener",
    "Gent",
    "LossFactor",
    "Material",
    "NeoHookean",
    "Ogden",
    "Prony",
    "Shift",
    "ShoreBand",
    "Slopes",
    "StandardLinearSolid",
    "TabulatedShift",
    "Thermal",
    "Viscoelastic",
    "Volumetric",
    "Yeoh",
    "creep_compliance",
    "exponential_terms",
    "is_passive",
    "memory_integral",
    "relaxation_modulus",
    "shore_a_band",
    "shore_a_modulus",
    "shore_a_modulus_log_linear",
    "shore_a_of_modulus",
    "stiffness_of_hardness",
    "with_shore_a",
    "with_stiffness",
]
