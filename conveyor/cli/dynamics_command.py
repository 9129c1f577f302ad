"""`conveyor dynamics`: starts and stops followed through time."""

from __future__ import annotations

from contextlib import ExitStack
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from conveyor.cli.application import Spec, option
from conveyor.cli.output_files import PICTURE, Outputs
from conveyor.cli.shared_options import Session, session_command
from conveyor.cli.worker_processes import open_executor
from conveyor.errors import InputError

if TYPE_CHECKING:
    from conveyor.dynamics.simulation import CalculatedDynamics
    from conveyor.models import Conveyor, Scenario
    from conveyor.report.table_model import Contents


class SizeTarget(StrEnum):
    """Quantities that can be sized."""

    RAMP = "ramp"
    BRAKE = "brake"
    DELAY = "delay"
    TAKE_UP = "take-up"


@session_command(
    short_help="Starting and stopping through time: waves in the belt.",
    examples_of=(
        "conveyor dynamics overland.yaml",
        'conveyor dynamics overland.yaml --scenario "start full" -o start.png',
        "conveyor dynamics overland.yaml -o starts.xlsx -o starts.html",
        'conveyor dynamics overland.yaml --scenario "start full" --size ramp',
        'conveyor dynamics downhill.yaml --scenario "emergency stop" --size brake',
        "conveyor dynamics overland.yaml --json | jq .scenarios",
    ),
)
def dynamics(
    session: Session,
    spec: Spec,
    scenario: Annotated[list[str] | None, option("Only this one; may be repeated.", "NAME", "--scenario", "-s")] = None,
    output: Annotated[
        list[Path] | None,
        option(
            "Write the report (.xlsx, .html, .pdf), or a figure of each scenario (.png, .svg); may be repeated.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None,
    error: Annotated[float, option("Error of the highest and lowest tension asked for.", "SHARE")] = 0.01,
    size: Annotated[
        SizeTarget | None, option("Find the least of it with which each scenario keeps every criterion.")
    ] = None,
    workers: Annotated[int, option("Processes.", "N", min=1, max=64)] = 1,
) -> None:
    """Follow starts and stops of a conveyor through time: those of its spec, or standard ones."""
    to = session.outputs(spec)
    pictures = to.reports(output, *PICTURE)
    from conveyor.dynamics.simulation import simulate_scenarios
    from conveyor.report.tables.dynamics_tables import dynamics_contents, dynamics_json

    line = session.read(spec)
    system = session.system(line)
    chosen = _chosen_scenarios(line, scenario)
    with ExitStack() as stack:
        told = stack.enter_context(session.progress("scenarios"))
        executor = stack.enter_context(open_executor(None, workers)) if workers > 1 else None
        how: Any = {"executor": executor, "workers": workers, "progress": told}
        if size is None:
            followed = simulate_scenarios(line, chosen, error=error, **how)
        else:
            from conveyor.dynamics.scenario_sizing import size_and_simulate

            followed = size_and_simulate(line, chosen, size.value, error=error, **how)
    contents = dynamics_contents(followed, system)
    for path in pictures:
        _write_figures(followed, contents, path, to)
    to.write(contents)
    from conveyor.cli.terminal import show_dynamics

    session.answer(lambda: dynamics_json(followed), to, lambda: show_dynamics(contents))


def _chosen_scenarios(line: Conveyor, names: list[str] | None) -> tuple[Scenario, ...]:
    """Scenarios of the given names, else all."""
    from conveyor.dynamics.simulation import standard_scenarios

    every = {one.name: one for one in line.scenarios or standard_scenarios(line)}
    for name in names or ():
        if name not in every:
            known = ", ".join(f'"{one}"' for one in every)
            raise InputError(f'--scenario: got "{name}", there are: {known}')
    return tuple(every[name] for name in names) if names else tuple(every.values())


def _write_figures(dynamics: CalculatedDynamics, contents: Contents, path: Path, to: Outputs) -> None:
    """Add a figure for each scenario."""
    from conveyor.report.dynamics_plots import scenario_figure
    from conveyor.report.table_model import slug

    several = len(dynamics.followed) > 1
    for one in dynamics.followed:
        at = path.with_stem(f"{path.stem}_{slug(one.name)}") if several else path
        to.figure(scenario_figure(one, system=contents.system), at)
