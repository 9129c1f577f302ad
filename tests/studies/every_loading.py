"""Every loading of a conveyor, each calculated on its own: what the load states of a report are judged against.

Forces along the belt are those of `tests.loop.loop_lines.closed`, so that a loading costs no contact.
"""

from __future__ import annotations

import itertools

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import run_checks
from conveyor.forces import rubber_free_forces
from conveyor.line.contacts import Contacts
from conveyor.line.stretches import STRANDS
from conveyor.loop.balance import with_take_up_at
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from tests.loop.loop_lines import BOOSTER, DATA, TAIL_DRIVE, closed, line

FEEDING = DATA["route"]["feeding"]
SHAFT = {
    "diameter": "1 m",
    "mass": "2 t",
    "shaft_diameter": "200 mm",
    "bearing_centres": "1.9 m",
    "hub_centres": "1.4 m",
    "hub_shaft_diameter": "220 mm",
    "shaft_steel": "C1045",
    "bearing_rating": "900 kN",
    "bearing_life": "40000 h",
    "lagging_pressure": "1 MPa",
}
PULLEYS = [SHAFT | {"name": "head", "position": "head"}, SHAFT | {"name": "tail", "position": "tail"},
           SHAFT | {"name": "bend", "position": "take-up"}]  # fmt: skip
PARTS = {"pulley_diameter": "1 m", "backstop": True, "backstop_torque": "150 kN*m", "brake_heat": "50 MJ"}


def calculated(conveyor, take_up=None):
    """A conveyor without contacts, its take-up at a setting; with pulleys its flexure, too, follows the tension."""
    balance = closed(conveyor, by_sag=bool(conveyor.route.pulleys))
    if take_up is not None:
        (balance,) = with_take_up_at([balance], take_up)
    contacts, fixed = Contacts(balance.line, {}, (), ()), rubber_free_forces(balance.line.strands)
    return CalculatedConveyor(conveyor, conveyor.temperature, contacts, balance, fixed)


def calculated_many(variants, *_args, **_kwargs):
    """In the place of `pipeline.calculate_many`."""
    return [calculated(variant.conveyor, variant.take_up) for variant in variants]


def route(rng, count, pulleys=()):
    """A conveyor that rises and falls, with all that criteria look at by chance.

    Without pulleys nothing depends on the tensions, flexure included, and sums of forces are exact.
    """
    sections = [_section(rng, i) for i in range(count)]
    drive = {"position": str(rng.choice(["head", "tail"]))}
    further = [BOOSTER | {"section": f"s{rng.integers(count - 1)}"}] if rng.random() < 0.4 else []
    further += [TAIL_DRIVE] if rng.random() < 0.3 else []
    if further:
        drive["further_drives"] = further
    if rng.random() < 0.6:
        drive |= {"brake_force": f"{rng.uniform(20, 200):.1f} kN", "brake_delay": f"{rng.uniform(0, 2):.2f} s",
                  "reduced_mass": f"{rng.uniform(1, 20):.1f} t", "stop_deceleration": "0.2 m/s^2"} | PARTS  # fmt: skip
    if rng.random() < 0.5:  # else all that the motors give
        drive["start_factor"] = 1.4
        drive["torque_factor"] = 1.8
    made = {"sections": sections, "pulleys": list(pulleys)}
    kind = str(rng.choice(["gravity", "fixed", ""]))
    if kind:
        made["take_up"] = {"kind": kind, "position": str(rng.choice(["head", "tail"])), "travel": "4 m"}
    if rng.random() < 0.5:
        made |= {"head_transition": {"length": "4 m"}, "tail_transition": {"length": "3 m"}}
    if rng.random() < 0.3:
        made["feeding"] = FEEDING | {"share": 0.6}
        made["further_feeding"] = [FEEDING | {"section": "s1", "share": 0.4}]
    idlers = {strand: DATA["idlers"][strand] | {"raised": "3 mm", "rating": "6 kN"} for strand in STRANDS}
    return line(route=made, drive=drive, idlers=idlers, calculation={"not_given": "nothing"})


def _section(rng, i):
    """Straight, or on a vertical curve of constant slope."""
    made = {"name": f"s{i}", "length": f"{rng.uniform(50, 600):.3f} m"}
    made["lift"] = f"{rng.uniform(-40, 40):.3f} m"
    if rng.random() < 0.25:
        kind = str(rng.choice(["convex", "concave"]))
        made |= {"lift": "0 m", "length": "60 m", "curve": kind, "curve_radius": "900 m"}
    elif rng.random() < 0.25:
        side = str(rng.choice(["left", "right"]))
        made |= {
            "horizontal_curve": side,
            "horizontal_radius": "2 km",
            "carry_banking": "2 deg",
            "return_banking": "1 deg",
        }
    return made


def bearing(conveyor, loading):
    """The conveyor with bulk on those sections."""
    names = [s.name for s, on in zip(conveyor.route.sections, loading, strict=True) if on]
    if names:
        return with_case(conveyor, LoadCase(name="some", loading="sections", sections=names))
    return with_case(conveyor, LoadCase(name="empty", loading="empty"))


def every_loading(conveyor, take_up):
    """Every loading with the take-up at a setting."""
    for loading in itertools.product([True, False], repeat=len(conveyor.route.sections)):
        yield loading, calculated(bearing(conveyor, loading), take_up)


def judged(found):
    """Criteria of a load that need no contacts."""
    return run_checks(found, contacts=False)
