"""Options of a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

REPLICAS = 20
"""Bootstrap replicas in a compound file: nine tenths lie between the outermost of nineteen."""


@dataclass(frozen=True)
class Request:
    """Options for turning laboratory files into a compound.

    Parameters
    ----------
    name : str
        Name of the compound.
    reference_temperature : str, optional
        Temperature of the master curve, with unit ("20 degC"); else the file's line ``# reference_temperature: …``.
    shift : Path, optional
        File of shift factors; without it, and without isotherms, the compound holds at its reference only.
    strain : Path, optional
        File of strain sweeps.
    reference_strain : str, optional
        Single strain amplitude of the master curve, with unit ("0.1 %"), of shear "0.15 % shear"; needed with `strain`
        where the files do not state it.
    poisson_ratio : float
        ν; also turns shear moduli into tensile ones [-].
    equilibrium : float, optional
        E_e held in the fit [Pa]; fitted without it.
    terms_per_decade : float, optional
        Density of the times; chosen by AICc without it [1/decade].
    vertical : bool
        Whether isotherms may be shifted vertically, too; a master curve gets b_T = T/T_ref, by its shift factors.
    by : {"both", "storage", "loss"}
        Modulus whose overlap places the isotherms.
    law : {"table", "wlf", "arrhenius"}
        Shift law of the compound and its master curve.
    repeats : bool
        Whether sweeps at one temperature, specimens or runs, are averaged; else they are refused.
    exclude : tuple of str
        Rows left out, "12-15,20" or "isotherms.csv:12-15,20".
    storage_error, loss_error : float, optional
        Relative standard errors of E' and E'' that weigh them [-]; both or neither, equal without.
    replicas : int
        Number of bootstrap replicas of the band; 0 for none.
    accept : frozenset of str
        Findings to accept, names of `conveyor.fitting.findings.FINDINGS`; others are refused.
    reading : mapping
        Answers to ambiguities of a file: keywords of `conveyor.laboratory.read_dma`.
    """

    name: str
    reference_temperature: str | None = None
    shift: Path | None = None
    strain: Path | None = None
    reference_strain: str | None = None
    poisson_ratio: float = 0.5
    equilibrium: float | None = None
    terms_per_decade: float | None = None
    vertical: bool = False
    by: Literal["both", "storage", "loss"] = "both"
    law: Literal["table", "wlf", "arrhenius"] = "table"
    repeats: bool = False
    exclude: tuple[str, ...] = ()
    storage_error: float | None = None
    loss_error: float | None = None
    replicas: int = REPLICAS
    accept: frozenset[str] = frozenset()
    reading: Mapping[str, Any] = field(default_factory=dict)
