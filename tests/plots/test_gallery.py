"""The gallery's code makes the gallery's pictures."""

import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


@pytest.mark.slow
def test_every_picture_is_made_and_shown(tmp_path):
    (tmp_path / "docs" / "figures").mkdir(parents=True)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    script = runpy.run_path(str(DOCS / "scripts" / "gallery_pictures.py"))
    script["make_pictures"](tmp_path)
    made = {path.name for path in (tmp_path / "docs" / "figures").iterdir()}
    page = (DOCS / "gallery.md").read_text("utf-8")
    assert made == set(re.findall(r"\(figures/([\w.]+)\)", page))
    assert made <= {path.name for path in (DOCS / "figures").iterdir()}


def test_code_is_short():
    script = runpy.run_path(str(DOCS / "scripts" / "gallery_pictures.py"))
    blocks = script["code_blocks"](DOCS / "gallery.md")
    assert len(blocks) > 10
    assert all(len(block.strip().splitlines()) <= 10 for block in blocks)
