"""Every route: what it answers, and that it says what the rest of rollnip says."""

import json
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import rollnip as rn
from rollnip.cli.app import app
from rollnip.io import case_hash, parse_case, result_dict


@pytest.fixture
def solution(case):
    problem = parse_case(case)
    return rn.solve(problem.nip, problem.model)


def without_seconds(tree):
    tree["solver"].pop("seconds")
    return tree


def test_solve_is_the_json_of_the_command(client, case):
    answer = client.post("/api/solve", json=case)
    assert answer.status_code == 200
    command = CliRunner().invoke(app, ["solve", "-", "--json"], input=json.dumps(case))
    assert without_seconds(answer.json()) == without_seconds(json.loads(command.stdout))
    assert answer.headers["x-rollnip-case"] == case_hash(parse_case(case))


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"traction": "0 N/mm", "load": "9 kN/mm"}, "nip.load"),
        ({"traction": None, "torque_lower": "500 N"}, "nip.torque_lower"),
        ({"load": None, "approach": "0.2 mm", "traction": "9 N/mm"}, "nip.traction"),
    ],
)
def test_what_the_solver_refuses_is_told_at_its_key(post, case, change, path):
    given = case["nip"] | change
    case["nip"] = {key: value for key, value in given.items() if value is not None}
    answer = post("solve", case, 422)
    (detail,) = answer["details"]
    assert detail["path"] == path
    assert answer["error"] == f"{path}: {detail['message']}"


def test_solve_without_interfaces_leaves_out_that_key_alone(client, case):
    whole = client.post("/api/solve", json=case).json()
    rest = client.post("/api/solve?interfaces=false", json=case).json()
    assert whole.pop("interfaces")
    assert rest == whole


@pytest.mark.slow  # a face and a heat balance, each here and by the command
@pytest.mark.parametrize("name", ["face", "heat"])
def test_solve_holds_face_and_heat_as_the_command_does(client, case, name):
    if name == "face":
        case["face"] = {"length": "300 mm"}
        case["upper"]["shaft"] = {"bearing_distance": "400 mm"}
    else:
        case["nip"]["speed"] = "1 m/s"
        case["heat"] = {"ambient": "23 degC"}
        rubber = case["upper"]["layers"][0]["material"]
        rubber |= {"thermal": "natural-rubber-filled"}
        for side in ("upper", "lower"):
            case[side]["heat"] = {"film": "30 W/(m2 K)"}
    case["model"] = {"geometry": "linear"}
    answer = client.post("/api/solve", json=case).json()
    command = CliRunner().invoke(app, ["solve", "-", "--json"], input=json.dumps(case))
    expected = json.loads(command.stdout)
    assert answer[name].keys() == expected[name].keys()
    assert (answer["case"], answer["case_hash"]) == (expected["case"], expected["case_hash"])
    rest = client.post("/api/solve?whole=false", json=case).json()
    assert set(answer) - set(rest) == {name}


def test_solve_takes_a_patch_as_the_command_does(client):
    case = {
        "nip": {"load": "100 N", "friction": 0.5},
        "patch": {"grid": [16, 16]},
        "upper": {"radius": 50, "lateral_radius": 50},
        "lower": {"radius": 50, "core": {"model": "elastic", "modulus": 500, "poisson": 0.3}},
    }
    answer = client.post("/api/solve", json=case)
    assert answer.status_code == 200
    assert answer.json() == client.post("/api/patch", json=case).json()


def test_geometry_and_title_are_those_of_the_case(post, case):
    del case["model"]
    assert post("solve", case)["geometry"] in ("finite", "curved")
    case["model"] = {"geometry": "linear"}
    case["title"] = "One"
    assert post("solve", case)["geometry"] == "linear"
    case["title"] = "Another"  # of the same hash: the solution is kept
    assert post("solve", case)["title"] == "Another"


