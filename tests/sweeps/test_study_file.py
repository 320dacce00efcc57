"""Study files: what they may hold, and one clear line for what they may not."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import rollnip as rn
from rollnip._errors import RollnipError
from rollnip.sweeps import read_study
from rollnip.sweeps.study_file import MOST_CASES

ROOT = Path(__file__).parents[2]
LOAD = {"path": "nip.load", "values": [0.5, 1.0]}
SAMPLED = {"path": "nip.load", "start": 0.5, "stop": 1.0}


def study_of(case: Any, *parameters: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"case": case, "parameters": list(parameters)} | more


def test_files_count_from_the_folder_of_the_study(case: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "nips").mkdir()
    (tmp_path / "nips" / "case.json").write_text(json.dumps(case))
    (tmp_path / "designs.csv").write_text("nip.load [kN/m], lower.radius [in]\n1, 2\n2, 3\n")
    (tmp_path / "study.toml").write_text(
        'case = "nips/case.json"\n[[parameters]]\ntable = "designs.csv"\n'
    )
    study = read_study(tmp_path / "study.toml")
    assert [study.values(i) for i in range(study.count)] == [(1.0, 50.8), (2.0, 76.2)]
    assert study.units == ("N/mm", "mm")


def test_rows_of_a_table_may_name_materials(case: dict[str, Any], tmp_path: Path) -> None:
    case["materials"] = {
        "soft": {"model": "elastic", "modulus": 1.0, "poisson": 0.5},
        "hard": {"model": "elastic", "modulus": 9.0, "poisson": 0.5},
    }
    designs = tmp_path / "designs.csv"
    designs.write_text("# two\nupper.layers[0].material; nip.load [N/mm]\nsoft; 1,5\nhard; 2,5\n")
    study = read_study(study_of(case, {"table": str(designs)}))
    assert study.case(1)["upper"]["layers"][0]["material"] == "hard"
    assert study.case(1)["nip"]["load"] == 2.5


def test_samples_are_crossed_with_lists(case: dict[str, Any]) -> None:
    study = read_study(
        study_of(
            case,
            SAMPLED,
            {"path": "lower.radius", "values": [20.0, 30.0]},
            {"path": "nip.friction", "start": "10 %", "stop": 1, "spacing": "log"},
            sampling={"method": "sobol", "count": 8, "seed": 5},
        )
    )
    assert study.paths == ("nip.load", "nip.friction", "lower.radius")
    assert study.count == 16
    loads = [float(study.values(position)[0]) for position in range(16)]
    assert loads[0] == loads[1] != loads[2]
    assert all(0.5 <= load <= 1.0 for load in loads)


def test_json_and_standard_units_are_read_alike(case: dict[str, Any], tmp_path: Path) -> None:
    one = study_of(case, LOAD)
    (tmp_path / "study.json").write_text(json.dumps(one))
    assert read_study(tmp_path / "study.json").digest == read_study(one).digest


WRONG = [
    ({"parameters": []}, "parameters: must hold at least one parameter"),
    ({"parameters": [{"path": "nip.load"}]}, "must hold one of values, start and table, got none"),
    ({"parameters": [{**LOAD, "start": 1}]}, "got values and start"),
    ({"parameters": [{"values": [1]}]}, "parameters[0].path: is missing"),
    ({"parameters": [{"path": "nip.load", "start": 1}]}, "parameters[0].stop: is missing"),
    ({"parameters": [{**LOAD, "values": []}]}, "parameters[0].values: must hold at least one"),
    ({"parameters": [{**LOAD, "spacing": "log"}]}, "parameters[0].spacing: has no meaning beside"),
    ({"parameters": [{**LOAD, "path": "nip.laod"}]}, 'nip has no "laod"; did you mean "load"'),
    (
        {"parameters": [{**LOAD, "path": "upper.layers[1].thickness"}]},
        "upper.layers has 1 entry, counted from 0",
    ),
    ({"parameters": [{**LOAD, "path": "nip load"}]}, "must be written like nip.load"),
    ({"parameters": [{**LOAD, "values": [1, "2 mm"]}]}, "parameters[0].values[1]: "),
    ({"parameters": [{**SAMPLED, "count": 3.0}]}, "count: must be a whole number, got 3.0."),
    ({"parameters": [{**SAMPLED, "count": 1}]}, "parameters[0].count: must be 2 or more, got 1"),
    ({"parameters": [{**SAMPLED, "count": 3, "stop": "2 mm"}]}, "parameters[0].stop: "),
    ({"parameters": [{**SAMPLED, "count": 3, "stop": 0.5}]}, "`stop` must differ from `start`"),
    ({"parameters": [{**SAMPLED, "count": 10**12}]}, "must make at most 100,000,000 cases"),
    ({"parameters": [SAMPLED]}, "a range has no `count`; give one, or choose [sampling]"),
    ({"parameters": [SAMPLED], "sampling": {"method": "sobol"}}, "sampling.count: is missing"),
    (
        {"parameters": [SAMPLED], "sampling": {"method": "sobol", "count": 7}},
        "sampling: `count` must be a power of 2",
    ),
    ({"sampling": {"method": "sobol", "count": 8}}, "there is nothing to sample"),
    ({"sampling": {"methd": "sobol"}}, 'sampling.methd: is not a known key; did you mean "method"'),
    ({"paramters": []}, 'paramters: is not a known key; did you mean "parameters"'),
    ({"case": 3}, "case: must be the name of a case file, or a table"),
    ({"case": "none.toml"}, "none.toml: there is no such file"),
    ({"parameters": [LOAD, LOAD]}, "nip.load must not be there twice"),
    (
        {"parameters": [LOAD, {"path": "nip.approach", "values": [0.1]}]},
        "nip.load and nip.approach exclude each other",
    ),
    (
        {
            "parameters": [
                {"path": "upper.layers[0]", "values": [{"thickness": 1.0}]},
                {"path": "upper.layers[0].thickness", "values": [1.0]},
            ]
        },
        "upper.layers[0].thickness is a part of upper.layers[0]; leave one out",
    ),
    (
        {
            "parameters": [
                {"path": "upper.radius", "values": [1, 2], "group": "a"},
                {"path": "lower.radius", "values": [1, 2, 3], "group": "a"},
            ]
        },
        "those of group a must have equally many values, have 2, 3",
    ),
    ({"results": ["nip_widht"]}, 'results[0]: there is no "nip_widht"; did you mean "nip_width"'),
    ({"results": ["load", "load"]}, 'results[1]: "load" must not be there twice'),
    ({"profiles": ["presure"]}, 'profiles[0]: there is no "presure"; did you mean "pressure"'),
    ({"parameters": [{"path": "model.geometry", "start": 1, "stop": 2}]}, "is no quantity"),
    ({"parameters": [{"table": "designs.csv", "path": "nip.load"}]}, "path: has no meaning beside"),
]


@pytest.mark.parametrize(("change", "words"), WRONG, ids=[words for _, words in WRONG])
def test_what_is_wrong_is_one_clear_line(
    case: dict[str, Any], change: dict[str, Any], words: str
) -> None:
    with pytest.raises(RollnipError) as caught:
        read_study(study_of(case, LOAD) | change)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_case_that_is_wrong_throughout_is_said_before_it_runs(case: dict[str, Any]) -> None:
    case["nip"]["frictoin"] = case["nip"].pop("friction")
    with pytest.raises(rn.CaseFileError, match=r"study: case \(case 0\): nip.friction: is missing"):
        read_study(study_of(case, LOAD))


def test_a_case_in_place_of_a_study_is_told_from_it(case: dict[str, Any]) -> None:
    with pytest.raises(rn.CaseFileError, match=r"^study: is a case; a study names it with `case`"):
        read_study(case)


def test_a_case_that_is_wrong_at_one_end_is_a_matter_of_its_row(case: dict[str, Any]) -> None:
    read_study(study_of(case, {"path": "nip.load", "values": [-1.0, 1.0]}))


def test_huge_studies_are_refused_before_they_take_memory(case: dict[str, Any]) -> None:
    wide = {"start": 1.0, "stop": 2.0, "count": 20_000}
    paths = ("nip.load", "upper.radius")
    with pytest.raises(rn.CaseFileError, match=r"makes 400,000,000; part the study"):
        read_study(study_of(case, *({"path": path, **wide} for path in paths)))
    assert MOST_CASES < 20_000**2


TABLES = [
    ("nip.load [mm]\n1\n", 'unit of column "nip.load"'),
    ("nip.load [N/mm], nip.load [N/mm]\n1, 2\n", 'column "nip.load" must not be there twice'),
    ("nip.laod [N/mm]\n1\n", 'did you mean "load"'),
    ("nip.load [N/mm]\n", "must hold a line of column names and rows below it"),
    ("nip.load [N/mm], lower.radius\n1\n", "line 2: must have 2 cells, has 1"),
    ("nip.load [N/mm], lower.radius\n1, \n", '"lower.radius" must not be empty'),
    ("model.geometry [mm]\nlinear\n", "must have no unit"),
]


@pytest.mark.parametrize(("text", "words"), TABLES, ids=[words for _, words in TABLES])
def test_a_wrong_table_is_said_with_its_name(
    case: dict[str, Any], tmp_path: Path, text: str, words: str
) -> None:
    (tmp_path / "designs.csv").write_text(text)
    (tmp_path / "study.json").write_text(json.dumps(study_of(case, {"table": "designs.csv"})))
    with pytest.raises(RollnipError) as caught:
        read_study(tmp_path / "study.json")
    assert words in str(caught.value)
    assert "designs.csv" in str(caught.value)


def test_a_sheet_is_asked_of_the_table(case: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "designs.csv").write_text("nip.load [N/mm]\n1\n")
    wrong = study_of(case, {"table": str(tmp_path / "designs.csv"), "sheet": "two"})
    with pytest.raises(RollnipError, match=r"designs.csv: is a text file and has no sheets"):
        read_study(wrong)
