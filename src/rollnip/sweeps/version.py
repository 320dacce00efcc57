"""The version of the code that solves: only rows computed by the same code may be combined."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]
# Rooms that only ask for solutions or show them; the rest of the package determines the numbers.
_ASKS = {"design", "identification", "dma", "lda", "paper", "verification"}
_SHOWS = {"cli", "web", "plots"}
BESIDE = frozenset(_ASKS | _SHOWS)
_DIGITS = 10


@cache
def own_version() -> str:
    """Return the version of rollnip in this process with the fingerprint of its code.

    For example "0.1.0 (code 3f9a1c20d4)"; "0.1.0" where the sources cannot be read.
    """
    release = version("rollnip")
    try:
        code = fingerprint(_PACKAGE)
    except OSError:
        code = ""
    return f"{release} (code {code})" if code else release


def fingerprint(package: Path) -> str:
    """Return a hash of the sources that determine the numbers; empty where there are none.

    The hash is the same on every system, whatever the line endings. Raises OSError where a source
    cannot be read.
    """
    digest = sha256()
    names = sorted(path.relative_to(package).as_posix() for path in package.rglob("*.py"))
    names = [name for name in names if name.partition("/")[0] not in BESIDE]
    for name in names:
        source = (package / name).read_bytes().replace(b"\r\n", b"\n")
        digest.update(f"{name}:{len(source)}:".encode())
        digest.update(source)
    return digest.hexdigest()[:_DIGITS] if names else ""
