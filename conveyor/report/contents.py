"""What a report holds: every table under a name that others link to, in SI or US units; no spreadsheet in sight.

Sheets, names of tables and of columns are stable: docs/workbook.md lists them.
"""

from __future__ import annotations

import platform
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import date
from functools import cached_property
from importlib.metadata import version
from typing import TYPE_CHECKING, Final

import pandas as pd

from conveyor.report import case_tables, loop_tables, tables
from conveyor.report import inputs as fields
from conveyor.report.checks import checks
from conveyor.report.unit_systems import converted, converted_figure
from conveyor.spec import fingerprint
from conveyor.units import System, si

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies

_UNIT: Final = re.compile(r" \[[^\]]*\]$")
_SHORTER: Final = {
    "indentation_share_of_main_resistance": "indentation_share",
    "equivalent_din_f": "equivalent_f",
    "energy": "specific_energy",
    "indentation": "indentation_force",
    "flexure": "flexure_force",
    "secondary": "secondary_force",
    "special": "special_force",
    "idler_rotation": "idler_rotation_force",
    "take_up_mean_tension_of_the_loop": "take_up_mean_tension",
    "take_up_mass_of_a_gravity_take_up": "take_up_mass",
    "take_up_pull_on_the_rope_of_a_winch": "take_up_pull",
    "largest_error_estimate_of_the_contacts": "contact_error_estimate",
    "largest_energy_error_of_the_contacts": "contact_energy_error",
}
_VERSIONED: Final = ("conveyor", "numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl")
_CASE_TENSIONS: Final = (
    "case", "temperature [degC]", "belt speed [m/s]", "tight side tension [N]", "slack side tension [N]",
    "largest tension [N]", "smallest tension [N]", "take-up tension asked for [N]", "largest roll load [N]",
    "governed by", "at roll",
)  # fmt: skip
CHECKS_AND_NOTES: Final = "Checks and notes"


@dataclass(frozen=True)
class Part:
    """A table of a report.

    Attributes
    ----------
    sheet, key : str
        Sheet it stands on, and its name: of the range in the workbook (``table_<key>``) and of its file.
    heading : str
        Words above it.
    frame : DataFrame
        The table, units in the names.
    by_row : str
        Column that names the figure of each row with its unit; empty where columns have units.
    names : str or None
        Where rows are figures that others link to, what the names of their cells begin with.
    note : str
        What to know of it.
    """

    sheet: str
    key: str
    heading: str
    frame: pd.DataFrame
    by_row: str = ""
    names: str | None = None
    note: str = ""

    def figures(self) -> dict[str, int]:
        """Names of the figures in column "value", and their rows."""
        if self.names is None:
            return {}
        return {figure_name(str(name), self.names): i for i, name in enumerate(self.frame[self.by_row])}


def figure_name(figure: str, prefix: str = "") -> str:
    """Return the name others link to a figure by: lower case, without its unit.

    Examples
    --------
    >>> figure_name("motor power [kW]"), figure_name("setting [N]", "take_up_")
    ('motor_power', 'take_up_setting')
    """
    slug = re.sub(r"[^a-z0-9]+", "_", _UNIT.sub("", figure).lower()).strip("_")
    return _SHORTER.get(prefix + slug, prefix + slug)


@dataclass(frozen=True)
class Contents:
    """The tables of a report in their order, none of them empty, and the system they are in."""

    parts: tuple[Part, ...]
    system: System

    @cached_property
    def by_key(self) -> dict[str, Part]:
        """Tables by name."""
        return {part.key: part for part in self.parts}

    def __getitem__(self, key: str) -> Part:
        return self.by_key[key]

    def of(self, sheet: str) -> tuple[Part, ...]:
        """Tables of one sheet."""
        return tuple(part for part in self.parts if part.sheet == sheet)

    @property
    def sheets(self) -> tuple[str, ...]:
        """Sheets that hold a table, in order."""
        return tuple(dict.fromkeys(part.sheet for part in self.parts))


