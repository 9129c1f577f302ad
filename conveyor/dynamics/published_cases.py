"""Published and measured starts and stops, recalculated with the bare wave equation.

Sources: A. Harrison, Criteria for minimising transient stress in conveyor belts, Beltcon 2 (1983), and Reducing dynamic
loads in belts powered by three wound-rotor motors, Beltcon 3 (1985); L. K. Nordell and Z. P. Ciozda, Transient belt
stresses during starting and stopping, Bulk Solids Handling 4 (1984) 93; G. Lodewijks, Dynamics of belt systems, PhD
thesis, Delft (1996), chapter 8. Figures as read and converted in the open repository daniel-gonzalezm/beltloop
(maps/cases.py, validation/), whose readings of the printed charts are taken over; the papers themselves were not read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import SPEED_POINTS, Chain, InitialState, Machines, Record
from conveyor.dynamics.wave import simulate_belts
from conveyor.laws.waves import ramp_speed, wave_speed

Array = NDArray[np.float64]

_FOOT: Final = 0.3048  # [m]
_STIFF: Final = 1e12  # of a drive that leads its speed [N s/m]


@dataclass(frozen=True)
class EvenLoop:
    """A level loop of uniform strands, from behind its take-up round to the drive next to it.

    Attributes
    ----------
    strands : tuple of (float, float, float)
        Length [m], line mass [kg/m] and running resistance [N] of each, in belt order.
    stiffness : float
        EA [N].
    held, carriage : float
        Tension of the take-up [N]; its mass over the square of its strands [kg].
    speed : float
        Speed of the given resistances [m/s].
    rising : float
        Share of them proportional to the speed; the rest is dry [-].
    drive : float or None
        Distance of the drive [m]; by default right before the take-up.
    """

    strands: tuple[tuple[float, float, float], ...]
    stiffness: float
    held: float
    carriage: float
    speed: float
    rising: float = 1.0
    drive: float | None = None

    def followed(self, times: float, led: Array, step: float) -> tuple[Record, Array]:
        """Simulate it with the drive speed prescribed over time; also returns the positions of its masses [m]."""
        at, lying = np.zeros(1), np.zeros((2, 1))
        for length, line_mass, newtons in self.strands:
            cells = max(1, round(length / wave_speed(self.stiffness, line_mass=line_mass) / step))
            at = np.append(at, at[-1] + length * np.arange(1, cells + 1) / cells)
            part = np.outer([length * line_mass, newtons], np.ones(cells + 1)) / cells
            part[:, [0, -1]] *= 0.5
            lying = np.hstack([lying[:, :-1], lying[:, -1:] + part[:, :1], part[:, 1:]])
        n, (mass, friction) = at.size - 1, lying
        friction[[0, -1]] = 0.0
        node = n if self.drive is None else int(np.argmin(np.abs(at - self.drive)))
        chain = Chain(
            mass=mass[None], stiffness=self.stiffness / np.diff(at)[None], retardation=0.0,
            weight=np.zeros((1, n + 1)),
            friction=np.stack([
                (1.0 - self.rising) * friction[None],
                self.rising / self.speed * friction[None],
                np.zeros((1, n + 1)),
            ]),
            sticking=(1.0 - self.rising) * friction[None], end=np.array([n]), nodes=np.array([[node]]),
            before=(1.0 if node == n else 0.5) * np.array([  # the belt is uniform at the drive
                mass[node], 0.0, (1.0 - self.rising) * friction[node], self.rising / self.speed * friction[node], 0.0,
                (1.0 - self.rising) * friction[node],
            ])[:, None, None],
            lumps=np.zeros((1, 0), int),
            rim=np.ones((1, 1)), grip=np.full((1, 1), 1e12), backstop=np.zeros((1, 1), bool),
            held=np.array([self.held]), carriage=np.array([self.carriage]), winch=np.zeros((3, 1)),
            sag=np.zeros((1, n)),
        )  # fmt: skip
        step = 0.95 * chain.longest_step
        steps = round(times / step)
        given = np.interp(step * np.arange(steps), np.linspace(0.0, times, led.size), led)
        machines = Machines(
            np.full((1, 1), _STIFF), given[:, None, None], np.ones((steps, 1, 1)), np.zeros((steps, 1, 1)),
            np.full((1, 1, SPEED_POINTS), _STIFF), 1.0, np.zeros((1, 1)),
        )  # fmt: skip
        begin = float(led[0])
        start = InitialState(
            np.full((1, n + 1), begin), self.held + np.cumsum(friction * begin / self.speed)[None, :-1],
            friction[None] * begin / self.speed, np.zeros((1, 1)), np.full((1, 1), begin),
        )  # fmt: skip
        return simulate_belts(chain, machines, start, step=step, samples=steps), at


def lodewijks_start(shape: str, rising: float = 0.5) -> float:
    """Peak strain of Lodewijks' loaded 1 km conveyor in a start of 30 s to 5.11 m/s (1996, table 8.7) [-].

    How his resistances rise with speed is unknown: all or none rising makes the peak 12 to 16 % smaller or larger.
    """
    stiffness, speed, time = 340.917e6 * 0.01236, 5.11, 30.0
    loop = EvenLoop(
        ((1000.0, 14.28 + 6.95, 4.23e3), (1000.0, 14.28 + 13.38 + 133.54, 31.32e3)), stiffness, 21.33e3, 4350.0 / 4.0,
        speed, rising,
    )  # fmt: skip
    at = np.linspace(0.0, 50.0, 1001)
    tensions, _ = loop.followed(50.0, speed * ramp_speed(at / time, shape=shape), 0.16)
    return float(tensions.highest.max()) / stiffness


@dataclass(frozen=True)
class HarrisonStart:
    """Harrison's empty 5.1 km belt: return belt at rest until [s], carriage travel at 7 s [m], slow period [s]."""

    still: float
    carriage: float
    period: float


