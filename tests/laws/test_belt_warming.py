"""Warming of a belt by its own indentation."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.laws.belt_warming import belt_warming, heat_transfer


def test_heat_given_off_is_the_loss():
    """The heat that all open faces give off at that temperature is what the covers lose."""
    width, length, speed, loss = 1.4, 3000.0, 4.0, 150e3
    rise = belt_warming(loss, width=width, length=length, speed=speed)
    carry, back = (faces * width * length * heat_transfer(speed) * rise for faces in (1, 2))
    assert carry + back == pytest.approx(loss)


def test_the_two_laws_of_heat_transfer_meet():
    """Juerges' laws differ by a tenth where one takes over from the other, and by no more."""
    below, above = heat_transfer(5.0), heat_transfer(5.0 + 1e-9)
    assert below == pytest.approx(24.7)
    assert above == pytest.approx(below, rel=0.1)


@pytest.mark.parametrize("field", ["width", "length"])
def test_refusals(field):
    with pytest.raises(InputError, match=field):
        belt_warming(1e3, **({"width": 1.0, "length": 100.0} | {field: 0.0}), speed=3.0)
    with pytest.raises(InputError, match="loss"):
        belt_warming(-1.0, width=1.0, length=100.0, speed=3.0)
