"""Figures 2 to 7 of Menga, Bottiglione and Carbone, Lubricants 7 (2019), redrawn.

python examples/04_paper_figures.py [OUTDIR]    PNGs into OUTDIR (out/paper), a table of points to the terminal

Symbols are the paper's: R̃ = R/λ, k h, p̃_m = 2(1-ν²) p_m/(E0 k R), ζ = V τ k, ã = a/R, W̃_d = μ p̃_m ζ; ν = ½, free layer.
The paper states neither E∞/E0 nor the scenes of Figs. 2, 4, 5 and 7 in full; what is chosen here stands on the figures.
Open circles are contacts of more than one strip; a point without an answer is a gap and is counted. What the paper says
about the figures is judged in docs/paper.md and tests/test_paper_figures.py.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import ArrayLike, NDArray

from conveyor.contact import ContactProblem, ContactSolution, CreepSpectrum, Status, solve_many

MODULUS_RATIO = 10.0  # E∞/E0, not stated in the paper
RTOL = 1e-5  # of friction; a line is 1e-3 of an axis wide
ASSUMED = rf"$E_\infty/E_0$ = {MODULUS_RATIO:g} (assumed: the paper does not state it), $\nu$ = ½"
LOAD = r"$\tilde p_m = 2(1-\nu^2)\,p_m/(E_0 k R)$"
SPEED = r"$\zeta = V \tau k$"
POWER = r"$\tilde W_d = 2(1-\nu^2)\,\tau W_d/(E_0 R \lambda b)$"
PRINTED_KERNEL = "Eq. (5) as printed: confined layer"
BLUE, ORANGE, GREEN, RED, GREY = "#1f5fa8", "#d9801a", "#2b8a5a", "#b3343a", "0.45"
COLOURS = (BLUE, ORANGE, GREEN, RED)
STYLE = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.92",
    "axes.axisbelow": True,
    "axes.titlesize": 9,
    "lines.linewidth": 1.6,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 120,
}


def scene(radius: float, thickness: float, load: float, zeta: float, *, support: str = "free") -> ContactProblem:
    """Problem at R̃, k h, p̃_m, ζ; one retardation time."""
    instantaneous = 1.0 / MODULUS_RATIO
    creep = CreepSpectrum(instantaneous, [1.0 - instantaneous], [zeta])
    return ContactProblem(support, radius, load, creep, thickness)


# Drawing


@dataclass
class Tally:
    """Points of a figure: one strip, several strips, no answer."""

    single: int = 0
    split: int = 0
    refused: int = 0

    def solved(self, problems: Sequence[ContactProblem]) -> list[ContactSolution]:
        """Solutions in order, counted."""
        found = solve_many(problems, RTOL)
        for solution in found:
            if solution.status not in {Status.OK, Status.TOO_DEEP}:
                self.refused += 1
            elif len(solution.patches) > 1:
                self.split += 1
            else:
                self.single += 1
        return found


@dataclass(frozen=True)
class Line:
    """What is drawn of solutions: gaps without an answer, open circles where the contact splits."""

    x: NDArray[np.float64]
    y: np.ma.MaskedArray
    split: NDArray[np.bool_]

    @classmethod
    def of(cls, x: ArrayLike, solutions: Sequence[ContactSolution], value: Callable[[ContactSolution], float]) -> Line:
        """Values of the solutions at x."""
        answered = np.array([s.status in {Status.OK, Status.TOO_DEEP} for s in solutions])
        y = [value(s) if good else 0.0 for s, good in zip(solutions, answered, strict=True)]
        split = [good and len(s.patches) > 1 for s, good in zip(solutions, answered, strict=True)]
        return cls(np.asarray(x, dtype=float), np.ma.masked_array(y, mask=~answered), np.array(split))

    def draw(self, ax: Axes, colour: str, **style: object) -> None:
        """Line and circles."""
        ax.plot(self.x, self.y, color=colour, **style)
        at = self.split
        ax.plot(self.x[at], self.y[at], "o", ms=4.2, mfc="white", mec=colour, mew=1.0)


def say(ax: Axes, x: float, y: float, text: str, colour: str, **style: object) -> None:
    """A direct label; none at a point without an answer."""
    if y is np.ma.masked:
        return
    shift = style.pop("shift", (0, 0))
    ax.annotate(text, (x, y), color=colour, xytext=shift, textcoords="offset points", **style)


def finish(figure: Figure, tally: Tally, text: str) -> None:
    """The caption: assumption, choices, split points, points without an answer."""
    marks = [
        text,
        f"contacts of several strips (○): {tally.split}",
        f"points without an answer: {tally.refused}",
    ]
    figure.supxlabel(ASSUMED + "\n" + "   |   ".join(marks), fontsize=7.5, color="0.35")


def panels(count: int, *, height: float = 3.7, **options: object) -> tuple[Figure, NDArray[np.object_]]:
    width = 9.2 if count > 1 else 6.2
    return plt.subplots(1, count, figsize=(width, height), **options)


# The figures


def figure_2(points: int) -> tuple[Figure, Tally]:
    """Deformed lower face and pressure of two layers."""
    tally, radius, load, zeta = Tally(), 0.4, 0.05, 1.0
    figure, axes = plt.subplots(2, 2, figsize=(9.2, 4.6), sharex="row", sharey="row", height_ratios=[1, 1.1])
    period = 1.0 / radius
    x = np.linspace(-0.5 * period, 1.5 * period, 16 * points + 1)
    near = np.linspace(-1.0, 1.0, 16 * points + 1)
    for column, (thickness, name) in enumerate(((1.0, "a"), (0.8, "b"))):
        top, bottom = axes[:, column]
        moving, resting = tally.solved([scene(radius, thickness, load, zeta), scene(radius, thickness, load, 0.0)])
        face = moving.profile(x)
        top.fill_between(x, face, 0.75, color="0.93", lw=0)
        top.plot(x, face, color=BLUE)
        for centre in (0.0, period):
            top.add_patch(Circle((centre, moving.penetration - 1.0), 1.0, fc="0.75", ec="0.35", lw=0.8))
            for low, high in moving.patches:
                at = np.linspace(low, high, 200)
                top.plot(at + centre, moving.profile(at), color=RED, lw=2.8)
        top.plot([0, 0], [-0.62, moving.penetration], color="0.35", lw=0.7, ls=":")
        top.annotate("", (1.75, 0.58), (2.5, 0.58), arrowprops={"arrowstyle": "->", "color": "0.2"})
        say(top, 2.55, 0.58, "V", "0.2", va="center")
        say(top, -1.2, 0.58, "layer (upper face not drawn)", "0.4", va="center", fontsize=8)
        top.set(aspect="equal", ylim=(-0.62, 0.75), xlim=(x[0], x[-1]), xlabel="x/R")
        size = f"ã = {moving.half_width:.3f}, Δ/R = {moving.penetration:.3f}"
        strips = len(moving.patches)
        top.set_title(f"({name}) k h = {thickness:g}: {size}" + (f", {strips} strips" if strips > 1 else ""))
        top.grid(visible=False)
        bottom.fill_between(near, moving.pressure(near), color=RED, alpha=0.15, lw=0)
        bottom.plot(near, moving.pressure(near), color=RED)
        bottom.plot(near, resting.pressure(near), color=GREY, ls="--", lw=1.2)
        bottom.axvline(0.0, color="0.35", lw=0.7, ls=":")
        bottom.set(xlabel="x/R from the roll's axis", xlim=(-1.0, 1.0))
    axes[0, 0].set_ylabel("u/R")
    axes[1, 0].set_ylim(0.0, 0.62)
    axes[1, 0].set_ylabel(LOAD.replace("_m", ""))
    say(axes[1, 0], 0.42, 0.42, "ζ = 1", RED)
    say(axes[1, 0], -0.86, 0.16, "ζ = 0", GREY)
    finish(figure, tally, f"chosen: R̃ = {radius:g}, p̃ₘ = {load:g}, ζ = {zeta:g}")
    return figure, tally


def figure_3(points: int) -> tuple[Figure, Tally]:
    """Half width against load."""
    tally = Tally()
    figure, axes = panels(2, sharey=True)
    loads = 0.3 * np.linspace(0.04, 1.0, points) ** 2
    for ax, thickness, name in zip(axes, (1.0, 0.8), "ab", strict=True):
        for zeta, colour in zip((0.1, 1.0, 10.0), COLOURS, strict=False):
            found = tally.solved([scene(0.4, thickness, load, zeta) for load in loads])
            line = Line.of(loads, found, lambda s: s.half_width)
            line.draw(ax, colour)
            say(ax, loads[-1], line.y[-1], f"ζ = {zeta:g}", colour, shift=(4, -3))
        ax.set(title=f"({name}) k h = {thickness:g}", xlabel=LOAD, ylim=(0.0, 1.0))
        ax.set_xlim(0.0, 0.345)
    axes[0].set_ylabel(r"$\tilde a = a/R$")
    finish(figure, tally, "R̃ = 0.4")
    return figure, tally


def figure_4(points: int) -> tuple[Figure, Tally]:
    """Friction against speed for four rolls."""
    tally = Tally()
    figure, axes = panels(2, sharey=True)
    zeta = np.logspace(-2.0, 2.0, points)
    for ax, thickness, name in zip(axes, (1.0, 0.8), "ab", strict=True):
        for radius, colour in zip((0.1, 0.2, 0.3, 0.4), COLOURS, strict=True):
            found = tally.solved([scene(radius, thickness, 0.13, z) for z in zeta])
            line = Line.of(zeta, found, lambda s: s.friction)
            line.draw(ax, colour, lw=1.0, ls=(0, (2, 1.2)))
            shallow = [s if s.status is Status.OK else None for s in found]
            hidden = np.ma.getmaskarray(line.y) | np.array([s is None for s in shallow])
            ax.plot(zeta, np.ma.masked_array(line.y.data, mask=hidden), color=colour, lw=1.9)
            top = int(np.argmax(line.y))
            shift, side = {0.1: ((-8, 2), "right"), 0.2: ((14, 6), "left")}.get(radius, ((-2, -19), "center"))
            say(ax, zeta[top], line.y[top], f"R̃ = {radius:g}", colour, shift=shift, ha=side)
        ax.set(xscale="log", title=f"({name}) k h = {thickness:g}", xlabel=SPEED, ylim=(0.0, 1.65))
    axes[0].set_ylabel(r"$\mu = F_T/F_N$")
    finish(figure, tally, "p̃ₘ = 0.13, radii chosen   |   dashed: Δ > R")
    return figure, tally


def figure_5(points: int) -> tuple[Figure, Tally]:
    """Mean tangential stress against thickness, with the half-space."""
    tally, radius, load, zeta = Tally(), 0.4, 0.02, 0.5
    figure, ax = panels(1)
    thickness = np.logspace(math.log10(0.25), 1.0, points)
    (deep,) = tally.solved([scene(radius, math.inf, load, zeta, support="half-space")])
    for support, colour, style in (("free", BLUE, {}), ("confined", GREY, {"lw": 1.0, "ls": "--"})):
        found = tally.solved([scene(radius, h, load, zeta, support=support) for h in thickness])
        Line.of(thickness, found, lambda s: 1e3 * s.friction * load).draw(ax, colour, **style)
    limit = 1e3 * deep.friction * load
    ax.axhline(limit, color="0.2", lw=0.9, ls=(0, (5, 2)))
    say(ax, 10.0, limit, f"half-space, {limit:.3f}", "0.2", shift=(0, 5), ha="right")
    say(ax, 0.75, 3.75, "free layer", BLUE, shift=(6, 6))
    say(ax, 0.45, 1.35, PRINTED_KERNEL, GREY, shift=(14, -10))
    ax.set(
        xscale="log",
        xlabel="$k h$",
        ylabel=r"$10^3\,\tilde\tau_m = 10^3 \cdot 2(1-\nu^2)\,\tau_m/(E_0 k R)$",
        ylim=(0.0, None),
    )
    ticks = (0.25, 0.5, 1, 2, 5, 10)
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    finish(figure, tally, f"chosen: R̃ = {radius:g}, p̃ₘ = {load:g}, ζ = {zeta:g}")
    return figure, tally


def figure_6(points: int) -> tuple[Figure, Tally]:
    """Dissipation against speed for two rolls, at one p̃_m and at one load per roll."""
    tally = Tally()
    figure, axes = panels(3, height=3.9)
    zeta = np.logspace(-3.0, 3.0, points)
    loads = {"a": (1.0, 0.001, 0.001), "b": (0.8, 0.001, 0.001), "c": (1.0, 0.003, 0.001)}
    for ax, (name, (thickness, *pair)) in zip(axes, loads.items(), strict=True):
        for radius, load, colour in zip((0.1, 0.3), pair, COLOURS, strict=False):
            scale = radius if name == "c" else 1.0
            found = tally.solved([scene(radius, thickness, load, z) for z in zeta])
            line = Line.of(zeta, found, lambda s, scale=scale: scale * s.dissipation)
            line.draw(ax, colour, label=f"R̃ = {radius:g}, p̃ₘ = {load:g}")
        ax.set(xscale="log", yscale="log", xlabel=SPEED, ylim=(1e-10, 1e-4))
        ax.legend(frameon=False, loc="lower right", fontsize=8)
        ax.set_title(f"({name}) k h = {thickness:g}, " + ("one pₘ" if name == "c" else "p̃ₘ = 0.001"))
    axes[0].set_ylabel(POWER)
    axes[2].set_ylabel(r"$\tilde R\,\tilde W_d = 2(1-\nu^2)\,\tau W_d/(E_0 \lambda^2 b)$")
    finish(figure, tally, "(c) is not in the paper: one load per roll, with E₀, λ, h kept")
    return figure, tally


def figure_7(points: int) -> tuple[Figure, Tally]:
    """Dissipation against speed for three loads, with the printed kernel beside it."""
    tally = Tally()
    figure, ax = panels(1, height=4.2)
    zeta = np.logspace(-3.0, 3.0, points)
    plateau: dict[str, list[float]] = {"free": [], "confined": []}
    for load, colour in zip((0.001, 0.002, 0.004), COLOURS, strict=False):
        for support, style in (("free", {}), ("confined", {"lw": 1.0, "ls": "--"})):
            found = tally.solved([scene(0.3, 1.0, load, z, support=support) for z in zeta])
            line = Line.of(zeta, found, lambda s: s.dissipation)
            line.draw(ax, colour, **style)
            plateau[support].append(float(line.y[-1]))
        say(ax, 1e3, plateau["free"][-1], f"p̃ₘ = {load:g}", colour, shift=(4, -3))
    for support, x in (("free", 30.0), ("confined", 300.0)):
        for low, high in zip(plateau[support], plateau[support][1:], strict=False):
            dash = "--" if support == "confined" else "-"
            ax.annotate("", (x, high), (x, low), arrowprops={"arrowstyle": "->", "color": "0.3", "ls": dash})
            say(
                ax,
                x,
                math.sqrt(low * high),
                f"×{high / low:.2f}",
                "0.3",
                shift=(-3, -3),
                ha="right",
                fontsize=8,
            )
    ax.plot([], [], color="0.3", label="free layer")
    ax.plot([], [], color="0.3", lw=1.0, ls="--", label=PRINTED_KERNEL)
    ax.legend(frameon=False, loc="lower right")
    ax.set(xscale="log", yscale="log", xlabel=SPEED, ylabel=POWER)
    ax.set(xlim=(1e-3, 1.4e4), ylim=(1e-10, 2e-3))
    ax.set_xticks(10.0 ** np.arange(-3, 4))
    finish(figure, tally, "chosen: R̃ = 0.3, k h = 1")
    return figure, tally


FIGURES: dict[str, tuple[Callable[[int], tuple[Figure, Tally]], int]] = {
    "figure_2": (figure_2, 40),
    "figure_3": (figure_3, 40),
    "figure_4": (figure_4, 49),
    "figure_5": (figure_5, 41),
    "figure_6": (figure_6, 49),
    "figure_7": (figure_7, 49),
}


def save(draw: Callable[[int], tuple[Figure, Tally]], points: int, path: Path) -> Tally:
    with plt.rc_context(STYLE):
        figure, tally = draw(points)
        figure.savefig(path)
        plt.close(figure)
    return tally


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("outdir", nargs="?", type=Path, default=Path("out/paper"))
    outdir = parser.parse_args().outdir
    outdir.mkdir(parents=True, exist_ok=True)
    print(f"{'':10}{'one strip':>10}{'split':>7}{'refused':>9}{'seconds':>9}")
    for name, (draw, points) in FIGURES.items():
        start = time.perf_counter()
        tally = save(draw, points, outdir / f"{name}.png")
        seconds = time.perf_counter() - start
        print(f"{name:10}{tally.single:10}{tally.split:7}{tally.refused:9}{seconds:9.1f}")


if __name__ == "__main__":
    main()
