"""Load cases, duty and uncertainty as tables: pandas, units in the names. Column names are stable."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from conveyor.figures import celsius

if TYPE_CHECKING:
    from conveyor.studies.cases import CaseStudy, MotorChoice
    from conveyor.studies.duty import DutyStudy
    from conveyor.studies.uncertainty import UncertaintyStudy

_UNITS = {"power": ("kW", 1e-3), "force": ("N", 1.0)}


def cases(study: CaseStudy) -> pd.DataFrame:
    """One row a case, speed and temperature."""
    low, high = study.friction_band
    return pd.DataFrame(
        [
            {
                "case": r.case,
                "loading": r.loading,
                "temperature [degC]": celsius(r.temperature),
                "belt speed [m/s]": r.speed,
                "mass flow [t/h]": r.flow * 3.6,
                "indentation [N]": r.indentation,
                "main resistance [N]": r.main,
                "effective tension [N]": r.effective,
                "motor power [kW]": r.motor / 1e3,
                f"motor power, {low:g} x friction [kW]": r.motor_low / 1e3,
                f"motor power, {high:g} x friction [kW]": r.motor_high / 1e3,
                "equivalent DIN f [-]": r.friction_factor,
                "tight side tension [N]": r.tight,
                "slack side tension [N]": r.slack,
                "largest tension [N]": r.largest,
                "smallest tension [N]": r.smallest,
                "take-up tension asked for [N]": r.take_up,
                "governed by": r.governed_by,
                "largest roll load [N]": r.largest_roll,
                "at roll": r.largest_roll_at,
                "energy [kWh/(t km)]": r.energy_per_tonne_km,
                "error estimate [-]": r.error,
            }
            for r in study.results
        ]
    )


def governing(study: CaseStudy) -> pd.DataFrame:
    """One row a figure: its value and the case that decides it."""
    return pd.DataFrame(
        [
            {
                "figure": row.figure,
                "value": row.value * _UNITS[row.kind][1],
                "unit": _UNITS[row.kind][0],
                "case": row.result.case,
                "temperature [degC]": celsius(row.result.temperature),
                "belt speed [m/s]": row.result.speed,
            }
            for row in study.governing
        ]
    )


def refused_cases(study: CaseStudy) -> pd.DataFrame:
    """Cases without an answer, and why."""
    return pd.DataFrame(
        [
            {
                "case": row.case,
                "temperature [degC]": celsius(row.temperature),
                "belt speed [m/s]": row.speed,
                "reason": row.reason,
            }
            for row in study.refused
        ],
        columns=["case", "temperature [degC]", "belt speed [m/s]", "reason"],
    )


def motors(choices: tuple[MotorChoice, ...]) -> pd.DataFrame:
    """One row a drive pulley: what it needs, and motors of the series."""
    return pd.DataFrame(
        [
            {
                "drive": row.drive,
                "needed at the shaft [kW]": row.needed / 1e3,
                "reserve [-]": row.reserve,
                "motors": row.count,
                "rated each [kW]": row.rated / 1e3,
                "installed [kW]": row.count * row.rated / 1e3,
                "governing case": row.case,
            }
            for row in choices
        ]
    )


def duty(study: DutyStudy) -> pd.DataFrame:
    """One row a bar of the year's histogram."""
    return pd.DataFrame(
        [
            {
                "hours [h]": row.hours,
                "load share [-]": row.share,
                "temperature [degC]": celsius(row.temperature),
                "belt speed [m/s]": row.speed,
                "mass flow [t/h]": row.flow * 3.6,
                "effective tension [N]": row.effective,
                "motor power [kW]": row.shaft / 1e3,
                "mains power [kW]": row.mains / 1e3,
                "energy [MWh]": row.energy / 1e3,
                "conveyed [t]": row.mass / 1e3,
            }
            for row in study.rows
        ]
    )


def year(study: DutyStudy) -> pd.Series:
    """Sums of the year; those that need a price or a factor only where it is given."""
    rows = {
        "in operation [h]": study.year.time / 3600.0,
        "conveyed [t]": study.year.mass / 1e3,
        "drawn [MWh]": study.year.drawn_kwh / 1e3,
        "fed back [MWh]": study.year.fed_back_kwh / 1e3,
        "net [MWh]": study.year.net_kwh / 1e3,
        "energy [kWh/(t km)]": study.energy_per_tonne_km,
        f"cost [{study.currency or '-'}]": study.cost,
        "carbon dioxide [t]": None if study.emission is None else study.emission / 1e3,
    }
    return pd.Series({name: value for name, value in rows.items() if value is not None}, dtype=float)


def tornado(study: UncertaintyStudy) -> pd.DataFrame:
    """One row an input, the one that matters most first."""
    return pd.DataFrame(
        [
            {
                "input": row.name,
                "low": row.low,
                "as given": row.given,
                "high": row.high,
                "motor power at low [kW]": row.motor_low / 1e3,
                "motor power at high [kW]": row.motor_high / 1e3,
                "change at low [kW]": (row.motor_low - study.motor) / 1e3,
                "change at high [kW]": (row.motor_high - study.motor) / 1e3,
                "swing [kW]": row.swing / 1e3,
                "share of variance [-]": share,
            }
            for row, share in zip(study.effects, study.shares, strict=True)
        ]
    )


def band(study: UncertaintyStudy) -> pd.DataFrame:
    """The power with its bands, one row a way to combine the inputs."""
    ways = {"root of squares": study.band, "Latin hypercube, first order": study.sampled}
    return pd.DataFrame(
        [
            {
                "combined by": name,
                "motor power, low [kW]": low / 1e3,
                "motor power [kW]": study.motor / 1e3,
                "motor power, high [kW]": high / 1e3,
            }
            for name, (low, high) in ways.items()
        ]
    )


def cases_data(study: CaseStudy) -> dict[str, object]:
    """Load cases as plain numbers for JSON; units in the keys."""
    return {
        "conveyor": study.conveyor.name,
        "friction_band": list(study.friction_band),
        "cases": _records(cases(study)),
        "governing": _records(governing(study)),
        "motors": _records(motors(study.motors())) if study.results else [],
        "refused": _records(refused_cases(study)),
    }


def duty_data(study: DutyStudy) -> dict[str, object]:
    """A year as plain numbers for JSON; units in the keys."""
    return {
        "conveyor": study.conveyor.name,
        "year": {str(name): float(value) for name, value in year(study).items()},
        "emission_source": study.emission_source,
        "duty": _records(duty(study)),
    }


def uncertainty_data(study: UncertaintyStudy) -> dict[str, object]:
    """The power with its band as plain numbers for JSON; units in the keys."""
    return {
        "conveyor": study.conveyor.name,
        "band": _records(band(study)),
        "tornado": _records(tornado(study)),
        "notes": list(study.notes),
    }


def _records(frame: pd.DataFrame) -> list[dict[str, object]]:
    """Rows with None where a figure is not known."""
    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    return [{str(name): value for name, value in row.items()} for row in rows]
