"""`conveyor fit` and `conveyor shelf`: laboratory files to compounds, compounds at hand."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Final

from conveyor.cli.application import (
    Force,
    LanguageOption,
    Quiet,
    Shelves,
    app,
    argument,
    compound_names,
    examples_text,
    one_of,
    option,
    print_lines,
    si_of,
)
from conveyor.cli.output_files import FIGURE, SPEC, Outputs
from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.text.printable import escape_controls

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console
    from rich.table import Table

    from conveyor.fitting.fit_verdict import Criterion
    from conveyor.fitting.fitted_compound import FittedCompound, TabulatedCompound
    from conveyor.models import RubberCompound

EXPORT_ENDINGS: Final = (".inp", ".mac", ".csv")
Export = Annotated[
    list[Path] | None,
    option("Write the series for Abaqus (.inp), Ansys (.mac) or pyvisco (.csv); may be repeated.", "FILE"),
]


@app.command(
    short_help="Fit a compound to laboratory data.",
    epilog=examples_text(
        "conveyor fit s120.dma.csv --shift s120.shift.csv --vertical -o s120.yaml -o s120.xlsx",
        'conveyor fit isotherms.csv --at "20 degC" --plot fit.png',
        'conveyor fit frequency_sweep.xlsx --sheet E --modulus-unit MPa --at "23 degC"',
        "conveyor fit isotherms.csv relaxation.csv ramp.csv --exclude isotherms.csv:12-15 --law wlf",
        "conveyor fit s120.dma.csv --export s120.inp --export s120.mac --export s120.csv",
    ),
)
def fit(
    data: Annotated[
        list[Path],
        argument(
            "Files of one rubber: a master curve; or isotherms, sweeps, relaxation, temperature sweeps, "
            "shift factors, strain sweeps; or a Prony table. CSV, TXT or XLSX of any layout."
        ),
    ],
    output: Annotated[
        list[Path] | None,
        option(
            "Write the compound file (.yaml), the workbook (.xlsx), or the page to sign with verdict, figures and "
            "glossary (.html, .pdf); may be repeated.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None,
    reference_temperature: Annotated[
        str | None,
        option('Temperature of the master curve, e.g. "20 degC"; else the file states it.', None, "--at"),
    ] = None,
    name: Annotated[str | None, option("Name of the compound; else the file's.")] = None,
    shift: Annotated[Path | None, option("File of shift factors: temperature and a_T.")] = None,
    strain: Annotated[Path | None, option("File of strain sweeps (Payne effect).")] = None,
    reference_strain: Annotated[
        str | None,
        option('Strain amplitude of the master curve, "0.1 %" or "0.15 % shear"; else a column says it.'),
    ] = None,
    equilibrium: Annotated[str | None, option('Hold the equilibrium modulus, e.g. "4 MPa".')] = None,
    terms_per_decade: Annotated[float | None, option("Relaxation times per decade; else chosen by AICc.")] = None,
    vertical: Annotated[
        bool,
        option(
            "Shift isotherms vertically, too; a master curve with --shift as b_T = T/T_ref.",
            None,
            "--vertical",
        ),
    ] = False,
    by: Annotated[str, option("Modulus that places the isotherms: both, storage, loss.")] = "both",
    law: Annotated[str, option("Shift law the compound keeps: table, wlf, arrhenius.")] = "table",
    repeats: Annotated[
        bool, option("Average sweeps at one temperature, specimens or runs; else they are refused.")
    ] = False,
    exclude: Annotated[list[str] | None, option("Rows to leave out, 12-15,20; may be repeated.", "[FILE:]ROWS")] = None,
    storage_error: Annotated[str | None, option('Standard error of E\', "1 %"; rows weigh by its reciprocal.')] = None,
    loss_error: Annotated[str | None, option("The same of E''; both or neither.")] = None,
    plot: Annotated[Path | None, option("Draw data, fit and band to this file (.png, .svg, .pdf).")] = None,
    poisson: Annotated[float, option("Poisson's ratio; also turns G into E.", None, "--poisson")] = 0.5,
    frequency_unit: Annotated[str | None, option("Where the file leaves it open: Hz, rad/s.")] = None,
    modulus_unit: Annotated[str | None, option("Pa, kPa, MPa, GPa, psi, ...")] = None,
    temperature_unit: Annotated[str | None, option("degC, degF, K.")] = None,
    strain_unit: Annotated[str | None, option("%, 1, ...")] = None,
    moduli: Annotated[
        str | None, option("E or G, where a file does not say whether its moduli are tensile or shear.")
    ] = None,
    column: Annotated[
        list[str] | None,
        option(
            'What a column holds whose name is not known, by one that is: "Modul A=E\'"; may be repeated.',
            "NAME=MEANING",
        ),
    ] = None,
    ignore: Annotated[
        list[str] | None,
        option("Column to leave aside, by its name, number or letter; may be repeated.", "COLUMN"),
    ] = None,
    instantaneous: Annotated[
        str | None, option('Tensile modulus at time 0 of a Prony table of shares, e.g. "800 MPa".')
    ] = None,
    temperature: Annotated[str | None, option('Of a file without a column for it, e.g. "20 degC".')] = None,
    sheet: Annotated[
        str | None, option("Sheet of a workbook; with * or ? all that fit, each as a file of the rubber.")
    ] = None,
    kind: Annotated[str | None, option("What the file holds, where it leaves it open.")] = None,
    accept: Annotated[
        list[str] | None,
        option(
            "Accept what is refused as implausible for rubber: few-rows, modulus, contradiction; may be repeated.",
            "FINDING",
        ),
    ] = None,
    document: Annotated[
        list[str] | None,
        option(
            "On the page: laboratory, number, specimen, instrument, method, measured, by; may be repeated.",
            "NAME=WORDS",
        ),
    ] = None,
    spec: Annotated[
        Path | None, option("Conveyor whose rolls the window has to cover, for the verdict.", "SPEC")
    ] = None,
    export: Export = None,
    write_shift: Annotated[
        Path | None, option("Write the shift factors (.csv), to be edited and given to --shift.", "FILE")
    ] = None,
    language: LanguageOption = None,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Fit a compound to laboratory data: shift isotherms, fit a Prony series; what a file leaves open is asked for."""
    from conveyor import shelf as shelf_of
    from conveyor.fitting import fitted_compound as compound_file

    to = Outputs(*data, shift, strain, spec, force=force, language=language)
    compounds = to.reports(output, *SPEC, kind=output_marks.COMPOUND)
    to.file("--plot", plot, *FIGURE)
    to.file("--write-shift", write_shift, ".csv")
    said = dict(_document_field(words) for words in document or ())
    for path in export or ():
        to.file("--export", path, *EXPORT_ENDINGS)
    answers = {
        "frequency_unit": frequency_unit, "modulus_unit": modulus_unit, "temperature_unit": temperature_unit,
        "strain_unit": strain_unit, "sheet": sheet, "kind": kind, "letter": moduli,
        "instantaneous": si_of("--instantaneous", instantaneous, "pressure"),
        "columns": dict(map(_column_meaning, column or ())) or None, "ignore": ignore or None,
        "temperature": si_of("--temperature", temperature, "temperature"),
    }  # fmt: skip
    request = compound_file.Request(
        name=name or data[0].name.split(".")[0],
        reference_temperature=reference_temperature,
        shift=shift,
        strain=strain,
        reference_strain=reference_strain,
        poisson_ratio=poisson,
        equilibrium=si_of("--equilibrium", equilibrium, "pressure"),
        terms_per_decade=terms_per_decade,
        vertical=vertical,
        by=one_of("--by", by, ("both", "storage", "loss")),
        law=one_of("--law", law, ("table", "wlf", "arrhenius")),
        repeats=repeats,
        exclude=tuple(exclude or ()),
        storage_error=si_of("--storage-error", storage_error, "fraction"),
        loss_error=si_of("--loss-error", loss_error, "fraction"),
        accept=frozenset(accept or ()),
        reading={key: value for key, value in answers.items() if value is not None},
    )
    from conveyor.fitting import fit_verdict, summary

    files = [file for file in (*data, shift, strain) if file is not None]
    with _name_files(files):
        fitted = compound_file.compound_from_files(data, request)
    criteria: tuple[Criterion, ...] = ()
    if isinstance(fitted, compound_file.FittedCompound):
        criteria = fit_verdict.fit_criteria(fitted)
        fitted = fit_verdict.record_failures(fitted, criteria)
    lines = summary.summary_lines(fitted)
    if plot is not None:
        to.figure(summary.band_figure(fitted), plot)
    for path in compounds:
        to.add("compound file", path, {path: shelf_of.dump(fitted.compound, output_marks.FIT_HEADING).encode()})
    if write_shift is not None:
        to.add("shift factors", write_shift, {write_shift: summary.shift_table(fitted).encode()})
    _add_exports(fitted.compound, export, to)
    lines += _verdict_lines((fitted, criteria), spec, said, to)
    lines += to.save()
    lines += [
        f'use it by its path in specs and with --compound, or by the name "{path.stem}" with --shelf {path.parent}'
        for path in compounds
    ]
    if not quiet:
        print_lines(*lines)


