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

import numpy as np

from conveyor.dynamics.belt_chain import Array, Chain, InitialState, Integers, Machines, Record
from conveyor.dynamics.wave_pulleys import (
    DriveGroup,
    GroupResponse,
    solve_pulleys,
    speed_after_friction,
    winch_direction,
)
from conveyor.dynamics.wave_record import MotionRecord, stored_energy
from conveyor.dynamics.wave_solver import BeltLaw, WaveSolver, add_impulses
from conveyor.errors import NoSolutionError


def simulate_belts(
    chain: Chain,
    machines: Machines,
    start: InitialState,
    *,
    step: float | Array,
    lasts: Integers | None = None,
    samples: int = 300,
) -> Record:
    """Simulate belts through time.

    Parameters
    ----------
    chain : Chain
        The belts.
    machines : Machines
        Motors and brakes.
    start : InitialState
        Initial speeds, tensions and forces.
    step : float or ndarray, shape (s,)
        Time step [s], at most `chain.longest_steps`.
    lasts : ndarray of int, shape (s,)
        Steps of every belt, the most first; by default all of the machines.
    samples : int
        Approximate number of samples of all tensions over the motion of each belt.

    Raises
    ------
    NoSolutionError
        The step is too long, or a figure is not finite.
    """
    steps, longest = np.broadcast_to(step, chain.end.shape), chain.longest_steps
    if np.any(steps > longest * (1.0 + 1e-9)):  # rounding of the quotient
        raise NoSolutionError(f"a step of {steps.max():.4g} s is unstable: at most {longest.min():.4g} s")
    if lasts is None:
        lasts = np.full(steps.shape, machines.reference.shape[0])
    return _Motion(chain, machines, start, step=steps, lasts=lasts, samples=samples).followed()


