"""A compound's series as the input of other programs: Abaqus, Ansys, pyvisco."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

import numpy as np

from conveyor.errors import InputError, NoSolutionError
from conveyor.files import output_marks
from conveyor.models import RubberCompound
from conveyor.rubber import WLF, Arrhenius, ShiftTable, fit_wlf
from conveyor.rubber.shift import GAS_CONSTANT
from conveyor.units import text
from conveyor.units.sentences import ZERO_CELSIUS, to_celsius

INCOMPRESSIBLE_RATIO: Final = 0.4999
"""Poisson's ratio written for 0.5, at which elements with displacements alone have no solution."""
LARGEST_LAW_MISS: Final = 0.3
"""Largest miss of a law written in place of a table: a factor of two in time (general knowledge) [decades]."""
_TERMS_PER_LINE: Final = 3  # terms of a TBDATA command: it takes six constants


def program_input(compound: RubberCompound, ending: str) -> tuple[str, str]:
    """Name of a program, and its input for a compound.

    Parameters
    ----------
    compound : RubberCompound
        At its reference temperature; its shift as the program's WLF or Arrhenius law, a table as the nearest WLF law
        with its misfit, or none where it misses the table by more than 0.3 decades.
    ending : {".inp", ".mac", ".csv"}
        Abaqus, Ansys APDL or pyvisco.

    Raises
    ------
    InputError
        Another ending.

    Notes
    -----
    Moduli in MPa (N, mm, s). Shear and bulk relax alike, so Poisson's ratio is constant and the tensile modulus is the
    compound's. Abaqus 2017, Keywords: ``*VISCOELASTIC, TIME=PRONY`` takes g_i, k_i, tau_i; ``*TRS`` takes T0, C1, C2
    of log10 a_T = -C1 (T - T0)/(C2 + T - T0), or T0 and E_a. Ansys (its manual was not at hand: general knowledge):
    ``TB,PRONY`` takes pairs of share and time; ``TB,SHIFT`` T0, C1, C2, or T0 and E_a/R. pyvisco 2.1: the csv of its
    Prony terms, units in the second row.

    Examples
    --------
    >>> from conveyor import shelf
    >>> program_input(shelf.compound("standard-cover"), ".csv")[1].splitlines()[:2]
    ['i,tau_i,alpha_i,E_0,E_i', '-,s,-,MPa,MPa']
    """
    made = {
        ".inp": ("Abaqus", _abaqus_lines),
        ".mac": ("Ansys", _ansys_lines),
        ".csv": ("pyvisco", _pyvisco_lines),
    }
    if ending not in made:
        raise InputError(f'--export: a name ends in {", ".join(made)}, got "{ending}"')
    program, lines = made[ending]
    return program, "\n".join([*lines(compound), ""])


def _head_lines(compound: RubberCompound) -> list[str]:
    """Remarks at the head of a file."""
    lines = [
        f"{output_marks.program_version()}: {compound.name}, series at {text(compound.reference_temperature)}; N, "
        f"mm, s: moduli in MPa",
        f"data: {compound.source.data or 'not stated'}; {compound.source.origin}",
    ]
    if compound.range is not None:
        low, high = (text(f) for f in compound.range.frequency)
        lines.append(f"holds from {low} to {high} at that temperature")
    if compound.poisson_ratio == 0.5:
        lines.append(f"incompressible: Poisson's ratio written as {INCOMPRESSIBLE_RATIO:g}")
    lines += ["softening with strain, tests and vertical shift are not in here"]
    return [line.encode("ascii", "replace").decode() for line in lines]


def _prony_shares(compound: RubberCompound) -> tuple[float, list[tuple[float, float]]]:
    """Instantaneous modulus [MPa], share and time [s] of each term by rising time."""
    series = compound.series_at_reference
    glassy = series.glassy
    order = np.argsort(series.times)
    terms = zip((series.moduli[order] / glassy).tolist(), series.times[order].tolist(), strict=True)
    return glassy / 1e6, list(terms)


