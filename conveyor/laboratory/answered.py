"""Several files read with the answers of one command."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.laboratory.read import read_dma
from conveyor.laboratory.table import DmaData

_UNITS: Final = frozenset({"frequency_unit", "modulus_unit", "temperature_unit", "strain_unit", "letter"})


def read_answered(path: Path, answers: Mapping[str, Any], *, poisson_ratio: float, several: bool) -> DmaData:
    """Read a file with what its command answers; of several files, one may state units that another leaves open.

    Parameters
    ----------
    path : Path
        The file.
    answers : mapping
        Keywords of `read_dma`.
    poisson_ratio : float
        To convert shear moduli [-].
    several : bool
        Whether the answers are for other files too: units that this file contradicts are then left to it.

    Raises
    ------
    InputError
        As `read_dma`, of the reading with all answers.
    """
    try:
        return read_dma(path, poisson_ratio=poisson_ratio, **answers)
    except InputError:
        own = {key: value for key, value in answers.items() if key not in _UNITS}
        if several and own != answers:
            with suppress(InputError):
                return read_dma(path, poisson_ratio=poisson_ratio, **own)
        raise
