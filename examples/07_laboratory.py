"""Three files of a laboratory, and the page it signs.

Run it as ``python examples/07_laboratory.py [FOLDER]``: it writes isotherms, stress relaxation and a temperature sweep
of one rubber as three instruments export them. The rubber is constructed, as the shelf's standard cover is, but of one
glass transition, at -50 degC; 1 % noise on E' and E(t), 2 % on E''; so the truth is known. examples/laboratory holds
what it writes; a test holds the one against the other, and docs/laboratory.md goes on from there.
"""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import numpy as np

from conveyor import shelf
from conveyor.models import RubberCompound

GLASS = -50.0
"""Glass temperature of the rubber [degC]."""


def one_transition() -> RubberCompound:
    """The standard cover with the spectrum and the WLF law of a rubber of one glass transition."""
    script = runpy.run_path(str(Path(__file__).with_name("02_refit_materials.py")))
    cover = script["ILLUSTRATIVE"][0]
    series, law = script["construct"](cover, script["Shape"]({"rubber": GLASS}, {"rubber": 1.0}))
    terms = [
        {"modulus": f"{e!r} Pa", "time": f"{t!r} s"}
        for e, t in zip(series.moduli.tolist(), series.times.tolist(), strict=True)
    ]
    prony = {"equilibrium": f"{series.equilibrium!r} Pa", "terms": terms}
    shift = {"law": "wlf", "c1": law.c1, "c2": f"{law.c2!r} K"}
    return shelf.compound(cover.name).replace(prony=prony, shift=shift)


TRUTH = one_transition()
ZERO = 273.15
ABOUT = (
    "laboratory: constructed, no laboratory",
    "specimen: rubber of one glass transition, sheet of 2 mm",
    "origin: constructed for this project",
    "licence: MIT",
)


def isotherms(noise: np.random.Generator) -> str:
    """Tension DMA, -36 to 48 degC every 6 K, 0.5 to 50 Hz."""
    lines = [f"# {line}" for line in (*ABOUT, "instrument: DMA, tension 15 x 5 x 2 mm", "strain: 0.1 %")]
    lines.append("Temperature [degC],Frequency [Hz],E' [MPa],E'' [MPa]")
    for celsius in range(-36, 49, 6):
        series = TRUTH.series(celsius + ZERO)
        for f in np.geomspace(0.5, 50.0, 11):
            omega = 2.0 * np.pi * f
            storage = series.storage(omega) / 1e6 * (1.0 + 0.01 * noise.standard_normal())
            loss = series.loss(omega) / 1e6 * (1.0 + 0.02 * noise.standard_normal())
            lines.append(f"{celsius + 0.1 * noise.uniform(-1.0, 1.0):.2f},{f:.4g},{storage:.5g},{loss:.4g}")
    return "\n".join([*lines, ""])


def relaxation(noise: np.random.Generator) -> str:
    """Stress relaxation at 20 and 44 degC, 0.1 to 3000 s, as a text file with tabs."""
    lines = ["Stress relaxation, tension, strain 1 %", "time\tE(t)\ttemperature", "s\tMPa\tdegC"]
    for celsius in (20.0, 44.0):
        series = TRUTH.series(celsius + ZERO)
        for t in np.geomspace(0.1, 3000.0, 37):
            modulus = float(series.relaxation(t)) / 1e6 * (1.0 + 0.01 * noise.standard_normal())
            lines.append(f"{t:.5g}\t{modulus:.5g}\t{celsius:.1f}")
    return "\n".join([*lines, ""])


def ramp(noise: np.random.Generator) -> str:
    """Temperature sweep at 10 Hz, -40 to 44 degC at every second kelvin, semicolons and decimal commas."""
    lines = ["Temperatur [°C];Frequenz [Hz];Speichermodul E' [MPa];tan delta"]
    for celsius in np.arange(-40.0, 45.0, 2.0):
        series, omega = TRUTH.series(celsius + ZERO), 20.0 * np.pi
        storage = series.storage(omega) / 1e6 * (1.0 + 0.01 * noise.standard_normal())
        tangent = series.tan_delta(omega) * (1.0 + 0.02 * noise.standard_normal())
        lines.append(f"{celsius:.1f};10,0;{storage:.5g};{tangent:.4g}".replace(".", ","))
    return "\n".join([*lines, ""])


def texts() -> dict[str, str]:
    """Name and content of every file."""
    noise = np.random.default_rng(7)
    return {"isotherms.csv": isotherms(noise), "relaxation.txt": relaxation(noise), "ramp.csv": ramp(noise)}


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "laboratory"
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts().items():
        (folder / name).write_text(text, encoding="utf-8", newline="\n")
        print(f"wrote {folder / name}")
