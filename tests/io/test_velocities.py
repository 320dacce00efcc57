import numpy as np
import pytest

import rollnip as rn
from rollnip._errors import InvalidInputError
from rollnip.io.velocities import (
    Settings,
    profile_csv,
    read_velocities,
    scan_csv,
)
from rollnip.lda import Instrument, estimate_profile
from rollnip.lda.bursts import Record
from rollnip.lda.scan import Scan

OPTICS = Settings(wavelength=632.8e-6, beam_angle=np.radians(10.0))


@pytest.fixture
def file(tmp_path):
    """Write a text, read it back."""

    def reader(text, encoding="utf-8"):
        path = tmp_path / "points.csv"
        path.write_bytes(text.encode(encoding) if isinstance(text, str) else text)
        return read_velocities(path)

    return reader


def rows(head, *values, places=5):
    lines = [head, *(f"{x},{v}" for x in range(places) for v in values)]
    return "\n".join(lines) + "\n"


def test_units_are_converted(file):
    read = file("x [in], velocity [m/min], stay [us]\n1, 6, 250\n")
    assert read.x == pytest.approx([25.4])
    assert read.velocity == pytest.approx([100.0])
    assert read.stay == pytest.approx([250e-6])


@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_decimal_comma_where_it_is_clear(file, mark):
    read = file(f"x [mm]{mark}velocity [mm/s]\n-1,5{mark}100,25\n")
    assert (read.x[0], read.velocity[0]) == (-1.5, 100.25)


def test_frequencies_become_velocities(file):
    read = file(rows("position [mm], frequency [kHz]", *np.linspace(27.0, 28.0, 8)))
    profile = read.profile(OPTICS)
    spacing = Instrument().fringe_spacing
    assert profile.velocity == pytest.approx(27.5e3 * spacing, rel=1e-3)
    shifted = read.profile(Settings(shift=20e3).over(OPTICS))
    assert shifted.velocity == pytest.approx(7.5e3 * spacing, rel=1e-2)


def test_comments_say_what_the_instrument_was(file):
    read = file(
        "# SIMULATED\n# wavelength: 0.6328 um\n# beam angle: 10°\n# half width: 50 um\n"
        "# sample rate: 1 MHz\n# shift: 40 kHz\n# roller: lower\n# roller speed: 0.1 m/s\n"
        "# by hand\nx [mm],velocity [mm/s]\n0,1\n"
    )
    assert read.simulated
    assert read.settings == Settings(
        wavelength=pytest.approx(632.8e-6),
        beam_angle=pytest.approx(np.radians(10.0)),
        half_width=pytest.approx(0.05),
        sample_rate=1e6,
        shift=4e4,
        roller_speed=pytest.approx(100.0),
        roller="lower",
    )
    assert Settings(roller="upper").over(read.settings).roller == "upper"
    assert read.settings.averaging_width == pytest.approx(Instrument().averaging_width)


def test_a_scan_comes_back(tmp_path):
    record = Record(np.zeros(10), 1.0, np.zeros(0), np.zeros(0))
    x, frequency = np.repeat([-1.0, 2.0], 6), np.linspace(27e3, 28e3, 12)
    scan = Scan(Instrument(), "upper", 101.0, x, frequency, np.full(12, 20.0), record)
    path = tmp_path / "scan.csv"
    path.write_text(scan_csv(scan), "utf-8")
    read = read_velocities(path)
    assert read.simulated
    profile = read.profile(read.settings)
    direct = estimate_profile(x, scan.velocity, speed=101.0)
    assert profile.velocity == pytest.approx(direct.velocity, rel=1e-7)
    assert profile.strain == pytest.approx(direct.strain, abs=1e-7)


def test_a_profile_with_errors_comes_back(file):
    read = file("x [mm],frequency [Hz],error [Hz]\n1,100,2\n0,50,1\n")
    profile = read.profile(OPTICS)
    assert profile.error == pytest.approx(np.array([1.0, 2.0]) * Instrument().fringe_spacing)


def test_the_table_of_a_profile(file):
    profile = file(rows("x [mm],velocity [mm/s]", 9.0, 10.0, 10.0, 10.5, 11.0)).profile(
        Settings(roller_speed=10.0)
    )
    lines = profile_csv(profile).splitlines()
    assert lines[1].startswith("x [mm],velocity [mm/s],error [mm/s],band [mm/s]")
    assert lines[1].endswith("strain,strain band")
    assert len(lines) == 2 + 5


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("", "must hold a line of column names and rows below it"),
        ("# only: this\n", "must hold a line of column names and rows below it"),
        ("x [mm],velocity [mm/s]\n", "must hold a line of column names and rows below it"),
        ("x [mm],speed [mm/s]\n1,2\n", '"speed" is no known column; known are x, position'),
        ("x [mm],velocty [mm/s]\n1,2\n", 'did you mean "velocity"'),
        ("x [mm]\n1\n", 'either "velocity" or "frequency"'),
        ("x [mm],velocity [mm/s],frequency [Hz]\n1,2,3\n", 'either "velocity"'),
        ("x [mm],x [mm],velocity [mm/s]\n1,2,3\n", "twice"),
        ("x [mm],Position [mm],velocity [mm/s]\n1,2,3\n", "twice"),
        ("x,velocity [mm/s]\n1,2\n", 'column "x" must say its unit, such as "x .mm."'),
        ("x [mm],frequency [kHz],error\n1,2,3\n", 'column "error" must say its unit'),
        ("x [mm],velocity [mm]\n1,2\n", 'unit of column "velocity"'),
        ("x [mm],frequency [mm]\n1,2\n", 'unit of column "frequency"'),
        ("x [mm],frequency [1/s]\n1,2\n", "turns or radians a second"),
        ("x [mm],velocity [mm/s]\n1,\n", 'line 2: "velocity" must not be empty'),
        ("x [mm],velocity [mm/s]\n1,2\n3\n", "line 3: must have 2 cells, has 1"),
        ("x [mm],velocity [mm/s]\n1,two\n", 'line 2: "velocity" must be a number, got "two"\\.'),
        ("x [mm],velocity [mm/s]\n1,nan\n", 'line 2: "velocity" must be a number, got "nan"'),
        ("x [mm],velocity [mm/s]\n1,1_000\n", 'line 2: "velocity" must be a speed'),
        ("x [mm],velocity [mm/s]\n1,2,5\n", "has 3"),
        ("# wavelength: 10 deg\nx [mm],velocity [mm/s]\n1,2\n", "line 1: `wavelength`"),
        ("# roller: middle\nx [mm],velocity [mm/s]\n1,2\n", "upper"),
        (b"\xff\xfe\x00", "UTF-8"),
    ],
)
def test_refuses(file, text, hint):
    with pytest.raises(InvalidInputError, match=hint) as caught:
        file(text)
    assert "\n" not in str(caught.value)
    assert "points.csv" in str(caught.value)


def test_refuses_what_cannot_be_a_profile(file):
    read = file(rows("x [mm],frequency [kHz]", *range(20, 26)))
    with pytest.raises(InvalidInputError, match=r"points.csv: `wavelength` and `beam angle`"):
        read.profile(Settings())
    with pytest.raises(InvalidInputError, match="Nyquist"):
        read.profile(Settings(sample_rate=48e3).over(OPTICS))
    with pytest.raises(InvalidInputError, match=r"points.csv.*at least 5"):
        file("x [mm],velocity [mm/s]\n1,2\n").profile(Settings())


def test_refuses_a_file_that_is_not_there(tmp_path):
    with pytest.raises(rn.RollnipError, match="there is no such file"):
        read_velocities(tmp_path / "none.csv")
