"""Ctrl-C in `./reproduce test` leaves pytest time to say which tests have failed so far."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from patience import HANGS_S, wait_for

ROOT = Path(__file__).parents[3]
TESTS = """import pathlib, time

def test_that_fails():
    assert False

def test_that_lasts():
    pathlib.Path(__file__).with_name("begun").touch()
    time.sleep(600)
"""


def test_the_summary_of_stopped_tests_names_what_failed(tmp_path):
    path = tmp_path / "test_stopped.py"
    path.write_text(TESTS)
    command = [sys.executable, str(ROOT / "reproduce"), "test", str(path), "--rootdir", str(tmp_path), "-rf"]
    tests = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
    wait_for((tmp_path / "begun").exists)
    os.killpg(tests.pid, signal.SIGINT)
    printed, _ = tests.communicate(timeout=HANGS_S)
    assert "test_that_fails" in printed.partition("short test summary")[2]
    assert tests.returncode != 0
