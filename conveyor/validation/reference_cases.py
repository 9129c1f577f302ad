"""Checks of the package against independent figures, for `conveyor validate`.

`run_reference_checks` returns one `ReferenceCheck` for each figure. The tests check the same sources in more depth.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from conveyor.dynamics.published_cases import harrison_start, lodewijks_start, nordell_ciozda_stop
from conveyor.laws import (
    discharge,
    drives,
    feeder,
    horizontal_curve,
    loading,
    power,
    pulley,
    resistance,
    roll_life,
    take_up,
    tension,
    transfer,
    transition,
    waves,
)
from conveyor.laws.belt_strength import belt_safety
from conveyor.sizing.spacing import SectionSpacing
from conveyor.validation.contact_cases import (
    IDENTITY_TOLERANCE,
    compliance_identity,
    contact_program,
    hunter_contacts,
    reference_contacts,
    split_contacts,
)
from conveyor.validation.reference_check import ReferenceCheck, printed_check, relative_check

_ISO = "ISO 5048 worked example"


_HELIX = "Helix shaft report"


_HELIX_PRINTED = "Helix delta-T reports"


_HELIX_FEEDER = "Helix feeder load calculation"


_SHORTT = "Shortt (2019), idler of 127 mm, bearings 6305"


_NEMA = "NEMA MG 10, table 2-3"


_TRANSITION = "ISO 5293:2004"


_CURVE = "Grimmer, Kessler (1987), by eytelwein 0.1.9"


_FLAT = "course of a flat belt, set by set"


_POLYGON = "polygon of five rolls"


_CATENARY = "catenary between the sets"


_SPACING_COST = "least cost of the sets, by search"


_LEMMON = "Lemmon (2013), finite elements"


_CEMA_TRANSITION = "CEMA, transition"


_SECTION = "ISO 5048, cross-section"


_SIDEWINDER = "Conveyor C-1.1 report"


_CKIT = "ckit.co.za, trajectories"


_RULMECA = "Rulmeca, impact rollers"


_SANDVIK = "Sandvik (1999), load of idlers"


_SONG = "Song et al. (2012)"


_NORDELL = "Nordell and Ciozda (1984), measured"


_HARRISON = "Harrison (1983, 1985), measured"


_LODEWIJKS = "Lodewijks (1996), finite elements"


_CURVE_TOLERANCE = 1e-9  # ten digits given


def run_reference_checks() -> list[ReferenceCheck]:
    """Compare this package with every figure it ships: contacts, closed forms, published values, identities.

    Returns
    -------
    list of ReferenceCheck
        In the order: reference contacts, Hunter, CONTACT, ISO 5048, pulley shaft, roll, take-up, motor,
        transition, printed designs, transfer, horizontal curve, flat sets, five rolls, distances of the sets,
        compliance times modulus, starts and stops.

    Examples
    --------
    >>> all(check.passed for check in run_reference_checks())
    True
    """
    groups = (
        reference_contacts(),
        split_contacts(),
        hunter_contacts(),
        contact_program(),
        iso_5048_example(),
        _pulley_shaft(),
        _idler_roll(),
        _take_up_and_sag(),
        _feeder_loads(),
        _motor_starts(),
        _transition_lengths(),
        _printed_designs(),
        _transfer_figures(),
        _horizontal_curve(),
        _flat_sets(),
        _five_rolls(),
        _distances_of_sets(),
        compliance_identity(),
        _starts_and_stops(),
    )
    return [check for group in groups for check in group]


def iso_5048_example() -> Iterator[ReferenceCheck]:
    """Coal 0.85 t/m³, 2300 t/h, 4.8 m/s, 143 m level, belt 1.2 m, g 9.81 m/s²; itemised."""
    g, speed, flow = 9.81, 4.8, 2300.0 / 3.6
    bulk = loading.bulk_line_mass(flow, belt_speed=speed)
    carry = resistance.roll_line_mass(15.5, spacing=1.2)
    back = resistance.roll_line_mass(13.2, spacing=3.0)
    main = resistance.main_resistance(
        friction_factor=0.02,
        length=143.0,
        carry_roll_mass=carry,
        return_roll_mass=back,
        belt_mass=16.44,
        bulk_mass=bulk,
        inclination=0.0,
        gravity=g,
    )
    acceleration = resistance.acceleration_resistance(flow, belt_speed=speed, initial_speed=0.0)
    zone = resistance.acceleration_length(belt_speed=speed, initial_speed=0.0, belt_friction=0.5, gravity=g)
    chute = {
        "volume_flow": flow / 850.0,
        "bulk_density": 850.0,
        "skirt_distance": 0.75,
        "skirt_friction": 0.7,
        "gravity": g,
    }
    zone_skirt = resistance.acceleration_skirt_resistance(**chute, length=zone, belt_speed=speed, initial_speed=0.0)
    special = resistance.skirt_resistance(**chute, length=4.8, bulk_speed=speed)
    special += resistance.cleaner_resistance(4 * 1.2 * 0.008, pressure=3e4, friction=0.6)
    secondary = acceleration + zone_skirt + 2 * 360.0  # two wraps of 360 N
    total = main + secondary + special
    motor = power.motor_power(power.belt_power(total, belt_speed=speed), efficiency=0.95 * 0.97)
    drive = tension.drive_tensions(total, friction=0.3, wrap_angle=math.pi)
    yield printed_check(_ISO, "bulk m'_bulk [kg/m]", "133.10", bulk)
    yield printed_check(_ISO, "main resistance F_H [N]", "5142.73", main)
    yield printed_check(_ISO, "secondary resistances F_N [N]", "6177.05", secondary)
    yield printed_check(_ISO, "special resistances F_S [N]", "1912.54", special)
    yield printed_check(_ISO, "total F_U [N]", "13232.32", total)
    yield printed_check(_ISO, "motor power [kW]", "68.93", motor / 1e3)
    yield printed_check(_ISO, "tight side of the drive [N]", "21680.28", drive.tight)
    yield printed_check(_ISO, "slack side of the drive [N]", "8447.96", drive.slack)


def _pulley_shaft() -> Iterator[ReferenceCheck]:
    """Tail pulley CV212: 850 mm and 12 mm of lagging, 3200 kg, 180 deg, bearings 2560 and locking elements 1800 mm."""
    weight, start = 3200.0 * 9.81, (167.76e3, 171.76e3)

    def pull(tight: float, slack: float) -> float:
        return float(
            resistance.pulley_load(
                tight_tension=tight, slack_tension=slack, pulley_mass=0.0, gravity=9.81, wrap_angle=math.pi
            )
        )

    # the belt leaves at -2 deg: its tension is 92 deg from straight down
    whole = pulley.pulley_resultant(pull(*start), weight=weight, pull_angle=math.radians(92.0))
    moment = pulley.hub_moment(whole, bearing_centres=2.56, hub_centres=1.8)
    # tensions printed to 0.01 kN: half a unit added
    yield printed_check(_HELIX, "half resultant, run [kN]", "121.45", pull(120.75e3, 122.14e3) / 2e3, units=1.0)
    yield printed_check(_HELIX, "half resultant, start [kN]", "169.76", pull(*start) / 2e3)
    yield printed_check(_HELIX, "bending moment at the hub [kN m]", "64.58", moment / 1e3)
    yield printed_check(_HELIX, "torque [N m]", "1748", 0.5 * (start[1] - start[0]) * 0.874)


def _idler_roll() -> Iterator[ReferenceCheck]:
    """2000 t/h at 3.8 m/s on rolls of 127 mm, both bearings of the middle roll alike."""
    bulk = loading.bulk_line_mass(2000.0 / 3.6, belt_speed=3.8)
    rotation = resistance.roll_rotation(3.8, roll_diameter=0.127)
    # bearing load from its life: L10 ~ load^-3
    hours = roll_life.rating_life_hours(1e3, dynamic_rating=26e3, rotation=rotation)
    load = 2.0 * 1e3 * (hours / 40e3) ** (1.0 / roll_life.BALL_EXPONENT)
    yield printed_check(_SHORTT, "bulk [kg/m]", "146.199", bulk)
    yield printed_check(_SHORTT, "load of the roll that lives 40,000 h [kN]", "4.680", load / 1e3)


def _take_up_and_sag() -> Iterator[ReferenceCheck]:
    """Take-up tension of printed masses, and tension for the sag of belt and bulk; g 9.80665 m/s²."""
    g = 9.80665
    for name, mass, strands, figure in (
        ("Curragh North C3, 13 t", 13e3, 2, "63.74"), ("PC01, 17 t", 17e3, 2, "83.36"), ("BC-01, 2 t", 2e3, 2, "9.81"),
        ("20 t on 4 strands", 20e3, 4, "49.0"), ("46.9 t on 4 strands", 46.9e3, 4, "115"),
    ):  # fmt: skip
        one = take_up.take_up_mass(1.0, reeving=1.0, gravity=g, strands=strands)
        yield printed_check(_HELIX_PRINTED, f"tension of the take-up, {name} [kN]", figure, mass / one / 1e3)
    for name, line_mass, flow, speed, spacing, sag, figure in (
        ("Curragh North C3", 30.0, 2500.0, 7.5, 5.0, 0.02, "37.57"),
        ("PC01", 39.62, 1000.0, 5.2, 1.2, 0.015, "9.12"), ("BC-01", 11.06, 120.0, 1.0, 1.2, 0.015, "4.35"),
    ):  # fmt: skip
        whole = line_mass + loading.bulk_line_mass(flow / 3.6, belt_speed=speed)
        least = tension.sag_tension(whole, spacing=spacing, relative_sag=sag, gravity=g)
        yield printed_check(_HELIX_PRINTED, f"tension for {100 * sag:g} % sag, {name} [kN]", figure, least / 1e3)


def _feeder_loads() -> Iterator[ReferenceCheck]:
    """Slot of 2.05 x 0.35 m under a hopper of 3.5 m and 40 deg, lump coal of 900 kg/m³, 55 and 15 deg, 0.05 m/s."""
    half, inside, wall = (math.radians(angle) for angle in (40.0, 55.0, 15.0))
    outlet = {"density": 900.0, "outlet_length": 2.05, "outlet_width": 0.35, "gravity": 9.81}
    initial = feeder.initial_load_factor(3.5, outlet_width=0.35, half_angle=half)
    load = feeder.hopper_load(initial, **outlet)
    pull = math.sin(inside) * load
    yield printed_check(_HELIX_FEEDER, "surcharge factor after filling", "5.36", initial)
    yield printed_check(_HELIX_FEEDER, "vertical load after filling [kN]", "11.89", load / 1e3)
    yield printed_check(_HELIX_FEEDER, "pull-out force after filling [kN]", "9.74", pull / 1e3)
    yield printed_check(_HELIX_FEEDER, "pull-out power after filling [kW]", "0.49", 0.05 * pull / 1e3)
    flow = feeder.flow_load_factor(half, internal_friction=inside, wall_friction=wall)
    undivided = 4.0 * math.tan(half) * feeder.hopper_load(flow, **outlet)
    yield printed_check(_HELIX_FEEDER, "vertical load in flow, times 4 tan α [kN]", "2.12", undivided / 1e3)


def _motor_starts() -> Iterator[ReferenceCheck]:
    """25 hp, 4 poles, load Wk² 50 lb ft², as the EASA handbook works it out."""
    load = 50.0 * 0.45359237 * 0.3048**2
    starts = drives.allowed_starts(25.0 * drives.HORSEPOWER, poles=4, load_inertia=load)
    yield printed_check(_NEMA, "starts an hour, 25 hp, 4 poles, 50 lb ft²", "2.44", starts)


def _transition_lengths() -> Iterator[ReferenceCheck]:
    """The standard's formula where the pulley is level with the middle roll; a belt of 1600 mm by finite elements."""
    wing, lam, stiffness, induced = 0.4, math.radians(35.0), 72e6, 40e3
    zone = transition.transition_stretch(1.2, middle_roll_length=0.4, trough_angle=lam, pulley_height=0.0)
    # M, ΔT: induced in the edge against the middle
    expected = wing * math.sqrt(stiffness / induced * (1.0 - math.cos(lam)))
    got = math.sqrt(stiffness * (zone.edge - zone.middle) / induced)
    yield relative_check(_TRANSITION, "length [m], 1.2 m, 35 deg, ΔT 40 N/mm", expected, got, IDENTITY_TOLERANCE)
    for depth in (1.0, 0.5):  # of the trough, from the pulley to its edge: z = h, z = h/2
        zone = transition.transition_stretch(1.2, middle_roll_length=0.4, trough_angle=lam, pulley_height=1.0 - depth)
        raised = (1.0 - depth) * wing * math.sin(lam)
        expected = math.sqrt(0.5 * stiffness / induced) * math.hypot(
            wing * (1.0 - math.cos(lam)), depth * wing * math.sin(lam)
        )
        # the middle rises to the pulley, too: lifts are measured from it
        edge = zone.edge - zone.middle + 0.5 * raised**2
        got = math.sqrt(stiffness * edge / induced)
        name = f"length [m], 1.2 m, 35 deg, pulley at {depth:g} of the trough"
        yield relative_check(_CEMA_TRANSITION, name, expected, got, IDENTITY_TOLERANCE)
    # ST2500 by its safety of 5.79 at 432 N/mm, 72 times that as stiffness, rolls of 600 mm at 45 deg by the 8 widths
    # of CEMA; none of them printed, so that a hundredth is allowed
    mean, stiff, length = 600e3 / 1.6, 72.0 * 2.5e6, 13.0
    strips = transition.transition_stretch(
        1.6, middle_roll_length=0.6, trough_angle=math.radians(45.0), pulley_height=0.0
    )
    for where, printed, stretch in (("edge", 433.0, strips.edge), ("middle", 357.0, strips.middle)):
        here = (mean + stiff * stretch / length**2) / 1e3
        yield relative_check(_LEMMON, f"tension of the {where} [N/mm]", printed, here, 0.01)


