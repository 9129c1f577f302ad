"""The figures of examples/04_paper_figures.py, and the claims of the paper as docs/paper.md prints them.

Menga, Bottiglione, Carbone, Lubricants 7 (2019), sections 2 to 4. Each claim is a function that judges by our numbers
and returns what stands in its row of the table. `python tests/test_paper_figures.py` writes the table.
"""

from __future__ import annotations

import importlib.util
import itertools
import math
import re
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from conveyor.contact import ContactSolution, CreepSpectrum, solve

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs" / "paper.md"


def loaded():
    """The example as a module; its name begins with a digit."""
    spec = importlib.util.spec_from_file_location("paper_figures", ROOT / "examples" / "04_paper_figures.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


example = loaded()
scene, MODULUS_RATIO = example.scene, example.MODULUS_RATIO

# The paper's claims (sections 3 and 4), judged by our numbers

Judged = tuple[str, str]
CLAIMS: list[tuple[str, str, Callable[[], Judged]]] = []
RADII, SPEEDS = (0.1, 0.2, 0.3, 0.4), (0.01, 0.1, 1.0, 10.0, 100.0)


def claim(place: str, words: str) -> Callable[[Callable[[], Judged]], Callable[[], Judged]]:
    """Register a claim of the paper; its function returns verdict and numbers."""

    def register(judge: Callable[[], Judged]) -> Callable[[], Judged]:
        CLAIMS.append((place, words, judge))
        return judge

    return register


def verdict(everywhere: bool, somewhere: bool = False) -> str:
    """Holds wherever tried; holds in the part that the second condition states; does not hold."""
    return "true" if everywhere else "true with limits" if somewhere else "false"


@cache
def at(radius: float, thickness: float, load: float, zeta: float, support: str = "free") -> ContactSolution:
    return solve(scene(radius, thickness, load, zeta, support=support))


@cache
def peak(radius: float, thickness: float, load: float) -> tuple[float, float]:
    """ζ and μ at the largest friction."""
    logs = np.linspace(-2.0, 1.0, 13)
    near = logs[np.argmax([at(radius, thickness, load, 10.0**x).friction for x in logs])]
    around, fine = (near - 0.25, near + 0.25), {"xatol": 3e-3}
    best = minimize_scalar(lambda x: -at(radius, thickness, load, 10.0**x).friction, bounds=around, options=fine)
    return 10.0**best.x, -best.fun


def listed(values: Sequence[float], form: str = ".3f") -> str:
    return ", ".join(format(value, form) for value in values)


def falling(values: Sequence[float]) -> bool:
    return bool(np.all(np.diff(values) < 0.0))


@claim("Fig. 2", "the contact is displaced to the right, where the layer comes from")
def displaced() -> Judged:
    e = [at(0.4, 1.0, 0.05, zeta).eccentricity for zeta in (0.1, 1.0, 10.0)]
    return verdict(min(e) > 0.0), f"e/R {listed(e)} at ζ 0.1, 1, 10 (R̃ 0.4, kh 1, p̃ₘ 0.05)"


@claim("Fig. 2", "the thinner layer has the larger contact and bends more")
def thinner_bends() -> Judged:
    thick, thin = at(0.4, 1.0, 0.05, 1.0), at(0.4, 0.8, 0.05, 1.0)
    holds = thin.half_width > thick.half_width and thin.penetration > thick.penetration
    numbers = f"ã {thick.half_width:.3f} → {thin.half_width:.3f}, Δ/R {thick.penetration:.3f} → {thin.penetration:.3f}"
    return verdict(holds), f"{numbers} for kh 1 → 0.8 (R̃ 0.4, p̃ₘ 0.05, ζ 1)"


@claim("Eq. (1)", "the contact is one strip [-a, a]")
def one_strip() -> Judged:
    scenes = [(0.4, 1.0, 0.13, 1.0), (0.4, 1.0, 0.13, 3.0), (0.3, 0.8, 0.13, 1.0), (0.2, 0.8, 0.13, 0.01)]
    strips = [len(at(*each).patches) for each in scenes]
    where = "(R̃, kh, ζ) = (0.4, 1, 1), (0.4, 1, 3), (0.3, 0.8, 1), (0.2, 0.8, 0.01)"
    return verdict(max(strips) == 1, strips[0] == 1), f"{listed(strips, 'd')} strips at {where}, p̃ₘ 0.13"


@claim("Fig. 3", "ã grows steeply with load below 0.5-0.8, slowly above")
def steep_then_slow() -> Judged:
    a = [at(0.4, 1.0, load, 0.1).half_width for load in (0.005, 0.01, 0.02, 0.04, 0.08, 0.16)]
    factors = [high / low for low, high in itertools.pairwise(a)]
    holds = falling(factors) and factors[0] > math.sqrt(2.0) > factors[-1]
    numbers = f"per doubled load × {listed(factors, '.2f')} from ã {listed(a[:-1], '.2f')}"
    return verdict(holds), f"{numbers} (R̃ 0.4, kh 1, ζ 0.1)"


@claim("Fig. 3", "ã → 1 is an asymptote out of reach")
def asymptote() -> Judged:
    a = [at(0.4, 1.0, load, 0.1).half_width for load in (0.3, 0.5, 1.0)]
    holds = falling(a[::-1]) and a[-1] < 1.0
    return verdict(holds), f"ã {listed(a)} at p̃ₘ 0.3, 0.5, 1 (R̃ 0.4, kh 1, ζ 0.1)"


@claim("Fig. 3", "the faster, the smaller the contact")
def faster_smaller() -> Judged:
    a = [at(0.4, 1.0, 0.05, zeta).half_width for zeta in SPEEDS]
    back = [at(0.1, 1.0, 0.13, zeta).half_width for zeta in (0.1, 1.0, 10.0)]
    numbers = f"ã {listed(a)} at ζ 0.01 to 100 (R̃ 0.4, kh 1, p̃ₘ 0.05); it grows again where Δ > R: {listed(back)}"
    return verdict(falling(a) and falling(back), falling(a)), f"{numbers} at ζ 0.1, 1, 10 (R̃ 0.1, p̃ₘ 0.13)"


@claim("Fig. 3", "the faster, the smaller ã at which steep turns to slow")
def earlier_turn() -> Judged:
    loads, turns = np.geomspace(0.005, 0.3, 16), []
    for zeta in (0.1, 1.0, 10.0):
        log_a = np.log([at(0.4, 1.0, load, zeta).half_width for load in loads])
        growth = np.gradient(log_a, np.log(loads))
        last = int(np.flatnonzero(growth > 0.5)[-1])
        pair = [last + 1, last]
        turns.append(float(np.exp(np.interp(0.5, growth[pair], log_a[pair]))))
    return verdict(falling(turns), falling(turns[:2])), (
        f"d ln ã/d ln p̃ₘ falls through ½ (Hertz) at ã {listed(turns, '.2f')}, ζ 0.1, 1, 10 (R̃ 0.4, kh 1)"
    )


@claim("Fig. 3", "the thinner layer has the larger contact at every load")
def thinner_wider() -> Judged:
    ratio = [
        at(0.4, 0.8, load, zeta).half_width / at(0.4, 1.0, load, zeta).half_width
        for load in (0.001, 0.01, 0.03, 0.13, 0.3)
        for zeta in (0.1, 1.0, 10.0)
    ]
    return verdict(min(ratio) > 1.0), (
        f"ã(kh 0.8)/ã(kh 1) {min(ratio):.2f} to {max(ratio):.2f} over p̃ₘ 0.001 to 0.3, ζ 0.1, 1, 10 (R̃ 0.4)"
    )


@claim("Fig. 4", "friction is a bell of speed; slow and fast belts are elastic, the slow one softer")
def bell() -> Judged:
    slow, fast = at(0.4, 1.0, 0.13, 1e-3), at(0.4, 1.0, 0.13, 1e3)
    ends = [each.friction / peak(0.4, 1.0, 0.13)[1] for each in (slow, fast)]
    holds = max(ends) < 0.01 and slow.half_width > fast.half_width
    return verdict(holds), (
        f"μ {listed(ends, '.4f')} of its peak, ã {slow.half_width:.3f}, {fast.half_width:.3f} at ζ 0.001, 1000 "
        "(R̃ 0.4, kh 1, p̃ₘ 0.13)"
    )


@claim("Eq. (10)", "the loss factor of the rubber peaks at ωτ ≈ 1")
def loss_peak() -> Judged:
    creep = CreepSpectrum(1.0 / MODULUS_RATIO, [1.0 - 1.0 / MODULUS_RATIO], [1.0])
    omega = np.geomspace(0.1, 10.0, 20001)
    j = creep.compliance(omega)
    place = float(omega[np.argmax(j.imag / np.abs(j))])
    return verdict(abs(math.log(place)) < math.log(1.5)), (
        f"at ωτ = {place:.2f} with τ of Eq. (6), {place / MODULUS_RATIO:.3f} with the relaxation time: "
        "√(E∞/E₀), √(E₀/E∞)"
    )


@claim("Fig. 4", "friction peaks at ζ ≈ 1")
def peak_at_one() -> Judged:
    heavy = [peak(radius, h, 0.13)[0] for h in (1.0, 0.8) for radius in RADII]
    light = [peak(radius, 1.0, 0.001)[0] for radius in RADII]
    near = [max(place, 1.0 / place) < 3.0 for place in (*heavy, *light)]
    return verdict(all(near), all(near[: len(heavy)])), (
        f"ζ {listed(heavy[:4], '.2f')} (kh 1), {listed(heavy[4:], '.2f')} (kh 0.8) at p̃ₘ 0.13; {listed(light, '.2f')} "
        "(kh 1) at p̃ₘ 0.001; R̃ 0.1, 0.2, 0.3, 0.4"
    )


@claim("Fig. 4, section 4", "thick layer: a smaller roll shifts the peak up and to lower speed")
def thick_shift() -> Judged:
    places, tops = zip(*(peak(radius, 1.0, 0.13) for radius in RADII), strict=True)
    return verdict(falling(tops) and falling(places[::-1]), places[0] < places[-1] and falling(tops[1:])), (
        f"from R̃ 0.4 to 0.1 at kh 1, p̃ₘ 0.13: μ {listed(tops[::-1])}, ζ {listed(places[::-1], '.2f')}"
    )


@claim("Fig. 4, section 4", "thin layer: a smaller roll shifts the peak up only")
def thin_shift() -> Judged:
    places, tops = zip(*(peak(radius, 0.8, 0.13) for radius in RADII), strict=True)
    return verdict(falling(tops) and max(places) < 1.2 * min(places), falling(tops)), (
        f"from R̃ 0.4 to 0.1 at kh 0.8, p̃ₘ 0.13: μ {listed(tops[::-1])}, ζ {listed(places[::-1], '.2f')}"
    )


@claim("Fig. 4", "thick layer: the peak's ζ is about R̃ (a ≈ R)")
def peak_at_radius() -> Judged:
    light, heavy = ([peak(radius, 1.0, load)[0] / radius for radius in RADII] for load in (0.001, 0.13))
    near = [max(ratio, 1.0 / ratio) < 2.0 for ratio in (*light, *heavy)]
    return verdict(all(near), all(near[:4])), (
        f"ζ/R̃ {listed(light, '.2f')} at p̃ₘ 0.001, {listed(heavy, '.1f')} at 0.13 (kh 1; R̃ 0.1, 0.2, 0.3, 0.4)"
    )


def thinned(load: float, radii: Sequence[float]) -> list[float]:
    """μ, and W̃_d as well, at kh 0.8 over kh 1."""
    return [at(r, 0.8, load, z).friction / at(r, 1.0, load, z).friction for r in radii for z in SPEEDS]


@claim("Fig. 4, section 4", "thinner layer, more friction")
def thinner_friction() -> Judged:
    light, heavy = thinned(0.001, RADII), thinned(0.13, RADII)
    odd = sum(ratio <= 1.0 for ratio in heavy)
    return verdict(min(light + heavy) > 1.0, min(light) > 1.0), (
        f"μ(kh 0.8)/μ(kh 1) {min(light):.3f} to {max(light):.3f} at p̃ₘ 0.001; {min(heavy):.3f} to {max(heavy):.3f} at "
        f"p̃ₘ 0.13, below 1 in {odd} of {len(heavy)} (R̃ 0.4, ζ 10)"
    )


@claim("Fig. 5", "τₘ falls with thickness to the half-space; it rises if the layer is confined, from zero")
def to_half_space() -> Judged:
    deep = at(0.4, math.inf, 0.02, 0.5, "half-space").friction
    free = [at(0.4, h, 0.02, 0.5).friction / deep for h in (0.5, 1.0, 2.0, 4.0, 10.0)]
    confined = [at(0.4, h, 0.02, 0.5, "confined").friction / deep for h in (0.001, 0.1, 1.0, 4.0)]
    holds = falling(free) and free[-1] < 1.0 + 1e-5 and falling(confined[::-1]) and confined[0] < 0.02
    return verdict(holds), (
        f"of the half-space: free {listed(free)} at kh 0.5, 1, 2, 4, 10; confined {listed(confined)} at kh 0.001, 0.1, "
        "1, 4 (R̃ 0.4, p̃ₘ 0.02, ζ 0.5)"
    )


@claim("Fig. 6", "dissipation vanishes at low speed, rises in 0.1 < ζ < 10, plateau beyond")
def plateau() -> Judged:
    scenes = [(0.1, 1.0), (0.3, 1.0), (0.1, 0.8), (0.3, 0.8)]
    full = [at(*each, 0.001, 1e6).dissipation for each in scenes]
    parts = [np.divide([at(*each, 0.001, z).dissipation for each in scenes], full) for z in (0.01, 0.1, 10.0)]
    return verdict(max(parts[0]) < 0.01 and max(parts[1]) < 0.2 and min(parts[2]) > 0.99), (
        f"of the plateau: {listed(parts[0], '.4f')} at ζ 0.01; {listed(parts[1], '.2f')} at 0.1; "
        f"{listed(parts[2])} at 10 ((R̃, kh) = (0.1, 1), (0.3, 1), (0.1, 0.8), (0.3, 0.8), p̃ₘ 0.001)"
    )


@claim("Fig. 6, section 4", "below a threshold ζ ≈ 0.1, mildly dependent on load, dissipation is small")
def threshold() -> Judged:
    zeta, places = np.geomspace(0.03, 3.0, 21), []
    for load in (0.001, 0.01, 0.1):
        part = [at(0.3, 1.0, load, z).dissipation / at(0.3, 1.0, load, 1e6).dissipation for z in zeta]
        places.append(float(np.exp(np.interp(math.log(0.1), np.log(part), np.log(zeta)))))
    return verdict(max(places) < 2.0 * min(places), 0.05 < places[0] < 0.2), (
        f"a tenth of the plateau at ζ {listed(places, '.2f')} for p̃ₘ 0.001, 0.01, 0.1 (R̃ 0.3, kh 1)"
    )


def roll_ratio(heavier: float, thickness: float, zeta: float) -> float:
    """W̃_d at R̃ 0.1 and p̃ₘ `heavier` times 0.001, over R̃ 0.3 and p̃ₘ 0.001."""
    small = at(0.1, thickness, heavier * 0.001, zeta).dissipation
    return small / at(0.3, thickness, 0.001, zeta).dissipation


def small_over_large(heavier: float) -> list[float]:
    return [roll_ratio(heavier, h, z) for h in (1.0, 0.8) for z in SPEEDS]


@claim("Fig. 6", "smaller roll, more dissipation, at one p̃ₘ")
def smaller_roll() -> Judged:
    ratio = small_over_large(1.0)
    equal = brentq(lambda x: math.log(roll_ratio(1.0, 1.0, 10.0**x)), -2.0, 0.0, xtol=1e-4)
    return verdict(min(ratio) > 1.0, min(ratio[2:5] + ratio[7:]) > 1.0), (
        f"W̃_d(R̃ 0.1)/W̃_d(R̃ 0.3) {listed(ratio[:5], '.2f')} (kh 1), {listed(ratio[5:], '.2f')} (kh 0.8) at ζ 0.01, 0.1, "
        f"1, 10, 100, p̃ₘ 0.001: so below ζ {10.0**equal:.3f} only (kh 1)"
    )


@claim("Section 4", "larger roll, less dissipation, at one load per roll")
def larger_roll() -> Judged:
    ratio = [0.1 / 0.3 * each for each in small_over_large(3.0)]
    return verdict(min(ratio) > 1.0), (
        f"W_d(R̃ 0.1)/W_d(R̃ 0.3) {listed(ratio[:5], '.2f')} (kh 1), {listed(ratio[5:], '.2f')} (kh 0.8) at ζ 0.01, 0.1, "
        "1, 10, 100; p̃ₘ 0.003 and 0.001, one pₘ"
    )


@claim("Fig. 6, section 4", "thinner layer, more dissipation")
def thinner_dissipation() -> Judged:
    ratio = thinned(0.001, (0.1, 0.3))
    return verdict(min(ratio) > 1.0), (
        f"W̃_d(kh 0.8)/W̃_d(kh 1) {listed(ratio[:5])} (R̃ 0.1), {listed(ratio[5:])} (R̃ 0.3) at ζ 0.01, 0.1, 1, 10, 100 "
        "(p̃ₘ 0.001)"
    )


def doubled(load: float, zeta: float, support: str = "free") -> float:
    low, high = (at(0.3, 1.0, p, zeta, support).dissipation for p in (load, 2.0 * load))
    return high / low


@claim("Fig. 7", "more load, more dissipation at any speed")
def more_load() -> Judged:
    factors = [doubled(0.001, zeta) for zeta in SPEEDS]
    return verdict(min(factors) > 1.0), (
        f"p̃ₘ 0.001 → 0.002: × {listed(factors, '.2f')} at ζ 0.01, 0.1, 1, 10, 100 (R̃ 0.3, kh 1)"
    )


@claim("Fig. 7", "plateau: load doubled, dissipation almost multiplied by four")
def almost_four() -> Judged:
    free = [doubled(load, 100.0) for load in (0.001, 0.002, 0.01, 0.05, 0.1)]
    confined = doubled(0.001, 100.0, "confined")
    return verdict(min(free) > 3.75, min(free[:3]) > 3.75 and confined < 3.75), (
        f"× {listed(free, '.2f')} from p̃ₘ 0.001, 0.002, 0.01, 0.05, 0.1; printed kernel × {confined:.2f} from 0.001 "
        "(R̃ 0.3, kh 1, ζ 100)"
    )


@claim("Fig. 7", "friction vanishes at high speed, dissipation stays finite")
def finite() -> Judged:
    high, higher = at(0.3, 1.0, 0.001, 1e3), at(0.3, 1.0, 0.001, 1e6)
    ratio = higher.dissipation / high.dissipation
    return verdict(abs(ratio - 1.0) < 1e-4 and higher.friction < 1.1e-3 * high.friction), (
        f"ζ 1000 → 1000000: μ {high.friction:.2e} → {higher.friction:.2e}, W̃_d × {ratio:.4f} (R̃ 0.3, kh 1, p̃ₘ 0.001)"
    )


def claim_row(place: str, words: str, judge: Callable[[], Judged]) -> str:
    """One row of the table of docs/paper.md."""
    holds, numbers = judge()
    return f"| {place} | {words} | **{holds}** | {numbers} |"


# Tests

NUMBER = re.compile(r"\d+(?:\.(\d+))?(?:e([+-]\d+))?")
ROWS = [line for line in DOCS.read_text(encoding="utf-8").splitlines() if line.startswith("| ") and "**" in line]


@pytest.mark.parametrize("number", range(len(CLAIMS)), ids=[judge.__name__ for _, _, judge in CLAIMS])
def test_claim_is_judged_as_printed(number):
    assert len(ROWS) == len(CLAIMS)
    ours, printed = claim_row(*CLAIMS[number]), ROWS[number]
    assert NUMBER.sub("#", ours) == NUMBER.sub("#", printed)
    for new, old in zip(NUMBER.finditer(ours), NUMBER.finditer(printed), strict=True):
        # both are rounded to the digits printed: figures that differ by 1e-6 differ by one unit at most
        unit = 10.0 ** (int(old[2] or 0) - len(old[1] or ""))
        assert float(new[0]) == pytest.approx(float(old[0]), rel=1e-12, abs=1.001 * unit)


@pytest.mark.parametrize(("name", "scenes"), [(2, 4), (3, 24), (4, 32), (5, 9), (6, 24), (7, 24)])
def test_every_point_of_a_figure_is_counted_and_answered(name, scenes, tmp_path):
    draw, _ = example.FIGURES[f"figure_{name}"]
    tally = example.save(draw, 4, tmp_path / "figure.png")
    assert (tally.single + tally.split, tally.refused) == (scenes, 0)
    assert (tmp_path / "figure.png").stat().st_size > 0


def test_split_contacts_are_circles_and_refused_ones_gaps():
    # p̃ₘ 2 presses the roll in beyond its half circle; (0.3, 0.8, 0.13, 1) has two strips (docs/method.md)
    scenes = [scene(0.4, 1.0, 0.05, 1.0), scene(0.4, 1.0, 2.0, 0.1), scene(0.3, 0.8, 0.13, 1.0)]
    tally = example.Tally()
    line = example.Line.of([1.0, 2.0, 3.0], tally.solved(scenes), lambda s: s.friction)
    assert (tally.single, tally.split, tally.refused) == (1, 1, 1)
    assert line.split.tolist() == [False, False, True]
    assert np.ma.getmaskarray(line.y).tolist() == [False, True, False]
    figure, ax = example.panels(1)
    line.draw(ax, "k")
    example.say(ax, 2.0, line.y[1], "nothing", "k")
    drawn, circles = ax.lines
    assert np.ma.getmaskarray(drawn.get_ydata()).tolist() == [False, True, False]
    assert circles.get_xdata().tolist() == [3.0]
    assert not ax.texts
    example.plt.close(figure)


def test_figures_of_the_docs_are_there_and_small():
    shown = re.findall(r"\(figures/(\w+)\.png\)", DOCS.read_text(encoding="utf-8"))
    assert shown == list(example.FIGURES)
    for name in shown:
        assert (DOCS.parent / "figures" / f"{name}.png").stat().st_size < 120_000


if __name__ == "__main__":
    sys.stdout.write("\n".join(claim_row(*each) for each in CLAIMS) + "\n")
