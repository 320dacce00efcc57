"""Sources of the expected figures, each with its kind and its full citation."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Kind(StrEnum):
    """Kind of source of an expected figure."""

    CLOSED_FORM = "closed form"
    """A formula, evaluated by `rollnip.closed_forms` or beside the case."""
    PRINTED = "printed number"
    """A number as a publication prints it."""
    PROGRAM = "independent program"
    """A number from another program than the engine."""
    LAW = "law"
    """A law that every solution obeys, or two problems that must have one answer."""


@dataclass(frozen=True, slots=True)
class Source:
    """A source of expected figures.

    Attributes
    ----------
    kind : what stands behind its figures.
    text : full citation; of a program or a law what it is and, where there is one, its test.
    """

    kind: Kind
    text: str

    def __str__(self) -> str:
        return self.text


_PAPER = (
    "G.F.M. Braat, J.J. Kalker, Theoretical and experimental analysis of the rolling contact "
    "between two cylinders coated with multilayered, viscoelastic rubber, Contact Mechanics, WIT "
    "Press 1993, 119-126"
)
_JOHNSON = "K.L. Johnson, Contact Mechanics, Cambridge University Press 1985"

HERTZ = Source(
    Kind.CLOSED_FORM,
    "H. Hertz, Über die Berührung fester elastischer Körper, J. reine angew. Math. 92 (1882) "
    f"156-171; {_JOHNSON}, eqs 4.43 and 4.45",
)
CARTER = Source(
    Kind.CLOSED_FORM,
    "F.W. Carter, On the action of a locomotive driving wheel, Proc. R. Soc. Lond. A 112 (1926) "
    f"151-157; {_JOHNSON}, section 8.3",
)
BENTALL_JOHNSON = Source(
    Kind.CLOSED_FORM,
    "R.H. Bentall, K.L. Johnson, Slip in the rolling contact of two dissimilar elastic rollers, "
    f"Int. J. Mech. Sci. 9 (1967) 389-404; {_JOHNSON}, section 8.2",
)
HUNTER = Source(
    Kind.CLOSED_FORM,
    "S.C. Hunter, The rolling contact of a rigid cylinder with a viscoelastic half space, "
    "J. Appl. Mech. 28 (1961) 611-617, evaluated to five digits at E_g/E_r = 2",
)
MAY_MORRIS_ATACK = Source(
    Kind.CLOSED_FORM,
    "W.D. May, E.L. Morris, D. Atack, Rolling friction of a hard cylinder over a viscoelastic "
    f"material, J. Appl. Phys. 30 (1959) 1713-1724; {_JOHNSON}, section 9.4",
)
WANG_KNOTHE = Source(
    Kind.PRINTED,
    "G. Wang, K. Knothe, Stress analysis for rolling contact between two viscoelastic cylinders, "
    "J. Appl. Mech. 60 (1993) 310-317",
)
THIN_LAYER = Source(
    Kind.CLOSED_FORM, f"{_JOHNSON}, section 5.8: thin layer on a rigid base, leading terms"
)
KALKER_SIMPLIFIED = Source(
    Kind.CLOSED_FORM,
    "J.J. Kalker, Simplified theory of rolling contact, Delft Progress Report C1 (1973) 1-10",
)
PLATE_ON_SPRINGS = Source(
    Kind.CLOSED_FORM,
    "M. Hetényi, Beams on Elastic Foundation, University of Michigan Press 1946: thin plate on a "
    f"bed of springs, here under a cylinder; {_JOHNSON}, section 5.8",
)
LAME = Source(
    Kind.CLOSED_FORM,
    "G. Lamé, Leçons sur la théorie mathématique de l'élasticité, Bachelier 1852; S.P. "
    "Timoshenko, J.N. Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill 1970, chapter 4",
)
FLAMANT = Source(
    Kind.CLOSED_FORM,
    f"A. Flamant, C. R. Acad. Sci. Paris 114 (1892) 1465-1468; {_JOHNSON}, sections 2.2 and 2.3",
)
MCEWEN = Source(
    Kind.CLOSED_FORM,
    "E. McEwen, Stresses in elastic cylinders in contact along a generatrix, Phil. Mag. 40 (1949) "
    f"454-459; {_JOHNSON}, section 4.2",
)
WESTERGAARD = Source(
    Kind.CLOSED_FORM,
    "H.M. Westergaard, Bearing pressures and cracks, J. Appl. Mech. 6 (1939) A49-A53; "
    f"{_JOHNSON}, section 13.2",
)
BONDED_LAYER_FORM = Source(
    Kind.CLOSED_FORM,
    "C_zz of one bonded layer in plane strain, derived from the layer equations (theory, section "
    "on layers)",
)
ELLEA = Source(
    Kind.PRINTED,
    "E. Levenberg, ELLEA1: Isotropic Layered Elastic Analysis in Excel, Technical University of "
    "Denmark 2016: printed deflection under a disc",
)
CONFIGURATION_TWO = Source(
    Kind.PROGRAM,
    f"Configuration II of {_PAPER}; its linear equations solved by a program of uniform elements "
    "and Fourier integrals, tests/judges/linear_rolling.py, to the digits shown",
)
FIGURE_FOUR = Source(
    Kind.PROGRAM,
    f"Figure 4 of {_PAPER}, top layer 0.1 mm; the linear equations solved by a program of uniform "
    "elements and Fourier integrals, tests/judges/linear_rolling.py, to the digits shown",
)
FINITE_ELEMENTS = Source(
    Kind.PROGRAM,
    "Finite elements at finite strain: incompressible neo-Hookean covering on a rigid core "
    "against a rigid roller, tests/data/finite_strain_fe.json; mesh-converged to 0.1 % (approach, "
    "peak), 0.3 % (edges) and 0.5 % (creepage); such nips are run again by "
    "tests/judges/finite_elements",
)
COLLOCATION = Source(
    Kind.PROGRAM,
    "Chebyshev collocation of the integral equation of one bonded layer (the problem of P. "
    "Meijers, Appl. Sci. Res. 18 (1968) 353-383), converged to 11 digits; it is run again in "
    "tests/verification/test_bonded_layers.py",
)
FORTY_DIGITS = Source(
    Kind.PROGRAM,
    "Integration of the layer equations with 40 digits; it is run again in "
    "tests/verification/test_kernels.py",
)
BETTI = Source(Kind.LAW, "Betti's reciprocal theorem: C_zx = -C_xz")
PASSIVITY = Source(Kind.LAW, "Passivity: layers neither push by themselves nor give energy away")
ENERGY = Source(Kind.LAW, "Conservation of energy in steady rolling")
EQUILIBRIUM = Source(
    Kind.LAW, "Equilibrium of a roller: a pressure on a bare rigid roller passes through its axle"
)
DIMENSIONS = Source(
    Kind.LAW, "Dimensional analysis: lengths and moduli times 1000 leave strains as they are"
)
MIRROR = Source(Kind.LAW, "Symmetry: swapping the rollers turns the signs of shear and creepage")
PLIES = Source(Kind.LAW, "Identity: one layer cut into plies is the layer")
ONE_MATERIAL = Source(
    Kind.LAW, "Identity: layers of the core's own material are the half-space, where Hertz holds"
)
CORRESPONDENCE = Source(
    Kind.LAW, "Correspondence principle: V -> 0 is elastic with E0, V -> infinity with E0 + k"
)

END_LOADED_ROLLERS = Source(
    Kind.CLOSED_FORM,
    "M. Hetényi, Beams on Elastic Foundation, University of Michigan Press 1946: a finite beam "
    "with a force at each end; here two rollers on each other",
)
BENDING = Source(
    Kind.CLOSED_FORM,
    "Slender beam on two supports, B apart, under an even load w over the length L between them: "
    "w L^3 (12 B - 7 L)/(384 E I)",
)
EQUILIBRIUM_OF_FACE = Source(
    Kind.LAW, "Equilibrium of rollers: the bearing forces of each balance the load of the nip"
)
IMPRESSION = Source(Kind.LAW, "Identity: the impression of a face is read as that face")
TRADE_RULE = Source(
    Kind.LAW,
    "Rule of the trade for rubber-covered rollers: .005 in of deflection change the nip by 5 to "
    "40 pli",
)

CONDUCTION = Source(
    Kind.CLOSED_FORM,
    "H. S. Carslaw & J. C. Jaeger, Conduction of Heat in Solids, Oxford 1959: steady rings and "
    "slabs with even heat",
)
CONTACT_OF_HALF_SPACES = Source(
    Kind.CLOSED_FORM,
    "H. S. Carslaw & J. C. Jaeger, Conduction of Heat in Solids, Oxford 1959: two half-spaces "
    "brought into contact",
)
EXPANSION = Source(Kind.LAW, "Identity: an incompressible covering has the volume of its expansion")
ENERGY_OF_ROLLERS = Source(Kind.LAW, "Energy: in the steady state all heat of the nip leaves")
PERFECT_COOLING = Source(Kind.LAW, "Limit: what is cooled without limit stays the cold nip")
SEMENOV = Source(
    Kind.CLOSED_FORM,
    "N. Semenov, Z. Phys. 48 (1928) 571-582: one temperature, heat e^(beta T) against cooling in "
    "proportion; the last steady state at a rise of 1/beta",
)
NO_SHEET = Source(
    Kind.LAW, "Identity: a sheet without stiffness leaves the nip without it, the smaller friction"
)
DIRECT_SHEET = Source(
    Kind.PROGRAM,
    "A sheet between two rollers by uniform elements and constant tractions, "
    "tests/judges/sheet.py, extrapolated to first order; tests/data/sheet_direct.json",
)