def _printed_designs() -> Iterator[ReferenceCheck]:
    """Figures of cross-section, power and belt that other programs and examples print."""
    section = loading.cross_section(
        1.03, middle_roll_length=0.436, trough_angle=math.radians(45.0), surcharge_angle=math.radians(20.0)
    )
    yield printed_check(_SECTION, "heap above the water line [m²]", "0.0445", section.top)
    yield printed_check(_SECTION, "below the water line [m²]", "0.1357", section.bottom)
    for name, force, speed, printed in (
        ("Curragh", 506.64, 7.5, 3799.82),
        ("PC01", 297.71, 5.2, 1548.12),
        ("BC-01", 11.07, 1.0, 11.07),
    ):
        # half a unit of the printed tension
        got = power.belt_power(1e3 * force, belt_speed=speed) / 1e3
        yield relative_check(
            _HELIX_PRINTED, f"power at the belt [kW], {name}", printed, got, 0.005 / force + 0.005 / printed
        )
    bulk = loading.bulk_line_mass(2125.0 / 3.6, belt_speed=3.58)
    # its speed has three digits
    yield relative_check(_SIDEWINDER, "bulk on the belt [kg/m]", 165.0, bulk, 0.005 / 3.58 + 0.05 / 165.0)
    for state, force, printed in (("running", 88.3, 16.98), ("momentary", 127.0, 11.83)):
        got = belt_safety(1e3 * force, nominal_strength=1250e3, belt_width=1.2)
        digit = 0.05 if force < 100.0 else 0.5
        yield relative_check(
            _SIDEWINDER, f"safety of the belt [-], {state}", printed, got, digit / force + 0.005 / printed
        )


