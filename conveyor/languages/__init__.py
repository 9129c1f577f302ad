"""Languages of reports: catalogues of their texts, and how a text of a report is translated by them."""

from __future__ import annotations

from typing import Final, Literal, get_args

Language = Literal["en", "de", "es", "pt", "zh"]
"""English, German, Spanish, Portuguese, Chinese (ISO 639-1)."""
LANGUAGES: Final[tuple[str, ...]] = get_args(Language)
TRANSLATED: Final = LANGUAGES[1:]
"""Languages with a catalogue; the texts arise in English."""
