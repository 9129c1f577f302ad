"""Imported before pint, it keeps dask out: pint reads it, a tenth of a second, for arrays that no command has."""

from __future__ import annotations

import sys

if "dask" not in sys.modules and "pint" not in sys.modules:
    sys.modules["dask"] = None  # type: ignore[assignment] as Python marks what is not to be found
    try:
        import pint  # noqa: F401
    finally:
        del sys.modules["dask"]
