"""What can go wrong, sent from one process to another: message, attributes and notes are kept."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Iterator

import pytest

from conveyor.contact.galerkin.quadrature import RuleTooLongError
from conveyor.errors import ConveyorError, InputError, PlanError, ValidityWarning


def kinds(of: type[Exception] = ConveyorError) -> Iterator[type[Exception]]:
    yield of
    for each in of.__subclasses__():
        yield from kinds(each)


def made(kind: type[Exception]) -> Exception:
    if issubclass(kind, PlanError):
        return kind([(("states", 1), "states[1]: no such state"), ((), "x" * 2000)])
    return kind("belt.width: got 0 mm, allowed: > 0\n" + "x" * 2000 + " y" * 2000)


KINDS = [*kinds(), ValidityWarning]


def test_all_are_tried() -> None:
    assert {InputError, PlanError, RuleTooLongError} <= {*KINDS}


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_the_same_in_another_process(kind: type[Exception]) -> None:
    error = made(kind)
    error.add_note("while reading spec.yaml")
    for twin in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):  # noqa: S301 made here
        assert type(twin) is kind
        assert (str(twin), twin.args, vars(twin)) == (str(error), error.args, vars(error))


def test_a_placed_error_keeps_its_places() -> None:
    problems = [(("designs", 0, "speed"), "designs[0].speed: got 0 m/s"), (("states",), "states: none")]
    read = pickle.loads(pickle.dumps(PlanError(problems)))  # noqa: S301 made here
    assert isinstance(read, InputError)
    assert read.problems == tuple(problems)
    assert str(read) == "designs[0].speed: got 0 m/s\nstates: none"
