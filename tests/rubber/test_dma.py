"""The strict reader: units, layouts, and one message for each refusal."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.rubber import read_master_curve

HEADER = "frequency_Hz,storage_Pa,loss_Pa"


def write(folder: Path, text: str, encoding: str = "utf-8") -> Path:
    file = folder / "pad.csv"
    file.write_bytes(text.encode(encoding))
    return file


def test_own_layout(tmp_path: Path) -> None:
    file = write(tmp_path, f"# name: pad\n# source: a: b\n# a remark\n{HEADER}\n1e2,2e6,3e5\n\n10,1e6,1e5\n")
    curve = read_master_curve(file)
    assert curve.metadata == {"name": "pad", "source": "a: b"}
    # rows stay in the order of the file
    assert curve.frequency_Hz.tolist() == [100.0, 10.0]
    assert curve.storage_Pa.tolist() == [2e6, 1e6]
    assert curve.loss_Pa.tolist() == [3e5, 1e5]
    assert curve.source.endswith("pad.csv")
    with pytest.raises(ValueError, match="read-only"):
        curve.loss_Pa[0] = 1.0


@pytest.mark.parametrize(
    ("header", "row", "encoding"),
    [
        ("f [Hz]\tE' [Pa]\tE'' [Pa]", "1\t6e6\t7e5", "utf-8"),
        ("freq (Hz);E' (MPa);E'' (kPa)", "1;6;700", "utf-8"),
        ("omega [rad/s],E_stor [MPa],E_loss [MPa]", f"{2 * math.pi!r},6,0.7", "utf-8-sig"),
        ("loss_Pa,storage_GPa,frequency_Hz", "7e5,0.006,1", "utf-8"),
        ('Storage modulus (MPa), E" (MPa), Frequency (Hz)', "6, 0.7, 1", "utf-8"),
    ],
)
def test_units_and_layouts(tmp_path: Path, header: str, row: str, encoding: str) -> None:
    curve = read_master_curve(write(tmp_path, f"{header}\r\n{row}\r\n", encoding))
    values = curve.frequency_Hz[0], curve.storage_Pa[0], curve.loss_Pa[0]
    assert values == pytest.approx((1.0, 6e6, 7e5), rel=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "f,E_stor,E_loss\n1,2e6,3e5\n",
            r"pad\.csv:1: column 'f' has no unit; allowed for frequency: Hz, rad/s",
        ),
        (
            "frequency_Hz,storage_psi,loss_Pa\n",
            r"pad\.csv:1: .*unit 'psi' of storage; allowed: Pa, kPa, MPa, GPa",
        ),
        ("frequency_hz,storage_Pa,loss_Pa\n", r"unit 'hz' of frequency; allowed: Hz, rad/s"),
        ("frequency_Hz,G' (Pa),G'' (Pa)\n", r"pad\.csv:1: column \"G' \(Pa\)\" is a shear modulus"),
        (
            "frequency_Hz,storage_Pa,temperature_C\n",
            r"column 'temperature_C' is not known; the first line after",
        ),
        ("frequency_Hz,storage_Pa\n", r"pad\.csv:1: no column for loss"),
        ("frequency_Hz,omega [rad/s],storage_Pa,loss_Pa\n", r"two columns for frequency"),
        ("frequency_Hz storage_Pa loss_Pa\n", r"separated by one of comma, semicolon, tab"),
        ("frequency_Hz;storage_Pa,x;loss_Pa\n", r"separated by one of comma, semicolon, tab"),
        (f"# a: b\n{HEADER}\n1,2e6\n", r"pad\.csv:3: 2 values, the header names 3"),
        (
            f"{HEADER}\n1,0,2e6,3e5\n",
            r"pad\.csv:2: 4 values, the header names 3 \(a decimal comma\? use a point\)",
        ),
        (
            "f [Hz];E' [MPa];E'' [MPa]\n1;2,5;3\n",
            r"pad\.csv:2: storage = '2,5' is not a number \(decimal point",
        ),
        (f"{HEADER}\nHz,MPa,MPa\n", r"pad\.csv:2: frequency = 'Hz' is not a number"),
        (f"{HEADER}\n1,2e6,3e5\n2,nan,3e5\n", r"pad\.csv:3: storage = nan must be finite and > 0"),
        (f"{HEADER}\n1,2e6,-3\n", r"pad\.csv:2: loss = -3 must be finite and > 0"),
        (f"{HEADER}\n0,2e6,3\n", r"pad\.csv:2: frequency = 0 must be finite and > 0"),
        (f"{HEADER}\n1,12.4,1.8\n", r"pad\.csv:2: storage = 12\.4 Pa; a solid has .*MPa written as Pa"),
        (f"{HEADER}\n", r"pad\.csv: no rows of data found"),
        ("", r"pad\.csv: no rows of data found"),
    ],
)
def test_refusals_name_file_and_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_master_curve(write(tmp_path, text))


def test_other_encodings_and_missing_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"pad\.csv: not UTF-8 at byte 2: save it as UTF-8 text"):
        read_master_curve(write(tmp_path, f"# 내장\n{HEADER}\n1,2e6,3e5\n", "euc-kr"))
    with pytest.raises(InputError, match=r"absent\.csv: no such file"):
        read_master_curve(tmp_path / "absent.csv")


def test_numbers_keep_every_digit(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    values = 10 ** rng.uniform(5, 9, (20, 3))
    text = "\n".join(",".join(repr(float(v)) for v in row) for row in values)
    curve = read_master_curve(write(tmp_path, f"{HEADER}\n{text}\n"))
    np.testing.assert_array_equal(
        np.column_stack([curve.frequency_Hz, curve.storage_Pa, curve.loss_Pa]), values
    )
