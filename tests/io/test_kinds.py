"""A file of another kind than the command reads is told in one sentence, by its keys."""

from pathlib import Path

import pytest

import rollnip as rn
from rollnip.design.files import read_optimise, read_tolerance
from rollnip.identification.study import read_fit
from rollnip.io.document import read_document
from rollnip.sweeps import read_study

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = {
    "is a case": EXAMPLES / "press-driven.toml",
    "is a case of a patch": EXAMPLES / "patch/castor.toml",
    "is a study for `rollnip sweep`": EXAMPLES / "sweep/thickness-and-load.toml",
    "is a study for `rollnip optimise`": EXAMPLES / "design/optimise.toml",
    "is a study for `rollnip tolerance`": EXAMPLES / "design/tolerance.toml",
    "is a fit file for `rollnip fit`": EXAMPLES / "fit/fit.toml",
}
READERS = {
    "is a study for `rollnip sweep`": (read_study, "and holds [[parameters]]."),
    "is a study for `rollnip optimise`": (read_optimise, "[[parameters]] and [objective]."),
    "is a study for `rollnip tolerance`": (read_tolerance, "[[parameters]] or `fit`."),
    "is a fit file for `rollnip fit`": (read_fit, "[[unknowns]] and [[data]]."),
    "is a case": (rn.read_case, "a case is needed, with [nip], [upper] and [lower]."),
    "is a case of a patch": (rn.read_patch_case, "[nip], [upper] and [lower]."),
}


@pytest.mark.parametrize("wanted", READERS)
@pytest.mark.parametrize("kind", FILES)
def test_a_file_of_another_kind(kind, wanted):
    read, needed = READERS[wanted]
    if kind == wanted:
        read(FILES[kind])
        return
    if "case" in kind and "case" in wanted:
        return  # the one is told to add a table, the other to use another command
    with pytest.raises(rn.CaseFileError) as caught:
        read(FILES[kind])
    message = str(caught.value)
    assert message.startswith(f"{FILES[kind]}: {kind}; ")
    assert message.endswith(needed)
    assert "\n" not in message


def test_a_result_is_no_case(tmp_path):
    nip = rn.read_case(FILES["is a case"]).nip
    rn.write_result(rn.solve(nip, rn.Model(geometry="linear")), tmp_path / "result.json")
    with pytest.raises(rn.CaseFileError, match="is a result; a case is needed"):
        rn.read_case(tmp_path / "result.json")


@pytest.mark.parametrize("key", ["nip", "upper", "lower"])
def test_a_case_that_misses_a_table_is_still_told_which(tmp_path, key):
    tree = read_document(FILES["is a case"])
    del tree[key]
    with pytest.raises(rn.CaseFileError, match=f"{key}: is missing"):
        rn.io.parse_case(tree)