def _transfer_figures() -> Iterator[ReferenceCheck]:
    """Width of the bulk on the head pulley, loads of idlers, and the impact of a stream."""
    for width, printed in (
        (350, "265.5"), (400, "310"), (450, "354.5"), (500, "400"), (600, "500"), (1200, "1100"), (2100, "2000"),
    ):  # fmt: skip
        got = 1e3 * discharge.width_on_pulley(width / 1e3)
        yield printed_check(_CKIT, f"width of the bulk on the pulley [mm], belt {width} mm", printed, got)
    set_load = (loading.bulk_line_mass(1300.0 / 3.6, belt_speed=2.2) + 20.0) * 1.2 * 10.0
    yield printed_check(_SANDVIK, "load of a set [N]", "2210", set_load)
    # a belt of 1400 mm on rolls of 530 mm; 1.2 for lumps is theirs, their share of the middle has two digits
    share, _ = loading.shares_by_area(
        loading.usable_width(1.4), middle_roll_length=0.53, trough_angle=math.radians(45.0),
        surcharge_angle=math.radians(30.0),
    )  # fmt: skip
    yield relative_check(_SANDVIK, "load of the middle roll [N]", 1856.0, 1.2 * share * set_load, 0.005 / 0.70)
    stream = transfer.stream_impact(1.0 / 3.6, drop_height=1.0, gravity=9.81)
    yield printed_check(_RULMECA, "t/h √m over the impact [1/kgf]", "8", 9.81 / stream)


