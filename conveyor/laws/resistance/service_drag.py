"""Drag of a roll in service by its size alone: usual bearings, grease and seals.

Sources: Palmgren (moments of a bearing, see `roll_bearing`); boundary dimensions of ISO 15, static ratings as makers
list them. Which bearing, grease and seal is usual, and how they cool, is general knowledge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require, require_positive
from conveyor.errors import ConveyorError, MessageQuantity
from conveyor.laws.resistance.resistance_defaults import Default, Site
from conveyor.laws.resistance.rim_drag import bearing_roll_drag, roll_rotation
from conveyor.laws.resistance.roll_bearing import (
    BEARING_F0,
    BEARING_F1_EXPONENT,
    BEARING_F1_FACTOR,
    PALMGREN_FED,
    PALMGREN_SLOW,
    PALMGREN_SWITCH,
    PER_MINUTE,
    WALTHER_OFFSET,
    oil_viscosity,
    walther_constants,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Bearing:
    """A deep-groove ball bearing.

    Parameters
    ----------
    name : str
        As in the trade.
    bore, outside : float
        Diameters [m].
    static_rating : float
        C0 [N].
    """

    name: str
    bore: float
    outside: float
    static_rating: float

    @property
    def mean_diameter(self) -> float:
        """Mean of bore and outside diameter [m]."""
        return 0.5 * (self.bore + self.outside)


USUAL_BEARINGS: Final = (
    (0.051, Bearing("6201", 0.012, 0.032, 3.1e3)),
    (0.076, Bearing("6203", 0.017, 0.040, 4.75e3)),
    (0.108, Bearing("6204", 0.020, 0.047, 6.55e3)),
    (0.133, Bearing("6205", 0.025, 0.052, 7.8e3)),
    (0.159, Bearing("6305", 0.025, 0.062, 11.6e3)),
    (0.219, Bearing("6306", 0.030, 0.072, 16.0e3)),
    (math.inf, Bearing("6308", 0.040, 0.090, 24.0e3)),
)
"""Roll diameter up to [m], its bearings; general knowledge."""


def _range_middle(default: Default) -> float:
    return 0.5 * (default.low + default.high)


SERVICE_F0: Final = _range_middle(BEARING_F0)  # [-]
SERVICE_F1_FACTOR: Final = _range_middle(BEARING_F1_FACTOR)  # [-]
USUAL_OIL: Final = ((313.15, 100e-6), (373.15, 11e-6))  # base oil ISO VG 100: [K], [m²/s]; general knowledge
SEAL_STRESS: Final = Default(
    500.0, 250.0, 750.0,
    "grease in a labyrinth; a 159 mm roll then drags its acceptance limit of 2.45 N in the acceptance test", True,
)  # [Pa]  # fmt: skip
SEAL_LENGTH: Final = 0.020  # [m], of the filled gap; only its product with the stress counts
AIR_FILM: Final = Default(25.0, 15.0, 40.0, "heat to the air from a surface at some m/s", True)  # [W/(m² K)]
SHELL_CONDUCTANCE: Final = 50.0 * 0.004  # [W/K], steel 50 W/(m K) of 4 mm; general knowledge
SERVICE_DRAG: Final = Default(
    1.0,
    0.5,
    1.5,
    "drag over the central one: f0, z and the stress in the seal all at the ends of their ranges",
    True,
)  # [-]
ROLL_CONDITION: Final[dict[Site, Default]] = {
    "overland": Default(1.0, 1.0, 1.0, "rolls in order, replaced by their noise", True),
    "plant": Default(
        1.2, 1.0, 1.7,
        "CEMA 5, Ai of 4, 5 and 6 in rolls (2.3, 1.8, 1.5 lbf a set) over the drag of rolls in order, mean", True,
    ),
    "poor": Default(2.0, 1.5, 3.0, "wet, dirty or worn bearings, build-up on the rolls", True),
}  # fmt: skip
"""Drag of rolls in service over that of rolls in order [-], by site."""
_STEP_TOLERANCE: Final = 1e-10  # [K]
_UNIT_SPEED: Final = 1.0  # [m/s], at which a bearing's film is scaled; Palmgren's moment is proportional to it anywhere


@dataclass(frozen=True, eq=False)
class ServiceDrag:
    """Drag of rolls in service, in the shape of their loads.

    Parameters
    ----------
    force : ndarray
        At the rim [N].
    bearing_temperature : ndarray
        Of the running bearings [K].
    """

    force: Array
    bearing_temperature: Array


def usual_bearing(roll_diameter: float) -> Bearing:
    """Usual bearing of a roll by its diameter.

    Parameters
    ----------
    roll_diameter : float
        D [m], more than the smallest bearing's outside diameter.

    Returns
    -------
    Bearing
        Of `USUAL_BEARINGS`.

    Raises
    ------
    InputError
        No bearing of the table fits.

    Examples
    --------
    >>> usual_bearing(0.133).name, usual_bearing(0.159).name, usual_bearing(0.245).name
    ('6205', '6305', '6308')
    """
    smallest = USUAL_BEARINGS[0][1].outside
    diameter, least = (
        MessageQuantity(roll_diameter, "thickness", f"{roll_diameter!r}"),
        MessageQuantity(smallest, "thickness", f"{smallest:g} m"),
    )
    allowed = ConveyorError("> {}; give the roll's drag", least)
    require(smallest < roll_diameter < math.inf, "roll_diameter", diameter, allowed)
    return next(bearing for largest, bearing in USUAL_BEARINGS if roll_diameter <= largest)


def roll_end_cooling(roll_diameter: float, *, roll_length: float) -> float:
    """Heat conductance from one end of a roll to the air, h π D [l tanh(L/(2 l)) + D/4], l² = k s/h (derived).

    Parameters
    ----------
    roll_diameter : float
        D [m], positive.
    roll_length : float
        L of the shell [m], positive.

    Returns
    -------
    float
        Conductance of one end [W/K]: the disc, and half the shell as a fin of steel.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(roll_end_cooling(0.159, roll_length=0.465), 2)
    1.6
    """
    require_positive(roll_diameter=roll_diameter, roll_length=roll_length)
    film = AIR_FILM.value
    reach = math.sqrt(SHELL_CONDUCTANCE / film)
    fin = reach * math.tanh(roll_length / (2.0 * reach))
    return film * math.pi * roll_diameter * (fin + roll_diameter / 4.0)


def service_roll_drag(
    roll_load: ArrayLike,
    *,
    belt_speed: ArrayLike,
    roll_diameter: float,
    roll_length: float,
    air_temperature: ArrayLike,
) -> ServiceDrag:
    """Drag of rolls in service with usual bearings, grease and labyrinth seals that warm themselves (Palmgren).

    Parameters
    ----------
    roll_load : array_like
        P of each roll, radial, of both bearings together [N], at least 0.
    belt_speed : array_like
        v [m/s], positive; one, or one of each roll.
    roll_diameter : float
        D [m], see `usual_bearing`.
    roll_length : float
        L of the shell [m], positive.
    air_temperature : array_like
        Around the rolls [K], positive; one, or one of each roll.

    Returns
    -------
    ServiceDrag
        Drag at the rim, temperature of the bearings.

    Raises
    ------
    InputError
        An argument is outside its range, or the usual grease is solid in that air.

    Notes
    -----
    f0 and z are in the middle of Palmgren's ranges for greased ball bearings; a seal has the moment 2 π r² b τ of a
    shear stress τ in its grease at the bearing's outside radius r, whatever the speed. The bearing's temperature is
    where its friction heats as much as the roll's end cools, M ω = G (T - T_air): a few kelvin in summer, 12 K at
    -20 degC, where the drag is then three times, not thirty times, that at 20 degC. `SERVICE_DRAG` is its band.
    Worn, wet or misaligned rolls are not in it.

    Examples
    --------
    >>> drag = service_roll_drag(250.0, belt_speed=5.41, roll_diameter=0.159, roll_length=0.465, air_temperature=293.15)
    >>> round(float(drag.force), 1), round(float(drag.bearing_temperature) - 293.15, 1)
    (2.4, 4.0)
    """
    given = (np.asarray(one, dtype=float) for one in (roll_load, belt_speed, air_temperature))
    load, speed, air = np.broadcast_arrays(*given)
    borne = bool(np.all((load >= 0.0) & (load < math.inf)))
    require(borne, "roll_load", roll_load, ">= 0 and finite")
    (cool, thick), (warm, thin) = USUAL_OIL
    for v in np.unique(speed).tolist():
        require_positive(belt_speed=v)
    for at in np.unique(air).tolist():
        require_positive(air_temperature=at)
        oil_viscosity(at, first_temperature=cool, first_viscosity=thick, second_temperature=warm, second_viscosity=thin)
    bearing, cooling = usual_bearing(roll_diameter), roll_end_cooling(roll_diameter, roll_length=roll_length)
    seal = SEAL_STRESS.value * 2.0 * math.pi * (bearing.outside / 2.0) ** 2 * SEAL_LENGTH
    unit = bearing_roll_drag(
        1.0,
        belt_speed=_UNIT_SPEED,
        roll_diameter=roll_diameter,
        mean_diameter=bearing.mean_diameter,
        viscosity=thick,
        static_rating=bearing.static_rating,
        f0=SERVICE_F0,
        f1_factor=SERVICE_F1_FACTOR,
        f1_exponent=BEARING_F1_EXPONENT.value,
        seal_moment=seal,
    )
    rest = unit.seals + unit.load * load ** (1.0 + BEARING_F1_EXPONENT.value)
    turn, slope = walther_constants(cool, thick, warm, thin)

    def film(temperature: Array, speed: Array) -> tuple[Array, Array]:
        """Palmgren's f(ν n) of the oil at temperatures and speeds, and its slope [1/K]."""
        turns = speed * (PER_MINUTE * roll_rotation(1.0, roll_diameter=roll_diameter))
        log_z = np.exp(turn - slope * np.log(temperature))
        z = 10.0**log_z
        fed = (z - WALTHER_OFFSET) * turns >= PALMGREN_SWITCH
        fed_film = PALMGREN_FED * ((z - WALTHER_OFFSET) * turns) ** (2.0 / 3.0)
        falls = -2.0 / 3.0 * fed_film * z * math.log(10.0) * log_z * slope / ((z - WALTHER_OFFSET) * temperature)
        return np.where(fed, fed_film, PALMGREN_SLOW), np.where(fed, falls, 0.0)

    # F v = 2 G (T - T_air), by Newton's steps within a bracket that shrinks: friction falls as the oil warms
    scale = unit.no_load / float(film(np.asarray(cool), np.asarray(_UNIT_SPEED))[0])
    cooled = 2.0 * cooling / speed
    low, high = air, air + (rest + scale * film(air, speed)[0]) / cooled
    place, step = low, math.inf
    while step > _STEP_TOLERANCE:
        viscous, falls = film(place, speed)
        surplus = rest + scale * viscous - cooled * (place - air)
        low, high = np.where(surplus >= 0.0, place, low), np.where(surplus > 0.0, high, place)
        newton = place - surplus / (scale * falls - cooled)
        following = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        step, place = float(np.max(np.abs(following - place), initial=0.0)), following
    return ServiceDrag(rest + scale * film(place, speed)[0], place)