def in_system(part: Part, system: System) -> Part:
    """Return a table in a unit system: columns with a unit by it, others by the unit of their row's figure."""
    if system == "SI":
        return part
    frame = part.frame
    if not part.by_row:
        return replace(part, frame=converted(frame, system))
    figures = [str(figure) for figure in frame[part.by_row]]
    columns: dict[str, list[object]] = {}
    for name in map(str, frame.columns):
        values = frame[name].tolist()
        if name == part.by_row:
            columns[name] = [converted_figure(figure, [], system)[0] for figure in figures]
        elif _UNIT.search(name):
            columns.update([converted_figure(name, values, system)])
        else:
            rows = zip(figures, values, strict=True)
            columns[name] = [converted_figure(figure, [value], system)[1][0] for figure, value in rows]
    return replace(part, frame=pd.DataFrame(columns, dtype=object))


def gathered(parts: Iterable[Part], system: System) -> Contents:
    """Put the tables that hold something together, in a unit system."""
    return Contents(tuple(in_system(part, system) for part in parts if not part.frame.empty), system)


def listed(figures: pd.Series, names: str = "quantity", value: str = "value") -> pd.DataFrame:
    """Return figures as a table of two columns."""
    return figures.rename_axis(names).rename(value).reset_index()


def of_analysis(analysis: Analysis, studies: Studies | None = None) -> Contents:
    """Every table of an analysis and of its studies, in the system of its conveyor's report."""
    system = analysis.conveyor.report.units
    parts = (
        *_figures(analysis),
        *_line(analysis),
        *_loop(analysis),
        *(() if studies is None else _studies(studies)),
        *_contacts(analysis),
        *_known(analysis, studies, system),
    )
    return gathered(parts, system)


def _figures(analysis: Analysis) -> Iterator[Part]:
    results = listed(analysis.summary)
    results["name"] = [figure_name(str(name)) for name in results["quantity"]]
    yield Part("Results", "results", "Figures of the whole conveyor", results, "quantity", "")
    yield Part("Inputs", "inputs", "Inputs as entered and in SI", fields.inputs(analysis.conveyor))


def _line(analysis: Analysis) -> Iterator[Part]:
    found = analysis.balance
    yield Part("Sections", "sections", "Forces of every section and strand", analysis.sections)
    yield Part("Resistances", "resistances", "Every force and the law it comes from", analysis.resistances)
    yield Part("Resistances", "breakdown", "Breakdown of the effective tension", breakdown(analysis))
    yield Part(
        "Resistances",
        "classical",
        "Beside the classical estimate (ISO 5048 / DIN 22101, given f)",
        tables.comparison(found).rename_axis("quantity").reset_index(),
        "quantity",
        note=f"classical secondary: {found.classical.secondary_by}",
    )
    yield Part("Rolls", "rolls", "Rolls of a set, contact at the highest line load", analysis.rolls)
    heading = "Tension round the loop, steady running, from the drive"
    yield Part("Tensions", "tensions", heading, tables.tensions(found))


def breakdown(analysis: Analysis) -> pd.DataFrame:
    """Sums of the forces by what they are, and their share."""
    forces = analysis.balance.forces
    names = ("indentation", "idler_rotation", "flexure", "secondary", "special", "lift")
    values = [getattr(forces, name) for name in names]
    share = [value / forces.total for value in values] if forces.total else [None] * len(values)
    labels = [name.replace("_", " ") for name in names]
    return pd.DataFrame({"resistance": labels, "force [N]": values, "share of total [-]": share})


def _loop(analysis: Analysis) -> Iterator[Part]:
    found, duty, moving = analysis.balance, analysis.belt_duty, analysis.motions
    profile = loop_tables.profile(analysis.conveyor)
    states = loop_tables.tension_states(found, moving)
    yield Part("States", "profile", "Profile of the route", profile)
    yield Part("States", "tension_states", "Tension in every state of motion", states)
    yield Part("Loop", "drives", "Drives in every state of motion", loop_tables.drives(found))
    take_up = loop_tables.take_up(found)
    words = {name: value for name, value in take_up.items() if isinstance(value, str)}
    note = ", ".join(f"{name}: {value}" for name, value in words.items())
    figures = listed(take_up.drop(list(words)).astype(float))
    yield Part("Loop", "take_up", "Take-up", figures, "quantity", "take_up_", note)
    yield Part(
        "Loop",
        "tension_conditions",
        "What asks for the tension of the take-up",
        loop_tables.conditions(found),
    )
    motion = listed(loop_tables.start_stop(moving))
    yield Part("Loop", "start_stop", "Start and stop", motion, "quantity", "motion_")
    strength = listed(loop_tables.belt(duty))
    yield Part("Loop", "belt_strength", "Strength of the belt", strength, "quantity", "belt_")
    yield Part("Loop", "pulleys", "Pulleys", loop_tables.pulleys(duty))
    yield Part("Loop", "vertical_curves", "Vertical curves", loop_tables.curves(duty))
    settled = listed(loop_tables.convergence(analysis.convergence))
    yield Part("Loop", "convergence", "How tensions and roll loads settled", settled, "quantity")


