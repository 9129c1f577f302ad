"""Scatter of the indentation from lot to lot of one compound."""

from __future__ import annotations

from typing import Final

LOT_SCATTER: Final = 0.08
"""Half-width of the 90 % interval of the indentation over the lots of one compound, where nobody states it [-].

Indentation goes as tan δ E'^(-1/3). A usual tolerance of delivery, 3 Shore A, is 12 % of E' at 60 Shore A (A. N. Gent,
Rubber Chem. Technol. 31 (1958) 896-906), 4 % of the indentation; tan δ of lots mixed to one recipe scatters by 7 %
(general knowledge): 8 % together.
"""
LARGEST_LOT_SCATTER: Final = 0.5
"""Beyond it lots are no lots of one compound (general knowledge) [-]."""