def _horizontal_curve() -> Iterator[ReferenceCheck]:
    """Empty belt of 0.8 m that has drifted inside by 60 mm: 156.71475 N a set, 30 deg, banked by 1.46 deg."""
    weight, wing, middle = 156.71475, 0.2425, 0.315
    angles = {"trough_angle": math.radians(30.0), "banking_angle": math.radians(1.46)}
    centred = [loading.RollLoad("", 0.0, weight * width / 0.8, width, "uniform") for width in (wing, middle, wing)]
    drifted = horizontal_curve.drifted_loads(centred, 0.06, roll_length=middle)
    for name, width, load in zip(("inside", "middle", "outside"), (0.3025, 0.315, 0.1825), drifted, strict=True):
        yield relative_check(_CURVE, f"belt on the {name} roll [m]", width, load.length, IDENTITY_TOLERANCE)
    bare = horizontal_curve.outward_force_factors((0.0, 0.0, 0.0), **angles)
    factors = (1.1, 0.9, 1.1)  # load factors of the wings and of the middle, Part II
    weights = [k * load.force * push for k, load, push in zip(factors, drifted, bare, strict=True)]
    for name, printed, got in zip(
        ("inside", "middle", "outside"),
        (34.0194976531535, 1.41499913142688, -18.7886810270471),
        weights,
        strict=True,
    ):
        yield relative_check(_CURVE, f"weight outward on the {name} roll [N]", printed, got, _CURVE_TOLERANCE)
    yield relative_check(_CURVE, "weight outward, set [N]", 16.6458157575333, math.fsum(weights), _CURVE_TOLERANCE)
    guided = horizontal_curve.outward_force_factors((0.0, 0.70 * 0.279588668362082, 0.0), **angles)
    force = horizontal_curve.outward_force(drifted, guided) - horizontal_curve.outward_force(drifted, bare)
    yield relative_check(_CURVE, "friction outward of the middle roll [N]", 16.77059015, force, _CURVE_TOLERANCE)


