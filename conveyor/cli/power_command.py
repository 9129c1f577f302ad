"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from conveyor.cli.application import (
    AsParquet,
    ImageKind,
    PlotKind,
    PlotsFolder,
    Reports,
    Spec,
    TablesFolder,
)
from conveyor.cli.shared_options import Session, session_command


@session_command(
    short_help="Power, forces and tensions of a conveyor.",
    examples_of=(
        "conveyor power overland.yaml",
        "conveyor power overland.yaml -o report.xlsx -o report.pdf",
        "conveyor power overland.yaml --units us",
        "conveyor power overland.yaml --tables tables --plots figures",
        "conveyor power overland.yaml --json | jq .power_kW",
        "conveyor power input.xlsx --shelf my-compounds",
    ),
)
def power(
    session: Session,
    spec: Spec,
    output: Reports = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
    plots: PlotsFolder = None,
    plot_kind: PlotKind = ImageKind.PNG,
) -> None:
    """Power, forces and tensions of a conveyor, with the load cases, the year and the ranges its spec has."""
    to = session.outputs(spec)
    to.reports(output, tables=tables, parquet=parquet)
    to.folder("--plots", plots)
    import conveyor
    from conveyor import spec as spec_file
    from conveyor.report.tables.analysis_contents import analysis_contents
    from conveyor.report.tables.result_schema import analysis_json
    from conveyor.results.analysis import analyse_studies

    line = session.read(spec)
    system = session.system(line)
    result = conveyor.analyse(line)
    with session.progress() as told:
        with spec_file.locate_errors(spec):
            asked = analyse_studies(line, result, progress=told)
        assessment = result.assess(asked)
        contents = analysis_contents(assessment.in_units(system))
        to.write(contents, told)
        if plots is not None:
            to.figures(result.at_common_take_up(asked).in_units(system).plots.every(asked), plots, plot_kind.value)
    from conveyor.cli.terminal import show_power

    session.answer(lambda: analysis_json(assessment), to, lambda: show_power(contents))
