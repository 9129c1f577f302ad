"""JSON of an analysis, and the versioned schema of what `--json` prints, of a conveyor, a comparison and scenarios."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, replace
from typing import Any, Final, NamedTuple

from conveyor.assessment import Assessment
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.loop.estimates import ClassicalEstimate
from conveyor.report.json_keys import (
    LEFT_OUT,
    ROW_SCHEMA,
    SCHEMA_VERSION,
    VERSION_KEY,
    JsonKey,
    JsonList,
    JsonObject,
    Schema,
    choice_key,
    describe_value,
    number_key,
    number_list,
    number_object,
    row_object,
    text_key,
    text_list,
)
from conveyor.report.table_model import Figure
from conveyor.report.tables.analysis_contents import AnalysisTables
from conveyor.report.tables.check_tables import CHECK_KEYS, check_pairs
from conveyor.report.tables.comparison_tables import COMPARISON_KEYS
from conveyor.report.tables.dynamics_tables import DYNAMICS_KEYS, SCENARIO_KEYS
from conveyor.report.tables.study_json import STUDY_KEYS, TAKE_UP_KEYS


class _Source(NamedTuple):
    """What the data are taken from."""

    assessment: Assessment
    tables: AnalysisTables

    @property
    def own(self) -> CalculatedConveyor:
        """The spec's own load."""
        return self.assessment.own


class _Estimate(NamedTuple):
    """An estimate of the resistances, and its motor power [W]."""

    made: ClassicalEstimate
    motor: float


def _estimate_getter(name: str) -> Callable[[_Source], _Estimate | None]:
    """Estimate of a name; None where there is none."""

    def found(source: _Source) -> _Estimate | None:
        balance = source.own.balance
        made = getattr(balance, name)
        return None if made is None else _Estimate(made, balance.layout.shaft_power(made.motor_force))

    return found


_ESTIMATE: Final = {
    "friction_factor": number_key("made.friction_factor"),
    "total_N": number_key("made.total"),
    "motor_kW": number_key(lambda estimate: estimate.motor / 1e3),
}


def _figure_key(of: str = "") -> JsonKey:
    """A number that a figure of the results says by its own path."""
    return number_key(lambda _: None, of)


def _energy_of_year(source: _Source) -> tuple[float | None, float | None]:
    """Energy [kWh] and cost of a year at even load or of the duty."""
    year, duty = source.own.year, source.assessment.studies.duty
    if duty is not None:
        return duty.year.net_kwh, duty.cost
    return (None, None) if year is None else (year.energy, year.cost)


def _price_currency(source: _Source) -> str | None:
    operation = source.own.conveyor.operation
    return None if operation is None or operation.price is None else operation.price.currency


def _give_first(source: _Source) -> str | None:
    effects = source.assessment.power_range.effects
    return effects[0].give if effects else None


def _power_band_keys(source: _Source) -> Any:
    """Ends of the range of power, figures of the results; left out where no default is in use."""
    return dict.fromkeys(("low", "high")) if source.assessment.power_range.effects else LEFT_OUT


def _table_rows(key: str) -> Callable[[_Source], list[dict[str, Any]]]:
    """Rows of a table; none where it is left out."""
    return lambda source: source.tables[key].plain() if key in source.tables else []


def _optional_key(key: JsonKey) -> JsonKey:
    return replace(key, optional=True)


