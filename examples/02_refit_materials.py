"""Rebuild the shelf of compounds: fit the measured master curves, construct the illustrative covers.

Run it as ``python examples/02_refit_materials.py [FOLDER]``; without a folder it rewrites materials/*.yaml
beside the master curves it reads. It is deterministic: a test holds the committed files against it.

The illustrative covers are NOT measurements. Each has a continuous relaxation spectrum of a glass transition, the sum
of those of its rubbers, and a broad tail of network and filler,

    H(tau) = A sum_k phi_k g(tau/tau_k) + B n(tau)                                                  [Pa]
    g(x) = 1/(x^0.6 + x^-0.3)                              glass transition, Rouse-like on its slow side
    n = (tau/tau_s)^-0.12 exp(-sqrt(tau/tau_s))/(1 + tau_g/tau)    network and filler, broad, ends at tau_s

phi_k is the share of a rubber in the blend (rubbers of different kind stay in phases of their own), tau_k = 100 s at
its glass temperature, carried to 20 degC by the WLF law with the universal constants. The blend has the law of its
mean glass temperature, and tau_g with it. Sampled at two lines a decade, 1e-14 to 1e4 s, its tan delta ripples by
4 exp(-pi^2/1.15) = 0.08 %. A, B and the equilibrium modulus solve three linear equations: E' and E'' at 20 degC and
10 Hz, and E_inf.

What is not known of them in the cold is drawn: glass temperatures, shares of the rubbers, WLF constants, both slopes
of the transition, E_inf and the slope of the tail. Every draw meets the same E' and tan delta at 20 degC, 10 Hz, and
is a replica in `prony.band`.

The spectrum carries; the level of the indentation is that of published rolling-resistance tests at 20 degC: the law of
CEMA-7 for a low-resistance cover, and what a design program makes of it for others. Their Payne sweeps are Kraus' law
with the critical strain of the measured sweeps of S100 and S120, and more filler in the standard cover than in the
other two.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist

import numpy as np

from conveyor.fitting.fitted_compound import FittedCompound, Request, fit_file
from conveyor.rubber import WLF, KrausLaw, PronySeries
from conveyor.rubber.rolling_test_factor import DEVIATIONS_OF_90_PERCENT
from conveyor.shelf import dump

ZERO_CELSIUS = 273.15
SHELF = Path(__file__).resolve().parent.parent / "materials"

GLASS = {"NR": -66.0, "SBR": -51.0, "BR": -107.0}
"""Glass temperatures of vulcanized rubbers, the mean of two tables in one book: natural -60 and -72, styrene-butadiene
-52 and -50, butadiene -102 and -112 (Handbook of Plastics Technologies, McGraw-Hill 2006, tables 4.1, 4.2) [degC]."""
GLASS_OFF, SHARE_OFF = 6.0, 0.15
"""Half-widths of nine tenths: of a glass temperature, half the distance of the two tables [K]; of the share of the
first rubber in a blend, general knowledge [-]."""
SHAPE_OFF, GLASSY_OFF, TAIL_OFF, WLF_OFF = 0.07, 0.30, 0.03, (1.5, 5.0)
"""The same of both slopes of the transition [-], of ln E_inf [-], of the slope of the tail [-] and of the two WLF
constants at the glass temperature [-, K]: general knowledge."""
REPLICAS = 20
"""Draws of what is not known in the cold."""
UNIVERSAL_C1, UNIVERSAL_C2 = 17.44, 51.6
"""WLF constants at the glass transition, Williams, Landel and Ferry, J. Am. Chem. Soc. 77 (1955) 3701."""
TIME_AT_TG = 100.0
"""Relaxation time that defines the glass transition by convention [s]."""
REFERENCE = 20.0
"""Temperature of the targets [degC]."""
TARGET_FREQUENCY = 10.0
"""Frequency of the targets [Hz]."""
GLASSY = 1.5e9
"""E_inf of all three covers, as of a filled hydrocarbon rubber below T_g [Pa]."""
SLOWEST = 1.0e3
"""tau_s, where the network has settled at 20 degC [s]."""
TIMES = np.logspace(-14, 4, 37)
"""Two lines a decade [s]."""
REFERENCE_STRAIN = "0.4 %"
"""Of both master curves, inferred: near 0.4 % their sweeps at 1 Hz pass them at 10 and 30 degC."""


@dataclass(frozen=True)
class Measured:
    """A compound whose master curve lies on the shelf."""

    name: str
    description: str
    missing: tuple[str, ...]


@dataclass(frozen=True)
class Illustrative:
    """Targets of a constructed cover: E' [Pa] and tan delta at 20 degC, 10 Hz; shares of its rubbers."""

    name: str
    description: str
    storage: float
    tan_delta: float
    blend: dict[str, float]
    coldest: float  # sold down to [degC]
    far: float  # E' at large over E' at small strain at 20 degC
    peak: float  # E'' at the critical strain over E'' far from it
    level: float  # indentation over the published law's
    uncertainty: float  # of the level, half-width of nine tenths
    why: str  # source of the level


