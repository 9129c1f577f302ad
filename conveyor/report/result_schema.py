"""The versioned JSON schema of what `--json` prints, of a conveyor, a comparison and scenarios."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

SCHEMA_VERSION: Final = 1
"""Increased where a key goes or changes its meaning, not for a new key."""

Schema = dict[str, Any]


def _value_of_type(*kinds: str, of: str = "") -> Schema:
    """Schema of a value of one of some types."""
    said: Schema = {"type": kinds[0] if len(kinds) == 1 else list(kinds)}
    return said | ({"description": of} if of else {})


def _object_of(keys: Mapping[str, Schema], *, also: Mapping[str, Schema] | None = None, of: str = "") -> Schema:
    """Schema of an object with required keys, and optional ones in `also`."""
    said: Schema = {"type": "object", "properties": {**keys, **(also or {})}, "required": list(keys)}
    return said | ({"description": of} if of else {})


def _list_of(item: Schema, of: str = "") -> Schema:
    """Schema of a list of items of one schema."""
    return {"type": "array", "items": item} | ({"description": of} if of else {})


def _one_of(*values: Any) -> Schema:
    return {"enum": list(values)}


_NUMBER: Final = _value_of_type("number")
_TEXT: Final = _value_of_type("string")
_NUMBER_OR_NOT: Final = _value_of_type("number", "null")
_TEXT_OR_NOT: Final = _value_of_type("string", "null")
_ROW: Final = {
    "type": "object",
    "additionalProperties": _value_of_type("number", "string", "boolean", "null"),
}
_ROWS: Final = _list_of(_ROW, "rows of a table, under the names of its columns with their units")


def _object_of_numbers(*names: str, of: str = "") -> Schema:
    """Schema of an object of numbers: those named, and maybe more."""
    return _object_of(dict.fromkeys(names, _NUMBER), of=of) | {"additionalProperties": _NUMBER}


def _list_of_texts(of: str) -> Schema:
    return _list_of(_TEXT, of)


_ESTIMATE: Final = {"friction_factor": _NUMBER, "total_N": _NUMBER, "motor_kW": _NUMBER}

_CHECK: Final = _object_of(
    {
        "key": _value_of_type("string", of="of the criterion, for programs"),
        "subject": _value_of_type("string", of="what is checked; the same in every case"),
        "where": _value_of_type("string", "null", of="what decides in it: a state of motion, a section"),
        "case": _value_of_type(
            "string", "null", of="load case and its temperature; null: the conveyor as its spec gives it"
        ),
        "calculated": _value_of_type("number", "null", of="in `unit`"),
        "relation": _one_of("at least", "at most") | {"description": "how calculated must stand to required"},
        "required": _value_of_type("number", "null", of="in `unit`; null where the spec does not say or nothing helps"),
        "unit": _value_of_type("string", of="- of ratios"),
        "margin": _value_of_type("number", "null", of="over what is required, negative where it fails"),
        "verdict": _one_of("pass", "fail", "not checked"),
        "why": _value_of_type("string", "null", of="what to say where it does not pass"),
        "governs": _value_of_type("boolean", of="whether its margin is the least of its key and subject in all cases"),
    }
)

_STATE: Final = _object_of(
    {
        "loaded_sections": _list_of(_TEXT),
        "temperature_degC": _NUMBER,
        "power_kW": _object_of_numbers("belt", "motor"),
        "effective_tension_N": _NUMBER,
        "tensions_N": _object_of({}) | {"additionalProperties": _value_of_type("number", "string")},
        "take_up_asked_N": _NUMBER,
        "worst_for": _list_of(_TEXT),
    }
)


def _list_of_rows(*texts: str, numbers: tuple[str, ...], also: tuple[str, ...] = (), of: str = "") -> Schema:
    """Schema of rows of text and of numbers or null; `also` names optional numbers."""
    keys = dict.fromkeys(texts, _TEXT) | dict.fromkeys(numbers, _NUMBER_OR_NOT)
    return _list_of(_object_of(keys, also=dict.fromkeys(also, _NUMBER_OR_NOT)), of)


_EXTREMES: Final = ("highest_N", "highest_at_s", "lowest_N", "lowest_at_s")
_SCENARIOS: Final = {
    "scenarios": _list_of_rows(
        "scenario", "highest_in", "lowest_in",
        numbers=(
            "duration_s", "highest_tension_N", "highest_at_s", "lowest_tension_N", "lowest_at_s",
            "highest_speed_m_per_s", "rest_s", "way_m", "error", "energy_error", "cells", "step_s",
        ),
        of="one row a scenario; error is that of the peaks over the highest tension, by refinement",
    ),
    "drives": _list_of_rows(
        "scenario", "drive",
        numbers=(
            "torque_max", "torque_min", "force_max_N", "force_min_N", "power_kW", "slip_m", "slip_heat_MJ", "brake_N",
            "backstop_N", "take_up_setting_N", "take_up_min_N", "take_up_max_N", "carriage_out_m", "carriage_in_m",
        ),
    ),
    "pulleys": _list_of_rows("scenario", "pulley", numbers=_EXTREMES, also=("safety",)),
    "tensions": _list_of_rows("scenario", "section", "strand", numbers=(*_EXTREMES, "least_for_sag_N", "sag")),
    "splices": _list_of_rows("scenario", numbers=("highest_N_per_mm", "lowest_N_per_mm"), also=("strength_N_per_mm",)),
}  # fmt: skip
_SIZES: Final = {
    "sizes": _list_of(
        _object_of(
            dict.fromkeys(("sought", "scenario", "governs", "fails_with_less"), _TEXT)
            | {"value": _NUMBER, "error": _NUMBER_OR_NOT, "most": _NUMBER_OR_NOT},
            of="figures that --size sought, in the unit that `sought` names",
        )
    )
}

_POWER: Final = _object_of(
    {
        "schema_version": {"const": SCHEMA_VERSION},
        "name": _TEXT,
        "flow_t_per_h": _NUMBER,
        "length_m": _NUMBER,
        "lift_m": _value_of_type("number", of="from tail to head, negative downhill"),
        "friction_factor": _value_of_type("number", of="f that DIN 22101's main resistance needs for the same force"),
        "error_estimate": _value_of_type("number", of="largest of any roll's indentation, relative"),
        "forces_N": _object_of_numbers(
            "indentation", "idler_rotation", "flexure", "misalignment", "secondary", "special", "lift", "total",
            of="against the motion",
        ),
        "power_kW": _object_of_numbers("belt", "motor", "mains", of="negative where the belt drives"),
        "tensions_N": _object_of(
            dict.fromkeys(("tight", "slack", "tight_start", "largest", "smallest"), _NUMBER)
            | {"governed_by": _TEXT}
        ),
        "drives": _list_of(
            _object_of(
                {"drive": _TEXT}
                | dict.fromkeys(("force_N", "motor_kW", "arriving_N", "leaving_N"), _NUMBER),
                of="in steady running",
            )
        ),
        "take_up": _object_of(
            {"kind": _TEXT, "setting_N": _NUMBER, "least_setting_N": _NUMBER, "governed_by": _TEXT},
            also={"mass_kg": _NUMBER_OR_NOT, "strands": _NUMBER, "travel_m": _NUMBER_OR_NOT},
        ),
        "energy": _object_of(
            {
                "kWh_per_tonne_km": _NUMBER_OR_NOT,
                "kWh_per_year": _value_of_type("number", "null", of="at even load, or net of the duty where there "
                "is one"),
                "cost_per_year": _NUMBER_OR_NOT,
                "currency": _TEXT_OR_NOT,
            }
        ),
        "classical": _object_of(_ESTIMATE | {"secondary_by": _TEXT}),
        "cema": _object_of(_ESTIMATE) | {"type": ["object", "null"]},
        "rubber": _list_of(
            _object_of(
                {
                    "strand": _one_of("carry", "return"),
                    "compound": _TEXT,
                    "temperature_degC": _NUMBER,
                    "excited_Hz": _list_of(_NUMBER_OR_NOT),
                    "data_Hz": _list_of(_NUMBER_OR_NOT),
                    "working_strain": _NUMBER_OR_NOT,
                    "storage_factor": _NUMBER,
                    "loss_factor": _NUMBER,
                },
                also=dict.fromkeys(("level_factor", "level_from", "level_to"), _NUMBER_OR_NOT),
            )
        ),
        "sections": _list_of(
            _object_of(
                {"section": _TEXT, "strand": _one_of("carry", "return")}
                | dict.fromkeys(("length_m", "lift_m", "indentation_N", "idler_rotation_N", "total_N"), _NUMBER)
            )
            | {"additionalProperties": _NUMBER},
            of="of both strands; every force along the belt as <name>_N",
        ),
        "checks": _list_of(_CHECK, of="every criterion, of the conveyor as given and in every load case"),
        "assumptions": _list_of_texts("what every figure rests on"),
        "warnings": _list_of_texts("where one is strained, a default stands in, a criterion is not met"),
    },
    also={
        "defaults": _object_of(
            {},
            also={
                "motor_kW": _object_of_numbers("low", "high"),
                "replace_first": _TEXT_OR_NOT,
                "notes": _list_of(_TEXT),
                "in_use": _list_of(
                    {"type": "object", "additionalProperties": _value_of_type("number", "string", "boolean", "null")}
                ),
            },
            of="defaults in use and the range of power they leave open",
        )
        | {"type": ["object", "null"]},
        "states": _object_of(
            {}, also=dict.fromkeys(("empty", "full", "inclines", "declines", "worst"), _STATE), of="of load"
        )
        | {"additionalProperties": _STATE},
        "worst_states": _list_of(_STATE, of="loadings that are worst for a figure, those of `states` among them"),
        "flooded": _ROW | {"type": ["object", "null"], "description": "bulk from edge to edge of the belt"},
        "load_cases": _object_of(
            {
                "conveyor": _TEXT,
                "friction_band": _list_of(_NUMBER),
                "cases": _ROWS,
                "governing": _ROWS,
                "motors": _ROWS,
                "refused": _ROWS,
            },
            of="where the spec has cases",
        ),
        "duty": _object_of(
            {
                "conveyor": _TEXT,
                "year": _ROW,
                "emission_source": _TEXT_OR_NOT,
                "duty": _ROWS,
            },
            of="where the spec has operation.duty",
        ),
        "uncertainty": _object_of(
            {"conveyor": _TEXT, "band": _ROWS, "tornado": _ROWS, "notes": _list_of(_TEXT)},
            of="where the spec has ranges",
        ),
        "dynamics": _object_of(_SCENARIOS, of="where the spec has scenarios; their checks are among `checks`"),
    },
    of="conveyor power SPEC --json",
)  # fmt: skip

_COMPARISON: Final = _object_of(
    {
        "schema_version": {"const": SCHEMA_VERSION},
        "conveyor": _TEXT,
        "base": _value_of_type("string", of="compound of the savings"),
        "cover": _TEXT,
        "compared": _list_of(
            _object_of(
                {
                    "speed_m_per_s": _value_of_type("number"),
                    "temperatures_degC": _list_of(_value_of_type("number")),
                },
                of="temperatures that means are over",
            )
        ),
        "ranking": _ROWS,
        "scenes": _ROWS,
        "coverage": _ROWS,
        "refused": _ROWS,
        "warnings": _list_of_texts("notes"),
    },
    of="conveyor compare SPEC --json",
)

_DYNAMICS: Final = _object_of(
    {
        "schema_version": {"const": SCHEMA_VERSION},
        "conveyor": _TEXT,
        **_SCENARIOS,
        "checks": _list_of(_CHECK, of="every criterion of every scenario; `case` is the scenario"),
        "assumptions": _list_of_texts("what the figures rest on that the spec does not say"),
    },
    also=_SIZES,
    of="conveyor dynamics SPEC --json",
)


def result_schema() -> Schema:
    """Return the JSON schema (draft 2020-12) of what `--json` prints of `conveyor power`, `compare` and `dynamics`.

    Numbers are finite; what is not known is null. Keys may be added within a version.

    Examples
    --------
    >>> result_schema()["$defs"]["power"]["properties"]["checks"]["items"]["properties"]["verdict"]
    {'enum': ['pass', 'fail', 'not checked']}
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"Results of conveyor, version {SCHEMA_VERSION}",
        "oneOf": [{"$ref": f"#/$defs/{name}"} for name in ("power", "comparison", "dynamics")],
        "$defs": {"power": _POWER, "comparison": _COMPARISON, "dynamics": _DYNAMICS},
    }
