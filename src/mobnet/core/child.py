"""What a library does with a stranger's file, in a process of its own: there it may crash, or never end."""

import contextlib
import faulthandler
import multiprocessing
import resource
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any, TypeVar

import psutil

from mobnet.core.errors import DataError

MEMORY_BYTES = 4 * 2**30  # that the process may take beside what it was started with
Made = TypeVar("Made")


def in_child(make: Callable[[], Made], seconds: float, what: str) -> Made:
    """Return what a function makes in a child process, within a time [s] and a memory of its own; it must be picklable.

    Raises:
        Exception: the one that the function raised.
        DataError: the process crashed or did not end; the line names `what` it did.
    """
    context = multiprocessing.get_context("fork")  # the libraries are loaded already
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_send, args=(make, sender), daemon=True)
    process.start()
    sender.close()
    try:
        if not receiver.poll(seconds):
            raise DataError(f"{what}: no end after {seconds:g} s; accepted: a smaller file")
        is_made, value = receiver.recv()
    except (EOFError, ConnectionResetError):
        process.join()
        text = f"reading it ended by {_reason(process.exitcode)}; accepted: a file that its library can read"
        raise DataError(f"{what}: {text}") from None
    finally:
        process.kill()
        process.join()
        receiver.close()
    if not is_made:
        raise value
    return value


def _send(make: Callable[[], Any], sender: Connection) -> None:
    """Send what a function makes, or the error that it raises."""
    faulthandler.disable()  # a crash is told in one line
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # so is the end that a user asks for, elsewhere
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # The address space of the process that asks came along, and is large where much was loaded or read before.
    bytes_at_most = psutil.Process().memory_info().vms + MEMORY_BYTES
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY or most > bytes_at_most:
        resource.setrlimit(resource.RLIMIT_AS, (bytes_at_most, most))
    try:
        answer = True, make()
    except MemoryError:
        text = f"more than {MEMORY_BYTES // 2**30} GiB of memory are needed; accepted: a smaller file"
        answer = False, DataError(text)
    except Exception as error:  # noqa: BLE001 it is raised where the function is called
        answer = False, error
    with contextlib.suppress(BrokenPipeError):
        sender.send(answer)


def _reason(code: int | None) -> str:
    """Return how a process ended, by its exit code."""
    if code is not None and code < 0:
        return f"signal {signal.Signals(-code).name}"
    return f"an error, exit status {code}"
