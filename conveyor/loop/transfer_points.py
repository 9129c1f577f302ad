"""Loading and discharge: impact and skirts, carryback behind cleaners, the trajectory over the head."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.errors import NoSolutionError
from conveyor.laws.discharge import (
    BulkOnPulley,
    FreeFall,
    SlippingDischarge,
    bulk_on_pulley,
    discharge_angle,
    free_fall,
    slipping_discharge,
    width_on_pulley,
)
from conveyor.laws.resistance import cleaner_resistance
from conveyor.laws.transfer import (
    carryback,
    impact_class,
    lump_impact,
    stream_impact,
    usual_skirt_length,
)
from conveyor.line.line import Line
from conveyor.line.transfer_parts import HeadDischarge, LoadingPoint, Scraper


@dataclass(frozen=True)
class LoadingPointDuty:
    """Impact and skirts of a loading point.

    Attributes
    ----------
    point : LoadingPoint
        The loading point.
    acceleration, usual_skirts : float
        Length in which the bulk reaches the belt's speed by ISO 5048 (level), and length of skirtboards by CEMA [m].
    on_slope : float or None
        The first on the belt's slope, at least that of ISO 5048 [m]; None where it is too steep for its friction.
    resting : float
        Weight of belt and bulk on a set there [N].
    stream, lump_force, energy : float or None
        Force of the stream, of the heaviest lump [N], its energy [J]; None where data are missing.
    """

    point: LoadingPoint
    acceleration: float
    usual_skirts: float
    on_slope: float | None
    resting: float
    stream: float | None
    lump_force: float | None
    energy: float | None

    @property
    def load(self) -> float | None:
        """Highest load of a set [N]: resting weight plus the larger of stream and lump impact."""
        return None if self.stream is None else self.resting + max(self.stream, self.lump_force or 0.0)

    @property
    def bed(self) -> str | None:
        """Class of impact bed for the lump."""
        return None if self.energy is None else impact_class(self.energy)


def loading_point_duty(line: Line) -> tuple[LoadingPointDuty, ...]:
    """Impact and skirts of every loading point."""
    return tuple(_point_duty(line, point) for point in line.loading)


def _point_duty(line: Line, point: LoadingPoint) -> LoadingPointDuty:
    stretch, gravity, drop = line.stretches[point.section], line.gravity, point.drop_height
    spacing = point.idler_spacing or stretch.spacing
    stream = lump_force = energy = None
    if drop is not None:
        stream = stream_impact(point.flow, drop_height=drop, gravity=gravity)
        if point.lump_mass is not None:
            energy = point.lump_mass * gravity * drop
            if point.idler_stiffness is not None:
                lump_force = lump_impact(
                    point.lump_mass, drop_height=drop, stiffness=point.idler_stiffness, gravity=gravity
                )
    level = point.acceleration_length(line.speed, gravity)
    try:
        on_slope = max(level, point.acceleration_length(line.speed, gravity, stretch.inclination))
    except NoSolutionError:
        on_slope = None
    return LoadingPointDuty(
        point,
        level,
        usual_skirt_length(line.speed),
        on_slope,
        (stretch.belt_mass + point.flow_beyond / line.speed) * spacing * gravity,
        stream,
        lump_force,
        energy,
    )


@dataclass(frozen=True)
class CleanerDuty:
    """One or more equal cleaners: drag of one [N]; carryback behind the last [kg/m², kg/s], None if unknown."""

    scraper: Scraper
    drag: float
    left: float | None
    lost: float | None


def cleaner_duty(line: Line) -> tuple[CleanerDuty, ...]:
    """Cleaners in running direction, with the carryback behind each."""
    left, made = line.carryback[0], []
    for scraper in line.scrapers:
        drag = cleaner_resistance(scraper.area, pressure=scraper.pressure, friction=scraper.friction)
        lost = None
        if left is not None:
            left = carryback(left, efficiency=scraper.efficiency, count=scraper.count)
            lost = left * scraper.width * line.speed
        made.append(CleanerDuty(scraper, drag, left, lost))
    return tuple(made)


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Trajectory of the bulk over the head pulley.

    Attributes
    ----------
    head : HeadDischarge
        Discharge pulley.
    bulk : BulkOnPulley
        Cross-section of the bulk on the belt there [m].
    belt_radius, radius : float
        Radius of the belt's outside, and of the centre of the bulk [m].
    ratio : float
        V²/(g r) of that centre [-].
    angle, speed : float
        Angle at which it leaves, beyond the top of the pulley [rad], and its speed [m/s].
    fall, lower : FreeFall
        Path of the centre (CEMA), and of the lower edge with slip on the belt (Booth).
    slip : SlippingDischarge
        Slip of that lower edge.
    """

    head: HeadDischarge
    bulk: BulkOnPulley
    belt_radius: float
    radius: float
    ratio: float
    angle: float
    speed: float
    fall: FreeFall
    lower: FreeFall
    slip: SlippingDischarge

    @property
    def wraps(self) -> bool:
        """True if the bulk is carried round part of the pulley."""
        return self.angle != -self.head.slope


def discharge_trajectory(line: Line) -> Trajectory | None:
    """Trajectory of the bulk that reaches the head; None without `discharge` in the spec, or without bulk.

    Notes
    -----
    CEMA, as commonly reproduced: V = v r/R_belt decides and is the speed of bulk that is carried round; bulk that
    leaves at once has the belt's own.
    """
    head, last = line.discharge, line.stretches[line.count - 1]
    if head is None or last.bulk_mass == 0.0:
        return None
    belt_radius, gravity = 0.5 * head.diameter + line.belt.thickness, line.gravity
    bulk = bulk_on_pulley(last.bulk_mass / line.density, width=width_on_pulley(line.belt.width))
    radius = belt_radius + bulk.centroid
    tangential = line.speed * radius / belt_radius
    angle = discharge_angle(tangential, radius=radius, inclination=head.slope, gravity=gravity)
    speed = line.speed if angle == -head.slope else tangential
    slip = slipping_discharge(
        line.speed,
        radius=belt_radius,
        inclination=head.slope,
        friction=head.friction,
        sliding_friction=head.sliding_friction,
        gravity=gravity,
    )
    return Trajectory(
        head,
        bulk,
        belt_radius,
        radius,
        tangential**2 / (gravity * radius),
        angle,
        speed,
        free_fall(angle, speed=speed, radius=radius, drop=head.drop, gravity=gravity),
        free_fall(slip.angle, speed=slip.speed, radius=belt_radius, drop=head.drop, gravity=gravity),
        slip,
    )