def test_what_did_not_converge_is_an_answer_too(post, case):
    case["solver"] = {"tolerance": 1e-4}
    case["nip"] |= {"load": "8 N/mm", "traction": "12 N/mm"}
    answer = post("solve", case)
    assert answer["converged"] in (True, False)
    assert answer["solver"]["status"]


def test_surfaces_are_those_of_the_solution(post, case, solution):
    answer = post("surfaces", case)
    wanted = solution.deformed_surfaces
    for side, heights in (("upper", wanted.upper), ("lower", wanted.lower)):
        np.testing.assert_allclose(answer[side]["x"], wanted.x)
        np.testing.assert_allclose(answer[side]["z"], heights)


def test_interior_is_that_of_the_solution_to_six_digits(post, case, solution):
    case["upper"]["layers"].append({**case["upper"]["layers"][0], "thickness": "0.5 mm"})
    problem = parse_case(case)
    solution = rn.solve(problem.nip, problem.model)
    answer = post("interior", {"case": case, "roller": "upper", "nx": 31, "nz": 20})
    assert answer["interfaces"] == [2.0, 2.5]
    assert len(answer["x"]) == 31
    z = np.array(answer["z"])
    assert np.all(np.diff(z) > 0.0)
    assert (z[0], z[-1]) == (0.0, 2.5)
    assert answer["layer"] == [0 if depth <= 2.0 else 1 for depth in z]
    trailing, leading = solution.contact[0]
    wide = leading - trailing
    assert answer["x"][0] == pytest.approx(trailing - wide, rel=1e-5)
    field = solution.interior("upper", z, answer["x"])
    for key, name in {"mises": "von_mises", "s_zz": "s_zz", "u_x": "u_x"}.items():
        wanted = getattr(field, name)
        np.testing.assert_allclose(answer[key], wanted, atol=2e-5 * np.max(np.abs(wanted)))
    assert {"u_z", "s_xx", "s_xz", "max_shear"} < set(answer)
    assert "loss" not in answer


def test_interior_of_a_viscoelastic_roller_tells_the_loss(post, case):
    case["upper"]["layers"][0]["material"] = {
        "model": "standard-linear-solid",
        "modulus": 2,
        "stiffening": 3,
        "relaxation_time": "7 ms",
        "poisson": 0.5,
    }
    answer = post("interior", {"case": case, "roller": "upper", "nx": 21, "nz": 5})
    assert np.max(answer["loss"]) > 0.0


def test_interior_reaches_into_a_half_space_and_not_into_a_rigid_core(post, case):
    body = {"case": case, "roller": "lower", "nx": 11, "nz": 5}
    assert post("interior", body, 422)["details"][0]["path"] == "roller"
    case["lower"]["core"] = {"model": "elastic", "modulus": 200, "poisson": 0.3}
    answer = post("interior", body)
    assert len(answer["z"]) == 5
    assert answer["interfaces"] == []


def test_sweep_solves_each_value(post, case):
    values = [1.0, "2 mm", "0.1 in", "60 mm", "2 N"]
    path = "upper.layers[0].thickness"
    answer = post("sweep", {"case": case, "path": path, "values": values})
    assert answer["path"] == path
    assert answer["unit"] == "mm"
    assert answer["values"][:4] == pytest.approx([1.0, 2.0, 2.54, 60.0])
    assert answer["values"][4] is None
    *solved, too_thick, no_length = answer["results"]
    assert "upper" in too_thick["error"]
    assert "that is a force" in no_length["error"]
    widths = [row["nip_width"] for row in solved]
    assert widths == sorted(widths)  # a thicker covering gives way more
    wanted = result_dict(rn.solve(*both(case)))
    for name in ("load", "nip_width", "peak_pressure", "creepage", "torque_upper"):
        assert solved[1][name] == pytest.approx(wanted[name])
    assert solved[1]["dissipation_friction"] == pytest.approx(wanted["dissipation"]["friction"])
    assert solved[1]["warnings"] == wanted["warnings"]
    assert solved[1]["converged"] == wanted["converged"]
    assert solved[1]["max_surface_strain"] > 0.0


