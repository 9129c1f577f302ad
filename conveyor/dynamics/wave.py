"""The wave equation of belts between both ends of a take-up, many in one batch; numbers only.

A belt is cut into cells of equal travel time: springs between masses, friction on the masses. Tensions are taken at
whole steps, speeds between them (leapfrog), so that at a step of one cell travel time a uniform belt without damping is
solved exactly, without numerical damping. The damping T = k (Δu + τ Δu̇) is taken at the mean of old and new speeds:
one tridiagonal system per step, stable at any τ. Friction is a set-valued force: that needed to keep a mass at rest, up
to its limit, so that nothing chatters where the motion reverses. The same holds for the grip of a belt on its driven
pulley, for brakes and for backstops. Distributed friction acts on every mass alone, local friction on the response of
the whole belt: it is constant while the mass there shrinks with its cell. Between the idlers the belt hangs: as its
tension falls the sag takes up belt, so that it softens and never pushes.

Source: derived (Newton, Hooke, Kelvin and Voigt, Maxwell, the shallow parabola); leapfrog, its stability (Courant,
Friedrichs, Lewy 1928) and the projection of friction are textbook numerics.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from conveyor.dynamics.belt_chain import Array, Chain, InitialState, Machines, Record
from conveyor.dynamics.wave_pulleys import (
    DriveGroup,
    GroupResponse,
    solve_pulleys,
    speed_after_friction,
    winch_direction,
)
from conveyor.dynamics.wave_solver import BeltLaw, WaveSolver, add_impulses
from conveyor.errors import NoSolutionError

_BLOCK = 32  # steps between two searches for extremes


@dataclass(eq=False)
class _Extremes:
    """Highest and lowest of values recorded step by step, and their steps."""

    shape: tuple[int, ...]
    block: Array = field(init=False)
    count: int = 0
    first: int = -1  # the initial state is recorded before the first step

    def __post_init__(self) -> None:
        self.block = np.empty((_BLOCK, *self.shape))
        self.high, self.low = np.full(self.shape, -np.inf), np.full(self.shape, np.inf)
        self.high_at, self.low_at = np.zeros(self.shape), np.zeros(self.shape)

    def tell(self, values: Array) -> None:
        self.block[self.count] = values
        self.count += 1
        if self.count == _BLOCK:
            self.look()

    def look(self) -> None:
        if self.count == 0:
            return
        block = self.block[: self.count]
        for extreme, best, at, better in (
            (block.argmax(axis=0), self.high, self.high_at, np.greater),
            (block.argmin(axis=0), self.low, self.low_at, np.less),
        ):
            extremes = np.take_along_axis(block, extreme[None], axis=0)[0]
            new = better(extremes, best)
            best[new] = extremes[new]
            at[new] = (self.first + extreme)[new]
        self.first += self.count
        self.count = 0

    def include_series(self, *place: int, values: Array) -> None:
        """Include a further series of one of them, from the initial state on."""
        for i, best, at, better in (
            (int(values.argmax()), self.high, self.high_at, np.greater),
            (int(values.argmin()), self.low, self.low_at, np.less),
        ):
            if better(values[i], best[place]):
                best[place], at[place] = values[i], i - 1


def simulate_belts(chain: Chain, machines: Machines, start: InitialState, *, step: float, samples: int = 300) -> Record:
    """Simulate belts through time.

    Parameters
    ----------
    chain : Chain
        The belts.
    machines : Machines
        Motors and brakes; they set the number of steps.
    start : InitialState
        Initial speeds, tensions and forces.
    step : float
        Time step [s], at most `chain.longest_step`.
    samples : int
        Approximate number of samples of all tensions.

    Raises
    ------
    NoSolutionError
        The step is too long, or a figure is not finite.
    """
    if step > chain.longest_step * (1.0 + 1e-9):  # rounding of the quotient
        raise NoSolutionError(f"a step of {step:.4g} s is unstable: at most {chain.longest_step:.4g} s")
    return _Motion(chain, machines, start, step, samples).followed()


class _Motion:
    """Belts in motion: the state from step to step, and its record."""

    def __init__(self, chain: Chain, machines: Machines, start: InitialState, step: float, samples: int) -> None:
        self.chain, self.machines, self.dt = chain, machines, step
        self.steps = machines.reference.shape[0]
        self.every = max(1, self.steps // samples)
        self.solver, self.law = WaveSolver(chain, step), BeltLaw(chain, step, start.tension)
        self.solver.update_damping(self.law.eased)
        self.ledger = _EnergyLedger(chain, step, start, self.law)
        self._set_up()
        self._answered()
        s, n = chain.stiffness.shape
        self.speed, self.tension = start.speed, start.tension
        self.stretching = np.diff(start.speed, axis=1)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        self.resisting = start.resisting * self.loose
        self.driving, self.rims = start.driving, start.rims
        self.begun = start.rims
        self.gripping = np.ones(chain.nodes.shape, dtype=bool)
        self.rubbing = start.resisting[self.rows, self.at]
        self.on_pulleys = start.speed[self.rows, self.at]  # exactly 0 at rest, which rounding in the solver would blur
        self.lumps_rest = start.speed[self.rows, chain.lumps] == 0.0
        self.pulled, self.taken, self.winding = chain.held, np.zeros(s), np.zeros(s)
        self.extremes, self.speeds = _Extremes((s, n)), _Extremes((s, n + 1))
        names = ("force", "motor", "rim", "belt", "arriving", "leaving", "holding")
        self.drives = {name: np.zeros((self.steps, *chain.nodes.shape)) for name in names}
        self.take_up = {name: np.zeros((self.steps, s)) for name in ("tension", "belt")}
        self.frictions, self.going = np.zeros((2, self.steps, *chain.nodes.shape))
        self.fastest, self.slowest = np.zeros((s, n + 1)), np.zeros((s, n + 1))
        self.sampled = start.speed
        self.kept: list[tuple[float, Array, Array]] = []

    def _set_up(self) -> None:
        """Set constants: places, compliances, friction at rest."""
        chain, step, n = self.chain, self.dt, self.chain.stiffness.shape[1]
        self.one, self.rows = np.arange(chain.end.size), np.arange(chain.end.size)[:, None]
        self.at = at = chain.nodes
        self.loose = np.ones_like(chain.mass)
        self.loose[self.rows, at] = 0.0  # friction there belongs to the pulley
        alone = self.loose.copy()
        alone[self.rows, chain.lumps] = 0.0
        self.over_mass, self.under_mass = alone * step / chain.mass, alone * chain.mass / step
        self.still = chain.sticking * self.over_mass
        self.lumps = self.rows * (n + 1) + chain.lumps
        self.lumps_loose, self.lumps_stuck = self.loose.take(self.lumps), chain.sticking.take(self.lumps)
        self.winds = bool(np.any(chain.winch[0]))
        self.tau_k = chain.retardation * chain.stiffness
        self.flat = self.rows * (n + 1) + at
        self.turns = [DriveGroup.of(chain, self.machines, step, k) for k in self.solver.pulleys.turns()]

    def _answered(self) -> None:
        """Update the responses of the pulleys after a factorisation."""
        self.half_k = 0.5 * self.tau_k * self.solver.shares
        self.replies = [GroupResponse.of(self.solver, turn, self.dt) for turn in self.turns]

    def followed(self) -> Record:
        """Take every step."""
        rolling = self.chain.resisting(self.speed)
        self.beside = np.empty((2, *self.at.shape))
        for turn in self.turns:
            k, on = turn.drives, self.on_pulleys[:, turn.drives]
            self.beside[:, :, k] = (
                np.where(turn.ends, self.chain.held[:, None], self.tension.take(turn.sides))
                + turn.lying + turn.shares(on, on == 0.0, rolling.take(turn.at)) * self.rubbing[:, k]
            )  # fmt: skip
        beside = self.beside.copy()
        self.extremes.tell(self.tension)
        self.speeds.tell(self.speed)
        for i in range(self.steps):
            self._step(i)
            self._keep(i)
        self.extremes.look()
        self.speeds.look()
        self._at_pulleys(beside)
        slip = self.dt * (self.drives["rim"] - self.drives["belt"])
        self.ledger.drives(self.begun, self.drives, self.frictions, self.going)
        self.ledger.take_up(self.take_up)
        extremes, speeds, kept = self.extremes, self.speeds, self.kept
        if not (np.all(np.isfinite(extremes.high)) and np.all(np.isfinite(self.speed))):
            raise NoSolutionError("the belt's motion has no finite answer: look for extreme inputs")
        return Record(
            self.dt, extremes.high, extremes.low, self._time(extremes.high_at), self._time(extremes.low_at),
            speeds.high, speeds.low, self._time(speeds.high_at), self._time(speeds.low_at),
            np.array([time for time, _, _ in kept]), np.stack([t for _, t, _ in kept]),
            np.stack([v for _, _, v in kept]), self.drives, self.take_up, np.abs(slip).sum(axis=0),
            (slip * self.drives["force"]).sum(axis=0), self.fastest,
            self.slowest, self.ledger.closed(self.speed, self.rims, self.law),
        )  # fmt: skip

    def _time(self, steps: Array) -> Array:
        """Time of a step; 0 for the initial state."""
        return np.asarray(self.dt * np.maximum(steps, 0.0))

    def _step(self, i: int) -> None:
        """Advance speeds by forces, pulleys and friction, then tensions by speeds."""
        chain = self.chain
        if self.winds:
            speed, band, run_up = chain.winch
            wanted, most = (
                speed * winch_direction(self.pulled / chain.held - 1.0, band),
                self.dt * speed / run_up,
            )
            self.winding = np.clip(wanted, self.winding - most, self.winding + most)
        if self.solver.update_damping(self.law.eased):
            self._answered()
        change, lacking = self.solver.change(self.dt * self._acting(), self.speed, self.winding)
        new, rolling = self.speed + change, chain.resisting(self.speed)
        new, lacking, lumped = self._rubbed(new, lacking, rolling)
        if self.at.size:
            new, lacking = self._driven(i, new, lacking, rolling)
        # damping: the solver's share of τ k on half the new speeds, before single masses rub, the rest on the old
        damping = self.viscous + self.half_k * (new[:, 1:] - new[:, :-1] - self.stretching)
        free = new + self.resisting * self.over_mass
        allowed = np.where(self.speed == 0.0, self.still, rolling * self.over_mass)
        rubbed = np.minimum(np.maximum(free, -allowed), allowed)
        new = free - rubbed
        self.resisting = rubbed * self.under_mass
        self.resisting[self.rows, chain.lumps] = lumped
        self.pulled = chain.held - lacking / self.dt
        self.shown, spread = self.tension + damping, self.stretching
        self.stretching = new[:, 1:] - new[:, :-1]
        if self.law.relaxes:
            damping = damping + self.law.branch
        self.ledger.belts(self.speed + new, spread + self.stretching, self.resisting, damping)
        self.speed = new
        self.tension = self.law.stretch(self.stretching)
        self.viscous = self.tau_k * self.law.eased * self.stretching

    def _acting(self) -> Array:
        """Force on every mass, with the last friction and drive forces."""
        acting, strained = -self.chain.weight - self.resisting, self.tension + self.viscous
        acting[:, 1:] -= strained
        acting[:, :-1] += strained
        acting[:, 0] -= self.chain.held  # cancels exactly at rest
        acting[self.one, self.chain.end] += self.chain.held
        acting[self.rows, self.at] += self.driving - self.rubbing
        return acting

    def _driven(self, i: int, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array]:
        """Speeds with new pulley forces, in turn for coupled pulleys, and the impulse lacking at the take-up."""
        record, impulse = self.drives, self.dt * (self.driving - self.rubbing)
        friction, beside = self.frictions[i], np.empty_like(self.beside)
        self.going[i] = self.speed.take(self.flat)
        for turn, reply in zip(self.turns, self.replies, strict=True):
            k, going, rolls = turn.drives, new.take(turn.at), rolling.take(turn.at)
            on = self.on_pulleys[:, k]
            rests = on == 0.0
            faster = new.take(turn.ahead) - new.take(turn.astern) - self.stretching.take(turn.sides)
            cells = self.tension.take(turn.sides) + self.viscous.take(turn.sides) + reply.softer * faster
            tight = (self.chain.held - lacking / self.dt)[:, None]
            moved = solve_pulleys(
                turn, i, step=self.dt, answer=reply.own, reach=reply.reach, rim=self.rims[:, k],
                free=going - reply.own * impulse[:, k],
                sides=np.where(turn.ends, tight, cells) + turn.lying + turn.inert * (going - on)
                - reply.yields * going,
                yields=reply.yields, friction=np.where(rests, turn.stuck, rolls), shares=turn.shares(on, rests, rolls),
                last=(self.driving[:, k], self.beside[:, :, k]), gripped=self.gripping[:, k],
            )  # fmt: skip
            record["force"][i][:, k], record["motor"][i][:, k] = moved.force, moved.motor
            record["rim"][i][:, k], record["belt"][i][:, k] = moved.rim, moved.belt
            record["holding"][i][:, k], beside[:, :, k] = moved.holding, moved.sides
            friction[:, k], self.gripping[:, k] = moved.friction, moved.grips
            change = (moved.belt - going) / reply.own
            new, lacking = add_impulses(change, reply.columns, reply.of_take_up, new, lacking)
        record["arriving"][i], record["leaving"][i] = self.beside = beside
        self.driving, self.rubbing = record["force"][i], friction
        self.rims, self.on_pulleys = record["rim"][i], record["belt"][i]
        return new, lacking

    def _rubbed(self, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array, Array]:
        """Speeds with the lumps' friction, in turn, the impulse lacking at the take-up, and the friction."""
        at, answer = self.lumps, self.solver.lumps
        if not at.size:
            return new, lacking, np.zeros(at.shape)
        earlier, speed = self.resisting.take(at), new.take(at)
        most = self.lumps_loose * np.where(self.lumps_rest, self.lumps_stuck, rolling.take(at))
        over_force, impulse = self.dt * answer.own, np.zeros_like(most)
        free, allowed = over_force * earlier, over_force * most
        for j in range(at.shape[1]):
            left = speed_after_friction(speed[:, j] + free[:, j], allowed[:, j], allowed[:, j])
            self.lumps_rest[:, j] = left == 0.0
            impulse[:, j] = (left - speed[:, j]) / answer.own[:, j]
            speed = speed + impulse[:, j, None] * answer.mutual[:, j]
        return *answer.moved(impulse, new, lacking), earlier - impulse / self.dt

    def _keep(self, i: int) -> None:
        """Record extremes, samples and the take-up."""
        self.extremes.tell(self.shown)
        self.speeds.tell(self.speed)
        self.taken = self.taken + self.dt * (self.speed[self.one, self.chain.end] - self.speed[:, 0])
        self.take_up["tension"][i], self.take_up["belt"][i] = self.pulled, self.taken
        if i % self.every == 0:
            self.kept.append((i * self.dt, self.shown.astype(np.float32), self.speed.astype(np.float32)))
            if i:
                change = (self.speed - self.sampled) / (self.every * self.dt)
                self.fastest, self.slowest = (
                    np.maximum(change, self.fastest),
                    np.minimum(change, self.slowest),
                )
            self.sampled = self.speed

    def _at_pulleys(self, begin: Array) -> None:
        """Extremes of cells that end on driven pulleys, where sudden forces act first."""
        for side, name in enumerate(("arriving", "leaving")):
            values = np.concatenate([begin[side][None], self.drives[name]])
            for row, d in np.argwhere(self.at != (self.chain.end[:, None] if side else 0)).tolist():
                self.extremes.include_series(row, int(self.at[row, d]) - 1 + side, values=values[:, row, d])


