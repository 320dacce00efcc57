"""What the tests share. Threads are set before numpy loads: see the Makefile."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from tempfile import TemporaryDirectory

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
# what rollnip remembers of the files it wrote stays in the test run
_STATE = TemporaryDirectory(prefix="rollnip-state-")
os.environ["XDG_STATE_HOME"] = _STATE.name

import numpy as np  # noqa: E402
import pytest  # noqa: E402
from hypothesis import settings  # noqa: E402

import rollnip as rn  # noqa: E402
from rollnip.interior import InterfaceStress  # noqa: E402
from rollnip.solution import Profiles, SolverInfo, Zone  # noqa: E402

# a slow machine is no error of the code under test, and every run examines the same values
settings.register_profile("rollnip", deadline=None, derandomize=True, database=None)
settings.load_profile("rollnip")


def cpu_seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Processor time of this process for some work, the least of some repeats [s]."""

    def once() -> float:
        start = time.process_time()
        work()
        return time.process_time() - start

    return min(once() for _ in range(repeats))


@pytest.fixture(scope="session")
def cpu_unit() -> float:
    """Processor time of a fixed piece of Python, some 20 ms: what others are compared with [s].

    Processor time of one process and its ratio to this hardly depend on what else the machine does.
    """
    return cpu_seconds(lambda: sum(hash((i, str(i))) for i in range(100_000)), repeats=5)


@dataclass(frozen=True)
class HandMade:
    """What a Solution shows to others, as plain fields."""

    nip: rn.Nip
    model: rn.Model
    converged: bool
    status: str
    load: float
    approach: float | None
    traction: float
    creepage: float | None
    speed_ratio: float | None
    contact: tuple[tuple[float, float], ...]
    nip_width: float
    dwell_time: float | None
    peak_pressure: float
    peak_pressure_x: float
    mean_pressure: float
    zones: tuple[Zone, ...]
    torque_upper: float | None
    torque_lower: float | None
    rolling_resistance: float | None
    dissipation_friction: float | None
    dissipation_viscous: float | None
    error: dict[str, float]
    profiles: Profiles
    solver: SolverInfo
    warnings: tuple[str, ...]
    max_surface_strain: float | None = 0.04
    interfaces: tuple[InterfaceStress, ...] = ()
    sheet: None = None
    peaks_alike_x: tuple[float, ...] = ()

    def is_finite_inside(self, of):
        return True


rn.Solution.register(HandMade)


@pytest.fixture
def solution() -> HandMade:
    """A solution made by hand: every field filled, no solver run."""
    rubber = rn.Elastic(modulus=0.91, poisson=0.5)
    nip = rn.Nip(
        upper=rn.Roller(radius=50.0, layers=(rn.Layer(2.0, rubber),)),
        lower=rn.Roller(radius=25.0),
        normal=rn.LineLoad(1.78),
        tangential=rn.Traction(0.53),
        friction=2.8,
        speed=100.0,
        title="Made by hand",
    )
    x = np.linspace(-11.0, 11.0, 45)
    pressure = 0.35 * np.sqrt(np.clip(1.0 - (x / 3.6) ** 2, 0.0, None))
    zero = np.zeros_like(x)
    return HandMade(
        nip=nip,
        model=rn.Model(geometry="second"),
        converged=True,
        status="Solved and verified.",
        load=1.78,
        approach=0.28,
        traction=0.53,
        creepage=0.0689,
        speed_ratio=1.07,
        contact=((-3.5, 3.72),),
        nip_width=7.22,
        dwell_time=0.0722,
        peak_pressure=0.353,
        peak_pressure_x=0.12,
        mean_pressure=0.246,
        zones=(Zone(-3.5, -3.0, "slip", -1), Zone(-3.0, 3.72, "stick", None)),
        torque_upper=27.8,
        torque_lower=-13.62,
        rolling_resistance=0.0,
        dissipation_friction=4.78,
        dissipation_viscous=0.0,
        error={
            "approach": 1e-4,
            "load": 0.0,
            "creepage": 1e-5,
            "nip_width": 2e-3,
            "peak_pressure": 1e-4,
        },
        profiles=Profiles(
            x=x,
            pressure=pressure,
            shear=0.3 * pressure,
            gap=np.clip(x**2 - 13.0, 0.0, None) / 33.0,
            slip_velocity=zero,
            strain_upper=zero,
            strain_lower=zero,
            speed_upper=100.0 + zero,
            speed_lower=100.0 + zero,
        ),
        solver=SolverInfo(
            elements=240,
            iterations=9,
            residual=3e-5,
            geometry_change=0.0,
            seconds=0.21,
            version="0",
        ),
        warnings=("A reservation.",),
    )


@pytest.fixture(scope="session")
def faint_words():
    """Return the function that lists the words of a figure with a contrast below 3 to 1."""
    from matplotlib.colors import to_rgb
    from matplotlib.text import Text

    def found(figure):
        def brightness(colour):
            rgb = np.array(to_rgb(colour))
            linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
            return float(linear @ [0.2126, 0.7152, 0.0722]) + 0.05

        ground = brightness(figure.get_facecolor())
        words = [one for one in figure.findobj(Text) if one.get_visible() and one.get_text()]
        ratios = {one.get_text(): brightness(one.get_color()) / ground for one in words}
        return [text for text, ratio in ratios.items() if max(ratio, 1.0 / ratio) < 3.0]

    return found
