"""Several drives: Eytelwein pulley by pulley, the best split, the loop's constant, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import drive as drive_laws
from conveyor.laws import tension

ROUNDING = 1e-13


def test_one_pulley_in_a_row_is_eytelweins():
    index, slack = drive_laws.tandem_slack([1e4], frictions=[0.35], wrap_angles=[3.5])
    grip = tension.grip_tension(1e4, friction=0.35, wrap_angle=3.5)
    assert (index, slack) == (0, pytest.approx(grip, rel=ROUNDING))


@pytest.mark.parametrize("wraps", [(3.2, 3.6), (3.6, 3.2), (1.0, 6.0), (2.0, 3.0, 3.5)])
def test_best_split_grips_like_one_pulley_of_the_summed_wrap(wraps):
    frictions = [0.3] * len(wraps)
    shares = drive_laws.full_grip_shares(frictions=frictions, wrap_angles=wraps)
    assert sum(shares) == pytest.approx(1, rel=ROUNDING)
    _, slack = drive_laws.tandem_slack([s * 1e5 for s in shares], frictions=frictions, wrap_angles=wraps)
    together = tension.grip_tension(1e5, friction=0.3, wrap_angle=sum(wraps))
    assert slack == pytest.approx(together, rel=1e-12)


@pytest.mark.parametrize("first", [0.0, 0.3, 0.5, 2 / 3, 0.9, 1.0])
def test_any_other_split_needs_more(first):
    best, _ = drive_laws.full_grip_shares(frictions=[0.3, 0.3], wrap_angles=[3.4, 3.4])
    _, slack = drive_laws.tandem_slack(
        [first * 1e5, (1 - first) * 1e5], frictions=[0.3, 0.3], wrap_angles=[3.4, 3.4]
    )
    assert abs(first - best) > 0.01
    assert slack > tension.grip_tension(1e5, friction=0.3, wrap_angle=6.8)


def test_best_split_of_equal_pulleys_is_the_ratio_of_tensions():
    first, second = drive_laws.full_grip_shares(frictions=[0.3, 0.3], wrap_angles=[3.0, 3.0])
    assert first / second == pytest.approx(math.exp(0.9), rel=ROUNDING)


def test_every_pulley_of_a_row_grips_and_one_is_at_its_limit():
    forces, frictions, wraps = [60e3, 40e3, 20e3], [0.3, 0.35, 0.25], [3.2, 3.6, 3.0]
    governs, slack = drive_laws.tandem_slack(forces, frictions=frictions, wrap_angles=wraps)
    used = []
    for force, friction, wrap in reversed(list(zip(forces, frictions, wraps, strict=True))):
        used.append(drive_laws.used_wrap(force, slack_tension=slack, friction=friction) / wrap)
        slack += force
    used.reverse()
    assert max(used) == pytest.approx(1, rel=1e-12)
    assert used.index(max(used)) == governs


def test_idle_row_needs_nothing():
    assert drive_laws.tandem_slack([0.0, 0.0], frictions=[0.3, 0.3], wrap_angles=[3.0, 3.0]) == (1, 0.0)


def test_loop_tension_meets_every_condition_and_one_just():
    minima = {"grip head": (8e3, 0.0), "grip tail": (5e3, 2e3), "sag return": (6e3, -4e3)}
    found = drive_laws.loop_tension(minima)
    spare = {name: found.tension + offset - least for name, (least, offset) in minima.items()}
    assert min(spare.values()) == 0
    assert min(spare, key=spare.get) == found.governed_by == "sag return"


def test_loop_tension_moves_with_its_reference_point():
    minima = {"a": (8e3, 1e3), "b": (5e3, -6e3)}
    moved = {name: (least, offset - 500.0) for name, (least, offset) in minima.items()}
    assert drive_laws.loop_tension(moved).tension == drive_laws.loop_tension(minima).tension + 500.0


def test_head_and_tail_drive_each_grip():
    # carry strand 100 kN, return 20 kN of resistance; head 90 kN, tail 30 kN; reference: behind the head
    head, tail, grip = 90e3, 30e3, {"friction": 0.3, "wrap_angle": math.pi}
    head_on, tail_on = head, 20e3
    minima = {
        name: (tension.grip_tension(f, **grip), drive_laws.slack_side_offset(f, run_on_offset=on))
        for name, f, on in (("head", head, head_on), ("tail", tail, tail_on))
    }
    assert minima["head"][1] == 0
    assert minima["tail"][1] == -10e3
    found = drive_laws.loop_tension(minima)
    for force, on in ((head, head_on), (tail, tail_on)):
        run_on = found.tension + on
        assert run_on / (run_on - force) <= math.exp(0.3 * math.pi) * (1 + ROUNDING)
    assert found.governed_by == "head"
    # once round the loop: what the drives give the strands take
    assert head + tail == 100e3 + 20e3


def test_braking_pulley_is_slack_where_the_belt_runs_on():
    assert drive_laws.slack_side_offset(-2e4, run_on_offset=5e3) == 5e3
    assert drive_laws.slack_side_offset(0.0, run_on_offset=5e3) == 5e3


def test_used_wrap_is_the_inverse_of_the_grip():
    slack = tension.grip_tension(1e4, friction=0.3, wrap_angle=2.5)
    assert drive_laws.used_wrap(1e4, slack_tension=slack, friction=0.3) == pytest.approx(2.5, rel=ROUNDING)
    assert drive_laws.used_wrap(-1e4, slack_tension=slack, friction=0.3) == pytest.approx(2.5, rel=ROUNDING)
    assert drive_laws.used_wrap(0.0, slack_tension=slack, friction=0.3) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: drive_laws.loop_tension({}), r"minima = \{\} is not allowed: at least one condition"),
        (lambda: drive_laws.loop_tension({"grip": (-1.0, 0.0)}), r"grip = -1\.0"),
        (lambda: drive_laws.loop_tension({"sag": (1.0, math.nan)}), r"sag = nan"),
        (
            lambda: drive_laws.tandem_slack([1.0, 2.0], frictions=[0.3], wrap_angles=[3.0, 3.0]),
            r"frictions = \[0\.3\] is not allowed: one for each of 2 pulleys",
        ),
        (
            lambda: drive_laws.tandem_slack([], frictions=[], wrap_angles=[]),
            r"forces = \[\] .* at least one pulley",
        ),
        (lambda: drive_laws.tandem_slack([-1.0], frictions=[0.3], wrap_angles=[3.0]), r"forces = -1\.0"),
        (
            lambda: drive_laws.tandem_slack([1.0], frictions=[0.3], wrap_angles=[180.0]),
            r"wrap_angle = 180\.0",
        ),
        (lambda: drive_laws.full_grip_shares(frictions=[], wrap_angles=[]), r"frictions = \[\]"),
        (
            lambda: drive_laws.full_grip_shares(frictions=[0.3], wrap_angles=[1.0, 2.0]),
            r"wrap_angles = \[1\.0, 2\.0\]",
        ),
        (lambda: drive_laws.used_wrap(1.0, slack_tension=0.0, friction=0.3), r"slack_tension = 0\.0"),
        (lambda: drive_laws.slack_side_offset(math.inf, run_on_offset=0.0), r"drive_force = inf"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
