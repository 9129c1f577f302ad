"""The parts of the HTML report of an analysis, one function each."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Sequence
from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING, Final

import pandas as pd

from conveyor.markup import Html, element, joined
from conveyor.report import analysis_plots, loop_plots, loop_tables, tables
from conveyor.report import inputs as fields
from conveyor.report.checks import band_words
from conveyor.report.page import Part, bullets, facts, listed, table, tiles, verdict, verdicts
from conveyor.report.svg import figure, inline
from conveyor.report.verdicts import Check
from conveyor.spec import fingerprint
from conveyor.units import System, display, si, text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.analysis import Analysis
    from conveyor.line.stretches import Strand
    from conveyor.models import RubberCompound

KEY_FIGURES: Final = (
    "motor power [kW]", "effective tension [N]", "tight side tension [N]", "equivalent DIN f [-]",
    "indentation share of main resistance [-]", "energy [kWh/(t km)]",
)  # fmt: skip
_VERSIONED = ("conveyor", "numpy", "scipy", "pandas", "pint", "pydantic", "matplotlib")
_SECTION_LAYOUT = (
    "section", "strand", "length [m]", "lift [m]", "idler spacing [m]", "belt mass [kg/m]", "bulk mass [kg/m]",
    "equivalent f [-]",
)  # fmt: skip
_SECTION_FORCES = (
    "section", "strand", "indentation [N]", "idler rotation [N]", "flexure [N]", "idler tilt [N]",
    "lift force [N]", "total [N]",
)  # fmt: skip
_ROLL_FIGURES = (
    "section", "strand", "roll", "force [N]", "highest line load [N/m]", "half width [mm]", "penetration [mm]",
    "peak pressure [MPa]", "indentation [N]", "rim drag [N]",
)  # fmt: skip


def drawn(made: Figure, name: str, caption: str) -> Html:
    """Return a figure with its caption."""
    return figure(inline(made, name, caption), caption)


def top(analysis: Analysis, system: System) -> Html:
    """What is conveyed how far, and the notes of the spec."""
    conveyor = analysis.conveyor
    belt, material, route = conveyor.belt, conveyor.material, conveyor.route
    duty = (
        ("material", material.name),
        ("mass flow", _plain(display(si(material.flow), "mass flow", system))),
        ("length", _plain(display(route.length, "length", system))),
        ("lift", _plain(display(route.rise, "length", system))),
        ("belt width", text(belt.width)),
        ("belt speed", _plain(display(si(belt.speed), "speed", system))),
        ("temperature of the covers", _plain(display(si(conveyor.ambient.belt), "temperature", system))),
        ("bottom cover", conveyor.carry_compound.name),
    )
    lines = [line for line in (conveyor.notes or "").splitlines() if line.strip()]
    return joined([facts(duty), *(element("p", line) for line in lines)])


def _plain(words: str) -> str:
    return words.replace("degC", "°C").replace("degF", "°F")


def key_figures(analysis: Analysis, found: Sequence[Check], system: System) -> Part:
    """What a designer looks for first, and how many checks failed."""
    failed = [check for check in found if check.verdict == "FAIL"]
    count = {word: sum(check.verdict == word for check in found) for word in ("pass", "FAIL", "not checked")}
    counted = joined(
        part for word, n in count.items() if n for part in (f"{n} ", verdict(word), Html("&ensp;"))
    )
    warned = element("a", f"{len(analysis.warnings)} warnings", href="#warnings")
    content = [
        tiles(analysis.summary, KEY_FIGURES, system),
        element("p", "Checks: ", counted, " ", warned),
    ]
    if failed:
        content.append(element("p", "Failed: ", "; ".join(check.subject for check in failed), "."))
    return Part("key-figures", "Key figures", joined(content))


def checked(found: Sequence[Check]) -> Part:
    """Pass and fail of every check."""
    caption = (
        "Found against what is asked for; sources of the limits are in the warnings and in docs/conveyor.md"
    )
    return Part("checks", "Checks", verdicts(found, caption))


def warned(analysis: Analysis) -> Part:
    """Where an assumption is strained."""
    return Part("warnings", "Warnings", bullets(analysis.warnings, "warnings"))


def summed_up(analysis: Analysis, system: System) -> Part:
    """All figures of the summary."""
    return Part(
        "summary", "Summary", listed(analysis.summary, "Figures of the whole conveyor", system=system)
    )


def resistances(analysis: Analysis, system: System) -> Part:
    """Breakdown, classical estimates beside it, every force with its law."""
    found = analysis.balance
    beside = tables.comparison(found).rename_axis("quantity").reset_index()
    remark = f"Classical secondary resistances: {found.classical.secondary_by}."
    frame = analysis.resistances
    total = found.forces.total
    foot = ["effective tension", None, total, 1.0 if total else None, None]
    content = (
        drawn(
            analysis_plots.resistance_breakdown(found, system=system),
            "breakdown",
            "Resistances of this calculation; beside their sums the classical estimates with given friction.",
        ),
        table(beside, "Beside the classical estimates", system=system, by_row="quantity"),
        element("p", remark, class_="note"),
        table(frame, "Every force and the law it comes from", system=system, foot=foot),
    )
    return Part("resistances", "Resistances", joined(content))


def route(analysis: Analysis, system: System) -> Part:
    """Profile, sections, their forces."""
    frame = analysis.sections
    lives = [name for name in frame.columns if "life" in str(name)]
    forces = frame[list(_SECTION_FORCES)]
    sums = ["all sections", None, *(float(forces[name].sum()) for name in _SECTION_FORCES[2:])]
    content = (
        drawn(
            loop_plots.route_profile(analysis.conveyor, system=system),
            "profile",
            "Profile of the route from the tail: triangles are feeding points, rings are drives.",
        ),
        table(
            frame[[*_SECTION_LAYOUT, *lives]], "Sections of both strands, in running direction", system=system
        ),
        table(forces, "Forces of the sections", system=system, foot=sums),
    )
    return Part("route", "Route and sections", joined(content))


def tensions(analysis: Analysis, system: System) -> Part:
    """Tension diagram, tensions of the sections, drives, take-up."""
    found = analysis.balance
    content = (
        drawn(
            loop_plots.tension_diagram(found, analysis.motions, system=system),
            "tensions",
            "Tension round the loop in every state, from the head along the return strand and back.",
        ),
        table(_tensions(analysis), "Tensions where the sections begin and end", system=system),
        table(loop_tables.drives(found), "Drives in every state", system=system, named=2),
        listed(loop_tables.take_up(found), "Take-up", system=system),
        table(loop_tables.conditions(found), "What asks for the tension of the take-up", system=system),
    )
    return Part("tensions", "Tensions, drives and take-up", joined(content))


def _tensions(analysis: Analysis) -> pd.DataFrame:
    """One row a stretch: steady running and the state of the highest tension."""
    settled = analysis.balance.settled
    states = (settled.steady, settled.unsteady)
    geometry = settled.loop.geometry
    rows: dict[str, list[object]] = {
        "section": [stretch.section for stretch in geometry.stretches],
        "strand": [stretch.strand for stretch in geometry.stretches],
    }
    for state in states:
        rows[f"{state.name}, begins [N]"] = state.starts.tolist()
        rows[f"{state.name}, ends [N]"] = state.ends.tolist()
    rows["least for sag [N]"] = geometry.least.tolist()
    return pd.DataFrame(rows)


def rolls(analysis: Analysis, system: System) -> Part:
    """Pressure under the governing rolls, and the highest loaded roll of every section."""
    frame = analysis.rolls
    highest = frame.loc[frame.groupby(["section", "strand"], sort=False)["highest line load [N/m]"].idxmax()]
    lives = [str(name) for name in frame.columns if "life" in str(name)]
    columns = [*_ROLL_FIGURES, *lives]
    content = (
        drawn(
            analysis_plots.pressure_under_rolls(analysis.stretches, system=system),
            "pressure",
            "Contact pressure at the highest line load of each strand; the contact leans to where the belt arrives.",
        ),
        table(highest[columns], "Roll of the highest line load of every section and strand", system=system),
        element(
            "p", f"Relative error of the contacts: at most {analysis.error_estimate:.0e}.", class_="note"
        ),
    )
    return Part("rolls", "Roll contacts", joined(content))


def rubber(analysis: Analysis, system: System) -> Part:
    """What the rolls ask of each rubber, its master curve with the band, what is known of it."""
    conveyor = analysis.conveyor
    temperature = si(conveyor.ambient.belt)
    worked: dict[str, tuple[RubberCompound, tuple[Strand, ...]]] = {}
    strands: tuple[Strand, ...] = ("carry", "return")
    for strand in strands:
        compound = conveyor.carry_compound if strand == "carry" else conveyor.return_compound
        worked[compound.name] = (compound, (*worked.get(compound.name, (compound, ()))[1], strand))
    content: list[Html] = [
        table(_asked(analysis), "What the rolls ask of the rubber, and what its data hold", system=system)
    ]
    for k, (compound, at) in enumerate(worked.values(), start=1):
        caption = (
            f"Master curve of {compound.name} at {_plain(display(temperature, 'temperature', system))}; "
            f"shaded: the band in which the {' and '.join(at)} rolls lose nine tenths of their energy."
        )
        made = analysis_plots.rubber_at_work(compound, temperature, analysis.stretches, at, system=system)
        content += [
            element("h3", f"{compound.name} ({compound.kind})"),
            drawn(made, f"rubber-{k}", caption),
            table(
                pd.DataFrame(_known(compound, system), columns=["fact", "value"]),
                f"What is known of {compound.name}",
            ),
        ]
    return Part("rubber", "Rubber", joined(content))


def bands(frame: pd.DataFrame) -> pd.DataFrame:
    """Bands of frequency in words, of a table that has what the rolls excite and what the data hold."""
    words = {
        f"{name} [Hz]": [
            None if pd.isna(low) else band_words((low, high)).removesuffix(" Hz")
            for low, high in zip(frame[f"{start} from [Hz]"], frame[f"{start} to [Hz]"], strict=True)
        ]
        for name, start in (("excited band", "excited"), ("band of the data", "data"))
    }
    return pd.DataFrame(words, index=frame.index)


def _asked(analysis: Analysis) -> pd.DataFrame:
    frame = analysis.rubber
    kept = ["strand", "compound", "kind", "temperature [degC]"]
    strains = ["working strain [-]", "E' factor of strain [-]", "E'' factor of strain [-]"]
    return pd.concat([frame[kept], bands(frame), frame[strains]], axis="columns")


def _known(compound: RubberCompound, system: System) -> Iterable[tuple[str, object]]:
    known = {
        "description": compound.description,
        "origin": compound.source.origin,
        "data": compound.source.data or "not stated",
        "strain of the data": compound.strain or "not stated",
        "Poisson's ratio": f"{compound.poisson_ratio:g}",
        "reference temperature": _plain(display(si(compound.reference_temperature), "temperature", system)),
        "temperature shift": "none" if compound.shift is None else compound.shift.law,
        "Prony terms": str(len(compound.prony.terms)),
        "not known": "; ".join(compound.missing),
    }
    return ((name, value) for name, value in known.items() if value != "")


def start_and_stop(analysis: Analysis, system: System) -> Part:
    """Start, coasting, braking, holding, limits of the bulk."""
    content = listed(
        loop_tables.start_stop(analysis.motions), "Start, stop and the limits of the bulk", system=system
    )
    return Part("start-stop", "Start and stop", content)


def belt(analysis: Analysis, system: System) -> Part:
    """Strength, pulleys, vertical curves, how they settled."""
    duty = analysis.belt_duty
    content = [listed(loop_tables.belt(duty), "Strength of the belt", system=system)]
    content += [
        table(frame, caption, system=system)
        for frame, caption in (
            (loop_tables.pulleys(duty), "Pulleys"),
            (loop_tables.curves(duty), "Vertical curves"),
        )
        if not frame.empty
    ]
    settled = loop_tables.convergence(analysis.convergence)
    if not settled.empty:
        content.append(listed(settled, "How tensions and roll loads settled on the curves", system=system))
    return Part("belt", "Belt, pulleys and curves", joined(content))


def assumed(analysis: Analysis) -> Part:
    """What every figure rests on."""
    return Part("assumptions", "Assumptions", bullets(analysis.assumptions))


def entered(analysis: Analysis) -> Part:
    """Every field as entered and in SI."""
    frame = fields.inputs(analysis.conveyor)
    frame["SI value"] = [None if value is None else f"{value:.6g}" for value in frame["SI value"]]
    caption = "Every field: as entered, in SI, and whether the spec, a library or a default gave it"
    return Part("inputs", "Inputs", table(frame, caption))


def provenance(analysis: Analysis, system: System) -> Part:
    """What the contacts cost, and what made the figures."""
    made = {
        "spec SHA-256": fingerprint(analysis.conveyor),
        "date": date.today().isoformat(),
        "python": platform.python_version(),
        **{name: version(name) for name in _VERSIONED},
    }
    contacts = tables.solver(analysis.stretches)
    caption = "Contact solutions, one a distinct roll, cover and spacing"
    content = (
        table(pd.DataFrame(made.items(), columns=["what", "which"]), "What made these figures"),
        table(contacts, caption, system=system),
    )
    return Part("provenance", "Provenance", joined(content))
