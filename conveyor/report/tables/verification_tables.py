"""Tables of the sheet for a belt maker: our figures, and empty columns for theirs; declared once."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from conveyor.files.output_marks import package_version
from conveyor.measured.rolling_test_table import FORM_SHEET
from conveyor.models import Report
from conveyor.models.given_names import given_names, given_notes
from conveyor.report.table_model import Column, Contents, PagePlacement, ReportHead, Table, remark_table
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from conveyor.studies.verification import CalculatedVerification

ABOUT: Final = "About"
PER_WIDTH: Final = FORM_SHEET
PER_SET: Final = "Idler set"
PARTS: Final = (
    ("assumptions", "What these figures are"),
    ("to-fill-in", "To fill in"),
    ("per-width", "Resistance per width"),
    ("per-set", "Resistance of an idler set"),
)
"""Parts of the page."""
_TO_FILL_IN: Final = (
    "maker", "belt or compound", "laboratory", "standard of the test", "date of the test", "remarks",
)  # fmt: skip


def verification_contents(sheet: CalculatedVerification, system: System) -> Contents:
    """Contents of a verification sheet in a unit system."""
    names = ", ".join(compound.name for compound in sheet.compounds)
    facts = (
        ("compounds", names),
        ("calculated by", f"conveyor {package_version('conveyor')}"),
        ("conveyor of the idler set", "none" if sheet.conveyor is None else sheet.conveyor.name),
    )
    title = f"Rolling resistance of {names}"
    report = Report() if sheet.conveyor is None else sheet.conveyor.report
    given, notes = (partial(texts, (*sheet.compounds, sheet.conveyor)) for texts in (given_names, given_notes))
    paper = report.sheet(system)
    about = ReportHead(title, "Verification sheet", {}, "", paper, facts, report.language, given, notes)
    what = remark_table({"assumption": basis_lines(sheet)}, ABOUT, "What these figures are")
    parts = (what, fill_in_table(), resistance_per_width(sheet, system), resistance_per_set(sheet))
    return Contents.of(about, parts, system, page=PARTS, layout="verification")


def basis_lines(sheet: CalculatedVerification) -> Iterator[str]:
    """Sentences on the basis of the figures."""
    yield (
        "Indentation rolling resistance of the cover alone, of one rigid roll in steady running: force per width "
        "against the belt's motion under a line load; without roll drag, flexure of the belt and losses of the rig."
    )
    yield (
        "Contact is plane strain, frictionless, of a cover bonded to a carcass that does not give (confined); "
        "the line load is even over the width."
    )
    for compound in sheet.compounds:
        yield f'Compound "{compound.name}" ({compound.kind}): {_strain_text(compound, softened=sheet.softened)}.'
    yield (
        "Figures follow from the compound's small-sample dynamic moduli. Those of a compound that holds tests of "
        "rolling resistance have their test factor; others have none, and published tests of belts lie above them."
    )
    if sheet.conveyor is not None:
        yield (
            f'The idler set is the most loaded carry set of "{sheet.conveyor.name}" at its flow and speed: the sum '
            "of its rolls, each under its own distribution of load, moduli as its calculation.strain says."
        )
    yield (
        "Please fill in the marked columns for the same roll, cover, speed, temperature and line load, measured or "
        "from your own test-based calculation, and say which."
    )


def _strain_text(compound: Any, *, softened: bool) -> str:
    known = compound.strain_dependence
    if known is None:
        return "linear, its moduli at the strain they were measured at"
    if softened:
        return "moduli at the strain of every roll, where its strain sweeps reach; elsewhere those of the master curve"
    return "linear, moduli at the strain of its master curve; its strain sweeps are not used here"


def fill_in_table() -> Table:
    """Details of the maker's test, to fill in."""
    columns = (
        Column("of the test", "text", lambda row: row),
        Column("maker", "text", lambda _: None, asked=True),
    )
    return Table("to_fill_in", ABOUT, "To fill in", columns, _TO_FILL_IN, (PagePlacement("to-fill-in", "Of the test"),))


def resistance_per_width(sheet: CalculatedVerification, system: System) -> Table:
    """Indentation resistance per width; two columns per line load, ours and the maker's."""
    strength = display_unit("strength", system)
    pairs: list[Column] = []
    for k, load in enumerate(sheet.line_loads):
        said = f"{strength.shown(load):.4g} {strength.sign}"
        pairs += [
            Column(f"at {said}, ours", "line force", f"resistances.{k}", key=f"ours_{k + 1}"),
            Column("maker", "line force", lambda _: None, asked=True, key=f"maker_{k + 1}"),
        ]
    columns = (
        Column("compound", "text", "compound"),
        Column("cover", "size", "cover"),
        Column("roll", "size", "diameter"),
        Column("belt speed", "speed", "speed", key="speed"),
        Column("temperature", "temperature", "temperature"),
        *pairs,
        Column("no figure because", "text", lambda row: row.reason or None, sparse=True),
    )
    heading = "Indentation resistance per width under line loads"
    return Table("per_width", PER_WIDTH, heading, columns, sheet.rows, "per-width", named=5)


def resistance_per_set(sheet: CalculatedVerification) -> Table:
    """Indentation resistance of the most loaded carry set, by compound and temperature."""
    columns = (
        Column("compound", "text", "compound"),
        Column("section", "text", "section"),
        Column("temperature", "temperature", "temperature"),
        Column("load of the set", "force", "load"),
        Column("ours", "force", "resistance"),
        Column("maker", "force", lambda _: None, asked=True),
        Column("no figure because", "text", lambda row: row.reason or None, sparse=True),
    )
    heading = "Indentation resistance of the most loaded carry set"
    return Table("per_set", PER_SET, heading, columns, sheet.sets, "per-set", named=3)


def verification_json(sheet: CalculatedVerification) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys."""
    return {
        "compounds": [compound.name for compound in sheet.compounds],
        "softened": sheet.softened,
        "line_loads_N_per_m": list(sheet.line_loads),
        "rows": [
            {
                "compound": row.compound,
                "cover_m": row.cover,
                "roll_diameter_m": row.diameter,
                "speed_m_per_s": row.speed,
                "temperature_K": row.temperature,
                "resistance_N_per_m": list(row.resistances),
                "reason": row.reason,
            }
            for row in sheet.rows
        ],
        "sets": [
            {
                "compound": row.compound,
                "section": row.section,
                "temperature_K": row.temperature,
                "load_N": row.load,
                "resistance_N": row.resistance,
                "reason": row.reason,
            }
            for row in sheet.sets
        ],
        "what": list(basis_lines(sheet)),
    }
