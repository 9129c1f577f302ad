"""Cover data, units and paper of reports; no effect on figures."""

from __future__ import annotations

from typing import Literal

from conveyor.languages import Language
from conveyor.models.base import Model, Name
from conveyor.units import System
from conveyor.units.unit_systems import trade_of

Paper = Literal["A4", "Letter"]


class Report(Model):
    """What stands on the cover of reports, and how they are written; no effect on figures."""

    project: Name | None = None
    """Project or plant the conveyor belongs to."""
    number: Name | None = None
    """Number of the document."""
    client: Name | None = None
    """For whom it is calculated."""
    engineer: Name | None = None
    """Who calculated it."""
    reviewer: Name | None = None
    """Who checked it."""
    approval: Name | None = None
    """Who approved it."""
    revision: Name | None = None
    """Revision of the document."""
    units: System = "SI"
    """System of units of reports and refusals; with US motors are suggested of NEMA, pulleys of CEMA."""
    language: Language = "en"
    """Language of page, PDF and workbook; tables and figures as files, JSON and the terminal are English."""
    paper: Paper | None = None
    """Paper that workbooks are set up for."""

    def sheet(self, system: System) -> Paper:
        """Paper size: as stated, else Letter with US units and A4 with SI."""
        return self.paper or ("Letter" if trade_of(system) == "US" else "A4")
