"""Arguments of the API of a wrong type: one kind of error that names them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import conveyor
from conveyor import shelf
from conveyor.contact import ContactProblem, CreepSpectrum, load_curves, solve
from conveyor.errors import InputError

SPECS = Path(__file__).parent.parent / "examples" / "specs"
LINE = conveyor.load(SPECS / "shuttle.yaml")
SCENE = ContactProblem("confined", 0.1, 0.01, CreepSpectrum(0.5, [0.5], [1.0]))

CALLS: dict[str, Callable[[Any], object]] = {
    r"load: path: expected str \| Path, got 5 \(int\)": lambda _: conveyor.load(5),
    r"load: got an unexpected keyword argument 'shelf'": lambda _: conveyor.load("a.yaml", shelf="a"),
    r"load: shelves: expected Iterable\[str \| Path\], got 'x' \(str\)": lambda _: conveyor.load("a.yaml", shelves="x"),
    r"to_excel: path: expected": lambda result: result.to_excel(5),
    r"to_excel: studies: expected Studies, got 5 \(int\)": lambda result: result.to_excel("a.xlsx", 5),
    r"compare_compounds: conveyor: expected Conveyor, got 'x'": lambda _: conveyor.compare_compounds("x", ["s100"]),
    r"compare_compounds: compounds: expected .*, got 's100'": lambda _: conveyor.compare_compounds(LINE, "s100"),
    r"compare_compounds: compounds: expected .*, got \[3\]": lambda _: conveyor.compare_compounds(LINE, [3]),
    r"temperatures: expected .*, got 20 \(int\)": lambda _: conveyor.compare_compounds(LINE, ["s100"], temperatures=20),
    r'cover = "x": allowed are bottom, top, both': lambda _: conveyor.compare_compounds(LINE, ["s100"], cover="x"),
    r"temperatures\[1\]: got 283.0 without a unit": lambda _: conveyor.compare_compounds(
        LINE, ["s100"], temperatures=["20 degC", 283.0]
    ),
    r"temperatures\[0\]: got 293.0 without a unit": lambda _: conveyor.compare_compounds(
        LINE, ["s100"], temperatures=np.array([293.0, 283.0])
    ),
    r"temperatures\[0\]: got -400 degC, below absolute zero": lambda _: conveyor.compare_compounds(
        LINE, ["s100"], temperatures=["-400 degC"]
    ),
    r"workers: got 0, allowed: a whole number from 1 to 1024": lambda _: conveyor.compare_compounds(
        LINE, ["s100"], workers=0
    ),
    r"workers: got -1, allowed": lambda _: conveyor.study(SPECS.parent / "studies" / "spacing.yaml", workers=-1),
    r"speeds\[0\]: got -5 m/s, allowed: > 0": lambda _: conveyor.compare_compounds(LINE, ["s100"], speeds=["-5 m/s"]),
    r"analyse_cases: conveyor: expected Conveyor, got 3": lambda _: conveyor.analyse_cases(3),
    r"analyse_duty: conveyor: expected Conveyor, got None": lambda _: conveyor.analyse_duty(None),
    r"compound: name_or_path: expected": lambda _: shelf.compound(3),
    r"solve: problem: expected ContactProblem, got 3": lambda _: solve(3),
    r"solve: rtol: expected float, got '1e-6' \(str\)": lambda _: solve(SCENE, "1e-6"),
    r"load_curves: problems: expected": lambda _: load_curves([1], [1], [2]),
    r"rtol: got -1, allowed: >= 1e-12": lambda _: load_curves([SCENE], [0.001], [0.01], -1),
    r"CreepSpectrum: instantaneous: expected float, got 'a'": lambda _: CreepSpectrum("a"),
    r"weights and times: two lists of numbers are needed": lambda _: CreepSpectrum(0.5, ["a"], ["b"]),
    r"thickness: got 1e\+300, allowed": lambda _: ContactProblem("free", 0.1, 0.01, SCENE.creep, 1e300),
}  # fmt: skip


@pytest.fixture(scope="module")
def result() -> conveyor.Analysis:
    return conveyor.analyse(LINE)


@pytest.mark.parametrize("message", CALLS)
def test_a_wrong_argument_is_named(message: str, result: conveyor.Analysis) -> None:
    with pytest.raises(InputError, match=message):
        CALLS[message](result)