def _studies(studies: Studies) -> Iterator[Part]:
    if studies.cases is not None:
        low, high = studies.cases.friction_band
        decides = case_tables.governing(studies.cases)
        if not decides.empty:
            decides["figure"] = [f"{row.figure} [{row.unit}]" for row in decides.itertuples()]
            yield Part(
                "Load cases",
                "governing_cases",
                "Governing cases",
                decides.drop(columns="unit"),
                "figure",
                "governing_",
                f"friction between {low:g} and {high:g} of the computed one, to the safe side",
            )
            motors = case_tables.motors(studies.cases.motors())
            figures = case_tables.cases(studies.cases)
            tensions = [name for name in _CASE_TENSIONS if name in figures.columns]
            yield Part("Load cases", "load_cases", "Load cases", figures.drop(columns=tensions[3:]))
            heading = "Tensions and roll loads of the cases"
            yield Part("Load cases", "case_tensions", heading, figures[tensions])
            yield Part("Load cases", "motors", "Motors of the series", motors)
        refused = case_tables.refused_cases(studies.cases)
        yield Part("Load cases", "refused_cases", "Cases without an answer", refused)
    if studies.duty is not None:
        year = listed(case_tables.year(studies.duty))
        yield Part("Duty", "duty_year", "The year", year, "quantity", "year_")
        bars = case_tables.duty(studies.duty)
        yield Part("Duty", "duty", "Hours at load, temperature and speed", bars)
    if studies.uncertainty is not None:
        band, effects = case_tables.band(studies.uncertainty), case_tables.tornado(studies.uncertainty)
        yield Part("Uncertainty", "power_band", "Motor power with its band", band)
        note = "; ".join(studies.uncertainty.notes)
        yield Part("Uncertainty", "sensitivity", "Which input matters", effects, note=note)


def _contacts(analysis: Analysis) -> Iterator[Part]:
    conveyor = analysis.conveyor
    heading = "Contacts, one a distinct roll, cover and spacing"
    yield Part("Indentation", "contact_solutions", heading, tables.solver(analysis.stretches))
    heading = "Indentation against line load, one block a contact"
    yield Part("Indentation", "indentation", heading, tables.indentation_curves(analysis.stretches))
    yield Part("Rubber", "rubber", "What the rolls ask of the rubber", analysis.rubber)
    at = si(conveyor.ambient.belt)
    for strand, compound in (("carry", conveyor.carry_compound), ("return", conveyor.return_compound)):
        prony, moduli = tables.prony(compound, at), tables.moduli(compound, at)
        yield Part("Rubber", f"prony_{strand}", "Relaxation spectrum", prony)
        yield Part("Rubber", f"moduli_{strand}", "Moduli at the belt's temperature", moduli)


def _known(analysis: Analysis, studies: Studies | None, system: System) -> Iterator[Part]:
    checked = [(c.subject, c.found, c.asked, c.verdict) for c in checks(analysis, system, studies)]
    columns = ["check", "found", "asked for", "verdict"]
    yield Part(CHECKS_AND_NOTES, "checks", "Checks", pd.DataFrame(checked, columns=columns))
    said = [("warning", line) for line in analysis.warnings]
    said += [("assumption", line) for line in analysis.assumptions]
    said += [("note of the spec", line) for line in (analysis.conveyor.notes or "").splitlines() if line]
    yield Part(CHECKS_AND_NOTES, "remarks", "Remarks", pd.DataFrame(said, columns=["kind", "text"]))
    yield Part(CHECKS_AND_NOTES, "provenance", "Provenance", provenance(fingerprint(analysis.conveyor)))


def provenance(spec: str) -> pd.DataFrame:
    """What made the figures; `spec` is the spec's SHA-256."""
    facts = {
        "spec SHA-256": spec,
        "date": date.today().isoformat(),
        "python": platform.python_version(),
        **{name: version(name) for name in _VERSIONED},
    }
    return pd.DataFrame(list(facts.items()), columns=["made by", "version"])
