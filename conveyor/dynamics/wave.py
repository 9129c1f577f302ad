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

from conveyor.dynamics.belt_chain import (
    Array,
    BeltRow,
    Chain,
    InitialState,
    Integers,
    Machines,
    Record,
    friction_at_speed,
)
from conveyor.dynamics.wave_pulleys import (
    DriveGroup,
    GroupResponse,
    group_drives,
    motor_lines,
    solve_pulleys,
    speed_after_friction,
    winch_direction,
)
from conveyor.dynamics.wave_record import BESIDE, MotionRecord, stored_energy
from conveyor.dynamics.wave_solver import NO_CELL, BeltLaw, StepPlaces, WaveSolver
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
        self.row = row = BeltRow.of(chain)
        self.places = places = StepPlaces.of(chain, row)
        self.law = BeltLaw(chain, row, step, start.tension)
        self.solver = WaveSolver(chain, row, places, step)
        self.solver.update_damping(self.law.eased)
        self.motors = motor_lines(chain, machines, self.dt)
        self._set_up()
        self.speed, self.tension = row.masses(start.speed), self.law.tension
        self.stretching = np.append(np.diff(self.speed), 0.0)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        resisting = row.masses(start.resisting)
        self.rubbing = resisting[self.at]
        self.resisting = resisting * self.loose
        self.record = MotionRecord(chain, row, start, self.law, step=step, lasts=lasts, samples=samples)
        self.driving, self.rims = start.driving, start.rims
        self.slipped = np.zeros(chain.nodes.shape, dtype=bool)
        self.on_pulleys = self.speed[self.at]  # exactly 0 at rest, which rounding in the solver would blur
        self.lumps_rest = self.speed[self.lumps] == 0.0
        self.pulled, self.winding = chain.held, np.zeros(chain.end.size)

    def _set_up(self) -> None:
        """Set constants: places, compliances, friction at rest."""
        chain, row, step, places = self.chain, self.row, self.dt, self.places
        self.at, self.lumps = places.near[:, places.of_drives], places.near[:, places.of_lumps]
        self.loose = np.ones(row.last[-1] + 1)
        self.loose[self.at] = 0.0  # friction there belongs to the pulley
        alone = self.loose.copy()
        alone[self.lumps] = 0.0
        mass, sticking = row.masses(chain.mass), row.masses(chain.sticking)
        self.each_dt = row.each(step[:, 0])
        self.over_mass, self.under_mass = alone * self.each_dt / mass, alone * mass / self.each_dt
        self.still = sticking * self.over_mass
        self.outside = -row.masses(chain.weight)
        self.outside[row.first] -= chain.held - NO_CELL
        self.outside[row.last] += chain.held - NO_CELL
        self.friction = row.masses(chain.friction)
        self.lumps_loose, self.lumps_stuck = self.loose[self.lumps], sticking[self.lumps]
        self.winds = bool(np.any(chain.winch[0]))
        self.tau_k = chain.retardation * row.cells(chain.stiffness, 0.0)
        self.turns = [DriveGroup.of(chain, row, self.machines, step, k) for k in group_drives(self.solver)]
        self._answered()

    def _answered(self) -> None:
        """Update the responses of the pulleys after a factorisation."""
        self.half_k = 0.5 * self.tau_k * self.solver.shares
        self.replies = [GroupResponse.of(self.solver, turn, self.dt) for turn in self.turns]
        lumps = self.places.lumps
        self.lumps_own = np.einsum("sll->sl", self.solver.reach[:, :lumps, :lumps])
        self.lumps_reach = self.dt * self.lumps_own

    def followed(self) -> Record:
        """Take every step."""
        self.beside = np.empty((2, *self.at.shape))
        for turn in self.turns:
            k = turn.drives
            _, shares = turn.belt_friction(self.on_pulleys[:, k])
            self.beside[:, :, k] = self.tension.take(turn.cells, mode="wrap") + turn.lying + shares * self.rubbing[:, k]
        beside = self.beside
        for i in range(self.lasts[0]):
            if i == self.lasts[len(self.dt) - 1]:
                self._end_belts(sum(last > i for last in self.lasts))
            self._step(i)
        self.record.end_belts(0, stored_energy(self.chain, self.row, self.speed, self.rims, self.law))
        return self.record.closed(beside)

    def _end_belts(self, count: int) -> None:
        """Go on with the first belts only."""
        self.record.end_belts(count, stored_energy(self.chain, self.row, self.speed, self.rims, self.law))
        belts, masses = slice(count), slice(self.row.last[count - 1] + 1)
        self.chain, self.machines = self.chain.of_belts(belts), self.machines.of_belts(belts)
        self.dt, self.motors = self.dt[belts], self.motors[:, :, belts]
        self.driving, self.rims, self.rubbing = self.driving[belts], self.rims[belts], self.rubbing[belts]
        self.slipped, self.on_pulleys, self.beside = self.slipped[belts], self.on_pulleys[belts], self.beside[:, belts]
        self.lumps_rest, self.pulled, self.winding = self.lumps_rest[belts], self.pulled[belts], self.winding[belts]
        self.speed, self.resisting = self.speed[masses].copy(), self.resisting[masses].copy()
        self.tension, self.viscous, self.stretching = (
            self.tension[masses], self.viscous[masses], self.stretching[masses]
        )  # fmt: skip
        self.row = BeltRow.of(self.chain)
        self.places = StepPlaces.of(self.chain, self.row)
        self.law.drop_belts(self.row)
        self.solver = WaveSolver(self.chain, self.row, self.places, self.dt[:, 0], self.solver.middle[masses])
        self._set_up()

    def _step(self, i: int) -> None:
        """Advance speeds by forces, pulleys and friction, then tensions by speeds."""
        chain, speed, last = self.chain, self.speed, self.stretching
        if self.winds:
            inward, band, run_up = chain.winch
            wanted, most = (
                inward * winch_direction(self.pulled / chain.held - 1.0, band),
                self.dt[:, 0] * inward / run_up,
            )
            self.winding = np.clip(wanted, self.winding - most, self.winding + most)
        if self.solver.update_damping(self.law.eased):
            self._answered()
        shown, new, resisting, damping = self.record.step_rows()
        pushed = self.driving - self.rubbing
        strained = np.add(self.tension, self.viscous, out=shown)
        allowed = friction_at_speed(self.friction, speed, chain.known)
        new += self._impulses_spread(i, strained, pushed, allowed)
        # damping: the solver's share of τ k on half the new speeds, before single masses rub, the rest on the old
        np.subtract(new[1:], new[:-1], out=damping[:-1])
        damping[-1] = 0.0
        damping -= last
        damping *= self.half_k
        damping += self.viscous
        np.add(self.tension, damping, out=shown)
        if self.law.relaxes:
            damping += self.law.branch
        allowed *= self.over_mass
        np.copyto(allowed, self.still, where=speed == 0.0)
        free = self.resisting * self.over_mass
        free += new
        rubbed = np.maximum(free, -allowed)
        np.minimum(rubbed, allowed, out=rubbed)
        np.subtract(free, rubbed, out=new)
        np.multiply(rubbed, self.under_mass, out=resisting)
        resisting[self.lumps] = self.lumped
        self.record.keep(i, pulled=self.pulled)
        self.speed, self.resisting = new, resisting
        self.stretching = stretching = np.zeros_like(last)
        np.subtract(new[1:], new[:-1], out=stretching[:-1])
        self.tension = self.law.stretch(stretching)
        self.viscous = self.tau_k * stretching
        self.viscous *= self.law.eased

    def _impulse(self, strained: Array, pushed: Array) -> Array:
        """Impulse on every mass over a step, with the last friction and these forces on driven masses."""
        acting = self.outside - self.resisting
        acting += strained
        acting[1:] -= strained[:-1]
        acting[0] -= NO_CELL
        acting[self.at] += pushed
        acting *= self.each_dt
        return np.asarray(acting)

    def _impulses_spread(self, i: int, strained: Array, pushed: Array, rolling: Array) -> Array:
        """Change of all speeds over a step, before single masses rub: by all forces, lumps, pulleys and take-up."""
        solver, lumps = self.solver, self.places.lumps
        change = solver.respond(self._impulse(strained, pushed))
        lacking = solver.lacking(change, self.speed, self.winding)
        near = change.take(self.places.near) - solver.pair * lacking[:, None]
        impulses = np.empty(self.places.acting.shape)
        impulses[:, 2 : 2 + lumps], lacking = self._rub_lumps(near, lacking, rolling)
        if self.at.size:
            impulses[:, 2 + lumps :], lacking = self._drive(i, near, lacking, strained=strained, pushed=pushed)
        self.pulled = self.chain.held - lacking / self.dt[:, 0]
        impulses[:, 0], impulses[:, 1] = lacking, -lacking
        change += solver.speed_changes(impulses)
        return change

    def _rub_lumps(self, near: Array, lacking: Array, rolling: Array) -> tuple[Array, Array]:
        """Impulses of the lumps' friction, in turn, and what lacks at the take-up; speeds near them are moved."""
        earlier, solver = self.resisting.take(self.lumps), self.solver
        most = self.lumps_loose * np.where(self.lumps_rest, self.lumps_stuck, rolling.take(self.lumps))
        free, allowed, going = self.lumps_reach * earlier, self.lumps_reach * most, self.speed.take(self.lumps)
        impulses = np.empty_like(most)
        for j in range(self.places.lumps):
            speed = going[:, j] + near[:, j]
            left = speed_after_friction(speed + free[:, j], allowed[:, j], allowed[:, j])
            self.lumps_rest[:, j] = left == 0.0
            impulses[:, j] = by = (left - speed) / self.lumps_own[:, j]
            near += by[:, None] * solver.reach[:, j]
        self.lumped = earlier - impulses / self.dt
        return impulses, lacking + np.vecdot(impulses, solver.of_take_up[:, : self.places.lumps])

    def _drive(
        self, i: int, near: Array, lacking: Array, *, strained: Array, pushed: Array
    ) -> tuple[Array, Array]:  # fmt: skip
        """Impulses of the pulleys, in turn if they are coupled, and what lacks at the take-up then."""
        lumps, drives = self.places.lumps, self.places.drives
        impulses, record = np.empty(pushed.shape), self.record.drives[i, :, : len(near)]
        beside, (force, motor, rim, belt, _, _, holding, rubbing, before) = record[BESIDE], record
        before[:] = self.speed.take(self.at)
        motors, near = self.motors[i], near[:, lumps:].reshape(-1, 3, drives)
        for turn, reply in zip(self.turns, self.replies, strict=True):
            k = turn.drives
            at = near[:, :, k].transpose(1, 0, 2)
            going, on = before[:, k] + at[1], self.on_pulleys[:, k]
            cells = strained.take(turn.cells, mode="wrap") + reply.softer * (at[1:] - at[:-1])
            cells += turn.lying - turn.ends * (lacking[:, None] / self.dt) - turn.inert * on - reply.gives * going
            friction, shares = turn.belt_friction(on)
            moved = solve_pulleys(
                turn, motors[:, :, k], step=self.dt, answer=reply.own, reach=reply.reach, rim=self.rims[:, k],
                free=going - reply.reach * pushed[:, k], sides=cells, yields=reply.yields, friction=friction,
                shares=shares, last=(self.driving[:, k], self.beside[:, :, k]), slipped=self.slipped[:, k],
            )  # fmt: skip
            force[:, k], motor[:, k], rim[:, k], belt[:, k] = moved.force, moved.motor, moved.rim, moved.belt
            holding[:, k], rubbing[:, k] = moved.holding, moved.friction
            beside[:, :, k], self.slipped[:, k] = moved.sides, moved.slips
            impulses[:, k] = by = (moved.belt - going) / reply.own
            lacking = lacking + np.vecdot(by, reply.of_take_up)
            if len(self.turns) > 1:
                near += (by[:, None] @ reply.near).reshape(near.shape)
        self.driving, self.rubbing, self.rims, self.on_pulleys, self.beside = force, rubbing, rim, belt, beside
        return impulses, lacking
