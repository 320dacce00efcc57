"""Run Python as if only the core of rollnip and some of its extras were installed.

    python bare.py EXTRAS ARGUMENTS...     extras with commas between, "-" for none

Every package that neither rollnip itself nor these extras ask for, directly or through others,
cannot be imported. ARGUMENTS are those of the command `rollnip`; after ``-c`` comes a program.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from types import ModuleType


def plain(name: str) -> str:
    """The name of a distribution as it is compared."""
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(extras: set[str]) -> set[str]:
    """Distributions that rollnip with these extras asks for, and those that they ask for."""
    found: set[str] = set()
    open_ones = [("rollnip", frozenset(extras))]
    seen = set()
    while open_ones:
        name, wanted = open_ones.pop()
        if (name, wanted) in seen:
            continue
        seen.add((name, wanted))
        try:
            lines = requires(name) or []
        except PackageNotFoundError:
            continue  # for another system or another Python
        found.add(plain(name))
        for line in lines:
            requirement, _, marker = line.partition(";")
            match = re.match(r"\s*([\w.-]+)\s*(?:\[([^]]*)\])?", requirement)
            assert match
            asked = re.findall(r"extra\s*==\s*[\"']([^\"']+)[\"']", marker)
            if not asked or set(asked) & wanted:
                of_its_own = frozenset(re.split(r"\s*,\s*", match[2])) if match[2] else frozenset()
                open_ones.append((match[1], of_its_own))
    return found


class Absent(MetaPathFinder):
    """Finds that the packages of other distributions are not there."""

    def __init__(self, extras: set[str]) -> None:
        there = needed(extras)
        self.absent = {
            module
            for module, owners in packages_distributions().items()
            if not {plain(owner) for owner in owners} & there
        }

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if path is None and name in self.absent:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return None


def hide(extras: set[str]) -> None:
    """Hide what these extras do not ask for; ``find_spec`` finds nothing then."""
    import importlib.util

    finder = Absent(extras)
    sys.meta_path.insert(0, finder)
    find = importlib.util.find_spec
    importlib.util.find_spec = lambda name, package=None: (
        None if name.partition(".")[0] in finder.absent else find(name, package)
    )


if __name__ == "__main__":
    chosen, *arguments = sys.argv[1:]
    hide(set() if chosen == "-" else set(chosen.split(",")))
    if arguments[0] == "-c":
        exec(arguments[1])
    else:
        from rollnip.cli import main

        sys.argv = ["rollnip", *arguments]
        main()