def both(case):
    problem = parse_case(case)
    return problem.nip, problem.model


def test_sweep_refuses_a_path_to_nowhere_or_to_no_number(post, case):
    for path, said in (("uper.radius", "upper"), ("title", "number"), ("nip", "number")):
        answer = post("sweep", {"case": case, "path": path, "values": [1, 2]}, 422)
        assert answer["details"][0]["path"] == "path"
        assert said in answer["error"]


def test_sweep_over_an_infinite_radius(post, case):
    answer = post("sweep", {"case": case, "path": "lower.radius", "values": ["inf", 1e7]})
    assert answer["values"] == ["inf", 1e7]
    plane, nearly = (row["nip_width"] for row in answer["results"])
    assert plane == pytest.approx(nearly, rel=1e-3)


def test_find_gives_the_load_of_a_nip_width(post, case):
    question = {"path": "nip.load", "quantity": "nip_width", "wanted": "8 mm", "low": 1, "high": 5}
    answer = post("find", {"case": case, **question})
    assert answer["found"] is True
    assert answer["unit"] == "N/mm"
    assert answer["result"]["nip_width"] == pytest.approx(8.0, rel=1e-3)
    case["nip"]["load"] = answer["value"]
    assert rn.solve(*both(case)).nip_width == pytest.approx(8.0, rel=1e-3)
    assert isinstance(answer["result"]["warnings"], list)


def test_find_says_where_there_is_nothing_to_find(post, case):
    question = {"path": "nip.load", "quantity": "nip_width", "wanted": 80, "low": 1, "high": 2}
    answer = post("find", {"case": case, **question})
    assert answer["found"] is False
    assert answer["value"] is None
    assert answer["message"]


@pytest.mark.parametrize(
    ("change", "said"),
    [({"quantity": "nip_with"}, "nip_width"), ({"low": 9}, "low"), ({"path": "nip.lod"}, "path")],
)
def test_find_refuses_a_wrong_question(post, case, change, said):
    question = {"path": "nip.load", "quantity": "nip_width", "wanted": 8, "low": 1, "high": 2}
    assert said in post("find", {"case": case, **question, **change}, 422)["error"]


def test_case_is_written_out_as_toml_python_and_base_units(post, case):
    answer = post("case", case)
    problem = parse_case(case)
    assert answer["hash"] == case_hash(problem)
    assert case_hash(parse_case(answer["toml"])) == answer["hash"]
    assert case_hash(parse_case(answer["case"])) == answer["hash"]
    names = {}
    exec(answer["python"].partition("solution =")[0], names)
    assert names["nip"] == problem.nip
    assert answer["case"]["upper"]["layers"][0]["thickness"] == 2.0
    assert answer["units"]["upper.layers[0].thickness"] == "mm"


def test_toml_is_read_as_written(post):
    text = 'title = "A"\nradius = inf\nwhen = 2020-01-01\n[nip]\nload = "10 pli"\n'
    assert post("toml", {"text": text})["case"] == {
        "title": "A",
        "radius": "inf",
        "when": "2020-01-01",
        "nip": {"load": "10 pli"},
    }
    assert post("toml", {"text": '{"a": 1}'})["case"] == {"a": 1}
    assert "not valid TOML" in post("toml", {"text": "a = = 1"}, 422)["error"]


def test_quantity_reads_a_text_box(post):
    answer = post("quantity", {"text": "2 in", "dimension": "length"})
    assert answer == {"value": 50.8, "unit": "mm"}
    assert post("quantity", {"text": "4,5 mm", "dimension": "length"})["value"] == 4.5
    wrong = post("quantity", {"text": "2 N", "dimension": "length"}, 422)
    assert wrong["details"] == [{"path": "text", "message": wrong["error"].removeprefix("text: ")}]
    post("quantity", {"text": "inf", "dimension": "length"}, 422)
    post("quantity", {"text": "1 mm", "dimension": "width"}, 422)


