"""Only regular files of a bounded size are read, whatever asks for them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from rollnip._errors import RollnipError
from rollnip._reading import UnreadableError, read_regular
from rollnip.dma import read_dma
from rollnip.io import read_case, read_columns, read_profile
from rollnip.io.velocities import read_velocities
from rollnip.sweeps.study_file import read_study

READERS = (read_case, read_columns, read_profile, read_velocities, read_dma, read_study)


def test_a_file_is_returned_whole(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"\0abc\r\n")
    assert read_regular(path, 6) == b"\0abc\r\n"
    with pytest.raises(UnreadableError, match="at most 5 bytes"):
        read_regular(path, 5)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_is_refused_before_it_could_block(tmp_path):
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    # In a process of its own: a reader that waits for a writer would wait for ever.
    code = "from rollnip import RollnipError\n"
    for read in READERS:
        code += (
            f"from {read.__module__} import {read.__name__}\n"
            f"print({read.__name__!r}, end=' ', flush=True)\n"
            f"try: {read.__name__}({str(pipe)!r})\n"
            "except RollnipError as error: print(error)\n"
        )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    said = done.stdout.splitlines()
    assert [line.split()[0] for line in said] == [read.__name__ for read in READERS]
    for line in said:
        assert "pipe.csv: must be a regular file, it is a pipe or a device" in line


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no endless device")
@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__name__)
def test_a_device_is_refused(read):
    with pytest.raises(RollnipError, match="/dev/zero: must be a regular file"):
        read("/dev/zero")


@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__name__)
def test_a_folder_and_what_is_not_there_are_refused(read, tmp_path):
    with pytest.raises(RollnipError, match="is a directory"):
        read(tmp_path)
    with pytest.raises(RollnipError, match="there is no such file"):
        read(tmp_path / "none.csv")


@pytest.mark.parametrize("read", READERS[:5], ids=lambda read: read.__name__)
def test_a_file_beyond_the_limit_is_refused_without_being_read(read, tmp_path):
    path = tmp_path / "large.csv"
    with path.open("wb") as stream:
        stream.truncate(2**40)  # takes no room on the disk, and would not fit into memory
    with pytest.raises(RollnipError, match="must be at most"):
        read(path)
