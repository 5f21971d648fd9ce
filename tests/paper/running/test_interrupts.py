"""A run that is stopped prints one line and nothing after it, ends its jobs, and ends with its own status."""

import signal
import subprocess
import sys

import pytest
from patience import HANGS_S

LINE = "stopped; the same command goes on from here\n"
RUN = """
import ctypes, signal, subprocess, sys, threading, time
from experiments.running import interrupts, processes

interrupts.AGAIN_S = 1
processes.LONGEST_S = 1.0
answers = interrupts.Interrupts()

def wait():
    print("begun", flush=True)
    time.sleep(900)

if sys.argv[1] == "before":
    wait()
if sys.argv[1] == "lost":
    ctypes.CFUNCTYPE(None)(wait)()  # Python ignores what it raises
    time.sleep(900)
told = threading.Event()
signal.signal(signal.SIGTERM, lambda *_: told.set())  # as Snakemake does, before it calls `onstart`
answers.jobs_begin(are_local=True)
job = "print('begun', flush=True); import time; time.sleep(900)"
if sys.argv[1] == "deaf":
    job = f"import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); {job}"
subprocess.run(f'{processes.PREFIX} {sys.executable} -c "{job}"; true', shell=True, executable="bash")
assert told.wait(900)
print("Snakemake says more")
sys.exit(1)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("when", ["before", "lost", "jobs", "deaf"])
def test_a_stopped_run_says_one_line(number, when):
    words = [sys.executable, "-c", RUN, when]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout.readline() == "begun\n"
        run.send_signal(number)
        out, said = run.communicate(timeout=HANGS_S)
    assert (run.returncode, said, out) == (128 + number, LINE, "")
