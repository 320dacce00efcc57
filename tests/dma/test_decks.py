"""Prony series of other programs: what is written is read again, and what differs is said."""

import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.dma import prony_deck, read_deck

TERMS = ((3.0, 1e-3), (1.5, 0.02), (0.5, 7.0), (0.25, 30.0))
LAW = rn.WLF(8.9, 101.0, 23.0)
SOLID = rn.Prony(modulus=2.0, terms=TERMS, poisson=0.49, temperature=23.0, shift=LAW)
BARE = rn.Prony(modulus=2.0, terms=TERMS, poisson=0.49)


@pytest.fixture
def deck(tmp_path):
    def write(text, name="deck.inp"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def same(one, other):
    assert one.modulus == pytest.approx(other.modulus, rel=1e-12)
    np.testing.assert_allclose(one.terms, other.terms, rtol=1e-12)
    assert one.poisson == other.poisson
    assert one.shift == other.shift


@pytest.mark.parametrize(("to", "unit"), [("abaqus", "MPa"), ("ansys", "MPa"), ("pyvisco", None)])
def test_what_is_written_is_read_again(deck, to, unit):
    solid = BARE if to == "pyvisco" else SOLID
    found = read_deck(deck(prony_deck(solid, to)), unit=unit, poisson=0.49)
    same(found.material, solid)
    assert found.format == to
    assert found.notes == ()


@pytest.mark.parametrize("to", ["abaqus", "ansys", "pyvisco"])
def test_round_numbers_stay_round(deck, to):
    """Moduli come back as they were written by a person, not as 0.09999999999999998."""
    terms = ((0.1, 1e-3), (0.3, 0.01), (0.7, 0.2), (1.1, 3.0))
    solid = rn.Prony(modulus=0.7, terms=terms, poisson=0.48)
    text = prony_deck(solid, to)
    found = read_deck(deck(text), unit=None if to == "pyvisco" else "MPa", poisson=0.48).material
    assert (found.modulus, found.terms) == (solid.modulus, solid.terms)
    numbers = "0.1, 0.1, 0.001\n0.3, 0.3, 0.1\n"
    abaqus = f"*ELASTIC, MODULI=INSTANTANEOUS\n1.7, 0.48\n*VISCOELASTIC, TIME=PRONY\n{numbers}"
    assert "EX,1,1.7 " in prony_deck(read_deck(deck(abaqus), unit="MPa").material, "ansys")


def test_abaqus_by_hand(deck):
    # E_0 = 8 MPa, g = .5 and .25: E_inf = 2 MPa, E_i = 4 and 2 MPa
    text = (
        "** somebody's deck\n*Material, name=cover\n*Density\n1.1e-9,\n"
        "*Elastic, moduli = INSTANTANEOUS\n 8000., 0.48\n"
        "*Viscoelastic, time=PRONY\n 0.5, 0.5, 0.01\n 0.25, 0.25, 1.\n"
        "*Trs, definition=WLF\n 20., 17.44, 51.6\n*Step\n"
    )
    material = read_deck(deck(text), unit="kPa").material
    assert material.modulus == pytest.approx(2.0)
    np.testing.assert_allclose(material.terms, [(4.0, 0.01), (2.0, 1.0)])
    assert material.poisson == 0.48
    assert material.shift == rn.WLF(17.44, 51.6, 20.0)
    relaxed = text.replace("moduli = INSTANTANEOUS", "moduli = LONG TERM").replace("8000.", "2000.")
    same(read_deck(deck(relaxed), unit="kPa").material, material)
    silent = read_deck(deck(relaxed.replace(", moduli = LONG TERM", "")), unit="kPa")
    same(silent.material, material)
    assert silent.notes == ("*ELASTIC says no MODULI: long term.",)


def test_ansys_by_hand(deck):
    text = (
        "! card\nMP,EX,1,8,\nMP,NUXY,1,0.48\nMP,DENS,1,1.1e-9\n"
        "TB,PRONY,1,1,2,SHEAR\nTBTEMP,0\nTBDATA,,0.5,0.01\nTBDATA,,0.25,1\n"
        "TB,PRON,1,1,2,BULK\nTBDATA,1,0.5,0.01,0.25,1\n"
        "TB,SHIFT,1,1,3,WLF\nTBDATA,1,20,17.44,51.6\n"
    )
    found = read_deck(deck(text, "card.mac"), unit="N/mm2")
    assert found.material.modulus == pytest.approx(2.0)
    np.testing.assert_allclose(found.material.terms, [(4.0, 0.01), (2.0, 1.0)])
    assert found.material.shift == rn.WLF(17.44, 51.6, 20.0)
    assert found.notes == ()


def test_pyvisco_by_hand(deck):
    text = "i,tau_i,alpha_i,G_0,G_i\n-,s,-,kPa,kPa\n1,0.01,0.5,3000,1500\n2,1,0.25,3000,750\n"
    material = read_deck(deck(text, "prony.csv"), poisson=0.5).material
    # E = 3 G of an incompressible solid
    assert material.modulus == pytest.approx(9.0 * 0.25)
    np.testing.assert_allclose(material.terms, [(4.5, 0.01), (2.25, 1.0)])


def test_a_deck_is_three_pairs_a_line(deck):
    lines = [line for line in prony_deck(SOLID, "ansys").splitlines() if line.startswith("TBDATA")]
    assert [line.split(",")[1] for line in lines] == ["1", "7", "1", "7", "1"]
    assert all(len(line.split(",")) <= 8 for line in lines)
    ratios = [float(cell) for cell in lines[0].split(",")[2::2]]
    np.testing.assert_allclose(ratios, np.array([3.0, 1.5, 0.5]) / 7.25)


def test_a_bulk_that_relaxes_otherwise_is_said(deck):
    text = "*ELASTIC, MODULI=LONG TERM\n2, 0.4\n*VISCOELASTIC, TIME=PRONY\n0.5, 0, 1\n"
    (note,) = read_deck(deck(text), unit="MPa").notes
    assert "Shear and bulk relax differently" in note
    rubber = read_deck(deck(text.replace("0.4", "0.4995")), unit="MPa")
    assert rubber.notes == ()


def test_what_a_deck_cannot_hold_is_said():
    law = rn.Arrhenius(60.0, 23.0, "entropic")
    solid = rn.Prony(modulus=2.0, terms=TERMS, poisson=0.5, temperature=40.0, shift=law)
    text = prony_deck(solid, "abaqus")
    assert "** the shift law is not written; the series holds at 23 degC" in text
    assert "** vertical shifts are not written; moduli are those at 23 degC" in text
    assert "hybrid elements" in text
    assert "*TRS" not in text


MPA = {"unit": "MPa"}


@pytest.mark.parametrize(
    ("text", "options", "said"),
    [
        ("*ELASTIC\n2,.4\n*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", {}, "`unit` must say"),
        (
            "*ELASTIC\n2,.4\n*VISCOELASTIC, TIME=CREEP\n.5,1\n",
            {"unit": "MPa"},
            "TIME=PRONY",
        ),
        ("*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", MPA, "*ELASTIC once, has it 0 times"),
        (
            "*ELASTIC\n2,.4\n*VISCOELASTIC, TIME=PRONY\n.7,.5,1\n.3,0,2\n",
            {"unit": "MPa"},
            "less than 1",
        ),
        ("*ELASTIC\n2\n*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", MPA, "`poisson` must be"),
        (
            "*ELASTIC\n2,x\n*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n",
            {"unit": "MPa"},
            'where "x" stands',
        ),
        ("TB,PRONY,1,,1,SHEAR\nTBDATA,1,.5,1\n", MPA, "must hold MP,EX"),
        ("i,tau_i\n-,s\n1,2\n", {}, "alpha_i and E_0 or G_0"),
        ("nothing\n", MPA, "must hold *VISCOELASTIC"),
        ("*ELASTIC\n2,.4\n*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n", {"unit": "mm"}, "is a length"),
    ],
)
def test_what_is_no_series_is_refused(deck, text, options, said):
    with pytest.raises(InvalidInputError) as error:
        read_deck(deck(text), **options)
    assert said in str(error.value)


def test_an_unknown_format_is_refused():
    with pytest.raises(InvalidInputError, match="`to` must be abaqus, ansys or pyvisco"):
        prony_deck(SOLID, "nastran")


@pytest.mark.parametrize(
    "text",
    [
        "i,tau_i,alpha_i,E_0,E_i\n-,s,-,MPa,MPa\n1,0.01\n",
        "i,tau_i,alpha_i,E_0,E_i\n",
        "*ELASTIC\n2,.4\n*VISCOELASTIC, TIME=PRONY\n.5\n*TRS\n20\n",
        "*ELASTIC\n\n*VISCOELASTIC, TIME=PRONY\n.5,.5,1\n",
        "TB,PRONY\nTBDATA\nMP,EX,1,8\n",
        'tau_i,"' + 200_000 * "x" + "\n",
    ],
)
def test_broken_decks_are_refused_in_words(deck, text):
    with pytest.raises(InvalidInputError):
        read_deck(deck(text, "broken.csv"), unit="MPa", poisson=0.4)


def test_ratios_that_add_up_to_one_leave_the_slowest_term_as_the_plateau(deck):
    text = "i,tau_i,alpha_i,E_0,E_i\n-,s,-,MPa,MPa\n1,1e6,0.25,8,2\n2,0.01,0.75,8,6\n"
    found = read_deck(deck(text, "prony.csv"), poisson=0.5)
    assert found.material.modulus == pytest.approx(2.0)
    assert found.material.terms == ((pytest.approx(6.0), 0.01),)
    assert "of 1e+06 s, is taken for it" in found.notes[0]
