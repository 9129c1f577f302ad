"""Contrast of the page's colours, light and dark, by the formula of WCAG 2.2 (1.4.3 and 1.4.11)."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import conveyor

STYLES = (Path(conveyor.__file__).parent / "desk" / "page" / "desk.css").read_text(encoding="utf-8")
COLOURS = {
    name: pair for name, *pair in re.findall(r"--([\w-]+): light-dark\((#[0-9A-F]{6}), (#[0-9A-F]{6})\)", STYLES)
}
TEXT, DRAWN = 4.5, 3.0
"""Least contrasts of small text, and of lines and controls."""
WRITTEN = [
    *((ink, on) for ink in ("ink", "muted", "accent") for on in ("paper", "pale")),
    *((ink, on) for ink in ("good", "bad", "open", "ink") for on in (f"{ink}-pale", "paper") if on in COLOURS),
    ("ink", "good-pale"), ("ink", "bad-pale"), ("bad", "pale"), ("paper", "accent"),
    ("paper", "c0"), ("paper", "c1"),  # letters on the bars of power
]  # fmt: skip
LINES = [(f"c{i}", "paper") for i in range(6)]


def luminance(colour: str) -> float:
    """Relative luminance of an sRGB colour."""
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """Contrast of two colours."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_the_contrast_of_black_and_white_is_21():
    assert contrast("#000000", "#FFFFFF") == pytest.approx(21.0)


@pytest.mark.parametrize("theme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize(("ink", "on", "least"), [(*p, TEXT) for p in WRITTEN] + [(*p, DRAWN) for p in LINES])
def test_every_colour_is_read_on_its_ground(ink, on, least, theme):
    assert contrast(COLOURS[ink][theme], COLOURS[on][theme]) >= least


def test_the_bars_of_power_are_as_dark_as_their_colour():
    """Their letters have the colour of the card, which a bar that lets it through comes near to."""
    for rule in re.findall(r"\.bar[^{]*\{([^}]*)\}", STYLES):
        assert "opacity" not in rule
