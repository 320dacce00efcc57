"""Make every picture of docs/gallery.md by running the code on that page."""

from __future__ import annotations

import os
import re
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "gallery.md"


def code_blocks(page: Path) -> list[str]:
    """The Python blocks of a page, in their order."""
    return re.findall(r"^```python\n(.*?)^```", page.read_text("utf-8"), re.DOTALL | re.MULTILINE)


def make_pictures(folder: Path = ROOT) -> None:
    """Run the blocks in one namespace, in a folder that holds examples/ and docs/figures/."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        names: dict[str, object] = {}
        for block in code_blocks(PAGE):
            exec(compile(block, str(PAGE), "exec"), names)
    finally:
        os.chdir(before)


if __name__ == "__main__":
    make_pictures()
