"""How long tests wait, and how they tell what is quick: other programs may take most of the machine meanwhile."""

import subprocess
import sys
import time
from collections.abc import Callable

HANGS_S = 900.0  # whoever waits so long waits in vain: nothing that works takes so long, however busy the machine is
STEP_S = 0.1


def wait_for(is_so: Callable[[], object], step_s: float = STEP_S) -> None:
    """Wait until something is so; fail where it never is."""
    end = time.monotonic() + HANGS_S
    while not is_so():
        assert time.monotonic() < end, "it did not come about"
        time.sleep(step_s)


def start_s() -> float:
    """Return how long a start of Snakemake takes at this moment [s]: what is to be quick is compared with it."""
    before = time.monotonic()
    subprocess.run([sys.executable, "-m", "snakemake", "--version"], check=True, capture_output=True)
    return time.monotonic() - before
