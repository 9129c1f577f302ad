"""Pulleys that stand in where a route has none: their places, diameters, wraps and resistances."""

from __future__ import annotations

import pytest

from conveyor.line.line import Line
from tests.loop.loop_lines import TAIL_DRIVE, balanced, line

LEAST = 145 * 0.005
"""Least diameter of a drive pulley by DIN 22101 for the 5 mm of steel cord of the plain line [m]."""


def bare(**route):
    return {"pulleys": []} | route


def test_usual_pulleys_at_a_drive_have_its_diameter():
    at_head = Line.of(line(route=bare(), drive={"pulley_diameter": "1 m"}))
    assert [pulley.diameter for pulley in at_head.pulleys] == pytest.approx([1.0, LEAST])
    assert at_head.pulleys[0].shaft_diameter == pytest.approx(0.2)
    second = TAIL_DRIVE | {"pulley_diameter": "1.25 m"}
    at_tail = Line.of(line(route=bare(), drive={"further_drives": [second]}))
    assert [pulley.diameter for pulley in at_tail.pulleys] == pytest.approx([LEAST, 1.25])


def test_a_larger_drive_pulley_wraps_more_easily():
    """DIN 22101: wrap resistance is inverse to the diameter, at the same tensions but for what it changes itself."""
    small, large = (
        next(force.total for force in balanced(route=bare(), drive=drive).singles if force.name == "wrap, head")
        for drive in ({}, {"pulley_diameter": "1.45 m"})
    )
    assert large == pytest.approx(0.5 * small, rel=0.01)
