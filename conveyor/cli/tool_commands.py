"""`conveyor contact`, `template`, `schema`, `validate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from conveyor.cli.application import (
    AsJson,
    Force,
    Quiet,
    Shelves,
    Units,
    app,
    argument,
    examples_text,
    option,
    print_json,
    print_lines,
    print_text,
)
from conveyor.cli.output_files import Outputs
from conveyor.errors import InputError, NoSolutionError
from conveyor.files.output_marks import TO_FILL_IN


@app.command(
    epilog=examples_text(
        "conveyor contact --support free --radius 0.4 --thickness 1 --pressure 0.05 --weight 0.9 --time 1",
        "conveyor contact --radius 0.1 --pressure 0.01 --weight 0.5 --time 1 --json",
    )
)
def contact(
    radius: Annotated[float, option("R over the spacing, in (0, 0.5].")],
    pressure: Annotated[float | None, option("Mean pressure 2(1-nu^2)p/(E0 k R).")] = None,
    penetration: Annotated[float | None, option("Penetration over R, held in place of the pressure.")] = None,
    support: Annotated[str, option("free, confined or half-space.")] = "confined",
    thickness: Annotated[float, option("k h; inf allowed.")] = float("inf"),
    instantaneous: Annotated[float | None, option("E0/E_inf; else 1 - sum of the weights.")] = None,
    weight: Annotated[list[float] | None, option("Creep weight; may be repeated.")] = None,
    time: Annotated[list[float] | None, option("zeta = V tau k of each weight.")] = None,
    poisson: Annotated[float, option("Poisson's ratio.")] = 0.5,
    rtol: Annotated[float, option("Relative tolerance.")] = 1e-6,
    as_json: AsJson = False,
) -> None:
    """Solve one dimensionless rolling contact."""
    from conveyor.contact import ContactProblem, CreepSpectrum, solve, solve_penetration

    if (pressure is None) == (penetration is None):
        raise InputError("give --pressure or --penetration")
    weights = weight or []
    creep = CreepSpectrum(1.0 - sum(weights) if instantaneous is None else instantaneous, weights, time or [])
    problem = ContactProblem(support, radius, 1.0 if pressure is None else pressure, creep, thickness, poisson)
    solution = solve(problem, rtol) if penetration is None else solve_penetration(problem, penetration, rtol)
    names = ("friction", "half_width", "eccentricity", "penetration", "peak_pressure", "dissipation",
             "error_estimate", "energy_error")  # fmt: skip
    figures = {name: float(getattr(solution, name)) for name in names}
    if as_json:
        about = {
            "pressure": solution.problem.pressure,
            "patches": solution.patches.tolist(),
            "status": solution.status.name,
            "order": solution.stats.order,
            "way": solution.stats.way,
        }
        print_json({**figures, **about})
        return
    for name, value in {"pressure": solution.problem.pressure, **figures}.items():
        print(f"{name:>15}  {value:.10g}")
    print(f"{'strips':>15}  {', '.join(f'{low:.6g} to {high:.6g}' for low, high in solution.patches)}")
    print(f"{'status':>15}  {solution.message}")


@app.command(
    short_help="Write an input workbook to fill in.",
    epilog=examples_text(
        "conveyor template input.xlsx",
        "conveyor template input.xlsx --units us",
        "conveyor template input.xlsx --from overland.yaml",
        "conveyor power input.xlsx",
    ),
)
def template(
    output: Annotated[Path, argument("Workbook to write (.xlsx).", show_default=False)],
    spec: Annotated[Path | None, option("Fill it in from this spec.", None, "--from")] = None,
    units: Annotated[Units | None, option("System of units of the example; a spec has its own.")] = None,
    force: Force = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Write an input workbook: fields, units, drop-downs, ranges, an example; `conveyor power` reads it."""
    to = Outputs(spec, force=force)
    to.file("OUTPUT", output, ".xlsx", kind=TO_FILL_IN)
    import conveyor
    from conveyor.starter.template_writer import template_bytes as made

    if spec is not None and units is not None:
        raise InputError("--units: with --from the spec says the units (report.units); leave one of the two out")
    line = None if spec is None else conveyor.load(spec, shelves=shelf or ())
    content = made(line, shelves=shelf or (), units="SI" if units is None else units.value)
    to.add("template", output, {output: content})
    lines = to.save()
    if not quiet:
        from conveyor.starter import quote_path

        print_lines(*lines, f"next: fill it in, then conveyor power {quote_path(str(output))}")