def _flat_sets() -> Iterator[ReferenceCheck]:
    """Return belt of 60 kN on flat sets of 918 N, 3 m apart, banked by 4.5 deg: 600 m of a curve of 2300 m.

    At each set the belt turns by what the set pushes outward, over the tension; the way back to the straight behind it
    ends the curve, from which the course is calculated.
    """
    tension_, weight, apart, radius, length = 60e3, 918.0, 3.0, 2300.0, 600.0
    banking, friction, full = math.radians(4.5), 0.35, math.radians(3.0)
    law = horizontal_curve.FlatDrift(
        weight, banking_angle=banking, skew=0.0, friction=friction, full_slip=full, length=length, reach=0.7
    )
    turned, way = 0.0, 0.0
    for _ in range(round(length / apart)):
        guiding = friction * (1.0 - (1.0 - turned / full) ** 3) * math.cos(banking)
        turned -= weight * (math.sin(banking) + guiding) / tension_ - apart / radius
        way += turned * apart
    drift = law.drift(tension_ * apart / radius)
    slope = 3.0 * friction / full * (1.0 - turned / full) ** 2 * math.cos(banking)
    settles = tension_ * apart / (weight * slope)  # length over which the course turns back [m]
    expected, got = 1e3 * turned, 1e3 * drift / length
    yield relative_check(_FLAT, "drift per metre inside the curve [mm]", expected, got, _CURVE_TOLERANCE)
    yield relative_check(_FLAT, "drift at the end of the curve [m]", way, drift, settles / (length - settles))


