"""Files as instruments write them: all written here, from the descriptions of the formats."""

import numpy as np
import pytest

from rollnip._errors import InvalidInputError
from rollnip.dma import read_dma, read_tables
from rollnip.dma.heads import read_head

from .conftest import write_workbook

# f [Hz], T [degC], E' [MPa], E'' [MPa]
VALUES = (
    (1.0, 20.0, 10.0, 2.0),
    (10.0, 20.0, 12.5, 2.5),
    (1.0, 40.0, 8.0, 1.0),
    (10.0, 40.0, 9.0, 1.5),
)
F, T, STORAGE, LOSS = (np.array(column) for column in zip(*VALUES, strict=True))
ABSOLUTE, PHASE = np.hypot(STORAGE, LOSS), np.degrees(np.arctan2(LOSS, STORAGE))


def lines(*columns, mark=";", comma=True, form="{:.10g}"):
    rows = [mark.join(form.format(v) for v in row) for row in zip(*columns, strict=True)]
    return "\n".join(row.replace(".", ",") if comma else row for row in rows) + "\n"


@pytest.fixture
def file(tmp_path):
    def write(text, name="export.txt", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return path

    return write


def check(data, factor=1.0):
    np.testing.assert_allclose(data.frequency, F)
    np.testing.assert_allclose(data.temperature, T, atol=1e-9)
    np.testing.assert_allclose(data.storage, factor * STORAGE, rtol=1e-8)
    np.testing.assert_allclose(data.loss, factor * LOSS, rtol=1e-8)


@pytest.mark.parametrize(
    ("heads", "scale"),
    [
        ("f;T;E';E''\nHz;°C;MPa;MPa\n", 1.0),
        ("f;T;E';E''\n[Hz];[°C];[Pa];[Pa]\n", 1e6),
        ("Frequency (Hz);Temperature (°C);Storage modulus E' (Pa);Loss modulus E'' (Pa)\n", 1e6),
        ("f / Hz;T / °C;E' / kPa;E'' / kPa\n", 1e3),
        ("Frequenz [Hz];Temperatur [°C];Speichermodul E' [N/mm²];Verlustmodul E'' [N/mm²]\n", 1.0),
        (
            "Frequenz in Hz;Probentemperatur in °C;Speichermodul E' in MPa;"
            "Verlustmodul E'' in MPa\n",
            1.0,
        ),
        ("f, Hz;T, degC;E_stor, MPa;E_loss, MPa\n", 1.0),
    ],
)
def test_units_stand_below_the_heads_or_in_them_in_any_form(file, heads, scale):
    check(read_dma(file(heads + lines(F, T, scale * STORAGE, scale * LOSS))))


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"]
)
@pytest.mark.parametrize("mark", [";", "\t"])
def test_encodings(file, encoding, mark):
    heads = mark.join(("Frequenz / Hz", "Temperatur / °C", "E' / MPa", "E'' / MPa")) + "\n"
    path = file(heads + lines(F, T, STORAGE, LOSS, mark=mark), encoding=encoding)
    check(read_dma(path))
    named = {"utf-8-sig": "UTF-8", "cp1252": "Windows-1252"}.get(encoding, encoding[:6].upper())
    assert named.removesuffix("-") in read_tables(path).text()
    assert "decimal commas" in read_tables(path).text()


def test_a_preamble_and_remarks_are_passed_over(file):
    text = (
        "Messung;DMA 42 Nr. 17\nPrüfer;M. Muster\nProbe;NR 60; 2,0 mm\nDatum;1.2.2026; 12:00\n\n"
        "Frequenz;Temperatur;Speichermodul E';Verlustmodul E'';Kraft\nHz;°C;MPa;MPa;N\n"
    )
    body = lines(F, T, STORAGE, LOSS, np.full(4, 1.5))
    path = file(text + body + "\nEnde der Messung\n", encoding="cp1252")
    check(read_dma(path))
    shown = read_tables(path).text()
    assert "heads in line 6" in shown
    assert "5 lines outside of tables (lines 1, 2, 3, 4, 13)" in shown
    assert "Kraft" in shown
    assert "passed over" in shown
    assert "storage modulus E (in MPa): 8.000 MPa to 12.50 MPa" in shown


