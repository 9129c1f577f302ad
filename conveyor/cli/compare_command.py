"""`conveyor compare`: compounds over temperature and speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated

from conveyor.arguments.limits import MOST_WORKERS
from conveyor.cli.application import (
    AsParquet,
    ImageKind,
    PlotKind,
    PlotsFolder,
    Reports,
    Spec,
    TablesFolder,
    compound_names,
    one_of,
    option,
    parse_values,
    si_of,
)
from conveyor.cli.shared_options import Session, session_command
from conveyor.cli.worker_processes import open_executor, preload_workers
from conveyor.errors import InputError, NoSolutionError


@session_command(
    short_help="Compare rubber compounds on a conveyor.",
    examples_of=(
        "conveyor compare overland.yaml -c standard-cover -c low-rolling-resistance-cover",
        "conveyor compare overland.yaml -c s100 -c mine.yaml --temperature -30:40:5",
        "conveyor compare overland.yaml -c s100 -c s120 --speed 5,6 -o compounds.xlsx -o compounds.html",
        "conveyor compare overland.yaml -c s100 -c s120 -c mine.yaml --temperature -40:40:2 --workers 3",
        'conveyor compare overland.yaml -c s100 -c s120 --temperature "0:100:20 degF" --units us',
    ),
)
def compare(
    session: Session,
    spec: Spec,
    compounds: Annotated[
        list[str],
        option(
            "Shelf name or compound file; may be repeated.",
            "NAME",
            "--compound",
            "-c",
            autocompletion=compound_names,
        ),
    ],
    temperatures: Annotated[
        list[str] | None,
        option(
            "Of the belt: from:to:step or a,b,c, in degC without a unit; may be repeated.",
            "VALUES",
            "--temperature",
        ),
    ] = None,
    speeds: Annotated[
        list[str] | None,
        option(
            "Of the belt: from:to:step or a,b,c, in m/s without a unit; else the spec's; may be repeated.",
            "VALUES",
            "--speed",
        ),
    ] = None,
    cover: Annotated[str, option("Cover made of the compounds: bottom, top or both.", "WHICH")] = "bottom",
    base: Annotated[str | None, option("Name of the compound to compare with; else the first.", "NAME")] = None,
    extra_costs: Annotated[
        list[str] | None,
        option("What its belt costs above the base's; may be repeated.", "NAME=AMOUNT", "--extra-cost"),
    ] = None,
    lot_scatter: Annotated[
        list[str] | None,
        option(
            'Half-width of the 90 % interval of the indentation from lot to lot: "5 %" of all, or "NAME=5 %" of one, '
            "repeated for others; else of the compound file, else 8 %.",
            "[NAME=]SHARE",
            "--lot-scatter",
        ),
    ] = None,
    output: Reports = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
    plots: PlotsFolder = None,
    plot_kind: PlotKind = ImageKind.PNG,
    workers: Annotated[int, option("Processes.", "N", min=1, max=MOST_WORKERS)] = 1,
) -> None:
    """Compare rubber compounds on a conveyor: power, energy, cost and payback over temperature and speed."""
    preload_workers(None, workers)
    to = session.outputs(spec, *compounds)
    to.reports(output, tables=tables, parquet=parquet, plots=plots, plot_kind=plot_kind)
    from conveyor.results.comparisons import compare_compounds

    line = session.read(spec)
    system = session.system(line)
    with session.progress("compounds") as told, open_executor(None, workers) as executor:
        comparison = compare_compounds(
            line,
            compounds,
            temperatures=_all_values(temperatures, "--temperature", "degC", "degF"),
            speeds=_all_values(speeds, "--speed", "m/s", "fpm"),
            cover=one_of("--cover", cover, ("bottom", "top", "both")),
            base=base,
            extra_costs=dict(_extra_cost(item) for item in extra_costs or ()),
            lot_scatter=_lot_scatter(lot_scatter or ()),
            shelves=session.shelf or (),
            executor=executor,
            workers=workers,
            progress=told,
        )
    if not comparison.scenes:
        reasons = "; ".join(dict.fromkeys(refusal.reason for refusal in comparison.refused))
        raise NoSolutionError(f"no scene has an answer: {reasons}")
    from conveyor.report.tables import comparison_tables

    contents = comparison_tables.comparison_contents(comparison, system)
    to.write(contents)
    from conveyor.cli.terminal import show_comparison

    session.answer(lambda: comparison_tables.comparison_json(comparison), to, lambda: show_comparison(contents))


def _all_values(given: list[str] | None, option: str, *units: str) -> list[str] | None:
    """Values of a repeatable option; None where it is not given."""
    return [value for words in given for value in parse_values(words, option, *units)] if given else None


def _lot_scatter(given: Sequence[str]) -> float | dict[str, float] | None:
    """Scatter of all compounds, or by name; None where it is not given."""
    shares: dict[str, float] = {}
    for words in given:
        name, _, share = words.rpartition("=")
        shares[name.strip()] = si_of("--lot-scatter", share.strip(), "fraction") or 0.0
    if "" in shares and len(given) > 1:
        raise InputError('--lot-scatter: one share of all compounds, or each with its name: "mine=5 %"')
    return shares.get("", shares or None)


def _extra_cost(given: str) -> tuple[str, float]:
    name, separator, amount = given.rpartition("=")
    try:
        if separator and math.isfinite(float(amount)):
            return name.strip(), float(amount)
    except ValueError:
        pass
    raise InputError(f'--extra-cost: got "{given}", expected NAME=AMOUNT such as "low-rolling-resistance-cover=150000"')
