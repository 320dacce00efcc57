import numpy as np
import pytest

from rollnip._errors import RollnipError
from rollnip.lda import (
    Comparison,
    FittedNumber,
    Instrument,
    Record,
    Scan,
    SpeedProfile,
    estimate_profile,
)
from rollnip.plots.lda import (
    plot_comparison,
    plot_record,
    plot_velocity,
    save_comparison,
    save_velocity,
)


@pytest.fixture
def comparison():
    x = np.linspace(-3.0, 3.0, 7)
    fit = FittedNumber(0.1, 0.01, 0.08, 0.12)
    return Comparison(
        x=x,
        strain=0.01 * x,
        strain_error=np.full(7, 0.001),
        computed=0.01 * x,
        curve=SpeedProfile(x, 0.01 * x),
        shift=fit,
        speed=fit,
        rms=1e-3,
        noise=1e-3,
        chi_square=4.0,
        degrees=5,
        probability=0.5,
        confidence=0.95,
        contact=(-1.0, 1.0),
        left_out=0,
    )


@pytest.fixture
def profile():
    x = np.repeat([0.0, 1.0], 8)
    return estimate_profile(x, 100.0 + np.tile(np.arange(8.0), 2), speed=100.0)


def labels(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_comparison_says_whether_it_was_measured(comparison):
    assert any("measured" in text for text in labels(plot_comparison(comparison)))
    assert any("SIMULATED" in t for t in labels(plot_comparison(comparison, simulated=True)))


def test_a_velocity_profile_has_both_bands(profile):
    shown = labels(plot_velocity(profile))
    assert {"95 %, each position", "95 %, all positions together"} <= set(shown)


def test_a_record_without_bursts_is_drawn():
    at = Instrument()
    noise = np.random.default_rng(0).standard_normal(20_000)
    record = Record(noise, at.sample_rate, np.zeros(0), np.zeros(0))
    empty = np.zeros(0)
    ax = plot_record(Scan(at, "upper", 100.0, empty, empty, empty, record))
    assert "SIMULATED" in ax.get_title(loc="left")


def test_saves_or_refuses(comparison, profile, tmp_path):
    save_comparison(comparison, tmp_path / "a.png")
    save_velocity(profile, tmp_path / "b.svg")
    assert {p.name for p in tmp_path.iterdir()} == {"a.png", "b.svg"}
    with pytest.raises(RollnipError, match="must end in"):
        save_velocity(profile, tmp_path / "b.exe")
