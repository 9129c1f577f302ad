"""Even rods whose answers are known in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np

from conveyor.dynamics.belt_chain import Chain, InitialState, Machines, Record
from conveyor.dynamics.wave import simulate_belts

EA, LINE_MASS, LENGTH = 4.0e7, 40.0, 2000.0
WAVE = np.sqrt(EA / LINE_MASS)  # 1000 m/s
PULL = 50e3


def rod(cells: int, **changes: Any) -> Chain:
    """A rod between the free ends that a weight without mass gives, on nothing that rubs, no pulley driven."""
    size = LENGTH / cells
    mass = np.full((1, cells + 1), LINE_MASS * size)
    mass[:, [0, -1]] *= 0.5
    parts: dict[str, Any] = {
        "mass": mass, "stiffness": np.full((1, cells), EA / size), "retardation": 0.0,
        "weight": np.zeros((1, cells + 1)), "friction": np.zeros((3, 1, cells + 1)),
        "sticking": np.zeros((1, cells + 1)), "end": np.array([cells]), "nodes": np.zeros((1, 0), int),
        "lumps": np.zeros((1, 0), int),
        "rim": np.zeros((1, 0)), "grip": np.zeros((1, 0)), "backstop": np.zeros((1, 0), bool),
        "held": np.array([PULL]), "carriage": np.zeros(1), "winch": np.zeros((3, 1)), "sag": np.zeros((1, cells)),
    }  # fmt: skip
    made = parts | changes
    return Chain(**({"before": lying_before(made)} | made))


def lying_before(parts: dict[str, Any]) -> np.ndarray:
    """What lies before the driven pulleys: half of it, nothing right behind the take-up, all right before it."""
    nodes, last = parts["nodes"], parts["end"][:, None]
    share = np.where(nodes == 0, 0.0, np.where(nodes == last, 1.0, 0.5))
    lying = np.stack([parts["mass"], parts["weight"], *parts["friction"], parts["sticking"]])
    return share * np.take_along_axis(lying, np.broadcast_to(nodes, (6, *nodes.shape)), axis=2)


def clamped(cells: int, *nodes: int) -> dict[str, Any]:
    """Masses that nothing moves."""
    sticking = np.zeros((1, cells + 1))
    sticking[:, list(nodes)] = 1e12
    friction = np.zeros((3, 1, cells + 1))
    friction[0] = sticking
    lumps = np.arange(cells + 1)[None, list(nodes)]
    return {"sticking": sticking, "friction": friction, "lumps": lumps}


def begun(chain: Chain, **changes: Any) -> InitialState:
    """At rest under an even tension."""
    s, n = chain.stiffness.shape
    drives = np.zeros((s, chain.nodes.shape[1]))
    parts = {
        "speed": np.zeros((s, n + 1)), "tension": np.full((s, n), PULL), "resisting": np.zeros((s, n + 1)),
        "driving": drives, "rims": drives,
    }  # fmt: skip
    return InitialState(**(parts | changes))


def idle(steps: int, drives: int = 0, scenes: int = 1) -> Machines:
    """No motor, no brake."""
    over_time = np.zeros((steps, scenes, drives))
    return Machines(
        np.zeros((scenes, drives)), over_time, over_time, over_time, np.zeros((scenes, drives, 65)), 1.0,
        np.zeros((scenes, drives)),
    )  # fmt: skip


def follow(chain: Chain, start: InitialState, time: float, machines: Machines | None = None) -> Record:
    """Every step kept."""
    step = chain.longest_step
    steps = round(time / step)
    given = idle(steps, chain.nodes.shape[1]) if machines is None else machines
    return simulate_belts(chain, given, start, step=step, samples=steps)
