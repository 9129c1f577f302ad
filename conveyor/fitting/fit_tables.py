"""Tables of a fit, declared once: those of the page to sign, and the others of the workbook."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Final

import numpy as np

from conveyor.files import output_marks
from conveyor.fitting.amplitude import WORKING_STRAIN, strain_text
from conveyor.fitting.fit_verdict import GLOSSARY, Criterion, compound_law
from conveyor.fitting.fitted_compound import FittedCompound
from conveyor.fitting.shift_choice import law_constants
from conveyor.models.given_names import given_names, given_notes
from conveyor.models.report import Paper
from conveyor.report.table_model import Column, Contents, ReportHead, Table
from conveyor.rubber import AmplitudeFactors, StrainSweep
from conveyor.units.sentences import percent, to_celsius

DOCUMENT_FIELDS: Final = ("laboratory", "number", "specimen", "instrument", "method", "measured", "by")
"""Fields of the document, given or stated by the files under these names."""


def fit_contents(
    fitted: FittedCompound, criteria: Sequence[Criterion], document: Mapping[str, str], *, paper: Paper = "A4"
) -> Contents:
    """Every table of a fit.

    Parameters
    ----------
    fitted : FittedCompound
        The fit.
    criteria : sequence of Criterion
        Of `conveyor.fitting.fit_verdict.fit_criteria`.
    document : mapping of str to str
        Laboratory, number, specimen, instrument, method, measured, by; others are taken from the files.
    paper : {"A4", "Letter"}
        To print on.
    """
    about = document_fields(fitted, document)
    pairs = (("what", itemgetter(0)), ("words", itemgetter(1)))
    plain = tuple(Column(label, "text", get) for label, get in pairs)
    parts = (
        criteria_table(criteria),
        Table("about", "Verdict", "The master curve", plain, (*about.items(), *fit_facts(fitted))),
        shift_factor_table(fitted), law_table(fitted), file_table(fitted), master_curve_table(fitted),
        series_table(fitted), strain_sweep_table(fitted),
        Table("read", "Read and done", "What was read and done", plain[1:], tuple(("", w) for w in fitted.understood)),
        Table("unknown", "Read and done", "Not known", plain[1:], tuple(("", w) for w in fitted.compound.missing)),
        Table("glossary", "Glossary", "Glossary", plain, GLOSSARY),
        Table("provenance", "Read and done", "Made by", plain[1:], (("", output_marks.program_version()),)),
    )  # fmt: skip

    def given() -> frozenset[str]:
        return given_names(fitted.compound) | {*about.values(), *fitted.metadata.values(), *fitted.files}

    def notes() -> frozenset[str]:
        return given_notes(fitted.compound)

    head = ReportHead(fitted.compound.name, "Master curve of a rubber", about, "", paper, names=given, notes=notes)
    return Contents.of(head, parts, "SI")


def document_fields(fitted: FittedCompound, document: Mapping[str, str]) -> dict[str, str]:
    """Fields of the document, given or stated by the files."""
    stated = {key.lower(): value for key, value in fitted.metadata.items()}
    return {name: words for name in DOCUMENT_FIELDS if (words := document.get(name) or stated.get(name))}


def criteria_table(criteria: Sequence[Criterion]) -> Table:
    """Criteria, one row each."""
    columns = (
        Column("criterion", "text", "name"),
        Column("calculated", "text", "calculated"),
        Column("required", "text", "required"),
        Column("verdict", "verdict", "verdict"),
        Column("what it says", "text", "why", page=None),
        Column("remark", "text", lambda row: None if row.verdict == "pass" else row.why, sheet=False, sparse=True),
    )
    return Table("criteria", "Verdict", "Criteria", columns, tuple(criteria))


def fit_facts(fitted: FittedCompound) -> list[tuple[str, str]]:
    """Main facts of a fit, label and text."""
    fit, compound = fitted.fit, fitted.compound
    low, high = fit.window
    law = "none"
    if fitted.laws:
        kept = compound_law(fitted)
        law = ": ".join(filter(None, (kept.name, law_constants(kept, compound.reference))))
    kelvin = () if compound.range is None else compound.range.kelvin
    return [
        ("window", f"{low:.2g} to {high:.2g} Hz at {to_celsius(compound.reference):.4g} °C"),
        ("temperatures", " to ".join(f"{to_celsius(t):.0f} °C" for t in dict.fromkeys(kelvin))),
        ("shift law kept", law),
        ("rows", f"{fitted.rows.frequency.size} of {len(fitted.files)} file{'s' * (len(fitted.files) > 1)}"),
        ("terms", f"{fit.active_terms}, E_e {fit.series.equilibrium / 1e6:.3g} MPa"),
        ("error of the series, rms", f"E' {percent(fit.storage.rms, 1)}, E'' {percent(fit.loss.rms, 1)}"),
        ("strain", compound.strain or "not stated"),
        ("Poisson's ratio", f"{compound.poisson_ratio:g}"),
    ]


def shift_factor_table(fitted: FittedCompound) -> Table:
    """Shift factors of isotherms; empty without."""
    shifted = fitted.superposition
    columns = ("temperature", "log10 a_T", "standard error", "log10 b_T")
    kinds = ("temperature", "decades", "decades", "decades")
    rows: list[tuple[float, ...]] = []
    if shifted is not None:
        arrays = (shifted.temperatures, shifted.log10_a_T, shifted.log10_a_T_error, shifted.log10_b_T)
        rows = [tuple(row) for row in np.array(arrays).T.tolist()]
    return Table("shifts", "Shifts", "Shift factors found", _tuple_columns(columns, kinds), rows)


def law_table(fitted: FittedCompound) -> Table:
    """Constants and misfit of each shift law."""
    columns = (
        Column("law", "text", "name"),
        Column("constants", "text", lambda law: law_constants(law, fitted.compound.reference)),
        Column("rms", "decades", "rms"),
        Column("worst", "decades", "worst"),
        Column("at", "temperature", "worst_temperature"),
        Column("a shift left out is missed by", "decades", "left_out"),
        Column("remark", "text", "remark"),
    )
    return Table("laws", "Shifts", "Shift laws", columns, tuple(law for law in fitted.laws if law.law is not None))


def file_table(fitted: FittedCompound) -> Table:
    """Error of the series, file by file."""

    def rms(which: int, number: int) -> float:
        return float(np.sqrt(np.mean(fitted.fit.relative_errors[which][fitted.rows.file == number] ** 2)))

    columns = (
        Column("file", "text", lambda k: fitted.files[k]),
        Column("rows", "count", lambda k: int(np.count_nonzero(fitted.rows.file == k))),
        Column("E', rms", "share", lambda k: rms(0, k), key="storage"),
        Column("E'', rms", "share", lambda k: rms(1, k), key="loss"),
    )
    numbers = tuple(k for k in range(len(fitted.files)) if (fitted.rows.file == k).any())
    return Table("files", "Files", "Error of the series, file by file", columns, numbers)


def strain_sweep_table(fitted: FittedCompound) -> Table:
    """Strain sweeps: what was measured, its scatter, E' beside the master curve, and the factors under rolls."""
    factors = fitted.compound.amplitude_factors()
    levels = {(one.temperature, one.frequency): one.ratio for one in fitted.levels}

    def factor(name: str) -> Callable[[StrainSweep], float | None]:
        def at(sweep: StrainSweep) -> float | None:
            if factors is None or not sweep.strain[0] <= WORKING_STRAIN <= sweep.strain[-1]:
                return None
            alone = AmplitudeFactors([sweep], factors.reference_strain)
            return float(getattr(alone, name)(WORKING_STRAIN, sweep.temperature))

        return at

    def scatter(k: int) -> Callable[[StrainSweep], float | None]:
        return lambda sweep: None if sweep.scatter is None else sweep.scatter[k]

    columns = (
        Column("temperature", "temperature", "temperature"),
        Column("frequency", "frequency", "frequency"),
        Column("strains", "count", lambda sweep: sweep.strain.size),
        Column("lowest", "share", lambda sweep: float(sweep.strain[0])),
        Column("largest", "share", lambda sweep: float(sweep.strain[-1])),
        Column("scatter of E'", "share", scatter(0), key="storage_scatter"),
        Column("scatter of E''", "share", scatter(1), key="loss_scatter"),
        Column("E' over that of the master curve", "ratio", lambda s: levels.get((s.temperature, s.frequency))),
        Column(f"factor of E' at {strain_text(WORKING_STRAIN)}", "ratio", factor("storage"), key="storage_factor"),
        Column(f"factor of E'' at {strain_text(WORKING_STRAIN)}", "ratio", factor("loss"), key="loss_factor"),
    )
    return Table("strain_sweeps", "Strain sweeps", "Strain sweeps", columns, () if factors is None else factors.sweeps)


