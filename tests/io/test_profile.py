"""Profiles from files, and the key `profile` of a case file."""

import numpy as np
import pytest

import rollnip as rn
from rollnip.io import parse_case, read_profile

CASE = """
[nip]
load = 2
friction = 0
[upper]
radius = 50
profile = "{name}"
[[upper.layers]]
thickness = 5
material = {{ model = "elastic", modulus = 3, poisson = 0.48 }}
[lower]
radius = 60
"""


def table(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def test_units_and_other_columns(tmp_path):
    path = table(tmp_path / "a.csv", "# a comment\nx [mm]; height [um]; note\n-1;2,5;a\n1;-3;b\n")
    profile = read_profile(path)
    np.testing.assert_allclose(profile.x, [-1.0, 1.0])
    np.testing.assert_allclose(profile.height, [2.5e-3, -3e-3])


def test_without_units_in_millimetres(tmp_path):
    profile = read_profile(table(tmp_path / "a.csv", "x,height\n0,0.001\n1,0.002\n"))
    np.testing.assert_allclose(profile.height, [0.001, 0.002])


def test_scanned_backwards(tmp_path):
    profile = read_profile(table(tmp_path / "a.csv", "x,height\n1,7\n0,8\n-2,9\n"))
    np.testing.assert_allclose(profile.x, [-2.0, 0.0, 1.0])
    np.testing.assert_allclose(profile.height, [9.0, 8.0, 7.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x,height\n0,1\n0,2\n", "`x` must increase"),
        ("x,height\n0,1\n2,2\n1,3\n", "`x` must increase"),
        ("x,height\n0,1\n", "2 to 262144 samples, got 1"),
        ("x,height\n0,nan\n1,2\n", '"height"'),
        ("x,height\n0,\n1,2\n", "must not be empty"),
        ("x [mm],height [N]\n0,1\n1,2\n", 'unit of column "height"'),
        ("x,hight\n0,1\n1,2\n", 'has no column "height"; it has "hight"'),
        ("x,height\n", "rows"),
    ],
)
def test_bad_files_are_named(tmp_path, text, said):
    path = table(tmp_path / "bad.csv", text)
    with pytest.raises(rn.InvalidInputError, match=r"bad\.csv") as caught:
        read_profile(path)
    assert said in str(caught.value)


def test_found_beside_the_case_file(tmp_path, monkeypatch):
    folder = tmp_path / "there"
    folder.mkdir()
    table(folder / "p.csv", "x [mm],height [um]\n-9,1\n9,2\n")
    table(folder / "case.toml", CASE.format(name="p.csv"))
    monkeypatch.chdir(tmp_path)
    for path in ("there/case.toml", folder / "case.toml"):
        nip = rn.read_case(path).nip
        assert nip.upper.profile == rn.Profile(x=[-9.0, 9.0], height=[0.001, 0.002])
        assert nip.lower.profile is None


@pytest.mark.parametrize("name", ["", "none.csv", "/etc/none.csv", "..", "case.toml"])
def test_what_is_no_profile_is_one_line(tmp_path, name):
    path = table(tmp_path / "case.toml", CASE.format(name=name))
    with pytest.raises(rn.CaseFileError) as caught:
        rn.read_case(path)
    assert str(caught.value).startswith(f"{path}: upper.profile: ")
    assert "\n" not in str(caught.value)


def test_a_text_or_a_tree_never_reads_a_file(tmp_path, monkeypatch):
    path = table(tmp_path / "p.csv", "x,height\n-9,0\n9,0\n")
    monkeypatch.chdir(tmp_path)
    for name in ("p.csv", str(path)):
        with pytest.raises(rn.CaseFileError, match=r"upper\.profile: names a file") as caught:
            parse_case(CASE.format(name=name))
        assert "rollnip solve" in str(caught.value)


def test_friction_is_refused_with_its_path(tmp_path):
    table(tmp_path / "p.csv", "x,height\n-9,0\n9,0\n")
    text = CASE.format(name="p.csv").replace("friction = 0", "friction = 0.3")
    path = table(tmp_path / "case.toml", text)
    with pytest.raises(rn.CaseFileError, match=r"nip\.friction: must be 0 with a measured profile"):
        rn.read_case(path)
