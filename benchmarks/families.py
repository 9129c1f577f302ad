"""Rubbers whose truth is known, measured as isotherms: errors and coverage of the fit, beside plain NNLS and pyvisco.

    python benchmarks/families.py [--seeds N] [--noise 0.01 0.02 0.03] [--family NAME ...]
    python benchmarks/families.py --wrong

Each rubber is "measured" at nine temperatures, -16 to 38 degC, at ten frequencies, 0.1 to 100 Hz, with independent
lognormal noise of E' and E'', and goes in as a laboratory's file would, through
`conveyor.fitting.fitted_compound.fit_file`.
Errors are relative to the truth: root mean squares over the window of the master curve at 20 degC, and of log10 a_T;
the friction of a 159 mm roll on 4 mm of cover at 5 m/s, 3 N/mm and 10 degC. Printed is the median of all fits of a
family; friction has its worst, too. Coverage is the share of the truth inside the 90 % band of 20 replicas, and beside
it stands the median half-width of that band. `--wrong` takes the ten rubbers measured with drawn errors: 300 fits.
The four families of `HELD_OUT` took no part in any choice. NNLS is `scipy.optimize.nnls` on errors relative to
the data, two times a decade inside the window, on the master curve as shifted here.

The figures of pyvisco stand in pyvisco.csv, with its version. To measure them again, in an environment that has it:

    python benchmarks/families.py --export FOLDER
    python benchmarks/pyvisco_fits.py FOLDER FITS.json
    python benchmarks/families.py --pyvisco FITS.json > benchmarks/pyvisco.csv
"""

from __future__ import annotations

import argparse
import csv
import json
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from conveyor.contact import solve_many
from conveyor.errors import ConveyorError
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.indentation import RollContact, to_problem
from conveyor.rubber import WLF, Arrhenius, PronySeries
from conveyor.studies.comparison_scenes import quantile_band

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
    vertical: Callable[[float], float] = lambda _: 1.0
    phase: float = 0.0
    """Error of the instrument: E'' grows by this share a decade of measured frequency [-]."""
    right: float = 10.0
    """Frequency at which the instrument tells the phase rightly [Hz]."""
    lag: float = 0.0
    """Time lag of the instrument: E'' grows by this share up to the highest frequency, in proportion to it [-]."""
    clamps: float = 0.0
    """Error of clamping: both moduli grow by this share per 10 K of cold [-]."""
    drawn: bool = False
    """True if errors are drawn anew for every measurement: E'' by up to 30 % over the frequencies, either way, by
    decades or in proportion to frequency; clamps up to 8 %."""

    def at(self, temperature: float) -> PronySeries:
        """The series at a temperature [K]."""
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
    "lines": Rubber(PronySeries(2e6, 4e5 * 10 ** np.linspace(3.0, 0.0, 11), np.logspace(-8, 2, 11)), wlf),
    "filled": Rubber(smooth(5e6, 3e5 * _CUT + 3e7 * hump(-7.0, 1.2)), lambda t: 1.4 * wlf(t)),
    "softening": Rubber(smooth(4e6, 5e6 * hump(-4.0, 2.0)), wlf, lambda t: (REFERENCE / t) ** 2),
}  # fmt: skip
FAMILIES |= {
    f"{name}, {fault}": replace(FAMILIES[name], **errors)
    for name in ("filled", "butyl")
    for fault, errors in (
        ("phase error 5 % a decade", {"phase": 0.05}),
        ("phase error 15 % a decade", {"phase": 0.15}),
        ("clamps 4 % per 10 K", {"clamps": 0.04}),
        ("clamps 8 % per 10 K", {"clamps": 0.08}),
        ("both, 10 % and 4 %", {"phase": 0.10, "clamps": 0.04}),
        ("time lag, 20 % at 100 Hz", {"lag": 0.20}),
    )
}
"""Rubbers measured wrongly: the band has to hold the truth all the same."""
WRONG = tuple(name for name, rubber in FAMILIES.items() if rubber.phase or rubber.clamps or rubber.lag)
HELD_OUT = ("Davidson-Cole", "lines", "filled", "softening")
VERTICAL = ("entropic", "softening")
DRAWN = {
    f"{name}, drawn errors": replace(rubber, drawn=True)
    for name, rubber in FAMILIES.items()
    if name not in (*WRONG, *VERTICAL)
}
FAMILIES |= DRAWN
"""Rubbers without vertical shift of their own, measured with errors that are drawn: 300 fits."""


PEER = Path(__file__).with_name("pyvisco.csv")