def master_curve_table(fitted: FittedCompound) -> Table:
    """Every row as measured and as shifted, and the series there."""
    rows, (f, storage, loss) = fitted.rows, fitted.rows.curve
    omega, made = 2.0 * np.pi * f, fitted.fit.series
    numbers = np.array([
        rows.temperature, rows.frequency, rows.storage, rows.loss, f, storage, loss, made.storage(omega),
        made.loss(omega), *fitted.fit.relative_errors,
    ]).T.tolist()  # fmt: skip
    kinds = ("temperature", "frequency", "pressure", "pressure") + ("frequency",) + ("pressure",) * 4 + ("share",) * 2
    names = (
        "temperature", "frequency", "E'", "E''", "reduced frequency", "reduced E'", "reduced E''", "E' of the series",
        "E'' of the series", "error of E'", "error of E''",
    )  # fmt: skip
    named = [(fitted.files[k], *row) for k, row in zip(rows.file.tolist(), numbers, strict=True)]
    columns = _tuple_columns(("file", *names), ("text", *kinds))
    return Table("master_curve", "Master curve", "Rows as measured, as laid, and the series", columns, named)


def series_table(fitted: FittedCompound) -> Table:
    """Terms of the series, equilibrium modulus first."""
    made = fitted.fit.series
    rows = [("E_e", None, made.equilibrium)]
    rows += [
        (f"E_{k}", tau, e) for k, (tau, e) in enumerate(zip(made.times.tolist(), made.moduli.tolist(), strict=True), 1)
    ]
    columns = _tuple_columns(("term", "relaxation time", "modulus"), ("text", "relaxation time", "pressure"))
    return Table("series", "Series", "Prony series at the reference temperature", columns, rows)


def _tuple_columns(names: Sequence[str], kinds: Sequence[str]) -> tuple[Column, ...]:
    """Columns for rows that are tuples."""
    pairs = enumerate(zip(names, kinds, strict=True))
    return tuple(Column(name, kind, itemgetter(k), key=f"column_{k}") for k, (name, kind) in pairs)