def _document_field(words: str) -> tuple[str, str]:
    from conveyor.fitting.fit_tables import DOCUMENT_FIELDS

    name, separator, value = words.partition("=")
    if not separator or name.strip() not in DOCUMENT_FIELDS or not value.strip():
        raise InputError(f'--document: got "{words}", expected NAME=WORDS with a name of: {", ".join(DOCUMENT_FIELDS)}')
    return name.strip(), value.strip()


def _column_meaning(words: str) -> tuple[str, str]:
    """Column name and meaning from NAME=MEANING."""
    name, _, meant = words.rpartition("=")
    if not name.strip() or not meant.strip():
        raise InputError(f'--column: got "{words}", expected NAME=MEANING such as "Modul A=E\'"')
    return name.strip(), meant.strip()


def _verdict_lines(
    judged: tuple[FittedCompound | TabulatedCompound, tuple[Criterion, ...]],
    spec: Path | None,
    said: Mapping[str, str],
    to: Outputs,
) -> list[str]:
    """Add the page to sign and the workbook of a fit and its criteria; returns the lines of the verdict."""
    from conveyor.fitting.fit_verdict import coverage_criteria
    from conveyor.fitting.fitted_compound import TabulatedCompound

    rubber, criteria = judged
    if isinstance(rubber, TabulatedCompound):
        if to.reported or spec is not None:
            raise InputError("-o .xlsx, .html, .pdf, --spec: a Prony table has no measurement to judge")
        return []
    if spec is not None:
        from conveyor.spec import load

        criteria = (*criteria, *coverage_criteria(rubber, load(spec)))
    if to.reported:
        from conveyor.fitting import fit_page, fit_tables

        page = partial(fit_page.build_page, rubber, criteria, said)
        to.write(fit_tables.fit_contents(rubber, criteria, said), page=page)
    return ["verdict", *(f"  {one.verdict:>11}  {one.line}" for one in criteria)]