UNKNOWN = (
    "compound and its standard grade",
    "instrument and deformation mode",
    "strain amplitude of the master curve (0.4 % inferred from the sweeps)",
    "density",
    "Poisson ratio (0.5 assumed)",
    "vertical shift (none by the origin; b_T = T/T_ref inferred, with which E' and E'' agree)",
)
MEASURED = (
    Measured(
        "S100",
        "Filled rubber of tyre type, not a belt cover: master curve as published, raw. Its E'' scatters"
        " by 24 % from row to row, and by 6 % it contradicts its E' (no positive spectrum does much better): for"
        " trends, no guarantees.",
        UNKNOWN,
    ),
    Measured(
        "S120",
        "Filled rubber of tyre type, not a belt cover: master curve as published, apparently smoothed by"
        " its origin. E' and E'' disagree by 3 % under any positive spectrum.",
        UNKNOWN,
    ),
)
ILLUSTRATIVE = (
    Illustrative(
        "standard-cover",
        "an ordinary cover",
        *(10.0e6, 0.20, {"NR": 0.5, "SBR": 0.2, "BR": 0.3}, -40.0, 0.58, 1.60, 1.25, 0.15),
        "the law over 0.80, the drag multiplier that a design program uses for low-resistance covers",
    ),
    Illustrative(
        "low-rolling-resistance-cover",
        "a low rolling resistance cover",
        *(8.0e6, 0.12, {"NR": 0.6, "BR": 0.4}, -50.0, 0.65, 1.20, 1.0, 0.15),
        "the law as published",
    ),
    Illustrative(
        "cold-resistant-cover",
        "a cold-resistant cover",
        *(8.0e6, 0.15, {"NR": 0.3, "BR": 0.7}, -60.0, 0.60, 1.45, 1.12, 0.17),
        "between low-resistance and standard, general knowledge",
    ),
)
"""The blends are general knowledge of the trade: wear-resistant grades of natural, styrene-butadiene and some butadiene
rubber, easily rolling ones of natural and butadiene rubber, cold-resistant ones mostly of butadiene rubber."""


SWEEP_STRAINS = np.geomspace(1e-4, 0.5, 16)
"""Of the constructed Payne sweeps [-]."""
SWEEP_TEMPERATURES = (-20.0, 20.0, 60.0)
"""Of them [degC]: filler networks soften less, the hotter they are."""
FAR_PER_KELVIN = 0.002
"""Change of E' at large over E' at small strain with the temperature [1/K]."""
CRITICAL_STRAIN, KRAUS_EXPONENT = 2e-3, 0.4
"""Of Kraus' law: the sweeps of S100 and S120 fitted by it have 0.16 to 0.20 % and 0.25 to 0.47; Kraus (1984) gives 0.5
to 0.6 for carbon blacks. Rolls work a cover at several times that strain, where the falls of E' and E'' balance in the
friction: its exponent in the line load is that of the published law, to 0.03."""
SMALL_STRAIN = 1e-3
"""Strain amplitude that the constructed spectra are taken to hold at [-]."""
LAW = "a 6.59e-3, b 1.28: low-resistance cover, 20 degC, 219 mm roll, 7 mm cover"
LAW_A, LAW_B = 6.59e-3, 1.28
SHARED = 0.14
"""Part of the uncertainty that all three levels have in common: speed and loads of the law's tests."""
LAW_SOURCE = (
    "CEMA-7 large sample test in the form of the DIN 22123 appendix; The CEMA Horsepower Equation, Bulk Solids"
    " Handling 34 (2014) 7"
)