@pytest.mark.parametrize(
    ("heads", "columns"),
    [
        ("f [Hz];T [°C];|E*| [MPa];Phasenwinkel [°]\n", (ABSOLUTE, PHASE)),
        ("f [Hz];T [°C];Komplexer Modul |E*| [MPa];delta [rad]\n", (ABSOLUTE, np.radians(PHASE))),
        ("f [Hz];T [°C];E* [MPa];Verlustfaktor tan delta [-]\n", (ABSOLUTE, LOSS / STORAGE)),
        ("f [Hz];T [°C];E' [MPa];tan(δ)\n", (STORAGE, LOSS / STORAGE)),
        ("f [Hz];T [°C];E' [MPa];Phase angle [deg]\n", (STORAGE, PHASE)),
    ],
)
def test_size_and_phase_give_both_moduli(file, heads, columns):
    check(read_dma(file(heads + lines(F, T, *columns))))


def test_angular_frequencies_and_shear(file):
    text = "omega;T;G';G''\nrad/s;°C;Pa;Pa\n" + lines(
        2.0 * np.pi * F, T, 1e6 * STORAGE / 3.0, 1e6 * LOSS / 3.0
    )
    check(read_dma(file(text)))
    check(read_dma(file(text.replace("omega", "Kreisfrequenz ω").replace("rad/s", "1/s"))))


def test_rows_with_gaps_are_left_out_and_said(file):
    body = lines(F, T, STORAGE, LOSS) + "5;30;;1,2\n6;30;9,5;---\n"
    path = file("f [Hz];T [°C];E' [MPa];E'' [MPa]\n" + body)
    check(read_dma(path))
    assert "left out: 2 rows without a value (lines 6, 7)" in read_tables(path).text()


TRIOS = """Filename\tsample 4.tri
Instrument name\tRSA-G2
operator\tsomebody
Sample name\tcover 60

[step]
Step name\tFrequency sweep ({first} °C)
Number of points\t2
Variables\tAngular frequency\tStorage modulus\tLoss modulus\tTan(delta)\tStep time
\trad/s\tMPa\tMPa\t\ts
{one}
[step]
Step name\tFlow ramp
Number of points\t2
Variables\tShear rate\tViscosity\tStep time
\t1/s\tPa.s\ts
Data point\t1\t100\t1
Data point\t2\t90\t2

[step]
Step name\tFrequency sweep ({second} °C)
Variables\tAngular frequency\tStorage modulus\tLoss modulus\tTan(delta)\tStep time
\trad/s\tMPa\tMPa\t\ts
{two}
"""


def trios():
    rows = [
        f"Data point\t{2 * np.pi * f:.10g}\t{s}\t{g}\t{g / s:.4f}\t{10 * f}"
        for f, _, s, g in VALUES
    ]
    return TRIOS.format(first=20.0, second=40.0, one="\n".join(rows[:2]), two="\n".join(rows[2:]))


def test_the_steps_of_trios(file):
    path = file(trios())
    check(read_dma(path, modulus="E"))
    shown = read_tables(path).text()
    assert "temperature 20 degC from line 7" in shown
    assert "temperature 40 degC from line" in shown
    assert "step 3" in shown
    first = read_tables(path).tables[0]
    np.testing.assert_allclose(first.values["frequency"], F[:2])
    assert first.name == "table 1, step 1: Frequency sweep (20.0 °C)"
    with pytest.raises(InvalidInputError, match="`modulus` must say"):
        read_dma(path)
    with pytest.raises(InvalidInputError, match="at least 4 measurements, got 2"):
        read_dma(path, modulus="E", tables=(2,))
    with pytest.raises(InvalidInputError, match="has no table 7, it has 2"):
        read_dma(path, modulus="E", tables=(7,))