class _Motion:
    """Belts in motion: the state from step to step, and its record."""

    def __init__(
        self, chain: Chain, machines: Machines, start: InitialState, *, step: Array, lasts: Integers, samples: int
    ) -> None:
        self.chain, self.machines, self.dt = chain, machines, step[:, None]
        self.lasts: list[int] = lasts.tolist()
        self.solver, self.law = WaveSolver(chain, self.dt), BeltLaw(chain, self.dt, start.tension)
        self.solver.update_damping(self.law.eased)
        self.record = MotionRecord(chain, start, self.law, step=step, lasts=lasts, samples=samples)
        self._set_up()
        self._answered()
        self.speed, self.tension = start.speed, start.tension
        self.stretching = np.diff(start.speed, axis=1)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        self.resisting = start.resisting * self.loose
        self.driving, self.rims = start.driving, start.rims
        self.gripping = np.ones(chain.nodes.shape, dtype=bool)
        self.rubbing = start.resisting[self.rows, self.at]
        self.on_pulleys = start.speed[self.rows, self.at]  # exactly 0 at rest, which rounding in the solver would blur
        self.lumps_rest = start.speed[self.rows, chain.lumps] == 0.0
        self.pulled, self.winding = chain.held, np.zeros(chain.end.size)

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
        self.sinking, self.still = -chain.weight, chain.sticking * self.over_mass
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
        beside = self.beside
        for i in range(self.lasts[0]):
            if i == self.lasts[len(self.speed) - 1]:
                self._end_belts(sum(last > i for last in self.lasts))
            self._step(i)
        self.record.end_belts(0, stored_energy(self.chain, self.speed, self.rims, self.law))
        return self.record.closed(beside)

    def _end_belts(self, count: int) -> None:
        """Go on with the first belts only."""
        self.record.end_belts(count, stored_energy(self.chain, self.speed, self.rims, self.law))
        first = slice(count)
        self.chain, self.machines = self.chain.of_belts(first), self.machines.of_belts(first)
        beside = self.beside[:, first]
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[first])
        self.beside = beside
        self.law.drop_belts(count)
        self.solver = WaveSolver(self.chain, self.dt, self.solver.shares[first])
        self._set_up()
        self._answered()

    def _step(self, i: int) -> None:
        """Advance speeds by forces, pulleys and friction, then tensions by speeds."""
        chain = self.chain
        if self.winds:
            speed, band, run_up = chain.winch
            wanted, most = (
                speed * winch_direction(self.pulled / chain.held - 1.0, band),
                self.dt[:, 0] * speed / run_up,
            )
            self.winding = np.clip(wanted, self.winding - most, self.winding + most)
        if self.solver.update_damping(self.law.eased):
            self._answered()
        change, lacking = self.solver.change(self._impulse(), self.speed, self.winding)
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
        self.pulled = chain.held - lacking / self.dt[:, 0]
        shown, spread = self.tension + damping, self.stretching
        self.stretching = new[:, 1:] - new[:, :-1]
        if self.law.relaxes:
            damping = damping + self.law.branch
        self.record.add_work(self.speed + new, spread + self.stretching, self.resisting, damping)
        self.speed = new
        self.tension = self.law.stretch(self.stretching)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        self.record.keep(i, shown, new, self.pulled, new[self.one, chain.end] - new[:, 0])

    def _impulse(self) -> Array:
        """Impulse on every mass over a step, with the last friction and drive forces."""
        acting, strained = self.sinking - self.resisting, self.tension + self.viscous
        acting[:, 1:] -= strained
        acting[:, :-1] += strained
        acting[:, 0] -= self.chain.held  # cancels exactly at rest
        acting[self.one, self.chain.end] += self.chain.held
        acting[self.rows, self.at] += self.driving - self.rubbing
        acting *= self.dt
        return acting

    def _driven(self, i: int, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array]:
        """Speeds with new pulley forces, in turn for coupled pulleys, and the impulse lacking at the take-up."""
        impulse, beside = self.dt * (self.driving - self.rubbing), np.empty_like(self.beside)
        record = {name: values[i, : len(new)] for name, values in self.record.drives.items()}
        friction = self.record.frictions[i, : len(new)]
        self.record.going[i, : len(new)] = self.speed.take(self.flat)
        for turn, reply in zip(self.turns, self.replies, strict=True):
            k, going, rolls = turn.drives, new.take(turn.at), rolling.take(turn.at)
            on = self.on_pulleys[:, k]
            rests = on == 0.0
            faster = new.take(turn.ahead) - new.take(turn.astern) - self.stretching.take(turn.sides)
            cells = self.tension.take(turn.sides) + self.viscous.take(turn.sides) + reply.softer * faster
            tight = (self.chain.held - lacking / self.dt[:, 0])[:, None]
            moved = solve_pulleys(
                turn, i, step=self.dt, answer=reply.own, reach=reply.reach, rim=self.rims[:, k],
                free=going - reply.own * impulse[:, k],
                sides=np.where(turn.ends, tight, cells) + turn.lying + turn.inert * (going - on)
                - reply.yields * going,
                yields=reply.yields, friction=np.where(rests, turn.stuck, rolls), shares=turn.shares(on, rests, rolls),
                last=(self.driving[:, k], self.beside[:, :, k]), gripped=self.gripping[:, k],
            )  # fmt: skip
            record["force"][:, k], record["motor"][:, k] = moved.force, moved.motor
            record["rim"][:, k], record["belt"][:, k] = moved.rim, moved.belt
            record["holding"][:, k], beside[:, :, k] = moved.holding, moved.sides
            friction[:, k], self.gripping[:, k] = moved.friction, moved.grips
            change = (moved.belt - going) / reply.own
            new, lacking = add_impulses(change, reply.columns, reply.of_take_up, new, lacking)
        record["arriving"][:], record["leaving"][:] = self.beside = beside
        self.driving, self.rubbing = record["force"], friction
        self.rims, self.on_pulleys = record["rim"], record["belt"]
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
