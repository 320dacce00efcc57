"""Case files in, results out: the only place that knows files, keys and pydantic."""

from rollnip.io.case import Case, case_hash, case_schema, parse_case, read_case
from rollnip.io.columns import TableColumns, read_columns
from rollnip.io.fields import check_fields_target, write_fields
from rollnip.io.heat import heat_text, write_heat
from rollnip.io.parts import case_parts
from rollnip.io.patch_case import PatchCase, parse_patch_case, read_patch_case
from rollnip.io.paths import dimension_at, value_at, with_values
from rollnip.io.profile import read_profile
from rollnip.io.result import check_result_target, result_dict, result_text, write_result
from rollnip.io.script import base_tree, case_python, case_toml, units_of

__all__ = [
    "Case",
    "PatchCase",
    "TableColumns",
    "base_tree",
    "case_hash",
    "case_parts",
    "case_python",
    "case_schema",
    "case_toml",
    "check_fields_target",
    "check_result_target",
    "dimension_at",
    "heat_text",
    "parse_case",
    "parse_patch_case",
    "read_case",
    "read_columns",
    "read_patch_case",
    "read_profile",
    "result_dict",
    "result_text",
    "units_of",
    "value_at",
    "with_values",
    "write_fields",
    "write_heat",
    "write_result",
]
