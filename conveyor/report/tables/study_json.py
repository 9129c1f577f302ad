"""JSON of the studies of a conveyor."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, Final

from conveyor.assessment import Assessment
from conveyor.report.json_keys import (
    LEFT_OUT,
    ROW_SCHEMA,
    JsonKey,
    JsonList,
    JsonObject,
    describe_value,
    free_object,
    number_key,
    number_list,
    table_rows,
    text_key,
    text_list,
)
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from conveyor.studies import CalculatedStudies
    from conveyor.studies.states import LoadState
from conveyor.report.tables.study_tables import (
    case_table,
    duty_table,
    flooded_belt,
    governing_cases,
    motor_table,
    power_bands,
    refused_cases,
    sensitivity_table,
    year_table,
)

_STATE_KEYS = ("empty", "full", "inclines", "declines", "worst")


TAKE_UP_KEYS: Final = JsonObject(
    lambda pair: pair,
    keys={
        "kind": text_key("0.unit.kind"),
        "setting_N": number_key("0.setting"),
        "least_setting_N": number_key("0.needed"),
        "mass_kg": number_key("0.mass", known=False, optional=True),
        "strands": number_key("0.unit.strands", optional=True),
        "travel_m": number_key("0.travel.whole", known=False, optional=True),
        "governed_by": text_key(lambda pair: pair[1].text()),
    },
)
"""Keys of the take-up's duty and of the load and condition that govern it."""


_STATE: Final = JsonObject(
    lambda state: state,
    keys={
        "loaded_sections": text_list("loaded"),
        "temperature_degC": number_key(lambda state: display_unit("temperature", "SI").shown(state.temperature)),
        "power_kW": JsonObject(
            "balance.power",
            {"additionalProperties": {"type": "number"}},
            keys={
                "belt": number_key(lambda power: power.belt / 1e3),
                "motor": number_key(lambda power: power.motor / 1e3),
            },
        ),
        "effective_tension_N": number_key("balance.forces.total"),
        "tensions_N": free_object(lambda state: asdict(state.balance.tensions), "number", "string"),
        "take_up_asked_N": number_key("balance.equilibrium.needed"),
        "worst_for": text_list("worst_for"),
    },
)


def _states_by_key(studies: CalculatedStudies) -> dict[str, LoadState] | None:
    if studies.states is None:
        return None
    return {key: state for state in studies.states.states for key in state.keys}


def _state_key(name: str) -> JsonKey:
    return replace(_STATE, get=lambda states: states.get(name, LEFT_OUT), optional=True)


def _flooded_row(studies: CalculatedStudies) -> Any:
    """Figures of the flooded belt; null without an answer, left out without load states."""
    if studies.flooded is None:
        return LEFT_OUT if studies.states is None else None
    return flooded_belt(studies.flooded).series("").to_dict() if studies.states is not None else LEFT_OUT


STUDY_KEYS: Final[dict[str, JsonKey]] = {
    "states": JsonObject(
        _states_by_key,
        describe_value("of load") | {"additionalProperties": _STATE.schema()},
        optional=True,
        keys={name: _state_key(name) for name in _STATE_KEYS},
    ),
    "worst_states": JsonList(
        lambda studies: (
            LEFT_OUT if studies.states is None else [state for state in studies.states.states if state.worst_for]
        ),
        describe_value("loadings that are worst for a figure, those of `states` among them"),
        optional=True,
        item=_STATE,
    ),
    "flooded": JsonKey(
        _flooded_row,
        ROW_SCHEMA | {"type": ["object", "null"]} | describe_value("the belt full to the brim"),
        optional=True,
    ),
    "load_cases": JsonObject(
        lambda studies: studies if studies.cases is not None else LEFT_OUT,
        describe_value("where the spec has cases"),
        optional=True,
        keys={
            "conveyor": text_key("cases.conveyor.name"),
            "friction_band": number_list("cases.friction_band"),
            "cases": table_rows(lambda studies: case_table(studies.cases)),
            "governing": table_rows(lambda studies: governing_cases(studies.cases, studies.governing)),
            "motors": table_rows(lambda studies: motor_table(studies, "SI")),
            "refused": table_rows(lambda studies: refused_cases(studies.cases)),
        },
    ),
    "duty": JsonObject(
        "duty",
        describe_value("where the spec has operation.duty"),
        optional=True,
        keys={
            "conveyor": text_key("conveyor.name"),
            "year": JsonKey(lambda study: year_table(study).series("").to_dict(), ROW_SCHEMA),
            "emission_source": text_key("emission_source", known=False),
            "duty": table_rows(duty_table),
        },
    ),
    "uncertainty": JsonObject(
        "uncertainty",
        describe_value("where the spec has ranges"),
        optional=True,
        keys={
            "conveyor": text_key("conveyor.name"),
            "band": table_rows(power_bands),
            "tornado": table_rows(sensitivity_table),
            "notes": text_list("notes"),
        },
    ),
}
"""Keys of the studies of a conveyor; those of studies that were not requested are left out."""


def studies_json(studies: CalculatedStudies) -> dict[str, Any]:
    """Plain numbers of the existing studies for JSON; units in the keys."""
    of_states = {} if studies.states is None else {
        "take_up": TAKE_UP_KEYS.plain(Assessment(studies.states.own, studies).take_up)
    }  # fmt: skip
    made = JsonObject(lambda held: held, keys=STUDY_KEYS).plain(studies)
    return {**made, **of_states}
