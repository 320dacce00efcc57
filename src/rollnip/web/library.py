"""What the page offers to begin with: examples and materials, each with its source."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any


def examples() -> list[dict[str, Any]]:
    """Cases of the paper: name, title, group, description, case."""
    return [_example(path, "paper") for path in sorted(_paper_folder().glob("*.toml"))]


def _example(path: Path, group: str) -> dict[str, Any]:
    text = path.read_text(encoding="utf-8")
    case = tomllib.loads(text)
    comments = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comments.append(line.removeprefix("#").strip())
    return {
        "name": path.stem,
        "title": case["title"],
        "group": group,
        "description": " ".join(comments),
        "case": case,
    }


def _paper_folder() -> Path:
    """Beside the package in a wheel, at the root of the source tree."""
    package = Path(str(files("rollnip")))
    inside = package / "examples"
    return inside if inside.is_dir() else package.parents[1] / "examples"