_POWER: Final = JsonObject(
    lambda source: source,
    describe_value("conveyor power SPEC --json"),
    keys={
        "schema_version": VERSION_KEY,
        "name": text_key("own.conveyor.name"),
        "flow_t_per_h": _figure_key(),
        "length_m": _figure_key(),
        "lift_m": _figure_key("from tail to head, negative downhill"),
        "friction_factor": _figure_key("f that DIN 22101's main resistance needs for the same force"),
        "design_friction": _figure_key("that motors, belt, grip and take-up are checked with, over the computed one"),
        "error_estimate": _figure_key("largest of any roll's indentation, relative"),
        "forces_N": number_object(
            lambda source: dict.fromkeys(source.own.balance.forces.parts),
            "secondary", "special", "lift", "total",
            of="against the motion; before these the main resistances: indentation, idler_rotation, flexure, "
            "misalignment, or by their keys those of a classical method",
        ),
        "power_kW": number_object(
            lambda _: dict.fromkeys(("belt", "motor", "mains", "design")), "belt", "motor", "mains", "design",
            of="negative where the belt drives; design: at the motor with the friction to design for",
        ),
        "tensions_N": row_object(
            {name: number_key(name) for name in ("tight", "slack", "tight_start", "largest", "smallest")}
            | {"governed_by": text_key("governed_by")},
        ).of(lambda source: asdict(source.own.balance.tensions)),
        "drives": JsonList(
            lambda source: [
                (side, balance.layout.motor(side.force, drive.share))
                for balance in [source.own.balance]
                for drive, side in zip(balance.line.drives, balance.equilibrium.steady.drives, strict=True)
            ],
            item=JsonObject(
                lambda pair: pair,
                describe_value("in steady running"),
                keys={
                    "drive": text_key("0.name"),
                    "force_N": number_key("0.force"),
                    "motor_kW": number_key(lambda pair: pair[1] / 1e3),
                    "arriving_N": number_key("0.arriving"),
                    "leaving_N": number_key("0.leaving"),
                },
            ),
        ),
        "take_up": TAKE_UP_KEYS.of("assessment.take_up"),
        "energy": JsonObject(
            lambda source: source,
            keys={
                "kWh_per_tonne_km": number_key("own.balance.power.energy_per_tonne_km", known=False),
                "kWh_per_year": number_key(
                    lambda source: _energy_of_year(source)[0],
                    "at even load, or net of the duty where there is one", known=False,
                ),
                "cost_per_year": number_key(lambda source: _energy_of_year(source)[1], known=False),
                "currency": text_key(_price_currency, known=False),
            },
        ),
        "classical": JsonObject(
            _estimate_getter("classical"), keys=_ESTIMATE | {"secondary_by": text_key("made.secondary_by")}
        ),
        "cema": JsonObject(
            _estimate_getter("cema"),
            {"type": ["object", "null"]},
            keys=_ESTIMATE
            | {
                "items_N": _optional_key(number_object(
                    lambda estimate: {symbol: newtons for symbol, _, newtons in estimate.made.items},
                    of="by symbol; they add up to the total",
                ))
            },
        ),
        "defaults": JsonObject(
            lambda source: source,
            describe_value("defaults in use and the range of power they leave open") | {"type": ["object", "null"]},
            optional=True,
            keys={
                "motor_kW": _optional_key(number_object(_power_band_keys, "low", "high")),
                "replace_first": _optional_key(text_key(_give_first, known=False)),
                "in_use": JsonList(
                    _table_rows("defaults"), optional=True, item=JsonKey(lambda row: row, ROW_SCHEMA)
                ),
            },
        ),
        "rubber": JsonList(
            _table_rows("rubber"),
            item=row_object({
                "strand": choice_key("strand", "carry", "return"),
                "compound": text_key("compound"),
                "temperature_degC": number_key("temperature_degC"),
                "excited_Hz": number_list("excited_Hz", known=False),
                "data_Hz": number_list("data_Hz", known=False),
                "working_strain": number_key("working_strain", known=False),
                "storage_factor": number_key("storage_factor"),
                "loss_factor": number_key("loss_factor"),
                **{
                    name: number_key(name, known=False, optional=True)
                    for name in ("level_factor", "level_from", "level_to")
                },
                "warming_K": number_key("warming_K"),
            }),
        ),
        "sections": JsonList(
            _table_rows("sections"),
            describe_value("of both strands; every force along the belt as <name>_N"),
            item=row_object(
                {"section": text_key("section"), "strand": choice_key("strand", "carry", "return")}
                | {
                    name: number_key(name)
                    for name in ("length_m", "lift_m", "total_N")
                },
                {"additionalProperties": {"type": "number"}},
            ),
        ),
        "assumptions": text_list("assessment.assumptions", "what every figure rests on"),
        "checks": JsonList(
            lambda source: check_pairs(source.assessment.checks, source.assessment.governing),
            describe_value("every criterion, of the conveyor as given and in every load case"),
            item=CHECK_KEYS,
        ),
        "warnings": text_list(
            lambda source: [said.text(source.assessment.system) for said in source.assessment.warnings],
            "where one is strained, a default stands in, a criterion is not met",
        ),
        **{name: key.inside("assessment.studies") for name, key in STUDY_KEYS.items()},
        "dynamics": JsonObject(
            lambda source: LEFT_OUT if source.assessment.dynamics is None else source.assessment.dynamics,
            describe_value("where the spec has scenarios; their checks are among `checks`"),
            optional=True,
            keys=SCENARIO_KEYS,
        ),
    },
)  # fmt: skip


def analysis_json(assessment: Assessment) -> dict[str, Any]:
    """Plain numbers for JSON, SI or the unit in the key, as `result_schema` describes them."""
    tables = AnalysisTables(assessment)
    return insert_by_path(_POWER.plain(_Source(assessment, tables)), tables["results"].rows)


def insert_by_path(data: dict[str, Any], rows: Iterable[Figure]) -> dict[str, Any]:
    """Insert figures into plain data at their dotted paths, in SI units of reports."""
    for row in rows:
        if row.json:
            *path, last = row.json.split(".")
            inside = data
            for name in path:
                inside = inside.setdefault(name, {})
            inside[last] = row.unit("SI").shown(row.value)
    return data


def result_schema() -> Schema:
    """Return the JSON schema (draft 2020-12) of what `--json` prints of `conveyor power`, `compare` and `dynamics`.

    Numbers are finite; what is not known is null. Keys may be added within a version.

    Examples
    --------
    >>> result_schema()["$defs"]["power"]["properties"]["checks"]["items"]["properties"]["verdict"]
    {'enum': ['pass', 'fail', 'not checked']}
    """
    declared = {"power": _POWER, "comparison": COMPARISON_KEYS, "dynamics": DYNAMICS_KEYS}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"Results of conveyor, version {SCHEMA_VERSION}",
        "oneOf": [{"$ref": f"#/$defs/{name}"} for name in declared],
        "$defs": {name: keys.schema() for name, keys in declared.items()},
    }
