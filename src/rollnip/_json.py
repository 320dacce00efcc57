"""Results as JSON: finite numbers, and one zero."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any


def json_text(tree: Any, *, indent: int | None = 2) -> str:
    """Return a tree as JSON, without a line end; a zero has no sign.

    Parameters
    ----------
    tree : mappings, lists, texts, numbers and None; a number that is not finite is an error of the
        program.
    indent : blanks by which a level is set in; None: all in one line.
    """
    return json.dumps(_with_one_zero(tree), indent=indent, allow_nan=False)


def json_bytes(tree: Any) -> bytes:
    """Return a tree as JSON in bytes without blanks; a zero has no sign."""
    return json.dumps(_with_one_zero(tree), allow_nan=False, separators=(",", ":")).encode()


def _with_one_zero(tree: Any) -> Any:
    """Return a tree in which no zero is negative: a reader takes -0.0 for a sign."""
    if isinstance(tree, float):
        return tree + 0.0  # -0.0 + 0.0 is 0.0
    if isinstance(tree, Mapping):
        return {name: _with_one_zero(value) for name, value in tree.items()}
    if isinstance(tree, list | tuple):
        return [_with_one_zero(value) for value in tree]
    return tree