def number(value: float) -> str:
    """Twelve digits: read back, the series is the fit to 1e-11."""
    return f"{value:.12g}"


def prony_lines(series: PronySeries) -> list[str]:
    terms = [
        f"    - {{modulus: {number(e / 1e6)} MPa, time: {number(t)} s}}"
        for e, t in zip(series.moduli, series.times, strict=True)
    ]
    return ["prony:", f"  equilibrium: {number(series.equilibrium / 1e6)} MPa", "  terms:", *terms]


def listing(items: list[str]) -> str:
    return "[" + ", ".join(items) + "]"


def refit(name: str) -> FittedCompound:
    """What `conveyor fit` makes of the files beside the compound."""
    file = SHELF / name.lower()
    return fit_file(
        file.with_suffix(".dma.csv"),
        Request(
            name=name,
            shift=file.with_suffix(".shift.csv"),
            strain=file.with_suffix(".strain.csv"),
            reference_strain=REFERENCE_STRAIN,
            vertical=True,
        ),
    )


def measured_text(compound: Measured) -> str:
    found = refit(compound.name).compound.replace(
        description=compound.description, missing=compound.missing, strain="not stated"
    )
    return dump(found, "Written by examples/02_refit_materials.py; change the data or the script, not this file.")


@dataclass(frozen=True)
class Shape:
    """What of a constructed spectrum its targets leave open."""

    glass: dict[str, float]  # of each rubber [degC]
    blend: dict[str, float]
    slow: float = 0.6
    fast: float = 0.3
    tail: float = 0.12
    glassy: float = GLASSY  # [Pa]
    c1: float = UNIVERSAL_C1
    c2: float = UNIVERSAL_C2  # [K]

    @property
    def mean(self) -> float:
        """Mean glass temperature of the blend [degC]."""
        return sum(share * self.glass[rubber] for rubber, share in self.blend.items())

    def law(self) -> WLF:
        """Constants at the mean glass temperature, moved to 20 degC (same curve, same pole)."""
        c2 = self.c2 + REFERENCE - self.mean
        return WLF(self.c1 * self.c2 / c2, c2, REFERENCE + ZERO_CELSIUS)

    def time(self, glass: float) -> float:
        """Relaxation time at 20 degC of a rubber with this glass temperature [s]."""
        return float(TIME_AT_TG * 10.0 ** (-self.c1 * (REFERENCE - glass) / (self.c2 + REFERENCE - glass)))


def construct(cover: Illustrative, shape: Shape | None = None) -> tuple[PronySeries, WLF]:
    """The series of a cover that meets its targets, and its shift law."""
    shape = shape or Shape(GLASS, cover.blend)
    glass = sum(
        share / (x**shape.slow + x**-shape.fast)
        for rubber, share in shape.blend.items()
        for x in [TIMES / shape.time(shape.glass[rubber])]
    )
    settled, x = TIMES / SLOWEST, TIMES / shape.time(shape.mean)
    network = settled**-shape.tail * np.exp(-np.sqrt(settled)) / (1.0 + 1.0 / x)
    wt = 2.0 * math.pi * TARGET_FREQUENCY * TIMES
    loss = wt / (1.0 + wt * wt)
    storage = wt * loss
    matrix = np.array(
        [
            [1.0, network @ storage, glass @ storage],
            [0.0, network @ loss, glass @ loss],
            [1.0, network.sum(), glass.sum()],
        ]
    )
    targets = np.array([cover.storage, cover.storage * cover.tan_delta, shape.glassy])
    equilibrium, b, a = np.linalg.solve(matrix, targets)
    return PronySeries(float(equilibrium), b * network + a * glass, TIMES), shape.law()