def _five_rolls() -> Iterator[ReferenceCheck]:
    """Rolls of 360 mm at 25 and 55 deg: 1.35 m of belt under bulk; an empty belt of 1.6 m drifted inside by 0.1 m."""
    roll, angles = 0.36, (math.radians(25.0), math.radians(55.0))
    inner = loading.Wing(roll, angles[0])

    def point(along: float) -> tuple[float, float]:
        """Across and up, of the polygon at a length from its middle."""
        flat, first = min(along, 0.5 * roll), min(max(along - 0.5 * roll, 0.0), roll)
        last = max(along - 1.5 * roll, 0.0)
        across = flat + first * math.cos(angles[0]) + last * math.cos(angles[1])
        return across, first * math.sin(angles[0]) + last * math.sin(angles[1])

    corners = [point(0.5 * roll), point(1.5 * roll), point(0.675)]
    around = [(-x, y) for x, y in reversed(corners)] + corners
    pairs = zip(around, around[1:] + around[:1], strict=True)
    expected = 0.5 * math.fsum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs)
    section = loading.cross_section(
        1.35, middle_roll_length=roll, trough_angle=angles[1], surcharge_angle=0.0, inner_wing=inner
    )
    yield relative_check(
        _POLYGON, "below the water line, five rolls [m²]", expected, section.bottom, IDENTITY_TOLERANCE
    )
    # without friction the force is the slope of the belt's energy: its weight per width times its edges' heights
    weight, expected = 250.0, 250.0 * (point(0.9)[1] - point(0.7)[1])
    half = [
        wing.length
        for wing in loading.wing_pieces(1.6, middle_roll_length=roll, trough_angle=angles[1], inner_wing=inner)
    ]
    belt = [loading.RollLoad("", 0.0, weight * on, on, "uniform") for on in (*reversed(half), roll, *half)]
    pushes = horizontal_curve.outward_force_factors(
        (0.0,) * 5, trough_angle=angles[1], banking_angle=0.0, inner_angle=angles[0]
    )
    got = horizontal_curve.DriftLaw.of(belt, pushes).force(0.1)
    yield relative_check(_POLYGON, "weight outward, set drifted by 0.1 m [N]", expected, got, 10.0 * IDENTITY_TOLERANCE)


def _distances_of_sets() -> Iterator[ReferenceCheck]:
    """Tension for the sag at a set spacing, against a hanging chain; the cheapest spacing of a section."""
    load = 150.0 * 9.81
    for sag in (0.01, 0.02):
        low, high = 0.1, 100.0  # tension of the chain's lowest point over the weight between the sets
        for _ in range(60):
            middle = 0.5 * (low + high)
            hangs = middle * (math.cosh(0.5 / middle) - 1.0)
            low, high = (middle, high) if hangs > sag else (low, middle)
        got = tension.sag_tension(150.0, spacing=3.0, relative_sag=sag, gravity=9.81)
        # next term of the cosh: (8 sag)²/48 of it
        expected, name = low * load * 3.0, f"tension for {100 * sag:g} % sag, 150 kg/m, 3 m [N]"
        yield relative_check(_CATENARY, name, expected, got, 1.01 * 4.0 / 3.0 * sag**2)
    section = SectionSpacing("", "carry", False, 400.0, 2.0, 5.0, 1.0, math.inf, grows=3.0, falls=4.0)
    tried = np.linspace(1.0, 8.0, 7_001)
    best = float(tried[np.argmin([section.cost(a) for a in tried.tolist()])])
    yield relative_check(_SPACING_COST, "cheapest distance [m], 3 a^(1/3) + 4/a", best, section.cheapest, 0.0005 / best)


def _starts_and_stops() -> Iterator[ReferenceCheck]:
    """Published waves; the tolerances are those of reading them and of unpublished data."""
    bulk = 600.0 / 3.6 / 2.5
    speed = waves.wave_speed(104e6, line_mass=27.0 + 11.25 + bulk)
    yield printed_check(_SONG, "wave speed of the loaded strand [m/s]", "995.6", speed)
    for where, measured, got in zip(
        ("above the drive", "at the take-up"), (3.72, 5.86), nordell_ciozda_stop(), strict=True
    ):
        yield relative_check(_NORDELL, f"arrival of the front of a stop {where} [s]", measured, got, 0.015)
    start = harrison_start()
    yield relative_check(_HARRISON, "return belt at rest after the start until [s]", 7.6, start.still, 0.07)
    yield relative_check(_HARRISON, "way of the take-up's carriage at 7 s, about [m]", 2.0, start.carriage, 0.1)
    yield relative_check(_HARRISON, "slow period of the take-up, motors not printed [s]", 24.9, start.period, 0.15)
    for shape, printed in (("linear", 0.0246), ("cosine", 0.0303), ("S", 0.0382)):
        yield relative_check(_LODEWIJKS, f"peak strain, 30 s, {shape} ramp [-]", printed, lodewijks_start(shape), 0.15)
