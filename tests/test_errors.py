"""Errors cross processes whole: with their words, and what they carry."""

from __future__ import annotations

import pickle

import pytest

from conveyor import errors
from conveyor.errors import ConveyorError, PlacedError

PLAIN = [one for one in vars(errors).values()
         if isinstance(one, type) and issubclass(one, ConveyorError) and one is not PlacedError]  # fmt: skip


@pytest.mark.parametrize("kind", PLAIN, ids=lambda kind: kind.__name__)
def test_an_error_unpickles(kind):
    found = pickle.loads(pickle.dumps(kind("belt.mass: got 3 kg")))  # noqa: S301 our own
    assert (type(found), str(found)) == (kind, "belt.mass: got 3 kg")


def test_a_placed_error_keeps_its_places():
    problems = ((("axes", 0), "not known"), (("limits",), "above most"))
    found = pickle.loads(pickle.dumps(PlacedError(problems)))  # noqa: S301 our own
    assert (found.problems, str(found)) == (problems, "not known\nabove most")
