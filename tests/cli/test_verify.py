"""The command verify: what it prints and how it leaves."""

import io
import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from typer.testing import CliRunner

import rollnip.verification as verification
from rollnip.cli.app import app
from rollnip.cli.verify import print_outcomes
from rollnip.verification import VerificationResult, cases_about

QUICK = "Viscoelastic strip"


def run(*arguments, **environment):
    return CliRunner().invoke(app, ["verify", *arguments], env=environment)


@pytest.fixture
def wrong(monkeypatch):
    """Every figure comes out 10 % too large."""

    def verify(cases):
        for case in cases:
            yield VerificationResult(case, 1.1 * case.expected)

    monkeypatch.setattr(verification, "verify", verify)


def shown(outcomes, width):
    text = io.StringIO()
    print_outcomes(outcomes, Console(file=text, width=width))
    return text.getvalue()


def test_a_pass_is_exit_0():
    result = run("--only", QUICK)
    assert result.exit_code == 0
    for text in ("Closed form: W.D. May, E.L. Morris", "centroid/a", "0.108875", "yes"):
        assert text in result.stdout
    assert "3 figures: all passed (closed form: 3 from 1 source)" in result.stdout
    assert result.stderr == ""


def test_a_failure_is_exit_1(wrong):
    result = run("--only", QUICK)
    assert result.exit_code == 1
    assert "NO" in result.stdout
    assert "10 %" in result.stdout
    assert "3 FAILED" in result.stdout


def test_json(wrong):
    result = run("--only", QUICK, "--json")
    assert result.exit_code == 1
    tree = json.loads(result.stdout)
    assert (tree["passed"], tree["figures"], tree["failed"]) == (False, 3, 3)
    entry = tree["cases"][0]
    assert entry["expected"] == 0.833125
    assert entry["error"] == pytest.approx(0.1)
    assert entry["reason"]


def test_what_could_not_be_computed_is_null_in_json_and_said_in_the_table():
    outcome = VerificationResult(cases_about(QUICK)[0], float("nan"), "It did not settle.")
    tree = verification.document([outcome])
    assert (tree["cases"][0]["got"], tree["cases"][0]["error"]) == (None, None)
    json.dumps(tree, allow_nan=False)
    assert "It did not settle." in shown([outcome], 80)


def test_numbers_of_arrays_become_those_of_json():
    """Closed forms may give numpy's numbers: a truth of numpy ended in a traceback."""
    case = cases_about(QUICK)[0]
    case = replace(case, expected=np.float64(case.expected), tolerance=np.float64(1e-3))
    tree = verification.document([VerificationResult(case, np.float64(case.expected))])
    assert json.loads(json.dumps(tree))["passed"] is True


def test_markdown():
    result = run("--only", QUICK, "--markdown")
    assert result.exit_code == 0
    assert result.stdout.startswith("# Verification\n")
    assert "| centroid/a | 0.108875 | " in result.stdout


@pytest.mark.parametrize("width", [80, 100, 300])
def test_the_table_fits(width):
    outcomes = [VerificationResult(case, case.expected) for case in cases_about("")]
    lines = shown(outcomes, width).splitlines()
    assert max(len(line) for line in lines) <= min(width, 100)
    # numbers are never cut
    assert "…" not in "".join(lines)
    for text in ("-0.0161", "1.248158", "6.138857", "0.3 %", "yes"):
        assert text in "\n".join(lines)


def test_no_color_is_respected(wrong):
    assert "\x1b[3" not in run("--only", QUICK, NO_COLOR="1", FORCE_COLOR="1").stdout
    assert "\x1b[" in run("--only", QUICK, FORCE_COLOR="1").stdout


def test_wrong_options_are_exit_2():
    for arguments, hint in (
        (("--only", "no such case"), "`--only` must be part of"),
        (("--json", "--markdown"), "must not be given together"),
    ):
        result = run(*arguments)
        assert (result.exit_code, result.stdout) == (2, "")
        assert hint in result.stderr
        assert result.stderr.count("\n") == 1


def test_numerics_are_loaded_late():
    code = (
        "import sys; from rollnip.cli.app import app; "
        "sys.exit(any(n in sys.modules for n in ('numpy', 'scipy', 'rollnip.verification')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