def drawn_shapes(cover: Illustrative) -> list[Shape]:
    """A Latin hypercube of normal draws of what the targets leave open."""
    generator = np.random.default_rng(0)
    middles = (np.arange(REPLICAS) + 0.5) / REPLICAS
    normal = np.array([NormalDist().inv_cdf(p) for p in middles]) / DEVIATIONS_OF_90_PERCENT
    draws = [generator.permutation(normal) for _ in range(len(GLASS) + 7)]
    shapes = []
    for *hotter, share, slow, fast, tail, glassy, c1, c2 in zip(*draws, strict=True):
        first, *others = cover.blend
        more = SHARE_OFF * share
        rest = (1.0 - cover.blend[first] - more) / (1.0 - cover.blend[first])
        shapes.append(
            Shape(
                {rubber: t + GLASS_OFF * off for (rubber, t), off in zip(GLASS.items(), hotter, strict=True)},
                {first: cover.blend[first] + more} | {rubber: rest * cover.blend[rubber] for rubber in others},
                0.6 + SHAPE_OFF * slow,
                0.3 + SHAPE_OFF * fast,
                0.12 + TAIL_OFF * tail,
                GLASSY * math.exp(GLASSY_OFF * glassy),
                UNIVERSAL_C1 + WLF_OFF[0] * c1,
                UNIVERSAL_C2 + WLF_OFF[1] * c2,
            )
        )
    return shapes


def band_lines(cover: Illustrative) -> list[str]:
    """The replicas: spectra of the drawn shapes, each with its own shift law."""
    made = [construct(cover, shape) for shape in drawn_shapes(cover)]
    return [
        "  band:",
        f'    method: "{REPLICAS} draws of glass temperatures, shares of the rubbers, WLF constants and shape of the'
        " transition; E' and tan delta at 20 degC, 10 Hz held\"",
        "    equilibrium: " + listing([f"{series.equilibrium / 1e6:.6g} MPa" for series, _ in made]),
        "    unit: MPa",
        "    moduli:",
        *("    - " + listing([f"{e / 1e6:.6g}" for e in series.moduli]) for series, _ in made),
        "    shift:",
        *(f"    - {{law: wlf, c1: {law.c1:.6g}, c2: {law.c2:.6g} K}}" for _, law in made),
    ]


def payne_lines(cover: Illustrative, series: PronySeries, law: WLF) -> list[str]:
    """Kraus' law at three temperatures, 10 Hz."""
    lines = [
        "strain_dependence:",
        f"  reference_strain: {100.0 * SMALL_STRAIN:g} %",
        '  reference_note: "taken, the spectrum is constructed"',
        '  source: "constructed: Kraus\' law, not measured"',
        "  sweeps:",
    ]
    for celsius in SWEEP_TEMPERATURES:
        far = cover.far + FAR_PER_KELVIN * (celsius - REFERENCE)
        kraus = KrausLaw(1.0, far, cover.peak, 1.0, CRITICAL_STRAIN, KRAUS_EXPONENT, CRITICAL_STRAIN, KRAUS_EXPONENT)
        held = float(kraus.storage(SMALL_STRAIN)), float(kraus.loss(SMALL_STRAIN))
        a_T = 10.0 ** float(law.log10_a_T(celsius + ZERO_CELSIUS))
        modulus = series.modulus(2.0 * math.pi * TARGET_FREQUENCY * a_T)
        storage = modulus.real * kraus.storage(SWEEP_STRAINS) / held[0] / 1e6
        loss = modulus.imag * kraus.loss(SWEEP_STRAINS) / held[1] / 1e6
        lines += [
            f"    - temperature: {celsius:g} degC",
            f"      frequency: {TARGET_FREQUENCY:g} Hz",
            f"      strain: {listing([f'{100.0 * s:.6g}' for s in SWEEP_STRAINS])}",
            "      unit: MPa",
            f"      storage: {listing([f'{e:.6g}' for e in storage])}",
            f"      loss: {listing([f'{e:.6g}' for e in loss])}",
        ]
    return lines


