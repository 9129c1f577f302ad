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
    motor_lines,
    solve_pulleys,
    speed_after_friction,
    winch_direction,
)
from conveyor.dynamics.wave_record import BESIDE, MotionRecord, stored_energy
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
        self.motors = motor_lines(chain, machines, self.dt)
        self._set_up()
        self._answered()
        self.speed, self.tension = start.speed, start.tension
        self.stretching = np.diff(start.speed, axis=1)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        self.strained = np.empty((chain.end.size, chain.mass.shape[1] + 1))
        self.resisting = start.resisting * self.loose
        self.driving, self.rims = start.driving, start.rims
        self.slipped = np.zeros(chain.nodes.shape, dtype=bool)
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
        self.pulse = np.where(np.arange(n + 1) <= chain.end[:, None], step, 0.0)
        alone = self.loose.copy()
        alone[self.rows, chain.lumps] = 0.0
        self.over_mass, self.under_mass = alone * step / chain.mass, alone * chain.mass / step
        self.sinking, self.still = -chain.weight, chain.sticking * self.over_mass
        self.lumps = self.rows * (n + 1) + chain.lumps
        self.lumps_loose, self.lumps_stuck = self.loose.take(self.lumps), chain.sticking.take(self.lumps)
        self.winds = bool(np.any(chain.winch[0]))
        self.tau_k = chain.retardation * chain.stiffness
        self.flat = self.rows * (n + 1) + at
        self.behind = self.one * (n + 2) + chain.end + 1
        self.turns = [DriveGroup.of(chain, self.machines, self.motors, step, k) for k in self.solver.pulleys.turns()]

    def _answered(self) -> None:
        """Update the responses of the pulleys after a factorisation."""
        self.half_k = 0.5 * self.tau_k * self.solver.shares
        self.replies = [GroupResponse.of(self.solver, turn, self.dt) for turn in self.turns]
        self.lumps_reach = self.dt * self.solver.lumps.own

    def followed(self) -> Record:
        """Take every step."""
        self._strain(self.tension)
        self.beside = np.empty((2, *self.at.shape))
        for turn in self.turns:
            k = turn.drives
            _, shares = turn.belt_friction(self.on_pulleys[:, k])
            self.beside[:, :, k] = self.strained.take(turn.strained) + turn.lying + shares * self.rubbing[:, k]
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
        beside, self.motors = self.beside[:, first], self.motors[:, :, first]
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray) and name != "motors":
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
        pushed = self.driving - self.rubbing
        change, lacking = self.solver.change(self._impulse(pushed), self.speed, self.winding)
        new, rolling = self.speed + change, chain.resisting(self.speed)
        new, lacking, lumped = self._rubbed(new, lacking, rolling)
        if self.at.size:
            new, lacking = self._driven(i, new, lacking, pushed)
        # damping: the solver's share of τ k on half the new speeds, before single masses rub, the rest on the old
        damping = self.viscous + self.half_k * (new[:, 1:] - new[:, :-1] - self.stretching)
        free = new + self.resisting * self.over_mass
        allowed = rolling * self.over_mass
        np.copyto(allowed, self.still, where=self.speed == 0.0)
        rubbed = np.minimum(np.maximum(free, -allowed), allowed)
        new = free - rubbed
        self.resisting = rubbed * self.under_mass
        self.resisting[self.rows, chain.lumps] = lumped
        self.pulled = chain.held - lacking / self.dt[:, 0]
        shown = self.tension + damping
        if self.law.relaxes:
            damping = damping + self.law.branch
        self.record.keep(i, tension=shown, speed=new, pulled=self.pulled, friction=self.resisting, damping=damping)
        self.speed, self.stretching = new, new[:, 1:] - new[:, :-1]
        self.tension = self.law.stretch(self.stretching)
        self.viscous = self.tau_k * self.law.eased * self.stretching

    def _strain(self, tension: Array) -> None:
        """Set the tensions of the cells between those of the take-up at both ends."""
        self.strained[:, 1:-1] = tension
        self.strained[:, 0] = self.chain.held
        self.strained.reshape(-1)[self.behind] = self.chain.held

    def _impulse(self, pushed: Array) -> Array:
        """Impulse on every mass over a step, with the last friction and these forces on driven masses."""
        self._strain(self.tension + self.viscous)
        acting = self.sinking - self.resisting
        acting -= self.strained[:, :-1]
        acting += self.strained[:, 1:]
        acting.reshape(-1)[self.flat] += pushed
        acting *= self.pulse
        return acting

    def _driven(self, i: int, new: Array, lacking: Array, pushed: Array) -> tuple[Array, Array]:
        """Speeds with new pulley forces, in turn for coupled pulleys, and the impulse lacking at the take-up."""
        impulse, record = self.dt * pushed, self.record.drives[i, :, : len(new)]
        beside, (force, motor, rim, belt, _, _, holding, rubbing, before) = record[BESIDE], record
        before[:] = self.speed.take(self.flat)
        for turn, reply in zip(self.turns, self.replies, strict=True):
            k, places = turn.drives, new.take(turn.places)
            going, on = places[0], self.on_pulleys[:, k]
            faster = places[1:3] - places[3:] - self.stretching.take(turn.cells)
            cells = self.strained.take(turn.strained) + reply.softer * faster - turn.ends * (lacking[:, None] / self.dt)
            friction, shares = turn.belt_friction(on)
            moved = solve_pulleys(
                turn, i, step=self.dt, answer=reply.own, reach=reply.reach, rim=self.rims[:, k],
                free=going - reply.own * impulse[:, k],
                sides=cells + turn.lying + turn.inert * (going - on) - reply.yields * going,
                yields=reply.yields, friction=friction, shares=shares,
                last=(self.driving[:, k], self.beside[:, :, k]), slipped=self.slipped[:, k],
            )  # fmt: skip
            force[:, k], motor[:, k], rim[:, k], belt[:, k] = moved.force, moved.motor, moved.rim, moved.belt
            holding[:, k], rubbing[:, k] = moved.holding, moved.friction
            beside[:, :, k], self.slipped[:, k] = moved.sides, moved.slips
            new, lacking = add_impulses((moved.belt - going) / reply.own, reply.columns, reply.of_take_up, new, lacking)
        self.driving, self.rubbing, self.rims, self.on_pulleys, self.beside = force, rubbing, rim, belt, beside
        return new, lacking

    def _rubbed(self, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array, Array]:
        """Speeds with the lumps' friction, in turn, the impulse lacking at the take-up, and the friction."""
        at, answer = self.lumps, self.solver.lumps
        if not at.size:
            return new, lacking, np.zeros(at.shape)
        earlier, speed = self.resisting.take(at), new.take(at)
        most = self.lumps_loose * np.where(self.lumps_rest, self.lumps_stuck, rolling.take(at))
        free, allowed = self.lumps_reach * earlier, self.lumps_reach * most
        impulse = np.empty_like(most)
        for j in range(at.shape[1]):
            left = speed_after_friction(speed[:, j] + free[:, j], allowed[:, j], allowed[:, j])
            self.lumps_rest[:, j] = left == 0.0
            impulse[:, j] = (left - speed[:, j]) / answer.own[:, j]
            if j + 1 < at.shape[1]:
                speed = speed + impulse[:, j, None] * answer.mutual[:, j]
        return *answer.moved(impulse, new, lacking), earlier - impulse / self.dt
