"""Resistances by the classical methods: friction factors f (ISO 5048, DIN 22101), or CEMA's classic form.

CEMA: Kx computed, Ky, Kt, Ai, Cs from the user's copy of Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6, as
commonly reproduced; skirts, cleaners, ploughs and pulleys by its figures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.force_sums import Force
from conveyor.laws.resistance import (
    CemaTension,
    cema_acceleration,
    cema_effective_tension,
    cema_idler_factor,
    cema_pulley_friction,
    cema_skirts,
    roll_line_mass,
    section_main_resistance,
    slider_bed_resistance,
    slope_resistance,
)
from conveyor.laws.resistance.cema import Place
from conveyor.line.bend_pulleys import BendPulley
from conveyor.line.cema_factors import CemaFactors
from conveyor.line.hopper_outlets import HopperOutlet
from conveyor.line.line import Line
from conveyor.line.stretches import Strand, Stretch
from conveyor.line.transfer_parts import LoadingPoint
from conveyor.models.calculation_methods import METHOD_NAMES

Array = NDArray[np.float64]

STANDARD_GRAVITY: Final = 9.80665
"""Pounds force for pounds mass [m/s²]."""
_LEAST_WRAP: Final = math.radians(150.0)  # CEMA: below it a pulley counts as "other"
_BOOK: Final = "CEMA classic"


def unit_main_force(stretch: Stretch, gravity: float) -> float:
    """Main resistance of a stretch for f = 1 [N]; none on a plate, whose friction is a resistance of its own."""
    if stretch.bed is not None:
        return 0.0
    return section_main_resistance(
        friction_factor=1.0,
        length=stretch.length,
        roll_mass=roll_line_mass(stretch.set_mass, spacing=stretch.spacing),
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        inclination=stretch.inclination,
        gravity=gravity,
    )


def factor_main_force(line: Line, unit_main: Array) -> Force:
    """Main resistance by friction factors, f L g (m'_R + (m'_G + m'_L) cos δ), stretch by stretch.

    Parameters
    ----------
    line : Line
        The conveyor, with f of every stretch.
    unit_main : ndarray, shape (2n,)
        Main resistance of every stretch for f = 1 [N].
    """
    return Force(
        "main_by_factor", f"main resistance, {line.friction_text}", "main", line.friction_factors * unit_main,
        f"{METHOD_NAMES[line.method]}, F_H with f given", short="main resistance",
    )  # fmt: skip


def cema_section_tension(stretch: Stretch, factors: CemaFactors) -> CemaTension:
    """Parts of Te of a section, from its carry stretch."""
    kx = cema_idler_factor(
        stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_friction=factors.idler_friction,
        spacing=stretch.spacing,
    )
    made = cema_effective_tension(
        stretch.length,
        lift=stretch.rise,
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_factor=kx,
        flexure_factor=factors.flexure_of(stretch.section),
        temperature_factor=factors.temperature,
    )
    return made if stretch.bed is None else replace(made, idlers=0.0, belt_carry=0.0, bulk=0.0)


def bed_forces(line: Line) -> Iterator[Force]:
    """Friction of the belt on plates, by every method a resistance of its own [N]; none without plates."""
    if any(stretch.bed is not None for stretch in line.stretches):
        newtons = np.array([_bed_friction(stretch, line.gravity) for stretch in line.stretches])
        law = "friction of belt on plate x weight of belt and bulk, Coulomb"
        yield Force("slider_bed", "slider bed", "special", newtons, law, short="slider bed")


def _bed_friction(stretch: Stretch, gravity: float) -> float:
    """Friction of the belt on the plate of a stretch [N]."""
    if stretch.bed is None:
        return 0.0
    return slider_bed_resistance(
        stretch.line_mass, friction=stretch.bed.friction, length=stretch.length, inclination=stretch.inclination,
        gravity=gravity,
    )  # fmt: skip


def hopper_forces(
    line: Line, load: Callable[[HopperOutlet], float] = lambda hopper: hopper.flow_load
) -> Iterator[Force]:
    """Pull-out force under every hopper, and what its load costs on sets or plate, by every method [N]; in flow."""
    for point in line.loading:
        if (hopper := point.loaded_hopper) is None:
            continue
        here = partial(
            Force, kind="special", spot=point.spot, place=point.place, reach=hopper.length, bulk=point.comes_with
        )
        pull, support, skirts = hopper_pull(line, point.section, hopper, load(hopper))
        yield here(key="hopper_pull", name=f"pull-out under the hopper{point.name}", newtons=pull,
                   source="load in flow x friction of the shear, Arnold, McLean and Roberts")  # fmt: skip
        yield here(key="hopper_load", name=f"sets or plate under the hopper{point.name}", newtons=support,
                   source="load in flow x f, or x friction of the plate")  # fmt: skip
        if hopper.skirts is not None:
            yield here(key="hopper_skirts", name=f"skirts under the hopper{point.name}", newtons=skirts,
                       source="friction x side pressure of load in flow and bulk, Roberts")  # fmt: skip


def hopper_pull(line: Line, section: int, hopper: HopperOutlet, load: float) -> tuple[float, float, float]:
    """Pull-out force at a vertical load under a hopper over a section, resistance below it, friction of skirts [N]."""
    bed = line.stretches[section].bed
    friction = float(line.friction_factors[section]) if bed is None else bed.friction
    skirts = 0.0 if hopper.skirts is None else hopper.skirts.resistance(load)
    return hopper.shear_friction * load, friction * load, skirts


def initial_pull(line: Line, point: LoadingPoint) -> float:
    """Addition to the resistance when a feeder starts after its hopper was filled [N]; 0 without a hopper or bulk."""
    if (hopper := point.loaded_hopper) is None:
        return 0.0
    filled, flow = (hopper_pull(line, point.section, hopper, load) for load in (hopper.initial_load, hopper.flow_load))
    return math.fsum(filled) - math.fsum(flow)


def cema_forces_along(line: Line, factors: CemaFactors) -> tuple[Force, ...]:
    """L Kt (Kx + Ky Wb + 0.015 Wb) + L Ky Wm: idlers and flexure of carry strand, flexure of return strand [N].

    Notes
    -----
    Kx is that of the carry sets, for the idlers of both strands, and stands on the carry strand.
    """
    count = line.count
    parts = {one.section: cema_section_tension(one, factors) for one in line.stretches[:count]}
    carry = [parts[one.section] for one in line.stretches[:count]]
    back = [parts[one.section] for one in line.stretches[count:]]
    none = np.zeros(count)

    def force(symbol: str, name: str, strand: Strand, newtons: list[float]) -> Force:
        both = np.concatenate([newtons, none] if strand == "carry" else [none, newtons])
        return Force(symbol, f"{symbol}, {name}", "main", both, f"{_BOOK}, {symbol}", short=symbol, only_on=strand)

    return (
        force("Tx", "idlers", "carry", [part.idlers for part in carry]),
        force("Tyc", "flexure of the belt, carry", "carry", [part.belt_carry for part in carry]),
        force("Tyr", "flexure of the belt, return", "return", [part.belt_return for part in back]),
        force("Tym", "flexure of the bulk", "carry", [part.bulk for part in carry]),
        *bed_forces(line),
    )


def cema_point_forces(line: Line, factors: CemaFactors) -> Iterator[Force]:
    """Tp, Tam, Tsb, Tbc, Tpl, Tac, the lift over trippers and the pull of hoppers where they stand [N]."""
    yield from hopper_forces(line)
    for point in line.loading:
        here = partial(Force, place=point.place, assumed=point.assumed)
        if point.lift is not None and point.flow > 0.0:
            over = slope_resistance(point.flow / line.speed, lift=point.lift, gravity=STANDARD_GRAVITY)
            yield here("tripper_lift", f"lift over the tripper{point.name}", "lift", over, f"{_BOOK}, Tm",
                       certain=True, spot=point.before, bulk=point.comes_with)  # fmt: skip
        if point.flow > 0.0:
            inertia = cema_acceleration(point.flow, belt_speed=line.speed, initial_speed=point.speed)
            yield here("Tam", f"Tam, acceleration of the bulk{point.name}", "secondary", inertia, f"{_BOOK}, Tam",
                       certain=True, spot=point.spot, bulk=point.comes_with)  # fmt: skip
        boards = point.boards(line.speed, line.gravity)
        drag = point.seal_drag if point.seal_drag > 0.0 and not point.assumed else factors.seals
        seals = cema_skirts(boards, skirt_factor=0.0, depth=factors.skirt_depth, seals=drag)
        yield here("Tsb", f"Tsb, seals of the skirts{point.name}", "special", seals, f"{_BOOK}, Tsb", spot=point.spot)
        if point.flow_beyond > 0.0:
            depth = factors.skirt_depth
            rubbing = cema_skirts(boards, skirt_factor=factors.skirt_factor, depth=depth, seals=0.0)
            yield here("Tsb", f"Tsb, skirts{point.name}", "special", rubbing, f"{_BOOK}, Tsb", spot=point.spot,
                       bulk=point.section)  # fmt: skip
    for i, each in enumerate(line.scrapers, start=1):
        force = factors.cleaner * each.count * each.width
        yield Force("Tbc", f"Tbc, cleaner {i} (x{each.count})", "special", force, f"{_BOOK}, Tbc",
                    spot=line.places.behind("head", None), place="head", assumed=each.assumed)  # fmt: skip
    for i, plough in enumerate(line.ploughs, start=1):
        force = factors.plough * plough.count * plough.width
        yield Force("Tpl", f"Tpl, plough {i} (x{plough.count})", "special", force, f"{_BOOK}, Tpl", spot=plough.spot,
                    place=plough.place)  # fmt: skip
    yield from _pulley_forces(line, factors)
    landing = line.loading[0].spot if line.loading else line.places.landing(None)
    if factors.accessories > 0.0:
        yield Force("Tac", "Tac, other accessories", "special", factors.accessories, f"{_BOOK}, Tac", spot=landing,
                    place=line.places.name(landing))  # fmt: skip


def _pulley_forces(line: Line, factors: CemaFactors) -> Iterator[Force]:
    """Tp of every pulley that is not driven; a given sum stands at the tail."""
    if factors.pulleys is not None:
        tail = line.places.before("tail", None)
        yield Force("Tp", "Tp, pulleys", "secondary", factors.pulleys, f"{_BOOK}, Tp given", spot=tail, place="tail")
        return
    at_tail = all(drive.spot.boundary == line.count for drive in line.drives)
    for pulley in line.pulleys:
        if not pulley.driven:
            force = cema_pulley_friction([cema_pulley_place(pulley, driven_at_tail=at_tail)])
            yield Force("Tp", f"Tp, {pulley.name}", "secondary", force, f"{_BOOK}, Tp", spot=pulley.spot,
                        place=pulley.place, assumed=pulley.assumed)  # fmt: skip


def cema_pulley_place(pulley: BendPulley, *, driven_at_tail: bool) -> Place:
    """CEMA place of a pulley; tight side: head and carry strand, slack side: the rest.

    Where all drives stand at the tail, the return strand and what stands before them are of the tight side, too.
    """
    if pulley.wrap_angle < _LEAST_WRAP:
        return "other"
    tight = {"head", "carry", "return", "tail"} if driven_at_tail else {"head", "carry"}
    return "tight" if pulley.position in tight else "slack"
