import errno
import os
from pathlib import Path

import pytest

from rollnip._errors import RollnipError
from rollnip._files import check_place, check_target, write_whole


def test_writes_and_leaves_nothing_else(tmp_path):
    target = tmp_path / "a.txt"
    write_whole(target, lambda file: file.write_text("new"))
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "No space left"), KeyboardInterrupt()])
def test_a_failure_half_way_leaves_the_old_file(tmp_path, failure):
    target = tmp_path / "a.txt"
    target.write_text("old")

    def write(file: Path) -> None:
        file.write_text("half")
        raise failure

    with pytest.raises((RollnipError, KeyboardInterrupt)) as caught:
        write_whole(target, write)
    if caught.type is RollnipError:
        assert str(caught.value) == f"{target}: cannot write: No space left."
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_writes_through_a_link(tmp_path):
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    real.write_text("old")
    link.symlink_to(real)
    write_whole(link, lambda file: file.write_text("new"))
    assert link.is_symlink()
    assert real.read_text() == "new"


@pytest.mark.parametrize("through_a_link", [False, True])
def test_a_pipe_stays_a_pipe(tmp_path, through_a_link):
    """A file took its place; with a link to /dev/full, the place of that device."""
    pipe, link = tmp_path / "pipe.json", tmp_path / "link.json"
    os.mkfifo(pipe)
    link.symlink_to(pipe)
    target = link if through_a_link else pipe
    said = f"{target}: cannot write, it is a pipe or a device; name a file."
    for call in (
        lambda: check_target(target, (".json",)),
        lambda: write_whole(target, lambda file: file.write_text("new")),
    ):
        with pytest.raises(RollnipError) as caught:
            call()
        assert str(caught.value) == said
    assert pipe.is_fifo()
    assert {one.name for one in tmp_path.iterdir()} == {"pipe.json", "link.json"}


def test_a_name_too_long_is_one_line(tmp_path):
    with pytest.raises(RollnipError, match="cannot write"):
        write_whole(tmp_path / ("x" * 254 + ".json"), lambda file: file.write_text(""))


def test_targets(tmp_path):
    check_target(tmp_path / "a.JSON", (".json",))
    (tmp_path / "folder.json").mkdir()
    for path, hint in (
        (tmp_path / "a.txt", "end in .json"),
        (tmp_path / "folder.json", "directory"),
        (tmp_path / "none" / "a.json", "no directory"),
    ):
        with pytest.raises(RollnipError, match=hint):
            check_target(path, (".json",))
    check_place(tmp_path / "a.txt")
    with pytest.raises(RollnipError, match="there is no directory"):
        check_place(tmp_path / "none" / "a.db")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(RollnipError, match="not writable"):
        check_target(tmp_path / "a.json", (".json",))
