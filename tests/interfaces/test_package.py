"""The package as others meet it: what it loads, what it offers."""

import pkgutil
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import rollnip as rn

# loading these takes longer than solving a nip
SLOW_SCIPY = {
    f"scipy.{one}"
    for one in ("integrate", "interpolate", "ndimage", "optimize", "sparse", "spatial", "stats")
}
HEAVY = ("pydantic", "typer", "rich", "matplotlib", "xarray", "pandas", "h5py")


def loaded_after(code: str, parts: int = 1) -> set[str]:
    """Modules in a fresh process after ``code``, by the first ``parts`` of their names."""
    names = f"{{'.'.join(name.split('.')[:{parts}]) for name in sys.modules}}"
    script = f"{code}\nimport sys\nprint(*{names})"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, check=True, text=True
    )
    return set(done.stdout.split())


def test_import_loads_only_numpy_and_scipy():
    loaded = loaded_after(
        "import rollnip as rn; rn.solve, rn.Nip, rn.Elastic, rn.Solution, rn.Model"
    )
    assert {"numpy", "scipy"} <= loaded
    assert loaded.isdisjoint(HEAVY)


@pytest.mark.parametrize("code", ["import rollnip as rn; rn.solve", "import rollnip.sweeps"])
def test_what_solves_nips_loads_no_part_of_scipy_that_most_do_not_need(code):
    loaded = loaded_after(code, parts=2)
    assert loaded.isdisjoint(SLOW_SCIPY)


def test_reading_a_case_loads_no_pictures_and_no_solver():
    """So that a wrong case is answered, and a schema printed, at once."""
    loaded = loaded_after("import rollnip as rn; rn.read_case, rn.write_result", parts=2)
    assert loaded.isdisjoint({"matplotlib", "typer", "xarray", "h5py", "scipy", "rollnip.solver"})


def test_a_plain_nip_on_the_command_line_loads_no_other_study(tmp_path):
    """Faces, heat, patches, sheets and the parts of scipy that they need took half its time."""
    case = Path(__file__).parents[2] / "examples/configuration-1-free.toml"
    command = ["rollnip", "solve", str(case), "-q", "--out", str(tmp_path / "a.json")]
    loaded = loaded_after(
        f"import sys\nfrom rollnip.cli import main\nsys.argv = {command!r}\n"
        "try:\n    main()\nexcept SystemExit as done:\n    assert not done.code",
        parts=2,
    )
    assert {"rollnip.solver", "scipy.linalg"} <= loaded
    assert loaded.isdisjoint(
        f"rollnip.{one}"
        for one in ("face", "heat", "patch", "sheet", "rough", "sweeps", "plots", "design", "web")
    )
    assert loaded.isdisjoint(SLOW_SCIPY)
    assert loaded.isdisjoint({"matplotlib", "xarray", "h5py", "urllib.request"})


def test_import_loads_no_search_for_names_alike():
    assert "difflib" not in loaded_after("import rollnip")


def test_the_command_line_starts_without_numerics():
    loaded = loaded_after("import rollnip.cli.app")
    assert loaded.isdisjoint({"numpy", "scipy", "matplotlib"})


def test_help_loads_little_beyond_what_reads_the_command_line():
    """Counted in modules, as time depends on what else the machine does."""
    count = "import sys\nprint(len(sys.modules))"
    typer = "import typer, typer.main, click\n" + count
    code = (
        "import atexit, sys\n"
        "atexit.register(lambda: sys.stderr.write(str(len(sys.modules))))\n"
        "sys.argv = ['rollnip', '--help']\n"
        "from rollnip.cli import main\n"
        "main()\n"
    )
    least, help_ = (
        subprocess.run([sys.executable, "-c", one], capture_output=True, check=True, text=True)
        for one in (typer, code)
    )
    assert "solve" in help_.stdout
    assert int(help_.stderr) < int(least.stdout) + 60


@pytest.mark.parametrize("name", rn.__all__)
def test_every_public_name_is_there(name):
    assert getattr(rn, name) is not None
    assert name in dir(rn)


def test_names_of_the_contract():
    names = (
        "solve Model read_case write_result Elastic StandardLinearSolid Prony Layer Roller Nip "
        "LineLoad Approach Traction Creepage Torque"
    )
    assert set(rn.__all__) >= set(names.split())
    assert rn.__version__ == version("rollnip")


def doors():
    """Every package that others import from."""
    inside = pkgutil.walk_packages(rn.__path__, "rollnip.")
    return ["rollnip", *(one.name for one in inside if one.ispkg)]


@pytest.mark.parametrize("name", [one for one in doors() if one != "rollnip.rolling"])
def test_no_module_has_the_name_of_something_beside_it(name):
    """`import rollnip.design.find as find` would give the function, or the module, by chance."""
    door = import_module(name)
    modules = {one.name for one in pkgutil.iter_modules(door.__path__)}
    assert not modules & set(getattr(door, "__all__", ()))


@pytest.mark.parametrize("name", ["plots", "identification", "io", "verification"])
def test_packages_need_no_import_of_their_own(name):
    loaded_after(f"import rollnip as rn\nassert rn.{name}.__all__")
    assert name in dir(rn)


def test_the_command_needs_no_place_on_the_path():
    command = [sys.executable, "-m", "rollnip", "--version"]
    done = subprocess.run(command, capture_output=True, check=True, text=True)
    assert done.stdout == f"rollnip {rn.__version__}\n"


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'Nipp'"):
        _ = rn.Nipp


@pytest.mark.parametrize("first", ["from rollnip.solver import solve", "import rollnip.solver", ""])
def test_solve_is_the_function_whatever_was_imported_before(first):
    code = f"{first}\nimport rollnip as rn\nfrom rollnip import solve\nassert callable(rn.solve)\n"
    loaded_after(code + "assert rn.solve is solve")
