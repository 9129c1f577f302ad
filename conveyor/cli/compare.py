"""`conveyor compare`: compounds over temperature and speed."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from conveyor.cli.app import AsJson, Quiet, Shelves, Spec, app, progress, values, write_text
from conveyor.errors import InputError, NoSolutionError

if TYPE_CHECKING:
    from conveyor.comparison import Comparison


@app.command()
def compare(
    spec: Spec,
    compounds: Annotated[
        list[str], typer.Option("--compound", "-c", help="Shelf name or compound file; may be repeated.")
    ],
    temperatures: Annotated[
        str | None,
        typer.Option("--temperature", help="Of the belt: from:to:step or a,b,c in degC; else the spec's."),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option("--speed", help="Of the belt: from:to:step or a,b,c in m/s; else the spec's."),
    ] = None,
    cover: Annotated[str, typer.Option(help="Cover made of the compounds: bottom, top or both.")] = "bottom",
    base: Annotated[
        str | None, typer.Option(help="Name of the compound to compare with; else the first.")
    ] = None,
    extra_costs: Annotated[
        list[str] | None,
        typer.Option(
            "--extra-cost", help="NAME=AMOUNT that its belt costs above the base's; may be repeated."
        ),
    ] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write every scene to this file (.csv).")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw power over temperature to this file (.png, .svg, .pdf).")
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Compare rubber compounds on a conveyor: power, energy, cost and payback over temperature and speed.

    Example: conveyor compare examples/specs/overland.yaml -c standard-cover -c low-rolling-resistance-cover
    --temperature -30:40:5 -o compounds.xlsx
    """
    import conveyor
    from conveyor.comparison import compare_compounds
    from conveyor.report import comparing

    line = conveyor.load(spec, shelves=shelf or ())
    with progress("compounds", silent=quiet or as_json) as step:
        found = compare_compounds(
            line,
            compounds,
            temperatures=None if temperatures is None else values(temperatures, "--temperature", "degC"),
            speeds=None if speeds is None else values(speeds, "--speed", "m/s"),
            cover=_one_of("--cover", cover, ("bottom", "top", "both")),
            base=base,
            extra_costs=dict(_amount(item) for item in extra_costs or ()),
            shelves=shelf or (),
            progress=step,
        )
    if not found.scenes:
        reasons = "; ".join(dict.fromkeys(refusal.reason for refusal in found.refused))
        raise NoSolutionError(f"no scene has an answer: {reasons}")
    written = [] if output is None else [f"workbook: {found.to_excel(output)}"]
    if csv is not None:
        write_text(csv, found.table.to_csv(index=False, lineterminator="\n"))
        written.append(f"table: {csv}")
    if plot is not None:
        from conveyor.report import plots

        written.append(f"figure: {plots.save(plots.power_against_temperature(found), plot)}")
    if as_json:
        print(json.dumps(comparing.to_dict(found), indent=2, allow_nan=False, ensure_ascii=False))
    elif not quiet:
        _print_comparison(found)
        print("\n".join(written))


def _print_comparison(found: Comparison) -> None:
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from conveyor.report import comparing

    frame = found.ranking
    table = Table(
        title=escape(f"{found.conveyor.name}: {found.cover} cover, against {found.base}"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
    )
    shown = {
        "compound": "compound",
        "belt speed [m/s]": "m/s",
        "mean motor power [kW]": "mean kW",
        "mean motor power, low [kW]": "low",
        "mean motor power, high [kW]": "high",
        "motor power against base [-]": "change",
        "peak motor power [kW]": "peak kW",
        "at temperature [degC]": "at degC",
        "energy per year [MWh]": "MWh/a",
        **{name: name.replace("saving per year", "saved/a") for name in frame.columns if "saving" in name},
        "payback [a]": "payback a",
    }
    names = [name for name in shown if name in frame.columns]
    for name in names:
        table.add_column(shown[name], justify="left" if name == "compound" else "right")
    for row in frame[names].astype(object).where(frame[names].notna(), None).itertuples(index=False):
        table.add_row(*(_figure(name, value) for name, value in zip(names, row, strict=True)))
    console = Console(highlight=False)
    console.print(table)
    for remark in comparing.remarks(found):
        console.print(f"[yellow]note:[/] {escape(remark)}")


def _figure(name: str, value: object) -> str:
    """A figure of the ranking as the terminal shows it."""
    if value is None or isinstance(value, str):
        return value or ""
    number = float(str(value))
    if "against" in name:
        return f"{number:+.1%}"
    return f"{number:g}" if name.startswith(("belt", "at")) else f"{number:,.1f}"


def _amount(given: str) -> tuple[str, float]:
    name, separator, amount = given.rpartition("=")
    try:
        if separator and math.isfinite(float(amount)):
            return name.strip(), float(amount)
    except ValueError:
        pass
    raise InputError(
        f'--extra-cost: got "{given}", expected NAME=AMOUNT such as "low-rolling-resistance-cover=150000"'
    )


def _one_of(option: str, given: str, allowed: tuple[str, ...]) -> Any:
    if given not in allowed:
        raise InputError(f'{option}: got "{given}", allowed: {", ".join(allowed)}')
    return given
