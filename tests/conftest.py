"""Workers of pytest-xdist share the cores: each takes one thread for BLAS, which numpy reads once, when imported.

No test has a time limit of its own: a busy machine is no fault.
"""

from __future__ import annotations

import os

from hypothesis import settings

if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile("without time limits", deadline=None)
settings.load_profile("without time limits")