@dataclass(frozen=True)
class Judged:
    """One fit against its truth: errors over the window and of friction [-], shares inside the band."""

    storage: float
    loss: float
    friction: float
    shift: float = np.nan
    shift_z: float = np.nan
    vertical_z: float = np.nan
    storage_inside: float = np.nan
    loss_inside: float = np.nan
    friction_inside: float = np.nan
    storage_width: float = np.nan
    loss_width: float = np.nan
    friction_width: float = np.nan
    terms: int = 0
    seconds: float = np.nan


def with_drawn_errors(rubber: Rubber, noise: float, seed: int) -> Rubber:
    """The rubber with errors of one measurement, evenly drawn."""
    rng = np.random.default_rng([seed, round(1e3 * noise)])
    decades = np.log10(FREQUENCY[-1] / FREQUENCY[0])
    whole = (1.0 + rng.uniform(0.0, 0.3)) ** rng.choice([-1.0, 1.0])
    rubber = replace(rubber, right=FREQUENCY[0] * 10.0 ** rng.uniform(0.0, decades), clamps=rng.uniform(0.0, 0.08))
    if rng.integers(2):
        return replace(rubber, lag=whole - 1.0)
    return replace(rubber, phase=whole ** (1.0 / decades) - 1.0)


def rows(rubber: Rubber, noise: float, seed: int) -> np.ndarray:
    """One measurement: temperature [K], frequency [Hz], E' and E'' [Pa], shape `(temperatures, 4, frequencies)`."""
    rng = np.random.default_rng(seed)
    omega = 2.0 * np.pi * FREQUENCY
    found = []
    rubber = with_drawn_errors(rubber, noise, seed) if rubber.drawn else rubber
    for t in TEMPERATURES:
        series = rubber.at(t)
        scatter = np.exp(noise * rng.standard_normal((2, omega.size)) - 0.5 * noise * noise)
        moduli = np.array([series.storage(omega), series.loss(omega)]) * scatter
        moduli *= (1.0 + rubber.clamps) ** ((REFERENCE - t) / 10.0)
        moduli[1] *= (1.0 + rubber.phase) ** np.log10(FREQUENCY / rubber.right)
        moduli[1] *= 1.0 + rubber.lag * FREQUENCY / FREQUENCY[-1]
        found.append([np.full_like(omega, t), FREQUENCY, *moduli])
    return np.array(found)


def written(measured: np.ndarray, header: str, *, sets: bool) -> str:
    lines = [header]
    for k, sheet in enumerate(measured):
        lines += [
            f"{f:.9g},{a / 1e6:.9g},{b / 1e6:.9g},{t - CELSIUS:g}" + (f",{k}" if sets else "") for t, f, a, b in sheet.T
        ]
    return "\n".join(lines) + "\n"


def friction(series: list[PronySeries]) -> np.ndarray:
    problems = [to_problem(replace(CONTACT, series=one), LINE_LOAD) for one in series]
    return np.array([found.friction for found in solve_many(problems, rtol=1e-4, throw=True)])


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def errors(rubber: Rubber, series: PronySeries, warm: PronySeries, omega: np.ndarray) -> dict[str, float]:
    """Of E', E'' at 20 degC and of friction at 10 degC."""
    mu = friction([warm, rubber.at(WARM)])
    return {
        "storage": rms(series.storage(omega) / rubber.series.storage(omega) - 1.0),
        "loss": rms(series.loss(omega) / rubber.series.loss(omega) - 1.0),
        "friction": float(mu[0] / mu[1] - 1.0),
    }


def share(values: list[np.ndarray], truth: np.ndarray) -> float:
    """Of the truth inside the ends of its replicas, shape `(replicas, n)`."""
    inside = [
        low <= true <= high for (low, high), true in zip(map(quantile_band, np.array(values).T), truth, strict=True)
    ]
    return float(np.mean(inside))


def half_width(values: list[np.ndarray]) -> float:
    """Half of the ratio of the band's ends less one, median over the window; replicas of shape `(replicas, n)`."""
    return float(np.median([0.5 * (high / low - 1.0) for low, high in map(quantile_band, np.array(values).T)]))