@app.command(
    short_help="Print the schema of specs, duties and results, or a reference page.",
    epilog=examples_text(
        "conveyor schema > conveyor.schema.json",
        "conveyor schema --duty > duty.schema.json",
        "conveyor schema --result > result.schema.json",
        "conveyor schema --markdown > spec.md",
        "conveyor schema --workbook > workbook.md",
    ),
)
def schema(
    markdown: Annotated[
        bool, option("Print the reference of all fields for people, as markdown.", None, "--markdown")
    ] = False,
    result: Annotated[bool, option("Print the JSON schema of what --json prints.", None, "--result")] = False,
    duty: Annotated[bool, option("Print the JSON schema of a duty to be sized.", None, "--duty")] = False,
    workbook: Annotated[
        bool, option("Print the page of sheets, tables and names of workbooks, as markdown.", None, "--workbook")
    ] = False,
    nomenclature: Annotated[
        bool, option("Print the page of names, symbols and units, as markdown.", None, "--nomenclature")
    ] = False,
) -> None:
    """Print the JSON schema of a spec, for editors, of a duty or of results; or a reference page."""
    if markdown + result + duty + workbook + nomenclature > 1:
        raise InputError("--markdown, --result, --duty, --workbook, --nomenclature: give one of them")
    if workbook or nomenclature:
        from conveyor.starter.output_reference import output_page

        print_text(output_page("workbook" if workbook else "nomenclature"))
        return
    if result:
        from conveyor.report.tables.result_schema import result_schema

        print_json(result_schema())
        return
    if markdown:
        from conveyor.starter.format_reference import markdown_reference as written

        print_text(written())
        return
    from conveyor.models import Conveyor
    from conveyor.models.sizing import SizingDuty
    from conveyor.spec import schema as build

    print_json(build(SizingDuty if duty else Conveyor))


def _compare_with_practice() -> None:
    """Print computed against published and measured resistances of conveyors."""
    from conveyor.cli.terminal import plain_table, terminal_console
    from conveyor.validation.practice_cases import QUANTITIES, practice_figures, practice_summary

    figures = list(practice_figures())
    heads = ("conveyor", "resistance", "stated", "low", "expected", "design")
    made = plain_table("Conveyors in practice, stated and computed", heads, left=("conveyor", "resistance"))
    for one in figures:
        what, unit = QUANTITIES[one.resistance]
        computed = (f"{each:.4g}" for each in (one.low, one.expected, one.design))
        made.add_row(
            f"{one.source} ({one.evidence})",
            f"{what}, {one.loading} [{unit}]",
            f"{one.stated:.4g}",
            *computed,
        )
    terminal_console().print(made)
    for evidence in ("printed", "measured"):
        found = practice_summary([one for one in figures if one.evidence == evidence])
        print(
            f"{evidence}: {found.within} of {found.count} figures between low and design, all of "
            f"{found.conveyors_within} of {found.conveyors} conveyors; median of design over stated "
            f"{found.design_over_stated:.2f}, of expected over stated {found.expected_over_stated:.2f}"
        )


@app.command(
    short_help="Run the built-in reference cases.",
    epilog=examples_text("conveyor validate", "conveyor validate --quiet && echo good"),
)
def validate(quiet: Quiet = False) -> None:
    """Run the built-in reference cases and print what was expected and what came out."""
    from conveyor.cli.terminal import plain_table, terminal_console
    from conveyor.validation import reference_cases

    checks = reference_cases.run_reference_checks()
    heads = ("reference", "expected", "got", "deviation", "allowed", "")
    made = plain_table(None, heads, left=("reference",))
    for check in checks:
        made.add_row(
            f"{check.source}: {check.quantity}",
            f"{check.expected:.7g}" if isinstance(check.expected, float) else str(check.expected),
            f"{check.got:.7g}" if isinstance(check.got, float) else str(check.got),
            f"{check.deviation:.1e}",
            f"{check.tolerance:.1e}",
            "ok" if check.passed else "[bold red]FAILED[/]",
        )
    failed = sum(not check.passed for check in checks)
    if not quiet:
        terminal_console().print(made)
        print(f"{len(checks) - failed} of {len(checks)} agree")
        _compare_with_practice()
    if failed:
        raise NoSolutionError(f"{failed} reference cases do not agree: do not trust results on this machine")
