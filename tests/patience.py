"""How long tests wait, and how they tell what is quick: other programs may take most of the machine meanwhile."""

import signal
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


def hear_ctrl_c() -> None:
    """Let Ctrl-C reach this process and all that it starts.

    A shell lets its background processes ignore it, as `nohup` does, and with them all that they start.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