def illustrative_text(cover: Illustrative) -> str:
    series, law = construct(cover)
    shares = [f"{100.0 * share:.0f} % {rubber} (T_g {GLASS[rubber]:g} degC)" for rubber, share in cover.blend.items()]
    blend = f"{', '.join(shares[:-1])} and {shares[-1]}"
    lines = [
        "# Written by examples/02_refit_materials.py; change the script, not this file.",
        f"name: {cover.name}",
        "kind: illustrative",
        f'description: "NOT a measured compound: a smooth spectrum built to look like {cover.description}.'
        f" Targets: E' {cover.storage / 1e6:g} MPa and tan delta {cover.tan_delta:g} at 20 degC, 10 Hz;"
        f" E_inf {GLASSY / 1e9:g} GPa; a blend of {blend}. The level of its indentation is that of published tests at"
        f' {REFERENCE:g} degC."',
        "source:",
        '  origin: "constructed for this project"',
        "  licence: MIT",
        "poisson_ratio: 0.5",
        "density: 1150 kg/m^3",
        f"strain: {SMALL_STRAIN:.1%} (taken)",
        f"reference_temperature: {REFERENCE:g} degC",
        *prony_lines(series),
        *band_lines(cover),
        "shift:",
        "  law: wlf",
        f"  c1: {number(law.c1)}",
        f"  c2: {number(law.c2)} K",
        "range:",
        "  frequency: [1e-3 Hz, 1e11 Hz]",
        f"  temperature: [{cover.coldest:g} degC, 80 degC]",
        *payne_lines(cover, series, law),
        "tests:",
        f'  - source: "{LAW_SOURCE}: {LAW}. Here {cover.level:g} times it: {cover.why}"',
        "    specimen: belt",
        "    roll_diameter: 219 mm",
        "    cover_thickness: 7 mm",
        "    speed: 5 m/s",
        "    temperature: 20 degC",
        f"    law: {{a: {number(cover.level * LAW_A)}, b: {LAW_B:g}, line_load: [1 N/mm, 8 N/mm]}}",
        f"    uncertainty: {100.0 * cover.uncertainty:g} %",
        f"    shared_uncertainty: {100.0 * SHARED:g} %",
        '    note: "speed and range of line load are not printed: 5 m/s and 1 to 8 N/mm assumed; with 2.5 or 7.5 m/s'
        ' the level would differ by up to 15 %"',
        "fit:",
        "  storage_rms: 0",
        "  loss_rms: 0",
        "  storage_worst: 0",
        "  loss_worst: 0",
        '  method: "none: constructed from a closed-form spectrum, not fitted to data"',
        "missing:",
        "  - any measurement of its spectrum, shift and strain dependence (compare with it, do not design with it)",
        "  - its glass temperatures and what it does in the cold (drawn in prony.band)",
        "  - rolling-resistance tests at other temperatures than 20 degC",
        "  - vertical shift (none applied)",
    ]
    return "\n".join(lines) + "\n"


def shelf_texts() -> dict[str, str]:
    """File name and content of every compound."""
    texts = {f"{m.name.lower()}.yaml": measured_text(m) for m in MEASURED}
    return texts | {f"{c.name}.yaml": illustrative_text(c) for c in ILLUSTRATIVE}


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for file, text in shelf_texts().items():
        (folder / file).write_text(text, encoding="utf-8", newline="\n")
        print(f"wrote {file}")
    for compound in MEASURED:
        fit = refit(compound.name).fit
        print(
            f"{compound.name}: {fit.active_terms} of {fit.grid_terms} terms,"
            f" E_e {fit.series.equilibrium / 1e6:.3f} MPa,"
            f" rms E' {fit.storage.rms:.1%}, E'' {fit.loss.rms:.1%}, tan delta {fit.tan_delta.rms:.1%};"
            f" both together {fit.residual:.1%}, at best {fit.consistency_floor:.1%};"
            f" scatter {fit.storage_noise:.1%} and {fit.loss_noise:.1%}"
        )
        for line in fit.candidates[:5]:
            print(
                f"  {line.terms_per_decade:g} per decade, penalty {line.regularisation:g}: {line.terms} terms,"
                f" {line.freedom:.1f} parameters, {line.residual:.2%}, AICc {line.score:.1f}"
            )
    for cover in ILLUSTRATIVE:
        series, _ = construct(cover)
        print(f"{cover.name}: {series.times.size} terms, E_e {series.equilibrium / 1e6:.3f} MPa")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else SHELF)