@contextmanager
def _name_files(files: Sequence[Path]) -> Iterator[None]:
    """Put the path of the file before errors about it."""
    try:
        yield
    except InputError as error:
        said = str(error)
        for file in files:
            own = re.compile(rf"^(?={re.escape(file.name)}[:\[])")
            if own.match(said):
                lines = (f"{file.parent / line}" if own.match(line) else line for line in said.splitlines())
                raise InputError("\n".join(lines)) from None
        known = said.startswith((*map(str, files), "--"))
        raise InputError(said if known else f"{files[0]}: {said}") from None


def _add_exports(compound: RubberCompound, paths: Sequence[Path] | None, to: Outputs) -> None:
    """Add the input files of other programs."""
    from conveyor.fitting import programs

    for path in paths or ():
        program, text = programs.program_input(compound, path.suffix.lower())
        to.add(f"{program} input", path, {path: text.encode()})


@app.command(
    epilog=examples_text(
        "conveyor shelf",
        'conveyor shelf s100 --at "-10 degC" --frequency "30 Hz"',
        "conveyor shelf s100 --plot s100.png",
        "conveyor shelf --shelf my-compounds",
    )
)
def shelf(
    name: Annotated[str | None, argument("Show one compound.", autocompletion=compound_names)] = None,
    at: Annotated[str, option("Temperature of the moduli shown.")] = "20 degC",
    frequency: Annotated[str, option("Frequency of the moduli shown.")] = "10 Hz",
    plot: Annotated[
        Path | None,
        option("Draw the compound, or the loss tangents of all, to this file (.png, .svg, .pdf)."),
    ] = None,
    export: Export = None,
    force: Force = False,
    shelves: Shelves = None,
) -> None:
    """List the compounds on the shelf, or show one."""
    import math

    to = Outputs(name, force=force)
    to.file("--plot", plot, *FIGURE)
    for path in export or ():
        to.file("--export", path, *EXPORT_ENDINGS)
    if export and name is None:
        raise InputError("--export: of which compound? Give its name")
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from conveyor import shelf as store
    from conveyor.errors import RangeError
    from conveyor.units import read_si, text
    from conveyor.units.presentation import display_unit
    from conveyor.units.sentences import degree_signs, to_celsius

    kelvin, hertz = read_si(at, "temperature"), read_si(frequency, "frequency")
    console = Console(highlight=False)
    if name is not None:
        compound = store.compound(name, extra=shelves or ())
        _add_exports(compound, export, to)
        series = compound.series(kelvin)
        omega = 2.0 * math.pi * hertz
        rows = {
            "kind": compound.kind,
            "description": degree_signs(compound.description),
            "origin": degree_signs(compound.source.origin),
            "licence": compound.source.licence or "not stated",
            "strain": compound.strain or "not stated",
            "reference temperature": text(compound.reference_temperature),
            "terms": str(len(compound.prony.terms)),
            "E_e / E_inf": f"{series.equilibrium / 1e6:.4g} / {series.glassy / 1e6:.4g} MPa",
            f"E' at {at}, {frequency}": f"{float(series.storage(omega)) / 1e6:.4g} MPa",
            f"tan delta at {at}, {frequency}": f"{float(series.tan_delta(omega)):.4g}",
            "missing": degree_signs("; ".join(compound.missing)) or "nothing stated",
        }
        if compound.range is not None:
            rows["measured frequency"] = " to ".join(text(f) for f in compound.range.frequency)
            rows["measured temperature"] = " to ".join(text(t) for t in compound.range.temperature)
        table = Table(title=escape(escape_controls(compound.name)), title_justify="left", show_header=False)
        for key, value in rows.items():
            table.add_row(key, escape(escape_controls(value)))
        _show_table(console, table, to, plot, lambda plots: plots.master_curve(compound, kelvin))
        return
    table = Table(
        title=f"E' and tan delta at {at}, {frequency}",
        title_justify="left",
        box=None,
        pad_edge=False,
        padding=(0, 1),
    )
    modulus = display_unit("pressure")
    for heading in ("compound", "kind", modulus.beside("E'"), "tan delta", "degC"):
        table.add_column(heading, no_wrap=True)
    drawn = []
    for known in store.names(shelves or ()):
        compound = store.compound(known, extra=shelves or ())
        span = () if compound.range is None else compound.range.kelvin
        limits = " to ".join(f"{to_celsius(t):.0f}" for t in span)
        try:
            series = compound.series(kelvin)
        except RangeError:
            table.add_row(escape(escape_controls(known)), compound.kind, "outside", "", limits)
            continue
        omega = 2.0 * math.pi * hertz
        storage, tangent = float(modulus(series.storage(omega))), float(series.tan_delta(omega))
        table.add_row(escape(escape_controls(known)), compound.kind, f"{storage:.3g}", f"{tangent:.3f}", limits)
        drawn.append(compound)
    _show_table(console, table, to, plot, lambda plots: plots.loss_tangents(drawn, kelvin))


def _show_table(
    console: Console, table: Table, to: Outputs, plot: Path | None, figure: Callable[[ModuleType], Figure]
) -> None:
    """Draw the figure, write the files, then print the table."""
    if plot is not None:
        from conveyor.report import plots

        to.figure(figure(plots), plot)
    written = to.save()
    console.print(table)
    if written:
        print_lines(*written)
