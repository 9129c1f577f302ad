"""Tables of the belt, the pulleys and the curves: figures put in by hand come out in the unit of their column."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from conveyor.loop.belt_duty import BeltDuty, CurveCheck, PulleyCheck
from conveyor.report.tables import belt_tables, curve_tables

DUTY = BeltDuty(
    largest_steady=100e3,
    largest=140e3,
    safety_steady=9.0,
    safety=6.5,
    safety_needed=8.0,
    per_width_steady=100e3,
    per_width=140e3,
    rating=None,
    strength_needed={"at rest": 630e3},
    drive_diameter=0.725,
    pulleys=(
        PulleyCheck("head", "head", "A", None, 0.63, 0.725, 0.8),
        PulleyCheck("snub", "return", "C", None, 0.5, 0.45675, 0.5),
    ),
    curves=(CurveCheck("dip", "carry", "concave", 250.0, 20e3, 50e3, 255.0, 70.0, 110.0, 90e3, 12e3),),
)
BELT = SimpleNamespace(stiffness=None, strength=None, covers=())
OF_DUTY = SimpleNamespace(belt_duty=DUTY, line=SimpleNamespace(belt=BELT, wind_speed=None))


def test_strength_in_newtons_a_millimetre_and_diameters_in_millimetres():
    table = belt_tables.belt_strength_table(OF_DUTY).series("belt")
    assert table["belt strength required by the splice [N/mm]"] == pytest.approx(630.0)
    assert table["minimum diameter of drive pulleys [mm]"] == pytest.approx(725.0)
    assert table["maximum tension, all states [N]"] == pytest.approx(140e3)
    assert table["safety, steady [-]"] == pytest.approx(9.0)
    assert table["required safety [-]"] == pytest.approx(8.0)
    pulleys = belt_tables.pulley_table(OF_DUTY).frame()
    assert pulleys["diameter [mm]"].tolist() == pytest.approx([630.0, 500.0])
    assert pulleys["minimum [mm]"].tolist() == pytest.approx([725.0, 456.75])
    assert pulleys["standard size [mm]"].tolist() == pytest.approx([800.0, 500.0])
    assert pulleys["large enough"].tolist() == [False, True]


def test_a_curve_beside_its_least_radii():
    (row,) = curve_tables.vertical_curves(OF_DUTY, [SimpleNamespace(found=OF_DUTY)]).frame().to_dict("records")
    assert row["radius [m]"] == pytest.approx(250.0)
    assert row["minimum against lift-off [m]"] == pytest.approx(255.0)
    assert row["minimum against overstress [m]"] == pytest.approx(70.0)
    assert row["minimum against slack strips [m]"] == pytest.approx(110.0)
    assert (row["highest in a strip [N/mm]"], row["lowest in a strip [N/mm]"]) == pytest.approx((90.0, 12.0))
    assert (row["lowest tension [N]"], row["highest tension [N]"]) == pytest.approx((20e3, 50e3))
