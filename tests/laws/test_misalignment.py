"""Drag of misaligned sets: the mean by another quadrature, its limits, and what it adds to a conveyor."""

from __future__ import annotations

import math

import pytest
from scipy.integrate import quad

import conveyor
from conveyor.errors import InputError
from conveyor.laws.horizontal_curve import FULL_SLIP_TILT, guide_friction
from conveyor.laws.misalignment import MISALIGNMENT, misalignment_friction
from conveyor.pipeline import calculate
from conveyor.units import quantity
from tests.worked_examples import SPECS

SLIP = FULL_SLIP_TILT.value


@pytest.mark.parametrize("degrees", [0.02, 0.1, 0.5, 1.0, 3.0, 5.0])
def test_mean_of_the_friction_law_over_a_normal_distribution(degrees):
    """Adaptive quadrature of `guide_friction` itself, to its own tolerance."""
    spread = math.radians(degrees)

    def lost(tilt):
        density = math.exp(-0.5 * (tilt / spread) ** 2) / (spread * math.sqrt(2.0 * math.pi))
        return 2.0 * guide_friction(tilt, friction=0.35, full_slip=SLIP) * math.sin(tilt) * density

    corner = min(SLIP, 10.0 * spread)
    expected = sum(
        quad(lost, *ends, epsabs=0.0, epsrel=1e-11)[0] for ends in ((0.0, corner), (corner, corner + 10.0 * spread))
    )
    assert misalignment_friction(spread, friction=0.35) == pytest.approx(expected, rel=1e-9)


def test_small_angles_cost_as_their_square():
    """3 μ σ²/ε_s, the next term being smaller by σ/ε_s times 1.6."""
    spread = math.radians(1e-4)
    expected = 3.0 * 0.4 * spread**2 / SLIP
    assert misalignment_friction(spread, friction=0.4) == pytest.approx(expected, rel=2.0 * spread / SLIP)
    assert misalignment_friction(0.0) == 0.0


def test_rolls_that_slide_altogether_have_the_full_friction():
    """Slip reached at once: μ E[sin ε], half-normal: μ σ sqrt(2/π) less σ³."""
    spread = math.radians(0.5)
    expected = 0.35 * spread * math.sqrt(2.0 / math.pi)
    assert misalignment_friction(spread, friction=0.35, full_slip=1e-9) == pytest.approx(expected, rel=spread**2)


@pytest.mark.parametrize("degrees", [-0.1, 5.1, math.nan])
def test_angles_that_are_none_are_refused(degrees):
    with pytest.raises(InputError, match="misalignment"):
        misalignment_friction(math.radians(degrees))


def _with(line, site, carry=None):
    sets = line.idlers.carry.replace(misalignment=carry)
    return line.replace(site=site, idlers=line.idlers.replace(carry=sets))


def test_force_by_hand():
    """Friction of each roll, the wings turned by cos λ of the set's angle, times its load, times the sets."""
    line = _with(conveyor.load(SPECS / "overland.yaml"), "plant", quantity("0.8 deg"))
    result = calculate(line)
    (force,) = (one for one in result.balance.along if one.key == "misalignment")
    trough = math.radians(line.idlers.carry.trough_angle.magnitude)
    for stretch, newtons in zip(result.line.stretches, force.newtons, strict=True):
        if stretch.strand == "carry":
            turned = [misalignment_friction(math.radians(0.8) * c) for c in (math.cos(trough), 1.0, math.cos(trough))]
            set_ = sum(mu * load.force for mu, load in zip(turned, stretch.loads, strict=True))
            assert newtons == pytest.approx(set_ * stretch.length / stretch.spacing, rel=1e-12)


def test_sites_differ_in_alignment_and_rolls_alone():
    line = conveyor.load(SPECS / "overland.yaml")
    by_site = {site: calculate(_with(line, site)).balance for site in MISALIGNMENT}
    f = [balance.friction_factor for balance in by_site.values()]
    assert f == sorted(f)
    indentation = [balance.forces.indentation for balance in by_site.values()]
    assert indentation == pytest.approx([indentation[0]] * 3, rel=1e-12)
    drags = [balance.forces.parts["idler_rotation"] for balance in by_site.values()]
    assert [drag / drags[0] for drag in drags] == pytest.approx([1.0, 1.2, 2.0], rel=1e-12)


def test_misalignment_and_site_are_refused_by_name(tmp_path):
    text = (SPECS / "overland.yaml").read_text(encoding="utf-8")
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(text.replace("site: overland", "site: swamp", 1), encoding="utf-8")
    with pytest.raises(conveyor.ConveyorError, match=r"site: got .*swamp.*overland.*plant.*poor"):
        conveyor.load(wrong)
    wrong.write_text(text.replace("  carry:\n", "  carry:\n    misalignment: 30 deg\n", 1), encoding="utf-8")
    with pytest.raises(conveyor.ConveyorError, match=r"idlers\.carry\.misalignment.*30 deg.*5 deg"):
        conveyor.load(wrong)
