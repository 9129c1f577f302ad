"""Tables of a result as a user gets them: written by `to_tables`, read back by name."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd


def written_tables(result: Any, folder: Path, **options: Any) -> dict[str, pd.DataFrame]:
    """Every table by the name of its file; figures are rows of "quantity" and "value"."""
    return {path.stem: pd.read_csv(path, encoding="utf-8-sig") for path in result.to_tables(folder, **options)}


def figures(table: pd.DataFrame) -> pd.Series:
    """Figures by their names, of a table of them."""
    return table.set_index("quantity")["value"]
