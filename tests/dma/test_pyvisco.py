"""Against pyvisco (NREL), where it is installed: pip install "rollnip[crosscheck]"."""

from dataclasses import replace

import numpy as np
import pytest

from rollnip.dma import DmaMethod, fit_dma

from .conftest import FREQUENCIES, LAW, TEMPERATURES, ZENER, isotherms

pytestmark = pytest.mark.filterwarnings("ignore")
REFERENCE = 20.0


@pytest.fixture(scope="module")
def both():
    """Shifts and master curve of pyvisco, and the fit of this package, from the same data."""
    load = pytest.importorskip("pyvisco.load", exc_type=ImportError)
    from pyvisco import master

    data = isotherms(ZENER, LAW)
    sets = np.repeat(np.arange(TEMPERATURES.size), FREQUENCIES.size)
    columns = (data.frequency, data.storage, data.loss, data.temperature, sets)
    rows = [",".join(str(value) for value in row) for row in zip(*columns, strict=True)]
    text = "\n".join(["f,E_stor,E_loss,T,Set", "Hz,MPa,MPa,C,-", *rows])
    raw, _, _ = load.user_raw(text.encode(), "freq", "E")
    shifts, _ = master.get_aT(raw, REFERENCE)
    curve = master.smooth(master.get_curve(raw, shifts, REFERENCE), 1)
    return shifts, curve, fit_dma(data, DmaMethod(reference=REFERENCE))


def test_shifts_agree(both):
    shifts, _, fit = both
    other = shifts["log_aT"].to_numpy()
    true = np.log10([LAW.factor(float(t)) / LAW.factor(REFERENCE) for t in TEMPERATURES])
    # pyvisco shifts pair by pair along power laws through the storage modulus
    np.testing.assert_allclose(other, fit.master.horizontal, atol=0.2)
    assert np.max(np.abs(fit.master.horizontal - true)) < np.max(np.abs(other - true))


def test_constants_of_wlf_agree(both):
    from pyvisco import shift

    shifts, _, fit = both
    other = shift.fit_WLF(REFERENCE, shifts)
    assert float(other["C1"].iloc[0]) == pytest.approx(fit.shift.values[0], rel=0.05)
    assert float(other["C2"].iloc[0]) == pytest.approx(fit.shift.values[1], rel=0.05)


def test_prony_series_agree_over_the_transition(both):
    from pyvisco import prony

    _, curve, fit = both
    series, _ = prony.fit(prony.discretize(curve, "round", 30), curve, opt=False)
    other = prony.calc_GMaxw(**series)
    inside = (other["f"] > 1e2) & (other["f"] < 1e7)
    omega = 2.0 * np.pi * other["f"][inside].to_numpy()
    mine = replace(fit.material, temperature=None, shift=None).modulus_at(1j * omega)
    # its collocation follows single points and leaves some 10 %
    np.testing.assert_allclose(other["E_stor"][inside], mine.real, rtol=0.2)
    np.testing.assert_allclose(other["E_loss"][inside], mine.imag, rtol=0.3)


def test_tables_of_prony_series_are_exchanged(both, tmp_path):
    from pyvisco import load, out, prony

    from rollnip.dma import prony_deck, read_deck

    _, curve, fit = both
    series, _ = prony.fit(prony.discretize(curve, "round", 20), curve, opt=False)
    units = {"tau_i": "s", "alpha_i": "-", "E_0": "MPa", "E_i": "MPa"}
    path = tmp_path / "prony.csv"
    path.write_text(out.to_csv(series["df_terms"], units, index_label="i"))
    found = read_deck(path, poisson=0.5)
    solid, terms = found.material, series["df_terms"]
    # its ratios add up to 1: the slowest term is the plateau
    assert "The ratios add up to 1" in found.notes[0]
    slowest = int(np.argmax(terms["tau_i"]))
    others = np.delete(terms["E_i"].to_numpy(), slowest)
    np.testing.assert_allclose([e for e, _ in solid.terms], others)
    assert solid.modulus == pytest.approx(terms["E_i"].iloc[slowest])
    assert solid.glassy_modulus == pytest.approx(series["E_0"], rel=1e-5)
    data = fit.master.reduced
    mine = solid.modulus_at(1j * data.omega)
    theirs = prony.calc_GMaxw(**series)
    np.testing.assert_allclose(
        np.interp(
            np.log(theirs["omega"]), np.log(np.sort(data.omega)), mine.real[np.argsort(data.omega)]
        )[20:-20],
        theirs["E_stor"][20:-20],
        rtol=0.05,
    )
    # and ours by its reader
    table, found = load.prep_csv(prony_deck(fit.material, "pyvisco").encode())
    assert found == units | {"i": "-"}
    np.testing.assert_allclose(table["tau_i"], [t for _, t in fit.material.terms])
    assert float(table["E_0"].iloc[0]) == pytest.approx(fit.material.glassy_modulus)
