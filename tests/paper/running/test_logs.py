"""A job tells an expected error in one line, ends with status 1, and accounts for what it took."""

import logging
import signal
import subprocess
import sys
import time

import pytest
from patience import HANGS_S

from experiments.running.accounts import Account
from experiments.running.logs import job
from mobnet.core.errors import DataError
from mobnet.core.files import read_json

GREEDY = """
import subprocess, sys
from experiments.running.logs import job
with job(sys.argv[1]):
    subprocess.run([sys.executable, "-c", "bytearray(300 << 20); sum(range(10**7))"], check=True)
"""


def fail(error):
    raise error


def account(path):
    return Account(**read_json(path.with_suffix(".json")))


def test_expected_error_is_one_line_in_log_and_terminal(tmp_path, capsys):
    path = tmp_path / "logs" / "a.log"
    with pytest.raises(SystemExit) as caught, job(path):
        fail(DataError("a.parquet: truncated"))
    assert caught.value.code == 1
    assert path.read_text().splitlines()[-1].endswith("ERROR a.parquet: truncated")
    assert capsys.readouterr().err == path.read_text()


def test_a_fault_of_the_program_keeps_its_traceback(tmp_path):
    with pytest.raises(ZeroDivisionError), job(tmp_path / "a.log"):
        fail(ZeroDivisionError())


def test_logging_and_signals_are_as_before_afterwards(tmp_path):
    before = logging.getLogger().handlers[:], signal.getsignal(signal.SIGTERM)
    with job(tmp_path / "a.log"):
        logging.getLogger("mobnet.some").info("progress")
    assert (logging.getLogger().handlers, signal.getsignal(signal.SIGTERM)) == before
    assert (tmp_path / "a.log").read_text().endswith("INFO progress\n")


@pytest.mark.parametrize(("log", "name"), [("logs/collect/walk-s1.log", "collect/walk-s1"), ("paper.log", "paper")])
def test_account_says_when_and_how_long(tmp_path, log, name):
    before, began, used = time.time(), time.monotonic(), time.process_time()
    with job(tmp_path / log):
        time.sleep(0.2)
    took_s, used_s = time.monotonic() - began, time.process_time() - used
    told = account(tmp_path / log)
    assert (told.job, told.succeeded) == (name, True)
    assert before - 0.01 <= told.start_s <= told.end_s <= time.time() + 0.01
    assert 0.19 <= told.end_s - told.start_s <= took_s + 0.01
    assert 0.19 <= told.wall_s <= took_s + 0.01
    assert told.cpu_s <= used_s + 0.01


def test_children_count(tmp_path):
    subprocess.run([sys.executable, "-c", GREEDY, tmp_path / "a.log"], check=True)
    told = account(tmp_path / "a.log")
    assert 300 < told.peak_mib < 400
    assert 0.1 < told.cpu_s <= told.wall_s + 0.1


SWALLOWING = """
import ctypes, sys, time
from experiments.running import logs

def wait():
    print("begun", flush=True)
    time.sleep(900)

logs.AGAIN_S = 1
with logs.job(sys.argv[1]):
    ctypes.CFUNCTYPE(None)(wait)()  # as numba calls functions while it compiles: Python ignores what they raise
    print("goes on", flush=True)
    time.sleep(900)
"""


@pytest.mark.parametrize("signals", [1, 2])
def test_a_job_that_loses_the_first_exit_ends_all_the_same(tmp_path, signals):
    """By itself after a while, and at a second signal at once."""
    words = [sys.executable, "-c", SWALLOWING, tmp_path / "a.log"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as child:
        assert child.stdout.readline() == b"begun\n"
        child.terminate()
        assert child.stdout.readline() == b"goes on\n"
        if signals > 1:
            child.terminate()
        assert child.wait(HANGS_S) in (128 + signal.SIGTERM, 128 + signal.SIGALRM)
    assert not account(tmp_path / "a.log").succeeded


@pytest.mark.parametrize("number", [None, signal.SIGTERM, signal.SIGINT])
def test_a_job_that_fails_or_is_interrupted_says_so(tmp_path, number):
    with pytest.raises((SystemExit, KeyboardInterrupt)), job(tmp_path / "a.log"):
        signal.raise_signal(number) if number else fail(DataError("damaged"))
    assert not account(tmp_path / "a.log").succeeded


def test_a_job_that_is_killed_leaves_no_account_of_the_run_before(tmp_path):
    with job(tmp_path / "a.log"):
        pass
    with job(tmp_path / "a.log"):
        assert not (tmp_path / "a.json").exists()
