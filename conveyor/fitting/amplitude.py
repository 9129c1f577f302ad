"""Strain amplitude of a master curve, stated by its files or given; both must agree."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from conveyor.errors import InputError
from conveyor.fitting.request import Request
from conveyor.laboratory import DmaData
from conveyor.laboratory.header_meanings import header_meaning
from conveyor.units import read_si

SAME_STRAIN: Final = 1.1
"""Amplitudes within this factor are equal: E' of a filled rubber changes by 1 % over it, the repeatability of a DMA
(some 7 % a doubling, general knowledge) [-]."""
UNLIKE_STRAINS: Final = 1.25
"""Isotherms whose amplitudes differ by more differ by their strain beyond scatter: 2 to 3 % of E' [-]."""
WORKING_STRAIN: Final = 0.022
"""Working strain of a cover under rolls: 0.8 to 2.2 % of a 5 mm cover of S100 under a 159 mm roll and 1 to 4 N/mm
(docs/rubber.md, section 5) [-]."""
_PERCENT: Final = re.compile(r"\s*(\d+(?:[.,]\d*)?(?:[eE][+-]?\d+)?)\s*%")
FEWEST_STRAINS: Final = 4
"""Least strains of a run that can be interpolated; a stray row is a run of one."""
_DEFORMATION_SUFFIX: Final = re.compile(r"\s+(shear|tensile|tension)\s*$", re.IGNORECASE)


@dataclass(frozen=True)
class StrainAmplitudes:
    """Single strain amplitudes of the rows of one file, tensile or converted to tensile.

    Attributes
    ----------
    place : str
        Place of the statement in the file.
    low, high, mean : float
        Smallest, largest, geometric mean [-].
    shear : bool
        Whether the file holds a shear strain, converted to these [-].
    """

    place: str
    low: float
    high: float
    mean: float
    shear: bool

    @property
    def text(self) -> str:
        """Amplitude or range, for messages."""
        same = self.high <= SAME_STRAIN * self.low
        return strain_text(self.mean) if same else f"{strain_text(self.low)} to {strain_text(self.high)}"


def strain_text(strain: float) -> str:
    """Strain as a percentage, for messages."""
    return f"{100.0 * strain:.4g} %"


def stated_amplitudes(read: Sequence[DmaData], poisson_ratio: float) -> tuple[StrainAmplitudes, ...]:
    """Strain amplitudes stated by files of a master curve, in a column or a remark; others are left out."""
    return tuple(found for each in read for found in _file_amplitudes(each, poisson_ratio))


def _file_amplitudes(read: DmaData, poisson_ratio: float) -> Iterator[StrainAmplitudes]:
    if read.kind == "strain sweep":
        return
    data = Path(read.source).name
    if read.strain is not None:
        values = read.strain
        place = f"{data}: column of the strain"
        mean = float(np.exp(np.mean(np.log(values))))
        yield StrainAmplitudes(place, float(values.min()), float(values.max()), mean, read.shear)
        return
    for key, value in read.metadata.items():
        sense, number = header_meaning(key), _PERCENT.match(value)
        if sense is not None and sense.quantity == "strain" and number is not None:
            strain = 0.01 * float(number[1].replace(",", ".")) * (0.5 if sense.peak_to_peak else 1.0)
            shear = sense.letter == "G" or (read.shear and sense.letter != "E")
            strain /= np.sqrt(2.0 * (1.0 + poisson_ratio)) if shear else 1.0
            place = f'{data}:{read.metadata_rows[key]}: "{key}"'
            yield StrainAmplitudes(place, strain, strain, float(strain), shear)
            return


def short_sweep_note(sweeps: DmaData) -> str:
    """Message on strain sweeps that end below the working strain of covers, or ""."""
    ends = [float(run.strain[-1]) for run in sweeps.strain_sweeps() if run.strain.size >= FEWEST_STRAINS]
    if not ends or min(ends) >= WORKING_STRAIN:
        return ""
    return (
        f"strain dependence above {strain_text(min(ends))}, where the sweeps end: rolls work covers at up to"
        f" {strain_text(WORKING_STRAIN)}, the factors of the largest strain are held there; measure larger strains, or"
        " leave strain out (calculation: {strain: off})"
    )


def amplitude_ratio(known: Sequence[StrainAmplitudes]) -> float:
    """Largest over smallest amplitude [-]; 1 without any."""
    return max((a.high for a in known), default=1.0) / min((a.low for a in known), default=1.0)


def reference_strain(
    read: Sequence[DmaData], known: Sequence[StrainAmplitudes], request: Request, *, needed: bool
) -> str | None:
    """Single tensile strain amplitude of the master curve, given or stated by its files; None if unknown.

    Raises
    ------
    InputError
        The given amplitude contradicts a file, or does not state shear or tension where the files are of shear; the
        files state different amplitudes, and one is `needed`.
    """
    given = request.reference_strain
    if given is None:
        if not known:
            return None
        if needed and amplitude_ratio(known) > UNLIKE_STRAINS:
            low, high = min(a.low for a in known), max(a.high for a in known)
            raise InputError(
                f"{known[0].place}: the isotherms were measured at {strain_text(low)} to {strain_text(high)}, and "
                f"strain sweeps"
                " are counted from one strain: measure all at one, or give the one that stands for them, for example"
                f' --reference-strain "{strain_text(np.sqrt(low * high))}"'
            )
        return _percent_text(float(np.exp(np.mean([np.log(a.mean) for a in known]))))
    strain = _tensile_amplitude(given, read, request.poisson_ratio, stated=bool(known))
    for each in known:
        if not each.low / SAME_STRAIN <= strain <= each.high * SAME_STRAIN:
            shear = ", converted from the shear strain of the file" if each.shear else ""
            raise InputError(
                f"{each.place} says {each.text}{shear}, --reference-strain {strain_text(strain)}: leave out"
                " --reference-strain, or correct the file"
            )
    return given if _DEFORMATION_SUFFIX.search(given) is None else _percent_text(strain)


def _percent_text(strain: float) -> str:
    return f"{100.0 * strain:.6g} %"


def _tensile_amplitude(given: str, read: Sequence[DmaData], poisson_ratio: float, *, stated: bool) -> float:
    """Given amplitude in tension [-]; of shear, "0.15 % shear", that of equal energy."""
    way = _DEFORMATION_SUFFIX.search(given)
    strain = read_si(given[: way.start()] if way else given, "fraction", "--reference-strain")
    if way is None and not stated and any(each.shear for each in read):
        raise InputError(
            f'--reference-strain: got "{given}", but the files are of shear: a shear strain, or the tensile one of'
            f' equal energy? Write "{given} shear" or "{given} tensile"'
        )
    if way is not None and way[1].lower() == "shear":
        return float(strain / np.sqrt(2.0 * (1.0 + poisson_ratio)))
    return float(strain)
