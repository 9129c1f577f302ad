"""Resistance of ploughs that sweep the bulk off the belt.

Source: ISO 5048, DIN 22101. A tripper has no law of its own there: it is a lift and its pulleys.
"""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require, require_not_negative
from conveyor.laws.resistance.resistance_defaults import Default

# Scraping factor k_a [N/m]
SCRAPING_FACTOR: Final = Default(1500.0, 1500.0, 1500.0, "ISO 5048: k_a, normally 1500 N/m", True)


def plough_resistance(scraped_width: float, *, scraping_factor: float, n_ploughs: int = 1) -> float:
    """Resistance of ploughs, F_a = n B k_a (ISO 5048, DIN 22101).

    Parameters
    ----------
    scraped_width : float
        B, width of belt or bulk swept [m], at least 0.
    scraping_factor : float
        k_a [N/m], at least 0; default of the craft `SCRAPING_FACTOR`.
    n_ploughs : int
        Ploughs that sweep at the same time [-], at least 0.

    Returns
    -------
    float
        F_a [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The standard's k_a knows neither the bulk's density nor the speed: an order of magnitude.

    Examples
    --------
    >>> plough_resistance(1.2, scraping_factor=1500.0)
    1800.0
    """
    require_not_negative(scraped_width=scraped_width, scraping_factor=scraping_factor)
    require(n_ploughs >= 0, "n_ploughs", n_ploughs, ">= 0")
    return n_ploughs * scraped_width * scraping_factor
