"""Some hundreds of malformed inputs: none a traceback, a hang, an exit code 0, or a message that nobody reads."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest

from tests.robustness.arrange import Case
from tests.robustness.generated import every, name
from tests.robustness.table import run

_HANG = 60.0
"""Seconds of processor time; most take a hundredth of a second, the slowest two on a slow machine."""
_MOST = 20_000
"""Letters of all that is said."""


@pytest.mark.parametrize("case", every(), ids=name)
def test_it_is_refused_soon_and_in_words(case: Case, tmp_path: Path) -> None:
    begun = time.process_time()
    outcome = run(case, tmp_path)
    assert time.process_time() - begun < _HANG
    assert outcome.code in {1, 2}, (outcome.out, outcome.err)
    assert "Traceback" not in outcome.err
    assert outcome.err.strip()
    assert outcome.out == ""
    assert len(outcome.err) < _MOST
    assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e]", outcome.err)
    assert outcome.after == outcome.before


def test_there_are_four_hundred() -> None:
    assert len(every()) >= 400