class _EnergyLedger:
    """Energy balance, at the mean of old and new speeds."""

    def __init__(self, chain: Chain, step: float, start: InitialState, law: BeltLaw) -> None:
        self.chain, self.dt = chain, step
        self.rows = np.arange(chain.end.size)
        names = ("motors", "lift", "friction", "damping", "brakes", "slip", "take-up")
        self.sums = {name: np.zeros(chain.end.size) for name in names}
        self.rubbed, self.damped = np.zeros_like(chain.mass), np.zeros_like(chain.stiffness)
        self.way = np.zeros_like(chain.mass)  # twice the way over the step
        self.apart = start.speed[self.rows, chain.end] - start.speed[:, 0]
        self.first = self._stored(start.speed, start.rims, law)

    def drives(self, begun: Array, drives: dict[str, Array], frictions: Array, going: Array) -> None:
        """Add the work of all steps at the driven pulleys, from initial rim speeds and belt speeds before each step."""
        rim = 0.5 * (drives["rim"] + np.concatenate([begun[None], drives["rim"][:-1]]))
        at = 0.5 * (drives["belt"] + going)
        for name, power in (
            ("motors", drives["motor"] * rim),
            ("friction", frictions * at),
            ("brakes", drives["holding"] * rim),
            ("slip", drives["force"] * (rim - at)),
        ):
            self.sums[name] += self.dt * power.sum(axis=(0, 2))

    def belts(self, speed: Array, spread: Array, friction: Array, damping: Array) -> None:
        """Add a step along the belts, with twice the mean speeds and speed differences."""
        self.way += speed
        self.rubbed += friction * speed
        self.damped += damping * spread

    def take_up(self, record: dict[str, Array]) -> None:
        """Add the work of all steps at the take-up."""
        apart = np.diff(record["belt"], axis=0, prepend=0.0) / self.dt
        mean = 0.5 * (apart + np.concatenate([self.apart[None], apart[:-1]]))
        pull = np.where(self.chain.winch[0] > 0.0, record["tension"], self.chain.held)
        self.sums["take-up"] -= self.dt * (pull * mean).sum(axis=0)

    def _stored(self, speed: Array, rims: Array, law: BeltLaw) -> tuple[Array, Array, Array]:
        apart = speed[self.rows, self.chain.end] - speed[:, 0]
        mass = np.where(np.isinf(self.chain.carriage), 0.0, self.chain.carriage)
        moving = np.einsum("sn,sn->s", self.chain.mass, speed**2) + np.einsum("sd,sd->s", self.chain.rim, rims**2)
        return 0.5 * (moving + mass * apart**2), *law.stored()

    def closed(self, speed: Array, rims: Array, law: BeltLaw) -> dict[str, Array]:
        """All terms and the error of the balance; energy stored in the relaxing branch is elastic, not damped."""
        kinetic, elastic, held = (
            last - first for last, first in zip(self._stored(speed, rims, law), self.first, strict=True)
        )
        half = 0.5 * self.dt
        self.sums["lift"] += half * (self.chain.weight * self.way).sum(axis=1)
        self.sums["friction"] += half * self.rubbed.sum(axis=1)
        self.sums["damping"] += half * self.damped.sum(axis=1)
        made = dict(self.sums) | {"kinetic": kinetic, "elastic": elastic + held}
        made["damping"] = made["damping"] - held
        spent = sum((value for name, value in made.items() if name != "motors"), np.zeros_like(kinetic))
        return made | {"missing": made["motors"] - spent}
