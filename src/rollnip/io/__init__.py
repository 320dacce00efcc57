"""Case files in, results out: the only place that knows files, keys and pydantic."""

from rollnip.io.case import Case, case_schema, parse_case, read_case
from rollnip.io.fields import check_fields_target, write_fields
from rollnip.io.result import check_result_target, result_dict, result_text, write_result

__all__ = [
    "Case",
    "case_schema",
    "check_fields_target",
    "check_result_target",
    "parse_case",
    "read_case",
    "result_dict",
    "result_text",
    "write_fields",
    "write_result",
]
