"""Presentation of a solution: in one line, as a summary, in a notebook, as a dataset."""

from __future__ import annotations

from typing import Any

from rollnip._extras import require_extra
from rollnip._results import summary
from rollnip._results.case import case_tree, problem_hash
from rollnip._results.dataset import result_dataset
from rollnip._results.tree import result_dict
from rollnip.figure import Units, checked_units
from rollnip.model import Model
from rollnip.nip import Nip


class Presented:
    """Base class of solutions: their case, summary and dataset."""

    nip: Nip
    model: Model

    @property
    def case(self) -> dict[str, Any]:
        """Problem and model as the tree of a case file: base units, defaults written out."""
        return case_tree(self.nip, self.model)

    @property
    def case_hash(self) -> str:
        """16 hexadecimal digits that identify problem and model; the title does not count."""
        return problem_hash(self.nip, self.model)

    def summary(self, units: Units = "metric") -> str:
        """Return the figures with units and errors, the zones and the warnings, as lines of text.

        A figure that can have either sign is shown as 0 below a twentieth of its estimated error.
        Stresses on interfaces may take longer than the solution and are left out; see
        ``interfaces``.

        Parameters
        ----------
        units : "metric", or "us": in, pli, psi, fpm, hp.

        Raises
        ------
        InvalidInputError
            where ``units`` is neither of these.
        """
        return summary.text(self, checked_units("units", units))

    def to_xarray(self, *, interfaces: bool = False) -> Any:
        """Return the result as an xarray Dataset, with the contents of the netCDF file.

        Parameters
        ----------
        interfaces : whether to include the stresses on interfaces, which may take longer than the
            solution.

        Raises
        ------
        RollnipError
            where xarray is not installed.
        """
        require_extra("netcdf", "to_xarray")
        return result_dataset(result_dict(self, interfaces=interfaces))

    def __repr__(self) -> str:
        return summary.brief(self)

    def _repr_html_(self) -> str:
        return summary.html(self)
