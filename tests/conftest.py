"""Workers of pytest-xdist share the cores: each takes one thread for BLAS, which numpy reads once, when imported."""

from __future__ import annotations

import os

if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
