"""Fit the files of `families.py --export` with pyvisco's defaults, as its examples do; run it where pyvisco is.

python benchmarks/pyvisco_fits.py FOLDER FITS.json
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pyvisco import load, master, prony

REFERENCE = 20


def fitted(path: Path) -> dict[str, Any]:
    raw, _, _ = load.user_raw(load.file(str(path)), "freq", "E")
    shifts, _ = master.get_aT(raw, REFERENCE)
    curve = master.smooth(master.get_curve(raw, shifts, REFERENCE), 1)
    found, _ = prony.fit(prony.discretize(curve), curve)
    terms = found["df_terms"]
    moduli = (found["E_0"] * terms["alpha_i"]).tolist()
    return {
        "equilibrium": float(found["E_0"] * (1.0 - terms["alpha_i"].sum())),
        "moduli": [e for e in moduli if e > 0.0],
        "times": [t for t, e in zip(terms["tau_i"].tolist(), moduli, strict=True) if e > 0.0],
        "temperatures": shifts["T"].tolist(),
        "log10_aT": shifts["log_aT"].tolist(),
        "window": [float(found["f_min"]), float(found["f_max"])],
    }


def main(folder: Path, target: Path) -> None:
    fits: dict[str, Any] = {"version": version("pyvisco")}
    for path in sorted(folder.glob("*.csv")):
        with contextlib.redirect_stdout(io.StringIO()):
            try:
                fits[path.stem] = fitted(path)
            except Exception as error:  # noqa: BLE001 - whatever it fails with is a failure of this file
                fits[path.stem] = {"error": repr(error)}
    target.write_text(json.dumps(fits))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