def test_a_step_does_not_inherit_the_temperature_of_another(file):
    text = trios().replace(" (40.0 °C)", "")
    with pytest.raises(InvalidInputError, match='a column "temperature", or `temperature` must be'):
        read_dma(file(text), modulus="E")


@pytest.mark.parametrize(
    "heads", ["Freq\tG'\tG\"\tTemp\tStrain\nrad/s\tPa\tPa\t°C\t%\n", "w\tG'\tG''\n", ""]
)
def test_reptate(file, heads):
    strain = np.full(4, 0.9)
    columns = (2.0 * np.pi * F, 1e6 * STORAGE / 3.0, 1e6 * LOSS / 3.0, np.full(4, 20.0), strain)
    wide = 5 if "Temp" in heads else 3
    body = lines(*columns[:wide], mark="\t", comma=False)
    text = "T=20;Mw=94.9;chem=PI;label=sample_1;\n" + heads + body
    data = read_dma(file(text, "sample.osc"))
    np.testing.assert_allclose(data.frequency, F)
    np.testing.assert_allclose(data.storage, STORAGE)
    np.testing.assert_allclose(data.loss, LOSS)
    np.testing.assert_allclose(data.temperature, 20.0)
    blanks = read_dma(file(text.replace("\t", "   "), "blanks.osc"))
    np.testing.assert_allclose(blanks.storage, STORAGE)


def test_eplexor_sheets(tmp_path):
    path = tmp_path / "eplexor.ods"
    heads = [
        ["f", "T", "E'", "E''", "|E*|", "tan delta", "static force"],
        ["Hz", "°C", "MPa", "MPa", "MPa", "-", "N"],
    ]
    body = [[f, t, s, g, float(np.hypot(s, g)), g / s, 1.0] for f, t, s, g in VALUES]
    gap = [5.0, 25.0, "---", 1.0, "---", "---", 1.0]
    sheets = {
        "Parameters": [["Operator", "somebody"], ["Sample", "cover 60"]],
        "Exported Data": [*heads, *body[:2], gap],
        "Exported Data 2": [*heads, *body[2:]],
    }
    write_workbook(path, sheets)
    check(read_dma(path))
    assert "left out: 1 row without a value (line 5)" in read_tables(path).text()
    assert len(read_tables(path, sheet="Exported Data").tables) == 1
    with pytest.raises(InvalidInputError, match='has no sheet "data"'):
        read_dma(path, sheet="data")


def test_sheets_named_after_their_temperature(tmp_path):
    path = tmp_path / "sheets.ods"
    heads = ["f / Hz", "E' / MPa", "E'' / MPa"]
    body = [[f, s, g] for f, _, s, g in VALUES]
    write_workbook(path, {"20 °C": [heads, *body[:2]], "40 °C": [heads, *body[2:]]})
    data = read_dma(path)
    check(data)
    assert data.rows[0] == 'sheet "20 °C", row 2'
    assert "temperature 40 degC from the name of the sheet" in read_tables(path).text()


