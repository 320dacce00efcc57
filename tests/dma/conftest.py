"""What the tests of dynamic-mechanical data share: simulated isotherms of known solids."""

from xml.sax.saxutils import escape
from zipfile import ZipFile

import numpy as np
import pytest

import rollnip as rn
from rollnip.dma import DmaData, DmaMethod, fit_dma

LAW = rn.WLF(c1=8.9, c2=101.0, reference=23.0)
ZENER = rn.FractionalZener(
    modulus=2.0, stiffening=800.0, relaxation_time=1e-7, order=0.45, poisson=0.5
)
PRONY = rn.Prony(
    modulus=2.0,
    terms=((1.0, 1e-1), (2.0, 1e-2), (5.0, 1e-3), (12.0, 1e-4), (40.0, 1e-5), (150.0, 1e-6)),
    poisson=0.5,
)
TEMPERATURES = np.arange(-20.0, 61.0, 10.0)
FREQUENCIES = np.geomspace(0.1, 100.0, 13)


def isotherms(solid, law, *, seed=0, noise=0.02, temperatures=TEMPERATURES, level=None):
    """Moduli at each temperature and frequency, with relative noise.

    ``level``: factor on the moduli of each temperature.
    """
    rng = np.random.default_rng(seed)
    frequency = np.tile(FREQUENCIES, temperatures.size)
    temperature = np.repeat(temperatures, FREQUENCIES.size)
    factors = np.array([law.factor(float(t)) for t in temperature])
    modulus = solid.modulus_at(2j * np.pi * frequency * factors)
    if level is not None:
        modulus = modulus * np.repeat(level, FREQUENCIES.size)
    scatter = 1.0 + noise * rng.standard_normal((2, frequency.size))
    return DmaData(frequency, temperature, modulus.real * scatter[0], modulus.imag * scatter[1])


@pytest.fixture(scope="session")
def fitted():
    """A Prony series from isotherms of a fractional Zener solid."""
    return fit_dma(isotherms(ZENER, LAW), DmaMethod(reference=23.0))


def write_workbook(path, sheets):
    """Write an OpenDocument workbook: rows of numbers and texts by the name of the sheet."""
    names = " ".join(
        f'xmlns:{short}="urn:oasis:names:tc:opendocument:xmlns:{name}:1.0"'
        for short, name in (("office", "office"), ("table", "table"), ("text", "text"))
    )

    def cell(value):
        if isinstance(value, str):
            text = f"<text:p>{escape(value)}</text:p>" if value else ""
            return f'<table:table-cell office:value-type="string">{text}</table:table-cell>'
        return f'<table:table-cell office:value-type="float" office:value="{value!r}"/>'

    def row(cells):
        return "<table:table-row>" + "".join(map(cell, cells)) + "</table:table-row>"

    tables = "".join(
        f'<table:table table:name="{escape(name)}">' + "".join(map(row, rows)) + "</table:table>"
        for name, rows in sheets.items()
    )
    with ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        manifest = "urn:oasis:names:tc:opendocument:xmlns:manifest:1.0"
        archive.writestr(
            "META-INF/manifest.xml",
            f'<?xml version="1.0"?><manifest:manifest xmlns:manifest="{manifest}">'
            '<manifest:file-entry manifest:full-path="/" manifest:media-type='
            '"application/vnd.oasis.opendocument.spreadsheet"/></manifest:manifest>',
        )
        archive.writestr(
            "content.xml",
            f'<?xml version="1.0"?><office:document-content {names}><office:body>'
            f"<office:spreadsheet>{tables}</office:spreadsheet></office:body>"
            "</office:document-content>",
        )