def test_units_convert_as_the_parser_does(client):
    from rollnip._units import parse_quantity

    tree = client.get("/api/units").json()
    assert tree["length"]["units"]["in"] == [25.4, 0.0]
    for dimension, table in tree.items():
        assert table["base"] in table["units"]
        for shown in (table["metric"], table["us"]):
            scale, offset = table["units"][shown]
            wanted = parse_quantity(f"7 {shown}".strip(), dimension)
            assert 7.0 * scale + offset == pytest.approx(wanted, rel=1e-14, abs=1e-12)


def test_examples_solve_and_verify(client):
    examples = client.get("/api/examples").json()
    names = [example["name"] for example in examples]
    assert len(set(names)) == len(names)
    assert {example["group"] for example in examples} == {"paper", "typical", "more"}
    for example in examples:
        assert len(example["description"]) > 40
        problem = parse_case(example["case"])
        assert problem.nip.title == example["title"]
        if example["group"] == "typical":
            solution = rn.solve(problem.nip, replace(problem.model, geometry="curved"))
            assert solution.converged
            assert not solution.warnings


def test_materials_have_a_source_and_make_a_nip(client, case):
    materials = client.get("/api/materials").json()
    assert len(materials) > 10
    for one in materials:
        assert one["source"]
        assert one["description"]
        assert all(not isinstance(v, str) or k == "model" for k, v in one["material"].items())
        case["upper"]["layers"][0]["material"] = one["material"]
        material = parse_case(case).nip.upper.layers[0].material
        if "modulus" in one["range"]:
            band = one["range"]["modulus"]
            assert band["low"] < band["likely"] < band["high"]
            assert band["low"] < material.relaxed_modulus < band["high"]


def test_schema_and_version(client):
    from rollnip.io import case_schema

    assert client.get("/api/schema").json() == case_schema()
    assert client.get("/api/version").json() == {"version": rn.__version__}


def test_schema_of_the_api_refers_to_the_case_file_and_holds_together(client):
    tree = client.get("/openapi.json").json()
    body = tree["paths"]["/api/solve"]["post"]["requestBody"]["content"]["application/json"]
    assert body["schema"] == {"$ref": "#/components/schemas/CaseTable"}
    text = json.dumps(tree)
    known = set(tree["components"]["schemas"])
    for part in text.split('"#/components/schemas/')[1:]:
        assert part.partition('"')[0] in known
    assert "x-case-file" not in text


def test_pages_and_scripts_come_from_here(client):
    page = client.get("/")
    assert page.headers["content-type"].startswith("text/html")
    script = client.get("/static/plotly.min.js")
    assert script.headers["content-type"].startswith("text/javascript")
    assert len(script.content) > 1_000_000
    assert client.head("/static/plotly.min.js").status_code == 200
    assert client.head("/").status_code == 200
    tag = page.headers["etag"]
    assert client.get("/", headers={"if-none-match": tag}).status_code in (200, 304)


def test_every_typical_example_is_a_readable_file():
    from rollnip.web import library

    files = sorted((library._DATA / "nips").glob("*.toml"))
    assert len(files) >= 5
    for file in files:
        tomllib.loads(file.read_text(encoding="utf-8"))


def test_the_us_page_shows_power_in_horsepower(client):
    """1 hp = 550 ft lbf/s = 745.69987 W (NIST SP 811, appendix B.8)."""
    text = client.get("/static/js/figures.js").text
    shown = dict(re.findall(r"export const (\w+) = (.*);", text))
    losses = [one for one in json.loads(shown["TOTALS"]) if one["units"]["metric"][0] == "W"]
    assert losses
    assert all(one["units"]["us"] == ["hp", pytest.approx(745.69987)] for one in losses)
    per_length = json.loads(shown["RESULT_UNITS"])["power per length"]["us"]
    assert per_length == ["hp/ft", pytest.approx(745.69987 / 0.3048)]