def judged(rubber: Rubber, noise: float, seed: int, *, vertical: bool) -> tuple[Judged, Judged | None]:
    """Ours, and plain NNLS; None where that gives up or finds a fluid."""
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "rubber.csv"
        data.write_text(written(rows(rubber, noise, seed), "frequency [Hz],E' [MPa],E'' [MPa],T [degC]", sets=False))
        start = time.perf_counter()
        found = fit_file(data, Request("x", "20 degC", vertical=vertical))
        seconds = time.perf_counter() - start
    shifts, compound = found.superposition, found.compound
    omega = 2.0 * np.pi * np.geomspace(*found.fit.window, 60)
    others, warm = compound.replicas(REFERENCE), compound.replicas(WARM)
    mus = friction(list(warm))
    away = shifts.temperatures != REFERENCE
    error = (shifts.log10_a_T - [rubber.shift(t) for t in shifts.temperatures])[away]
    error_b = (shifts.log10_b_T - np.log10([rubber.vertical(t) for t in shifts.temperatures]))[away]
    ours = Judged(
        **errors(rubber, compound.series(REFERENCE), compound.series(WARM), omega),
        shift=rms(error),
        shift_z=rms(error / shifts.log10_a_T_error[away]),
        vertical_z=rms(error_b / shifts.log10_b_T_error[away]) if np.all(shifts.log10_b_T_error[away]) else np.nan,
        storage_inside=share([one.storage(omega) for one in others], rubber.series.storage(omega)),
        loss_inside=share([one.loss(omega) for one in others], rubber.series.loss(omega)),
        friction_inside=share([[mu] for mu in mus], friction([rubber.at(WARM)])),
        storage_width=half_width([one.storage(omega) for one in others]),
        loss_width=half_width([one.loss(omega) for one in others]),
        friction_width=half_width([[mu] for mu in mus]),
        terms=found.fit.active_terms,
        seconds=seconds,
    )
    try:
        f, storage, loss = found.rows.curve
        plain = nnls_series(2.0 * np.pi * f, storage, loss)
    except (RuntimeError, ConveyorError):
        return ours, None
    a, b = (np.interp(WARM, shifts.temperatures, row) for row in shifts.shifts)
    return ours, Judged(**errors(rubber, plain, plain.scaled(a_T=10.0**a, b_T=10.0**b), omega))


def nnls_series(omega: np.ndarray, storage: np.ndarray, loss: np.ndarray) -> PronySeries:
    """Two times a decade inside the window, errors relative to the data."""
    from scipy.optimize import nnls

    low, high = -np.log10(omega.max()), -np.log10(omega.min())
    times = np.logspace(low, high, round(2.0 * (high - low)) + 1)
    x = np.outer(omega, times)
    top = np.column_stack([np.ones_like(omega), x * x / (1.0 + x * x)]) / storage[:, None]
    below = np.column_stack([np.zeros_like(omega), x / (1.0 + x * x)]) / loss[:, None]
    matrix = np.vstack([top, below]) * 1e6
    moduli = nnls(matrix, np.ones(2 * omega.size))[0] * 1e6
    return PronySeries(moduli[0], moduli[1:][moduli[1:] > 0.0], times[moduli[1:] > 0.0])


def peer(rubber: Rubber, fit: dict[str, list[float]]) -> Judged:
    """A fit of pyvisco: moduli [MPa], times [s], shifts. Its moduli add up to the glassy one, or nearly: a fluid."""
    moduli = np.array(fit["moduli"]) * 1e6
    series = PronySeries(max(fit["equilibrium"] * 1e6, 1e-6 * moduli.sum()), moduli, fit["times"])
    t = np.array(fit["temperatures"]) + CELSIUS
    omega = 2.0 * np.pi * np.geomspace(*fit["window"], 60)
    warm = series.scaled(a_T=10.0 ** np.interp(WARM, t, fit["log10_aT"]))
    away = t != REFERENCE
    error = (np.array(fit["log10_aT"]) - [rubber.shift(one) for one in t])[away]
    return Judged(**errors(rubber, series, warm, omega), shift=rms(error))


def median(found: list[Judged], name: str) -> float:
    return float(np.median([abs(getattr(one, name)) for one in found]))


def columns(found: list[Judged]) -> list[float]:
    """E', E'' [%], shift [decades], friction and its worst [%]."""
    return [
        100.0 * median(found, "storage"),
        100.0 * median(found, "loss"),
        median(found, "shift"),
        100.0 * median(found, "friction"),
        100.0 * max(abs(one.friction) for one in found),
    ]


def printed(label: str, found: list[tuple[Judged, Judged | None]], failed: int, other: dict[str, str]) -> None:
    ours, plain = [one for one, _ in found], [one for _, one in found if one is not None]
    e1, e2, shift, mu, worst = columns(ours)
    cover = [100.0 * float(np.mean([getattr(o, f"{k}_inside") for o in ours])) for k in ("storage", "loss", "friction")]
    wide = [100.0 * median(ours, f"{k}_width") for k in ("storage", "loss", "friction")]
    z = [rms(np.array([getattr(one, f"{k}_z") for one in ours])) for k in ("shift", "vertical")]
    n1, n2, _, nmu, nworst = columns(plain) if plain else [np.nan] * 5
    parts = (
        f"{label:34s} {e1:5.2f} {e2:5.2f} {shift:6.4f} {mu:5.2f} {worst:5.1f}",
        f"{cover[0]:3.0f} {cover[1]:3.0f} {cover[2]:4.0f}",
        f"{wide[0]:5.2f} {wide[1]:5.2f} {wide[2]:5.2f}",
        f"{z[0]:4.1f} {z[1]:4.1f}",
        f"{failed:2d}",
        f"{n1:5.2f} {n2:5.2f} {nmu:5.2f} {nworst:5.1f} {len(ours) - len(plain):2d}",
        " ".join(other.values()),
    )
    print(*parts, sep=" | ", flush=True)


