"""Transfers between databases: merge the shards of a study, and reuse cases of other studies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rollnip._errors import RollnipError
from rollnip.io import case_hash, parse_case
from rollnip.sweeps.store import About, Store
from rollnip.sweeps.study import Study

_SHOWN = 5


@contextmanager
def merged(databases: Sequence[Path]) -> Iterator[Store]:
    """Yield all cases of a study, merged from the databases of its shards into a temporary one.

    Raises
    ------
    RollnipError
        where a file is no database of a sweep or is in use, the databases belong to different
        studies
        or versions, or cases are missing.
    """
    with TemporaryDirectory(prefix="rollnip-") as folder:
        target: Store | None = None
        try:
            for path in databases:
                with Store(path) as shard:
                    _require_study(path, shard.about)
                    if target is None:
                        whole = replace(shard.about, shard=(1, 1))
                        target = Store(Path(folder) / "merged.db", whole)
                    _require_same(path, shard.about, databases[0], target.about)
                    target.take(shard)
            if target is None:
                raise RollnipError("There is no database to merge.")
            _require_all(target)
            yield target
        finally:
            if target is not None:
                target.close()


def take_known(study: Study, store: Store, databases: Sequence[Path]) -> int:
    """Copy those cases of a study that other databases hold already, matched by their hash.

    Parameters
    ----------
    study, store :
        the study and its database.
    databases :
        databases of other sweeps with the same version of rollnip.

    Returns
    -------
    The number of cases copied.

    Raises
    ------
    RollnipError
        where a file is no database of a sweep, is in use, or is of another version.
    """
    taken = 0
    for path in databases:
        with Store(path) as other:
            _require_same_version(path, other.about, Path(store.name), store.about)
            known = other.known()
            held = store.held(with_profiles=False)
            for position in (one for one in store.about.positions if not held[one]):
                there = known.get(_hash(study, position))
                if there is not None:
                    store.adopt(other, there, position, study.values(position))
                    taken += 1
    return taken


def _hash(study: Study, position: int) -> str:
    """Return the hash of a case; empty where the case is invalid."""
    try:
        return case_hash(parse_case(study.case(position)))
    except RollnipError:
        return ""


def _require_study(path: Path, about: About) -> None:
    if not about.count:
        raise RollnipError(f"{path}: holds the cases of a search, no study to be merged.")


def _require_same(path: Path, found: About, first: Path, about: About) -> None:
    _require_same_version(path, found, first, about)
    if found.study != about.study:
        raise RollnipError(f"{path}: holds another study than {first}; merge each apart.")


def _require_same_version(path: Path, found: About, first: Path, about: About) -> None:
    if found.version != about.version:
        raise RollnipError(
            f"{path}: was made by rollnip {found.version}, {first} by {about.version}; results of "
            "two versions are not mixed."
        )


def _require_all(store: Store) -> None:
    missing = np.flatnonzero(~store.held(with_profiles=False))
    if missing.size:
        shown = ", ".join(map(str, missing[:_SHOWN])) + (", ..." if missing.size > _SHOWN else "")
        raise RollnipError(
            f"{missing.size:,} of {store.about.count:,} cases are missing (case {shown}): run "
            "their shards to the end, and name all databases. One that was copied while its sweep "
            "ran, or after it was killed, also needs the file -wal beside it."
        )
