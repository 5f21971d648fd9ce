"""The smoke scale goes on after kills where a part of it is lost.

What was made is compared with a copy of the unbroken run that no test changes.
"""

import os
import random
import signal
import time

import pytest

from .conftest import with_losses
from .smoke import manifest_of, names, products, reproduce, told

KILLS = 5
LONGEST_S = 20.0

pytestmark = [pytest.mark.slow, pytest.mark.sim]


@pytest.fixture(scope="module")
def unbroken(smoke_run):
    """The project in which the smoke scale ran, as it was at the end of the run."""
    return smoke_run / "kept"


def test_killed_at_random_moments_ends_with_the_same_tables(unbroken, make_project):
    folder = with_losses(make_project, unbroken, "killed")
    moments = random.Random(2023)
    for kill in range(KILLS):
        run = reproduce(folder, "--cores", "1")
        time.sleep(moments.uniform(1.0, LONGEST_S))
        if kill % 2:
            os.killpg(run.pid, signal.SIGKILL)
        else:
            run.kill()  # its jobs live on until they end
        run.wait()
    assert reproduce(folder, "--cores", "3").wait() == 0, told(folder)  # whatever the number of cores is
    assert products(folder) == products(unbroken)
    assert manifest_of(folder) == manifest_of(unbroken)
    assert names(folder) == names(unbroken)