def test_the_layout_of_pyvisco(file):
    rows = lines(F, STORAGE, LOSS, T, np.array([0, 0, 1, 1]), mark=",", comma=False)
    check(read_dma(file("f,E_stor,E_loss,T,Set\nHz,MPa,MPa,C,-\n" + rows)))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("f;T;E';E''\n1;20;1;1\n", 'line 1: column "E\'" must say its unit; write "E\' [MPa]"'),
        ("f [Hz];T [°C];E' [Mpa];E'' [Mpa]\n1;20;1;1\n", 'unit of column "E\' [Mpa]"'),
        ("f [Hz];T [°C];E' [MPa];E'' [MPa]\n1;20;1.234,5;1\n", 'line 2: "1.234,5" cannot be read'),
        ("Zeit [s];Kraft [N]\n1;2\n", "holds no table whose heads are known"),
        ("1;2;3\n4;5;6\n", "holds no table whose heads are known"),
        (
            "f [Hz];T [°C];Storage moduls [MPa];E'' [MPa]\n1;20;1;1\n",
            '"storage moduls [mpa]" may mean "storage modulus"',
        ),
        ("f [Hz];f [Hz];E' [MPa];E'' [MPa];T [°C]\n1;1;1;1;1\n", "both say frequency; rename"),
        ("f [Hz];T [°C];E' [MPa];E'' [MPa]\n", "table 1: it has no rows of numbers; write them"),
        ("f [Hz]\tT [°C]\tE' [MPa]\tE'' [MPa]\n", "table 1: it has no rows of numbers"),
        ("f [Hz],T [°C],E' [MPa],E'' [MPa]\n\n", "table 1: it has no rows of numbers"),
        ("Date; 3 May\nf;T;E';E''\nHz;C;MPa;MPa\n", "table 1: it has no rows of numbers"),
        ("f [Hz];T [°C];E' [MPa];E'' [MPa]\n" + "1e-300;20;1;1\n" * 4, "between 1e-30 and 1e+30"),
        ("f [Hz];T [°C];E' [MPa];E'' [MPa]\n" + "1;1e300;1;1\n" * 4, "at most 10000 degC"),
        ("", "holds no rows; write one line of heads over the numbers"),
        ("T [°C];E' [MPa];E'' [MPa]\n20;1;1\n", "it has no column of frequencies"),
        ("|E*| [MPa];T [°C];f [Hz]\n20;1;1\n", "it lacks the loss modulus, tan delta or the phase"),
    ],
)
def test_messages_say_what_to_rewrite(file, text, said):
    with pytest.raises(InvalidInputError) as error:
        read_dma(file(text))
    assert said in str(error.value)


def test_a_table_is_taken_once(file):
    """Given twice, its rows counted twice, and intervals were too narrow."""
    path = file("f [Hz];T [°C];E' [MPa];E'' [MPa]\n" + "1;20;1;1\n" * 4)
    assert read_dma(path, tables=(1,)).frequency.size == 4
    with pytest.raises(InvalidInputError, match="table 1 must be given once"):
        read_dma(path, tables=(1, 1))


@pytest.mark.parametrize(
    ("data", "said"),
    [(b"\x00\x01\x02text", "zero bytes"), (b"a;b\n\x81\x8d\n", "Save it as UTF-8")],
)
def test_what_is_no_text_is_refused(file, data, said):
    with pytest.raises(InvalidInputError, match=said):
        read_dma(file(data))


@pytest.mark.parametrize(
    ("text", "quantity", "kind", "unit"),
    [
        ("Creep compliance J(t) [1/Pa]", "compliance", None, "1/Pa"),
        ("Relaxationsmodul E(t) / MPa", "relaxation", "E", "MPa"),
        ("Speichermodul (E') in MPa", "storage", "E", "MPa"),
        ("shear storage modulus, Pa", "storage", "G", "Pa"),
        ("Complex modulus |G*| (Pa)", "absolute", "G", "Pa"),
        ("E''/E'", "tan delta", None, None),
        ("Verlustfaktor tan δ [-]", "tan delta", None, "-"),
        ('G"', "loss", "G", None),
        ("t", "time", None, None),
        ("T", "temperature", None, None),
        ("Complex viscosity (Pa.s)", None, None, "Pa.s"),
        ("Kraft [N]", None, None, "N"),
    ],
)
def test_heads(text, quantity, kind, unit):
    head = read_head(text)
    assert (head.quantity, head.kind, head.unit) == (quantity, kind, unit)


def test_letters_of_other_quantities_are_passed_over(file):
    text = "f [Hz];T [°C];E' [MPa];E'' [MPa];F [N];delta [mm]\n"
    check(read_dma(file(text + lines(F, T, STORAGE, LOSS, F, F))))
