"""Rubbers whose truth is known, measured as isotherms: errors and coverage of the fit, beside plain NNLS and pyvisco.

    python benchmarks/families.py [--seeds N] [--noise 0.01 0.02 0.03] [--family NAME ...] [--write FILE]

Each rubber is "measured" at nine temperatures, -16 to 38 degC, at ten frequencies, 0.1 to 100 Hz, with independent
lognormal noise of E' and E''. A file goes in as a laboratory's would, through `conveyor.compound_file.fit_file`.
Errors are relative to the truth, over the window of the master curve at 20 degC; friction is that of a
159 mm roll on 4 mm of cover at 5 m/s, 3 N/mm and 10 degC. The last four families were kept out of all choices.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from conveyor.compound_file import Request, fit_file
from conveyor.contact import solve_many
from conveyor.errors import ConveyorError
from conveyor.indentation import RollContact, to_problem
from conveyor.rubber import WLF, Arrhenius, PronySeries

CELSIUS = 273.15
REFERENCE = 20.0 + CELSIUS
TEMPERATURES = np.array([-16.0, -10.0, -4.0, 2.0, 8.0, 14.0, 20.0, 29.0, 38.0]) + CELSIUS
FREQUENCY = np.logspace(-1.0, 2.0, 10)
PER_DECADE = 6
"""Lines of a truth: they ripple by 4 exp(-pi^2/0.38) = 3e-11."""
TIMES = np.logspace(-14.0, 7.0, 21 * PER_DECADE + 1)
CELL = np.log(10.0) / PER_DECADE
WARM = 10.0 + CELSIUS
CONTACT = RollContact(0.0795, 1.2, 0.004, 5.0, PronySeries(1e6, [1e6], [1.0]))
LINE_LOAD = 3e3


@dataclass(frozen=True)
class Rubber:
    """A truth: series at 20 degC, decades of time and factor of the moduli at a temperature [K]."""

    series: PronySeries
    shift: Callable[[float], float]
    vertical: Callable[[float], float] = lambda t: 1.0

    def at(self, temperature: float) -> PronySeries:
        return self.series.scaled(a_T=10.0 ** self.shift(temperature), b_T=self.vertical(temperature))


def smooth(equilibrium: float, spectrum: np.ndarray) -> PronySeries:
    """A series of a continuous spectrum H over ln tau, at TIMES."""
    moduli = spectrum * CELL
    kept = moduli > 1e-12 * equilibrium
    return PronySeries(equilibrium, moduli[kept], TIMES[kept])


def hump(centre: float, width: float) -> np.ndarray:
    return np.exp(-0.5 * ((np.log10(TIMES) - centre) / width) ** 2)


def havriliak(alpha: float, beta: float, time: float) -> np.ndarray:
    """Spectrum of 1 - 1/(1 + (i w tau)^alpha)^beta: Tschoegl (1989), Eq. 6.1-82."""
    x = (TIMES / time) ** alpha
    angle = np.arctan2(np.sin(np.pi * alpha), x + np.cos(np.pi * alpha))
    size = (1.0 + 2.0 * x * np.cos(np.pi * alpha) + x * x) ** (-0.5 * beta)
    return x**beta * np.sin(beta * angle) * size / np.pi


_WLF = WLF(7.5, 150.0, REFERENCE)
_ARRHENIUS = Arrhenius(150e3, REFERENCE)


def wlf(t: float) -> float:
    return float(_WLF.log10_a_T(t))


def wlf_and_arrhenius(t: float) -> float:
    return wlf(t) if t < REFERENCE else float(_ARRHENIUS.log10_a_T(t))


_CUT = np.exp(-1e-11 / TIMES - TIMES / 1e4)
_LN = np.log10(TIMES)
FAMILIES = {
    "power law": Rubber(smooth(2e6, 5.5e5 * TIMES**-0.25 * _CUT), wlf),
    "two sharp terms": Rubber(PronySeries(3e6, [2e6, 6e6], [3e-2, 3e-4]), wlf),
    "fractional Zener": Rubber(smooth(2.2e6, 1.2e7 * havriliak(0.7, 1.0, 3e-3)), wlf),
    "stretched": Rubber(
        smooth(2.5e6, 4e7 * np.sqrt(TIMES / 2e-5) * np.exp(-TIMES / 8e-5) / (2.0 * np.sqrt(np.pi))), wlf
    ),
    "plateau": Rubber(smooth(6e6, 8e4 * _CUT + 2e8 * hump(-9.5, 1.0)), wlf),
    "butyl": Rubber(smooth(1.5e6, 1.5e7 * hump(-5.5, 1.6) + 1.2e6 * hump(-2.0, 1.2)), wlf),
    "entropic": Rubber(smooth(3.5e6, 1.1e5 * TIMES**-0.5 * _CUT), wlf, lambda t: t / REFERENCE),
    "WLF, Arrhenius": Rubber(smooth(3e6, 8e6 * hump(-5.0, 1.5)), wlf_and_arrhenius),
    "Davidson-Cole": Rubber(smooth(4e6, 3e8 * havriliak(0.999, 0.4, 1e-4)), wlf),
    "lines a decade apart": Rubber(PronySeries(2e6, 4e5 * 10 ** np.linspace(3.0, 0.0, 11), np.logspace(-8, 2, 11)), wlf),
    "filled": Rubber(smooth(5e6, 3e5 * _CUT + 3e7 * hump(-7.0, 1.2)), lambda t: 1.4 * wlf(t)),
    "softening": Rubber(smooth(4e6, 5e6 * hump(-4.0, 2.0)), wlf, lambda t: (REFERENCE / t) ** 2),
}  # fmt: skip
HELD_OUT = ("Davidson-Cole", "lines a decade apart", "filled", "softening")


@dataclass(frozen=True)
class Judged:
    """One fit against its truth: errors over the window [-], shares inside the band, seconds."""

    storage: np.ndarray
    loss: np.ndarray
    storage_inside: np.ndarray
    loss_inside: np.ndarray
    shift: np.ndarray
    shift_z: np.ndarray
    vertical_z: np.ndarray
    friction: float
    friction_inside: bool
    width: float
    terms: int
    seconds: float


def measured(rubber: Rubber, noise: float, seed: int) -> str:
    """CSV of one measurement."""
    rng = np.random.default_rng(seed)
    lines = ["T [degC],frequency [Hz],E' [MPa],E'' [MPa]"]
    for t in TEMPERATURES:
        series = rubber.at(t)
        omega = 2.0 * np.pi * FREQUENCY
        scatter = np.exp(noise * rng.standard_normal((2, omega.size)) - 0.5 * noise * noise)
        e1, e2 = series.storage(omega) * scatter[0] / 1e6, series.loss(omega) * scatter[1] / 1e6
        lines += [
            f"{t - CELSIUS:g},{f:.9g},{a:.9g},{b:.9g}" for f, a, b in zip(FREQUENCY, e1, e2, strict=True)
        ]
    return "\n".join(lines) + "\n"


def friction(series: list[PronySeries]) -> np.ndarray:
    problems = [to_problem(replace(CONTACT, rubber=one), LINE_LOAD) for one in series]
    return np.array([found.friction for found in solve_many(problems, rtol=1e-4, throw=True)])


def quantiles(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    from conveyor.studies.compared import ends

    pairs = np.array([ends(column) for column in np.asarray(values).T.reshape(-1, len(values))])
    return pairs[:, 0], pairs[:, 1]


def judged(rubber: Rubber, noise: float, seed: int, *, vertical: bool, replicas: int) -> Judged:
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "rubber.csv"
        data.write_text(measured(rubber, noise, seed))
        start = time.perf_counter()
        found = fit_file(data, Request("x", "20 degC", vertical=vertical, replicas=replicas))
        seconds = time.perf_counter() - start
    shifts = found.superposition
    omega = 2.0 * np.pi * np.geomspace(*found.fit.window, 60)
    series, others = found.compound.series(REFERENCE), found.compound.replicas(REFERENCE)
    true1, true2 = rubber.series.storage(omega), rubber.series.loss(omega)
    low1, high1 = quantiles(np.array([one.storage(omega) for one in others]))
    low2, high2 = quantiles(np.array([one.loss(omega) for one in others]))
    away = shifts.temperatures != REFERENCE
    error = (shifts.log10_a_T - [rubber.shift(t) for t in shifts.temperatures])[away]
    error_b = (shifts.log10_b_T - np.log10([rubber.vertical(t) for t in shifts.temperatures]))[away]
    warm = [found.compound.series(WARM), *found.compound.replicas(WARM), rubber.at(WARM)]
    mu = friction(warm)
    low, high = quantiles(mu[1:-1, None])
    return Judged(
        storage=series.storage(omega) / true1 - 1.0,
        loss=series.loss(omega) / true2 - 1.0,
        storage_inside=(low1 <= true1) & (true1 <= high1),
        loss_inside=(low2 <= true2) & (true2 <= high2),
        shift=error,
        shift_z=error / shifts.log10_a_T_error[away],
        vertical_z=error_b / shifts.log10_b_T_error[away] if vertical else np.zeros(0),
        friction=float(mu[0] / mu[-1] - 1.0),
        friction_inside=bool(low[0] <= mu[-1] <= high[0]),
        width=float((high[0] - low[0]) / 2.0 / mu[0]),
        terms=found.fit.active_terms,
        seconds=seconds,
    )


def rms(values: object) -> float:
    return float(np.sqrt(np.mean(np.square(np.asarray(values, dtype=float)))))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--noise", type=float, nargs="*", default=[0.01, 0.02, 0.03])
    parser.add_argument("--family", nargs="*", default=list(FAMILIES))
    parser.add_argument("--vertical", action="store_true")
    parser.add_argument("--replicas", type=int, default=20)
    asked = parser.parse_args()
    print(
        f"{'family':22s}  noise  E'%   E''%  worst  shift   z_a  z_b  fric%  | cover E'  E''  fric  half  terms s fail"
    )
    for name in asked.family:
        for noise in asked.noise:
            found, failures = [], []
            for seed in range(asked.first, asked.first + (asked.seeds if noise else 1)):
                try:
                    found.append(
                        judged(FAMILIES[name], noise, seed, vertical=asked.vertical, replicas=asked.replicas)
                    )
                except ConveyorError as error:
                    failures.append(str(error))
            if not found:
                print(name, noise, "failed", failures[0][:150])
                continue
            print(
                f"{name:22s} {100 * noise:4.1f}%"
                f" {100 * rms([f.storage for f in found]):6.2f} {100 * rms([f.loss for f in found]):6.2f}"
                f" {100 * max(max(np.abs(f.storage).max(), np.abs(f.loss).max()) for f in found):6.1f}"
                f" {rms([f.shift for f in found]):7.4f} {rms([f.shift_z for f in found]):5.2f}"
                f" {rms([f.vertical_z for f in found]) if asked.vertical else 0:5.2f}"
                f" {100 * rms([f.friction for f in found]):6.2f} |"
                f" {100 * np.mean([f.storage_inside for f in found]):5.0f}"
                f" {100 * np.mean([f.loss_inside for f in found]):5.0f}"
                f" {100 * np.mean([f.friction_inside for f in found]):5.0f} {100 * np.mean([f.width for f in found]):5.2f}"
                f" {np.mean([f.terms for f in found]):5.1f} {np.median([f.seconds for f in found]):5.2f} {len(failures)}",
                flush=True,
            )
            for line in failures[:1]:
                print("      ", line[:200])


if __name__ == "__main__":
    main()