def export(folder: Path, noises: list[float], seeds: int) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    header = "f,E_stor,E_loss,T,Set\nHz,MPa,MPa,C,-"
    for name, rubber in FAMILIES.items():
        for noise in noises:
            for seed in range(seeds):
                text = written(rows(rubber, noise, seed), header, sets=True)
                (folder / f"{name};{noise:g};{seed}.csv").write_text(text)


def judge_peer(path: Path) -> None:
    """Print the table of pyvisco.csv."""
    fits = json.loads(path.read_text())
    print(f"# pyvisco {fits.pop('version')}, defaults: shift by power laws, smooth(win=1), one term a decade")
    print("family,storage_percent,loss_percent,shift_decades,friction_percent,worst_friction_percent,failed")
    for name, rubber in FAMILIES.items():
        found, failed = [], 0
        for key, fit in fits.items():
            if key.split(";")[0] == name:
                try:
                    found.append(peer(rubber, fit))
                except (ConveyorError, KeyError):
                    failed += 1
        figures = [f"{x:.3g}" for x in columns(found)] if found else ["-"] * 5
        print(",".join([f'"{name}"', *figures, f"{failed} of {failed + len(found)}"]))


def compare(names: list[str], noises: list[float], seeds: int) -> None:
    with PEER.open() as stream:
        peers = {row.pop("family"): row for row in csv.DictReader(line for line in stream if line[0] != "#")}
    print(
        f"{'family':34s} E'%   E''%  shift  mu%  worst | inside E' E'' mu | +- E'% E''% mu% | z_a z_b | failed"
        " | NNLS E'% E''% mu% worst failed | pyvisco E'% E''% shift mu% worst failed"
    )
    every: dict[str, list[tuple[Judged, Judged | None]]] = {
        "the eight": [], "held out": [], "measured wrongly": [], "drawn errors": []
    }  # fmt: skip
    failures: dict[str, list[str]] = {label: [] for label in every}
    for name, vertical in [(n, v) for n in names for v in ((True, False) if n in VERTICAL else (False,))]:
        found, failed = [], []
        for noise, seed in [(x, k) for x in noises for k in range(seeds if x else 1)]:
            try:
                found.append(judged(FAMILIES[name], noise, seed, vertical=vertical))
            except ConveyorError as error:
                failed.append(f"{name}, {noise:g}, seed {seed}: {error}")
        label = name + (", --vertical" if vertical else ", advice not taken" if name in VERTICAL else "")
        if found:
            printed(label, found, len(failed), peers.get(name, {}))
        if name not in VERTICAL or vertical:
            group = (
                "measured wrongly"
                if name in WRONG
                else "drawn errors"
                if name in DRAWN
                else "held out"
                if name in HELD_OUT
                else "the eight"
            )
            every[group] += found
            failures[group] += failed
    for group, found in every.items():
        if found:
            printed(f"{group}, {len(found)} fits", found, len(failures[group]), {})
    ours = [one for both in every.values() for one, _ in both]
    print(f"{median(ours, 'seconds'):.2f} s a file, {median(ours, 'terms'):.0f} terms (median)")
    print(*(line for lines in failures.values() for line in lines), sep="\n")


def main() -> None:
    parser = argparse.ArgumentParser(description="Errors and coverage of conveyor fit on rubbers of known truth.")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--noise", type=float, nargs="*", default=[0.01, 0.02, 0.03])
    parser.add_argument("--family", nargs="*", default=list(FAMILIES))
    parser.add_argument("--wrong", action="store_true")
    parser.add_argument("--export", type=Path)
    parser.add_argument("--pyvisco", type=Path)
    asked = parser.parse_args()
    if asked.export:
        export(asked.export, asked.noise, asked.seeds)
    elif asked.pyvisco:
        judge_peer(asked.pyvisco)
    else:
        compare(list(DRAWN) if asked.wrong else asked.family, asked.noise, asked.seeds)


if __name__ == "__main__":
    main()
