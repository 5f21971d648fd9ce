"""Compiled code checks no index: one out of range reads or writes what lies beside an array. Here it is checked."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

LIBRARY = Path(__file__).parents[1]
TESTS = (  # of compiled functions, but the plant's loop, which takes minutes to compile
    "control/test_geometry.py",
    "control/test_leg_ik.py",
    "detection/test_chain.py",
    "detection/test_gate.py",
    "estimation/test_low_pass.py",
    "learning/deployed/test_lanes.py",
    "reaction/test_contacts.py",
    "robot/test_momentum.py",
    "robot/test_wrench.py",
)


@pytest.mark.slow
def test_compiled_code_stays_within_its_arrays(tmp_path):
    """Code with checks cannot be cached: it is compiled as quickly as can be, in a process of its own."""
    checked = {"NUMBA_BOUNDSCHECK": "1", "NUMBA_OPT": "0", "NUMBA_CACHE_DIR": str(tmp_path)}
    words = ["-q", "-x", "-p", "no:cacheprovider", "-m", "not slow", "-W", "ignore::numba.core.errors.NumbaWarning"]
    command = [sys.executable, "-m", "pytest", *words, *(str(LIBRARY / name) for name in TESTS)]
    done = subprocess.run(command, env={**os.environ, **checked}, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
