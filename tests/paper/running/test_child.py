"""A process for what a library does with a stranger's file: its answer, its error, its crash, and its time."""

import mmap
import os
import signal
import time

import numpy as np
import pytest

from mobnet.core.child import MEMORY_BYTES, in_child
from mobnet.core.errors import ConfigError, DataError

FREED_BYTES = 2**28  # more than a process gives back between the setting of its limit and the call


def test_an_answer_and_an_error_come_back():
    assert in_child(lambda: {"a": np.arange(3).tolist()}, 10.0, "x") == {"a": [0, 1, 2]}

    def refuse():
        raise ConfigError("no")

    with pytest.raises(ConfigError, match=r"^no$"):
        in_child(refuse, 10.0, "x")


def test_a_crash_and_a_process_without_end_are_one_line():
    with pytest.raises(DataError, match=r"^x: reading it ended by signal SIGSEGV; accepted: "):
        in_child(lambda: os.kill(os.getpid(), signal.SIGSEGV), 10.0, "x")
    with pytest.raises(DataError, match=r"^x: reading it ended by an error, exit status 3; accepted: "):
        in_child(lambda: os._exit(3), 10.0, "x")
    with pytest.raises(DataError, match=r"^x: no end after 0\.1 s; accepted: a smaller file$"):
        in_child(lambda: time.sleep(60.0), 0.1, "x")


def test_more_memory_than_it_may_take_is_one_line():
    with pytest.raises(DataError, match=r"more than 4 GiB of memory"):
        in_child(lambda: np.empty(MEMORY_BYTES + FREED_BYTES, np.uint8).nbytes, 10.0, "x")


def test_what_was_loaded_before_takes_nothing_of_its_memory():
    held = mmap.mmap(-1, MEMORY_BYTES)  # address space of this process, of which no page is used
    try:
        assert in_child(lambda: np.empty(MEMORY_BYTES // 2, np.uint8).nbytes, 10.0, "x") == MEMORY_BYTES // 2
    finally:
        held.close()
