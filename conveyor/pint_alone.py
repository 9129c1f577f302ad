"""Imported before pint, it keeps dask out: pint reads it, a tenth of a second, for arrays that no command has.

None in `sys.modules` is how Python marks what is not to be found.
"""

from __future__ import annotations

import sys

if "dask" not in sys.modules and "pint" not in sys.modules:
    sys.modules["dask"] = None  # type: ignore[assignment]
    try:
        import pint  # noqa: F401
    finally:
        del sys.modules["dask"]
