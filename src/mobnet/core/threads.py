"""One thread for matrix products, also in a process that did not inherit it (`experiments.running.environment`).

Networks have small matrices: their products take longer in two threads than in one, 36 times longer where a core is
shared, and give other numbers. Whoever builds a network therefore calls `one_thread`, so that a script of a user's own
has the speed of a job. The limit holds for the process from then on.
"""

import ctypes
import re
import sys
from pathlib import Path

LOADED = Path("/proc/self/maps")
LIBRARY = re.compile(r"/\S.*openblas.*\.so.*$", re.MULTILINE)  # NumPy's and SciPy's bring one each
SET = ("scipy_openblas_set_num_threads64_", "scipy_openblas_set_num_threads", "openblas_set_num_threads")


def one_thread() -> None:
    """Let products of NumPy, SciPy and torch run in one thread, of those that this process has loaded."""
    if torch := sys.modules.get("torch"):
        torch.set_num_threads(1)
    loaded = LOADED.read_text(encoding="utf-8") if LOADED.exists() else ""
    for path in set(LIBRARY.findall(loaded)):
        library = ctypes.CDLL(path)
        if name := next((name for name in SET if hasattr(library, name)), None):
            library[name](ctypes.c_int(1))