def _program_shift(compound: RubberCompound) -> tuple[WLF | Arrhenius | None, str]:
    """Shift law for a program, and a remark on it."""
    law = compound.shift_law()
    if isinstance(law, ShiftTable):
        try:
            fit = fit_wlf(law.temperatures, law.log10_factors, law.reference)
        except (InputError, NoSolutionError) as error:
            return None, f"shift: the table follows no WLF law, none is written: {error}"
        misses = f"rms {fit.rms:.2f}, worst {fit.worst:+.2f} decades at {to_celsius(fit.worst_temperature):.0f} degC"
        if abs(fit.worst) > LARGEST_LAW_MISS:
            return None, f"shift: none written, the nearest WLF law misses the table by {misses}"
        return fit.law, f"shift: the WLF law nearest to the table, {misses}"
    if isinstance(law, WLF | Arrhenius):
        return law, f"shift: {type(law).__name__}, as in the compound"
    return None, "shift: none, for the reference temperature only"


def _program_poisson_ratio(compound: RubberCompound) -> float:
    return INCOMPRESSIBLE_RATIO if compound.poisson_ratio == 0.5 else compound.poisson_ratio


def _abaqus_lines(compound: RubberCompound) -> Iterator[str]:
    law, said = _program_shift(compound)
    yield from (f"** {line}" for line in (*_head_lines(compound), said))
    if isinstance(law, Arrhenius):
        yield f"*PHYSICAL CONSTANTS, ABSOLUTE ZERO={-ZERO_CELSIUS:g}, UNIVERSAL GAS={GAS_CONSTANT:.12g}"
    yield f"*MATERIAL, NAME={re.sub(r'[^A-Za-z0-9_-]', '_', compound.name)[:80]}"
    glassy, terms = _prony_shares(compound)
    yield "*ELASTIC, MODULI=INSTANTANEOUS"
    yield f"{glassy:.12g}, {_program_poisson_ratio(compound):g}"
    yield "*VISCOELASTIC, TIME=PRONY"
    yield from (f"{share:.12g}, {share:.12g}, {time:.12g}" for share, time in terms)
    if isinstance(law, WLF):
        yield "*TRS, DEFINITION=WLF"
        yield f"{to_celsius(law.reference):.9g}, {law.c1:.9g}, {law.c2:.9g}"
    if isinstance(law, Arrhenius):
        yield "*TRS, DEFINITION=ARRHENIUS"
        yield f"{to_celsius(law.reference):.9g}, {law.activation_energy:.9g}"


def _ansys_lines(compound: RubberCompound) -> Iterator[str]:
    law, said = _program_shift(compound)
    yield from (f"! {line}" for line in (*_head_lines(compound), said))
    glassy, terms = _prony_shares(compound)
    yield f"MP,EX,1,{glassy:.12g}"
    yield f"MP,PRXY,1,{_program_poisson_ratio(compound):g}"
    for kind in ("SHEAR", "BULK"):
        yield f"TB,PRONY,1,,{len(terms)},{kind}"
        for k in range(0, len(terms), _TERMS_PER_LINE):
            pairs = ",".join(f"{share:.12g},{time:.12g}" for share, time in terms[k : k + _TERMS_PER_LINE])
            yield f"TBDATA,{2 * k + 1},{pairs}"
    if isinstance(law, WLF):
        yield "TB,SHIFT,1,,3,WLF"
        yield f"TBDATA,1,{to_celsius(law.reference):.9g},{law.c1:.9g},{law.c2:.9g}"
    if isinstance(law, Arrhenius):
        yield f"TOFFST,{ZERO_CELSIUS:g}"
        yield "TB,SHIFT,1,,2,TN"
        yield f"TBDATA,1,{to_celsius(law.reference):.9g},{law.activation_energy / GAS_CONSTANT:.9g}"


def _pyvisco_lines(compound: RubberCompound) -> Iterator[str]:
    glassy, terms = _prony_shares(compound)
    yield "i,tau_i,alpha_i,E_0,E_i"
    yield "-,s,-,MPa,MPa"
    for number, (share, time) in enumerate(terms, start=1):
        yield f"{number},{time:.12g},{share:.12g},{glassy:.12g},{share * glassy:.12g}"
