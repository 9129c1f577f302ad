"""The command line: the only place that prints and sets exit codes.

0 done; 1 the calculation has no answer; 2 wrong input.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.errors import ConveyorError, InputError

if TYPE_CHECKING:
    from conveyor.analysis import Analysis

app = typer.Typer(
    name="conveyor",
    help="Belt-conveyor power from the viscoelastic contact of every idler roll.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Spec = Annotated[Path, typer.Argument(help="Conveyor spec, .yaml or .json.", show_default=False)]
ZERO_CELSIUS = 273.15

Shelves = Annotated[
    list[Path] | None, typer.Option("--shelf", help="Further folder of compound files; may be repeated.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout and nothing else.")]


def main() -> None:
    """Run the command line; errors become one message on stderr and an exit code, never a traceback."""
    try:
        app()
    except InputError as error:
        _fail(error, 2)
    except ConveyorError as error:
        _fail(error, 1)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)


def _fail(error: ConveyorError, code: int) -> None:
    print(f"conveyor: {error}" if code == 1 else str(error), file=sys.stderr)
    sys.exit(code)


@app.command()
def power(
    spec: Spec,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    as_json: AsJson = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")] = False,
    shelf: Shelves = None,
) -> None:
    """Power, forces and tensions of a conveyor.

    Example: conveyor power examples/specs/overland.yaml -o overland.xlsx
    """
    import conveyor

    result = conveyor.analyse(conveyor.load(spec, shelves=shelf or ()))
    written = None if output is None else result.to_excel(output)
    if as_json:
        print(json.dumps(result.to_dict(), indent=2, allow_nan=False, ensure_ascii=False))
    elif not quiet:
        _print_power(result)
        if written is not None:
            print(f"\nworkbook: {written}")


def _print_power(result: Analysis) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console(highlight=False)
    found = result.balance
    forces, classical, drive = found.forces, found.classical, found.power
    table = Table(title=escape(result.conveyor.name), title_justify="left", title_style="bold")
    table.add_column("")
    table.add_column("this calculation", justify="right")
    table.add_column("share", justify="right")
    table.add_column(f"classical, f = {classical.friction_factor:g}", justify="right")
    rows = (
        ("indentation", forces.indentation, None),
        ("idler rotation", forces.idler_rotation, None),
        ("flexure", forces.flexure, None),
        ("main resistance", forces.main, classical.main),
        ("secondary", forces.secondary, classical.secondary),
        ("special", forces.special, classical.special),
        ("lift", forces.lift, classical.lift),
        ("effective tension", forces.total, classical.total),
    )
    for name, force, other in rows:
        share = f"{force / forces.total:.1%}" if forces.total else ""
        table.add_row(name, f"{force / 1e3:.2f} kN", share, "" if other is None else f"{other / 1e3:.2f} kN")
    table.add_section()
    table.add_row("belt power", f"{drive.belt / 1e3:.1f} kW", "", "")
    table.add_row(
        "[bold]motor power[/]", f"[bold]{drive.motor / 1e3:.1f} kW[/]", "", f"{classical.motor / 1e3:.1f} kW"
    )
    table.add_row("friction factor f", f"{found.friction_factor:.4f}", "", f"{classical.friction_factor:.4f}")
    table.add_row(
        "tensions, tight / slack", f"{found.tensions.tight / 1e3:.1f} / {found.tensions.slack / 1e3:.1f} kN"
    )
    if drive.energy_per_tonne_km is not None:
        table.add_row("energy", f"{drive.energy_per_tonne_km:.4f} kWh/(t km)")
    if drive.energy_per_year is not None:
        cost = "" if drive.cost_per_year is None else f"{drive.cost_per_year:,.0f} {drive.currency}/a"
        table.add_row("energy per year", f"{drive.energy_per_year / 1e3:,.0f} MWh/a", "", cost)
    console.print(table)
    console.print(f"relative error of the contact solutions: at most {result.error_estimate:.0e}")
    for warning in result.warnings:
        console.print(f"[yellow]note:[/] {escape(warning)}")


@app.command()
def fit(
    data: Annotated[Path, typer.Argument(help="Master curve: frequency, E', E'' with units in the header.")],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write the compound file (.yaml).")
    ] = None,
    reference_temperature: Annotated[
        str | None,
        typer.Option(
            "--at", help='Temperature of the master curve, e.g. "20 degC"; else the file states it.'
        ),
    ] = None,
    name: Annotated[str | None, typer.Option(help="Name of the compound; else the file's.")] = None,
    shift: Annotated[Path | None, typer.Option(help="CSV of shift factors: temperature_degC,a_T.")] = None,
    poisson_ratio: Annotated[float, typer.Option(help="Poisson's ratio.")] = 0.5,
    equilibrium: Annotated[
        str | None, typer.Option(help='Hold the equilibrium modulus, e.g. "4 MPa".')
    ] = None,
    terms_per_decade: Annotated[float, typer.Option(help="Relaxation times per decade.")] = 1.0,
) -> None:
    """Fit a Prony series to a measured master curve.

    Example: conveyor fit materials/s120.dma.csv --shift materials/s120.shift.csv -o s120.yaml
    """
    from conveyor import compound_file
    from conveyor.units import quantity, si, text

    held = None if equilibrium is None else si(quantity(equilibrium, "pressure"))
    compound, found = compound_file.fit_file(
        data,
        name=name or data.name.split(".")[0],
        reference_temperature=reference_temperature,
        shift=shift,
        poisson_ratio=poisson_ratio,
        equilibrium=held,
        terms_per_decade=terms_per_decade,
    )
    print(f"{compound.name}: {found.series.moduli.size} terms, E_e {found.series.equilibrium / 1e6:.4g} MPa, "
          f"E_inf {found.series.glassy / 1e6:.4g} MPa")  # fmt: skip
    print(
        f"data window {found.window[0]:.4g} to {found.window[1]:.4g} Hz at {text(compound.reference_temperature)}"
    )
    for label, misfit in (("E'", found.storage), ("E''", found.loss), ("tan delta", found.tan_delta)):
        print(
            f"{label:>9}: rms {misfit.rms:.1%}, worst {misfit.worst:+.1%} at {misfit.worst_frequency:.3g} Hz"
        )
    print(f"any positive spectrum leaves at least {found.consistency_floor:.1%} rms of both: that much the data "
          "contradict themselves")  # fmt: skip
    if output is not None:
        _write_text(output, compound_file.dump(compound))
        print(f"compound file: {output}")


def _write_text(path: Path, text: str) -> None:
    partial = path.with_name(path.name + ".part")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None


@app.command()
def shelf(
    name: Annotated[str | None, typer.Argument(help="Show one compound.")] = None,
    at: Annotated[str, typer.Option(help="Temperature of the moduli shown.")] = "20 degC",
    frequency: Annotated[str, typer.Option(help="Frequency of the moduli shown.")] = "10 Hz",
    shelves: Shelves = None,
) -> None:
    """List the compounds on the shelf, or show one."""
    import math

    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from conveyor import shelf as store
    from conveyor.errors import RangeError
    from conveyor.units import quantity, si, text

    kelvin, hertz = si(quantity(at, "temperature")), si(quantity(frequency, "frequency"))
    console = Console(highlight=False)
    if name is not None:
        compound = store.compound(name, extra=shelves or ())
        series = compound.series(kelvin)
        omega = 2.0 * math.pi * hertz
        rows = {
            "kind": compound.kind,
            "description": compound.description,
            "origin": compound.source.origin,
            "licence": compound.source.licence or "not stated",
            "strain": compound.strain or "not stated",
            "reference temperature": text(compound.reference_temperature),
            "terms": str(len(compound.prony.terms)),
            "E_e / E_inf": f"{series.equilibrium / 1e6:.4g} / {series.glassy / 1e6:.4g} MPa",
            f"E' at {at}, {frequency}": f"{float(series.storage(omega)) / 1e6:.4g} MPa",
            f"tan delta at {at}, {frequency}": f"{float(series.tan_delta(omega)):.4g}",
            "missing": "; ".join(compound.missing) or "nothing stated",
        }
        if compound.range is not None:
            rows["measured frequency"] = " to ".join(text(f) for f in compound.range.frequency)
            rows["measured temperature"] = " to ".join(text(t) for t in compound.range.temperature)
        table = Table(title=escape(compound.name), title_justify="left", show_header=False)
        for key, value in rows.items():
            table.add_row(key, escape(value))
        console.print(table)
        return
    table = Table(
        title=f"E' and tan delta at {at}, {frequency}",
        title_justify="left",
        box=None,
        pad_edge=False,
        padding=(0, 1),
    )
    for heading in ("compound", "kind", "E' [MPa]", "tan delta", "degC"):
        table.add_column(heading, no_wrap=True)
    for known in store.names(shelves or ()):
        compound = store.compound(known, extra=shelves or ())
        span = () if compound.range is None else compound.range.temperature
        limits = " to ".join(f"{si(t) - ZERO_CELSIUS:.0f}" for t in span)
        try:
            series = compound.series(kelvin)
        except RangeError:
            table.add_row(known, compound.kind, "outside", "", limits)
            continue
        omega = 2.0 * math.pi * hertz
        storage, tangent = float(series.storage(omega)) / 1e6, float(series.tan_delta(omega))
        table.add_row(known, compound.kind, f"{storage:.3g}", f"{tangent:.3f}", limits)
    console.print(table)


@app.command()
def contact(
    radius: Annotated[float, typer.Option(help="R over the spacing, in (0, 0.5].")],
    pressure: Annotated[float | None, typer.Option(help="Mean pressure 2(1-nu^2)p/(E0 k R).")] = None,
    penetration: Annotated[
        float | None, typer.Option(help="Penetration over R, held in place of the pressure.")
    ] = None,
    support: Annotated[str, typer.Option(help="free, confined or half-space.")] = "confined",
    thickness: Annotated[float, typer.Option(help="k h; inf allowed.")] = float("inf"),
    instantaneous: Annotated[
        float | None, typer.Option(help="E0/E_inf; else 1 - sum of the weights.")
    ] = None,
    weight: Annotated[list[float] | None, typer.Option(help="Creep weight; may be repeated.")] = None,
    time: Annotated[list[float] | None, typer.Option(help="zeta = V tau k of each weight.")] = None,
    poisson: Annotated[float, typer.Option(help="Poisson's ratio.")] = 0.5,
    rtol: Annotated[float, typer.Option(help="Relative tolerance.")] = 1e-6,
    as_json: AsJson = False,
) -> None:
    """Solve one dimensionless rolling contact.

    Example: conveyor contact --support free --radius 0.4 --thickness 1 --pressure 0.05 --weight 0.9 --time 1
    """
    from conveyor.contact import ContactProblem, CreepSpectrum, solve, solve_penetration

    if (pressure is None) == (penetration is None):
        raise InputError("give --pressure or --penetration")
    weights = weight or []
    creep = CreepSpectrum(1.0 - sum(weights) if instantaneous is None else instantaneous, weights, time or [])
    problem = ContactProblem(
        support, radius, 1.0 if pressure is None else pressure, creep, thickness, poisson
    )
    solution = solve(problem, rtol) if penetration is None else solve_penetration(problem, penetration, rtol)
    names = ("friction", "half_width", "eccentricity", "penetration", "peak_pressure", "dissipation",
             "error_estimate", "energy_error")  # fmt: skip
    figures = {name: float(getattr(solution, name)) for name in names}
    if as_json:
        about = {
            "pressure": solution.problem.pressure,
            "strips": solution.patches.tolist(),
            "status": solution.status.name,
            "order": solution.stats.order,
            "way": solution.stats.way,
        }
        print(json.dumps({**figures, **about}, indent=2))
        return
    for name, value in {"pressure": solution.problem.pressure, **figures}.items():
        print(f"{name:>15}  {value:.10g}")
    print(f"{'strips':>15}  {', '.join(f'{low:.6g} to {high:.6g}' for low, high in solution.patches)}")
    print(f"{'status':>15}  {solution.message}")


@app.command()
def schema() -> None:
    """Print the JSON schema of a spec, for editors."""
    from conveyor.spec import schema as build

    print(json.dumps(build(), indent=2, ensure_ascii=False))


@app.command()
def validate() -> None:
    """Run the built-in reference cases and print what was expected and what came out."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    from conveyor import validation
    from conveyor.errors import NoSolutionError

    checks = validation.run()
    table = Table("source", "quantity", box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    for heading in ("expected", "got", "deviation", "allowed", ""):
        table.add_column(heading, no_wrap=True, justify="right")
    for check in checks:
        table.add_row(
            check.source,
            check.quantity,
            f"{check.expected:.10g}" if isinstance(check.expected, float) else str(check.expected),
            f"{check.got:.10g}" if isinstance(check.got, float) else str(check.got),
            f"{check.deviation:.1e}",
            f"{check.tolerance:.1e}",
            "ok" if check.passed else "[bold red]FAILED[/]",
        )
    Console(highlight=False).print(table)
    failed = sum(not check.passed for check in checks)
    print(f"{len(checks) - failed} of {len(checks)} agree")
    if failed:
        raise NoSolutionError(f"{failed} reference cases do not agree: do not trust results on this machine")


if __name__ == "__main__":
    main()
