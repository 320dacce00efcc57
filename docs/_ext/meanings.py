"""What each key of a case file means, where its schema does not say so or says it briefly."""

from __future__ import annotations

from typing import Any

_SHARED = {
    "conductivity": "Thermal conductivity.",
    "density": "Mass per volume.",
    "heat_capacity": "Heat capacity per mass.",
    "expansion": "Linear thermal expansion; without it the size does not follow the temperature.",
    "model": "Selects this table.",
    "modulus": "Relaxed Young's modulus; or give `shore_a`.",
    "poisson": "Poisson's ratio; 0.5 is incompressible, as solid rubber nearly is.",
    "relaxation_time": "Relaxation time.",
    "stiffening": "Glassy modulus less relaxed modulus.",
    "temperature": "Temperature of the material; needs `shift`.",
    "shift": "How the relaxation times depend on the temperature.",
    "reference": "Temperature at which the relaxation times are given.",
    "reading_time": "Time after contact at which the hardness was read; 3 s if left out.",
    "shore_a": "Shore A hardness at 23 degC, which fixes the relaxed modulus.",
    "thermal": "Typical thermal properties by name; other keys replace single ones.",
    "energy": 'Strain energy, for geometry `"finite"`; neo-Hookean if left out.',
    "volumetric": "Law of the change of volume, where compressible.",
}
_OF_TABLE: dict[str, dict[str, str]] = {
    "CaseTable": {
        "title": "Any text; it heads the results.",
        "nip": "Load, drive, friction, speed.",
        "model": "How the geometry is modelled.",
        "solver": "How accurate the solution must be.",
        "face": "How the nip varies along the rollers.",
        "sheet": "What runs between the rollers.",
        "heat": "The surroundings that take the heat.",
        "upper": "The upper roller.",
        "lower": "The lower roller.",
        "materials": "Materials by name, for layers and cores.",
    },
    "NipTable": {
        "load": "Line load: force that presses the rollers together, per length of roller.",
        "approach": "How much closer the axles are than at first touch.",
        "traction": "Force along the surface that the upper roller puts on the lower one, per "
        "length; positive where the upper roller drives.",
        "creepage": "Difference of the circumferential speeds over their mean; positive where the "
        "upper roller is the faster one.",
        "torque_lower": "Driving torque on the lower axle, per length of roller; 0: an idler.",
        "friction": "Coefficient of friction; it may be left out where the sheet has its own "
        "on both sides.",
        "speed": "Rolling speed V.",
        "face_width": "Length of the rollers, for totals in N, N m and W.",
    },
    "ModelTable": {"geometry": "Geometry model."},
    "SolverTable": {"tolerance": "Relative accuracy wanted."},
    "RollerTable": {
        "radius": "Outer radius, over the layers; `inf`: a plane.",
        "core": "Rigid, or the material of a half-space below the layers.",
        "layers": "From the surface to the core.",
        "profile": "CSV file of measured heights over the smooth surface.",
        "shaft": "The shaft that carries the core; for `[face]`.",
        "heat": "The ways in which the roller loses heat; for `[heat]`.",
    },
    "LayerTable": {"thickness": "Thickness of the layer.", "material": "What it is made of."},
    "SheetTable": {
        "thickness": "Thickness of the sheet; needed without `kind`.",
        "modulus": "Young's modulus in the plane, along the nip; needed without `kind`.",
        "poisson": "Poisson's ratio.",
        "modulus_thickness": "Modulus across the thickness; that in the plane if left out.",
        "tension_in": "Tension per width on the inlet side.",
        "tension_out": "Tension per width on the outlet side.",
        "friction_upper": "Friction on the upper roller; `nip.friction` if left out.",
        "friction_lower": "Friction on the lower roller; `nip.friction` if left out.",
        "bending": "Whether bending stiffness counts; if left out, where that shows.",
    },
    "FaceTable": {
        "length": "Length over which the rollers can touch.",
        "skew": "Angle between the axes, in the plane of contact.",
        "nip_angle": "Angle of the line from the lower to the upper axis against the vertical; "
        "it counts only with a `density`.",
        "end_radius": "Radius that rounds the ends of the shorter face; 0: sharp.",
    },
    "ArmForceTable": {
        "force": "Force on the arm; negative where it lifts.",
        "lever": "Its distance from the pivot.",
    },
    "ShaftTable": {
        "bearing_distance": "Between the centres of the bearings.",
        "bore": "Diameter of the hole through the core; 0: solid.",
        "journal_diameter": "Diameter between face and bearing; rigid if left out.",
        "modulus": "Young's modulus of core and journals; steel, 206 GPa, if left out.",
        "poisson": "Poisson's ratio of core and journals.",
        "density": "Density of the core; weight does not count if left out.",
        "covering": "How the outermost layer varies along the face.",
    },
    "CrownTableTable": {
        "height": "Diameter in the middle less that at the ends.",
        "shape": "Shape of the crown.",
        "diameter": "Diameter at these places, over the nominal one.",
        "file": "CSV file with the columns `y` and `diameter`.",
    },
    "JournalStepTable": {"diameter": "Diameter of this part."},
    "CoveringTableTable": {"thickness": "Thickness of the outermost layer at these places."},
    "HeatTable": {
        "ambient": "Temperature of the air around the rollers.",
        "start": "Temperature of everything when a warm-up begins; the ambient one if left out.",
        "sheet": "The sheet that takes heat along.",
    },
    "RollerHeatTable": {
        "core": "Insulated, held at a temperature, or cooled by a fluid.",
        "shell": "Wall of the core under the coverings.",
    },
    "CoolantTable": {
        "coolant": "Temperature of the fluid.",
        "film": "Film coefficient between core and fluid.",
    },
    "ShellTable": {"thickness": "Thickness of the wall."},
    "PassingSheetTable": {"temperature": "Temperature at which the sheet enters the nip."},
    "ElasticTable": {
        "modulus": "Young's modulus.",
        "shear_modulus": "Shear modulus.",
        "shore_a": "Shore A hardness, 20 to 95; the modulus follows from Gent's formula.",
    },
    "LossFactorTable": {
        "modulus": "Storage modulus; or give `shore_a`.",
        "loss_factor": "Loss factor at every frequency.",
    },
    "PronyTable": {"terms": "One table for each relaxation time."},
    "FractionalZenerTable": {"order": "Order of the derivative, above 0 and at most 1."},
    "TermTable": {"modulus": "Modulus that relaxes with this time."},
    "YeohTable": {"second": "$b = C_{20}/C_{10}$", "third": "$c = C_{30}/C_{10}$"},
    "GentTable": {"limit": "$m = J_m$, the largest $I_1 - 3$."},
    "OgdenTable": {"terms": "One table for each term."},
    "OgdenTermTable": {"weight": "$m_n$", "exponent": "$a_n$"},
    "WlfTable": {"c1": "First constant, $C_1$.", "c2": "Second constant, $C_2$."},
    "ArrheniusTable": {"activation_energy": "Activation energy."},
    "TabulatedTable": {"points": "Measured factors of the relaxation times."},
    "PointTable": {
        "temperature": "Where it was measured.",
        "factor": "Factor of the relaxation times, or of the moduli.",
    },
}


def meaning(table: str, key: str, part: dict[str, Any]) -> str:
    """Return what a key of a table means; its schema is asked last but for the shared keys."""
    own = _OF_TABLE.get(table, {}).get(key)
    described = str(part.get("description", ""))
    if own is not None:
        return own
    if key in _SHARED:
        return _SHARED[key]
    if not described or described.startswith("A number"):
        raise KeyError(f"docs/_ext/meanings.py: {table}.{key} has no meaning.")
    return described
