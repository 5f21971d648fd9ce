"""What a job of the workflow tells: progress to its log, an error as one line to the terminal too, and what it took."""

import contextlib
import logging
import os
import re
import resource
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from experiments.running.accounts import Account
from mobnet.core.code import commit
from mobnet.core.errors import DataError, MobnetError
from mobnet.core.files import REFUSALS, refusal, write_json
from mobnet.core.source import PACKAGES

log = logging.getLogger(__name__)
FORMAT = "%(asctime)s %(levelname)s %(message)s"
LOGS = "logs"  # folder of the jobs' logs, in which each rule with several jobs has a folder of its own
STATUS = Path("/proc/self/status")
MIB = 2**20
AGAIN_S = 5  # until a job that was told to end is told again


@contextlib.contextmanager
def job(log_file: Path | str) -> Iterator[None]:
    """Log a job to its file, write its account beside the log, as JSON, when it ends; print warnings and errors.

    Raises:
        SystemExit: the job raised a MobnetError, whose message is the last line of the log, or was terminated.
    """
    path = Path(log_file)
    with terminable(), accounted(path), logged(path):
        yield


@contextlib.contextmanager
def logged(path: Path) -> Iterator[None]:
    """Log to a file, print warnings and errors; an expected error is one line, and the end with status 1.

    What shows a run follows the file (`experiments.running.progress`).
    """
    printed = logging.StreamHandler(sys.stderr)
    printed.setLevel(logging.WARNING)
    handlers = [printed, *log_file(path)]
    root = logging.getLogger()
    previous = root.handlers[:], root.level
    root.handlers[:] = []
    for handler in handlers:
        handler.setFormatter(logging.Formatter(FORMAT, "%H:%M:%S"))
        root.addHandler(handler)
    for package in PACKAGES:
        logging.getLogger(package).setLevel(logging.INFO)
    logging.captureWarnings(capture=True)
    logging.raiseExceptions = False  # no job fails, or says more, because a full disk cuts its log short
    try:
        yield
    except MobnetError as error:
        log.error("%s", error)
        raise SystemExit(1) from None
    except OSError as error:
        if error.errno not in REFUSALS:
            printed.setLevel(logging.CRITICAL)
            log.exception("a fault of the system")
            raise
        log.error("%s", refusal(error, Path(error.filename2 or error.filename or fullest())))
        raise SystemExit(1) from None
    except Exception:
        printed.setLevel(logging.CRITICAL)  # Python prints the traceback itself
        log.exception("a fault of the code")
        raise
    finally:
        logging.captureWarnings(capture=False)
        for handler in handlers[1:]:
            with contextlib.suppress(OSError):
                handler.close()
        root.handlers[:], root.level = previous


def log_file(path: Path) -> list[logging.Handler]:
    """Return the handler of a new log; none where it cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        return [logging.FileHandler(path, mode="w", encoding="utf-8")]
    except OSError as error:
        sys.stderr.write(f"{refusal(error, path)}\n")
        return []


def fullest() -> str:
    """Return the folder with the least free space of those in which packages write files of their own."""
    places = [tempfile.gettempdir(), os.environ.get("NUMBA_CACHE_DIR", "."), "."]
    return min((place for place in places if Path(place).is_dir()), key=lambda place: shutil.disk_usage(place).free)


def account_name(log_path: Path) -> str:
    """Return the name of a job by its log: its place below the folder of logs."""
    below = log_path.with_suffix("").parts
    return "/".join(below[below.index(LOGS) + 1 :] if LOGS in below else below[-1:])


@contextlib.contextmanager
def accounted(log_path: Path) -> Iterator[None]:
    """Write what happens meanwhile took beside a log; a job that is killed outright leaves no account."""
    account = log_path.with_suffix(".json")
    with contextlib.suppress(OSError):
        account.unlink(missing_ok=True)
    made_by = commit()
    name = account_name(log_path)
    start_s = time.time()
    begin = time.monotonic()
    used_s = cpu_s()
    succeeded = False
    try:
        yield
        succeeded = True
    finally:
        wall_s = time.monotonic() - begin
        used_s = cpu_s() - used_s
        entry = Account(name, start_s, time.time(), wall_s, used_s, peak_mib(), succeeded, made_by)
        rounded = {key: round(value, 3) for key, value in asdict(entry).items() if isinstance(value, float)}
        with contextlib.suppress(DataError):  # on a full disk
            write_json(account, asdict(entry) | rounded)


@contextlib.contextmanager
def terminable() -> Iterator[None]:
    """Turn Ctrl-C and the signal to terminate into an exit without a traceback: files are whole or not there.

    Python ignores an exception in a function that was called from C, as numba calls some while it compiles. So the exit
    is raised again, after a while and at each further signal, until it comes through.
    """

    def leave(number: int, frame: object) -> None:
        signal.alarm(AGAIN_S)
        raise SystemExit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield  # other threads get no signals
        return
    before = {number: signal.signal(number, leave) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)}
    try:
        yield
    finally:
        signal.alarm(0)
        for number, handler in before.items():
            signal.signal(number, handler)


def cpu_s() -> float:
    """Return the processor time of this process and of the children that it waited for [s]."""
    uses = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(use.ru_utime + use.ru_stime for use in uses)


def peak_mib() -> float:
    """Return the most memory that this process, or one of the children that it waited for, held at once [MiB]."""
    unit = 1 if sys.platform == "darwin" else 1024  # of ru_maxrss [bytes]
    peaks = [resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * unit]
    # Linux counts in ru_maxrss what the process held before it became this program: the whole of Snakemake.
    match = re.search(r"^VmHWM:\s*(\d+) kB", STATUS.read_text() if STATUS.exists() else "", re.MULTILINE)
    peaks.append(int(match[1]) * 1024 if match else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit)
    return max(peaks) / MIB