def harrison_start() -> HarrisonStart:
    """Start of Harrison's belt to its first plateau, 1.6 m/s in 4 s (1983, 1985): 20 t on 4 strands, 2L/c 7.03 s."""
    length, mass = 5100.0, 79.0
    loop = EvenLoop(((2.0 * length, mass, 0.0),), mass * 1450.0**2, 49e3, 20e3 / 16.0, 1.0)
    whole = 170.0
    at = np.linspace(0.0, whole, 17001)
    tensions, _ = loop.followed(whole, 1.6 * ramp_speed(at / 4.0, shape="cosine"), 0.1)
    behind = np.abs(tensions.speeds[:, 0, 0])
    belt, times = tensions.take_up["belt"][:, 0], tensions.step * np.arange(len(tensions.take_up["belt"]))
    after = times > 10.0
    swing = (belt[after] - belt[after].mean()) * np.hanning(int(after.sum()))
    periods = np.linspace(20.0, 40.0, 401)
    power = [abs(swing @ np.exp(-2j * np.pi * times[after] / period)) for period in periods]
    return HarrisonStart(
        float(tensions.times[int(np.argmax(behind > 0.05 * 1.6)), 0]),
        abs(float(np.interp(7.0, times, belt))) / 4.0,
        float(periods[int(np.argmax(power))]),
    )


def nordell_ciozda_stop() -> tuple[float, float]:
    """Arrival of a stop's wave front above the drive and behind the take-up (1984, case 1; their wave speeds) [s]."""
    back, carry, stiffness, speed = 1450.0, 590.0, 1e8, 1.0
    light, heavy = stiffness / back**2, stiffness / carry**2
    feet = ((2700.0, light), (8150.0, heavy), (5150.0, light), (300.0, light))
    loop = EvenLoop(
        tuple((_FOOT * length, mass, 0.0) for length, mass in feet), stiffness, 1e6, 0.0, speed,
        drive=_FOOT * (2700.0 + 8150.0 + 5150.0),
    )  # fmt: skip
    tensions, at = loop.followed(8.0, np.array([1.0, *np.zeros(800)]), 0.02)
    slower = tensions.speeds[:, 0] < 0.97

    def arrival(place: float) -> float:
        i = int(np.argmin(np.abs(at - place)))
        return float(tensions.times[int(np.argmax(slower[:, i])), 0])

    return arrival(_FOOT * (2700.0 + 3000.0)), arrival(0.0)
