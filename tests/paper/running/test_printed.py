"""How a command ends: with lines, or with one line and no traceback."""

import errno
import logging
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from mobnet.core.code import ROOT
from mobnet.core.errors import DataError
from mobnet.core.printed import STOPPED, printed

CODE = """
import logging
from mobnet.core.printed import printed
raise SystemExit(printed(logging.getLogger("own"), lambda: (f"line {k}" for k in range(100_000))))
"""


def test_a_closed_pipe_is_no_traceback():
    with subprocess.Popen([sys.executable, "-c", CODE], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
        assert child.stdout.readline() == b"line 0\n"
        child.stdout.close()
        assert child.stderr.read() == b""
    assert child.returncode != 0


def raising(error):
    def lines():
        raise error

    return lines


@pytest.mark.parametrize(
    ("error", "status", "line"),
    [
        (DataError("log.csv: 'a\x1b[2J\0' is not accepted"), 1, "log.csv: 'a\\x1b[2J\\x00' is not accepted"),
        (MemoryError("Unable to allocate 4.47 GiB"), 1, "out of memory: Unable to allocate 4.47 GiB; accepted: a"),
        (
            OSError(errno.EROFS, os.strerror(errno.EROFS), "/out"), 1,
            "/out: cannot be written: Read-only file system; accepted: a folder that you may write to",
        ),
        (KeyboardInterrupt(), 130, STOPPED),
    ],
    ids=["refused", "memory", "read-only", "Ctrl-C"],
)  # fmt: skip
def test_what_goes_wrong_is_one_line(error, status, line, caplog):
    assert printed(logging.getLogger("own"), raising(error)) == status
    (said,) = caplog.messages
    assert said.startswith(line)


def test_errors_of_the_program_are_not_hidden():
    with pytest.raises(ValueError, match="a fault of ours"):
        printed(logging.getLogger("own"), raising(ValueError("a fault of ours")))


HELD_BACK = """
import logging, signal, time
from mobnet.core.printed import printed
print("ready", flush=True)
time.sleep(0.3)  # as while packages are imported
printed(logging.getLogger("own"), lambda: iter([time.sleep(900)]), "stopped, and so on")
"""


def test_ctrl_c_while_packages_are_imported_is_answered_by_the_command():
    """`./reproduce` blocks it until the command can answer; else it would print nothing for a quarter of an hour."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        child = subprocess.Popen([sys.executable, "-c", HELD_BACK], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    with child:
        assert child.stdout.readline() == b"ready\n"
        child.send_signal(signal.SIGINT)
        assert child.stdout.read() + child.stderr.read() == b"stopped, and so on\n"


FULL = "standard output: cannot be written: No space left on device; what was to be printed is lost\n"


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("words", [
    ("reproduce", "--help"), ("reproduce", "--version"), ("reproduce", "demo", "--help"), ("-m", "mobnet", "--help"),
    ("-c", CODE.replace("100_000", "3")),
])  # fmt: skip
def test_a_full_disk_behind_standard_output_is_one_line_and_no_success(words, unbuffered):
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    with Path("/dev/full").open("w") as full:
        streams = {"stdout": full, "stderr": subprocess.PIPE, "text": True}
        done = subprocess.run([sys.executable, *words], cwd=ROOT, env=environment, check=False, **streams)
    assert done.stderr == FULL
    assert done.returncode == 1
