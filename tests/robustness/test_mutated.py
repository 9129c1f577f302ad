"""Specs and compound files damaged at random (seeded): an answer, or a message with its place, and soon."""

from __future__ import annotations

import random
import re
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from conveyor import shelf, spec, starter
from conveyor.errors import InputError
from tests.robustness.arrange import SPEC, Case, power
from tests.robustness.mutate import mutated
from tests.robustness.table import run

_BLOCKS = 5
_READ = 30
"""Mutants read in each block."""
_RUN = 6
"""Mutants run through the command line in each block, calculation and all."""
_LONGEST = 2.0
"""Seconds of processor time; most take a hundredth."""
_COMMENT = re.compile(r" +#.*")
_TEXTS = (SPEC, _COMMENT.sub("", starter.starter_text("in-plant")))


def _seeded(seed: int) -> random.Random:
    return random.Random(seed)  # noqa: S311 a repeatable test, no secret


def _refusal(read: Callable[[Path], object], path: Path) -> str | None:
    try:
        read(path)
    except InputError as error:
        return str(error)
    return None


def _is_placed(message: str, path: Path) -> bool:
    return re.match(rf"{re.escape(str(path))}:[0-9]+:[0-9]+ .+: .+", message.split("\n", 1)[0]) is not None


@pytest.mark.parametrize("seed", range(_BLOCKS))
def test_a_damaged_spec_is_read_or_refused_with_places(seed: int, tmp_path: Path) -> None:
    seeded, path, seen = _seeded(seed), tmp_path / "spec.yaml", set()
    for k in range(_READ):
        path.write_bytes(mutated(seeded.choice(_TEXTS), seeded))
        begun = time.process_time()
        message = _refusal(spec.load, path)
        assert time.process_time() - begun < _LONGEST, (seed, k)
        assert message is None or _is_placed(message, path), (seed, k, message)
        seen.add(message is None)
    assert seen == {True, False}  # neither too much damage nor too little


@pytest.mark.parametrize("seed", range(_BLOCKS))
def test_the_command_line_ends_with_a_code_and_a_message(seed: int, tmp_path: Path) -> None:
    seeded = _seeded(1000 + seed)
    for k in range(_RUN):
        case = Case("mutant", f"{seed}.{k}", power(mutated(seeded.choice(_TEXTS), seeded)), "")
        outcome = run(case, tmp_path)
        assert outcome.code in {0, 1, 2}, (seed, k, outcome.err)
        assert outcome.code == 0 or outcome.err.strip(), (seed, k)
        assert "Traceback" not in outcome.err
        assert outcome.after == outcome.before
        assert not re.search(r"\b(?:nan|inf)\b", outcome.out), (seed, k, outcome.out)


@pytest.mark.parametrize("seed", range(_BLOCKS))
def test_a_damaged_compound_file_is_read_or_refused_with_places(seed: int, tmp_path: Path) -> None:
    text = (shelf.built_in() / "standard-cover.yaml").read_text(encoding="utf-8")
    seeded, path = _seeded(2000 + seed), tmp_path / "mine.yaml"
    for k in range(_READ // 3):
        path.write_bytes(mutated(text, seeded))
        message = _refusal(shelf.read_compound, path)
        assert message is None or _is_placed(message, path), (seed, k, message)
