"""E', E'' and tan delta in one file: what one of them really holds is named, where digits and scatter tell it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laboratory import read_dma

FREQUENCY = np.logspace(-1.0, 2.0, 25)
NAMES = ("E' [MPa]", "E'' [MPa]", "tan delta")


def moduli(middle: float) -> tuple[np.ndarray, np.ndarray]:
    """Of a rubber with tan delta about `middle`, rising by half over the frequencies [MPa]."""
    angle = np.arctan(middle * FREQUENCY**0.06 / FREQUENCY.mean() ** 0.06)
    storage = 8.0 * FREQUENCY ** (2.0 / np.pi * np.arctan(middle))
    return storage, storage * np.tan(angle)


def written(folder: Path, columns: tuple[np.ndarray, ...], digits: int, names: tuple[str, ...] = NAMES) -> Path:
    file = folder / "three.csv"
    rows = [
        ",".join([f"{f:.6g}", *(f"{v:.{digits}g}" for v in row)]) for f, *row in zip(FREQUENCY, *columns, strict=True)
    ]
    file.write_text("\n".join([",".join(["f [Hz]", *names]), *rows]) + "\n", encoding="utf-8")
    return file


def told(file: Path) -> str:
    """What is refused; nothing where the file is read."""
    try:
        read_dma(file)
    except InputError as error:
        return str(error)
    return ""


READINGS = {
    "|E*|": (
        lambda s, b: (np.hypot(s, b), b, b / s),
        r'column 2 "E\' \[MPa\]": .* if what is named E\' is \|E\*\|',
    ),
    "rad": (lambda s, b: (s, b, np.arctan(b / s)), r"column 4 .* 'phase \[rad\]'"),
    "deg": (lambda s, b: (s, b, np.degrees(np.arctan(b / s))), r"column 4 .* 'phase \[deg\]'"),
}


@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize("middle", [0.05, 0.1, 0.2, 0.5, 1.0])
def test_what_a_column_really_holds_is_named(tmp_path: Path, reading: str, middle: float) -> None:
    """One signal, five digits: 0.13 % between |E*| and E' at a tan delta of 0.05, and 0.01 % of rounding."""
    make, message = READINGS[reading]
    assert re.search(message, told(written(tmp_path, make(*moduli(middle)), 5)))


@pytest.mark.parametrize("middle", [0.05, 0.1, 0.2, 0.5, 1.0])
@pytest.mark.parametrize("digits", [2, 3, 4, 6])
def test_what_is_right_is_read_with_any_digits_and_scatter(tmp_path: Path, middle: float, digits: int) -> None:
    storage, loss = moduli(middle)
    for seed in range(10):
        noise = np.random.default_rng(seed).standard_normal((3, FREQUENCY.size))
        for scatter in (0.0, 0.001, 0.01) if digits > 2 else (0.0,):  # two digits are 5 % themselves
            columns = (c * (1.0 + scatter * e) for c, e in zip((storage, loss, loss / storage), noise, strict=True))
            assert told(written(tmp_path, tuple(columns), digits)) == ""


def test_digits_and_scatter_that_hide_the_difference_say_nothing(tmp_path: Path) -> None:
    """At 0.2 |E*| differs from E' by 2 %: told by three digits, not by two, nor where each column scatters by 2 %."""
    storage, loss = moduli(0.2)
    three = (np.hypot(storage, loss), loss, loss / storage)
    assert "is |E*|" in told(written(tmp_path, three, 4))
    assert told(written(tmp_path, three, 2)) == ""
    noise = np.random.default_rng(1).standard_normal((3, FREQUENCY.size))
    quiet, loud = (tuple(c * (1.0 + of * e) for c, e in zip(three, noise, strict=True)) for of in (0.002, 0.01))
    assert "is |E*|" in told(written(tmp_path, quiet, 4))
    assert "is |E*|" not in told(written(tmp_path, loud, 4))


def test_a_misprint_neither_hides_nor_makes_a_reading(tmp_path: Path) -> None:
    storage, loss = moduli(0.3)
    tangent = loss / storage
    tangent[7] *= 1.04
    assert told(written(tmp_path, (storage, loss, tangent), 4)) == ""
    assert "is |E*|" in told(written(tmp_path, (np.hypot(storage, loss), loss, tangent), 4))


@pytest.mark.parametrize("names", [("|G*| [MPa]", "G'' [MPa]", "tan delta"), ("|G*| [MPa]", "G'' [MPa]", "note")])
def test_complex_modulus_and_loss_give_the_storage(tmp_path: Path, names: tuple[str, ...]) -> None:
    storage, loss = moduli(0.3)
    read = read_dma(written(tmp_path, (np.hypot(storage, loss), loss, loss / storage), 7, names))
    assert read.storage == pytest.approx(3e6 * storage, rel=1e-6)
    assert read.loss == pytest.approx(3e6 * loss, rel=1e-6)
    assert any("E' from |E*| and E''" in said for said in read.understood)
    exchanged = written(tmp_path, (loss, np.hypot(storage, loss), loss / storage), 7, names)
    assert "of which it is a part" in told(exchanged)


def test_a_shear_file_is_told_in_its_own_letters(tmp_path: Path) -> None:
    storage, loss = moduli(0.3)
    columns = (np.hypot(storage, loss), loss, loss / storage)
    said = told(written(tmp_path, columns, 5, ("G' [MPa]", "G'' [MPa]", "Damping factor")))
    assert "if what is named G' is |G*|; name the column '|G*|'" in said
    said = told(written(tmp_path, columns, 5, ("Storage modulus [MPa]", "Loss modulus [MPa]", "tan delta")))
    assert "name the column 'complex modulus'" in said
