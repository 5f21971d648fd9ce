"""A lock is free again when its process ends, however it ends."""

import errno
import os
import signal
import subprocess
import sys

from mobnet.core.files import opened, taken, warn_of_missing_locks

HOLD = """
import fcntl, sys, time
lock = open(sys.argv[1], "w")
fcntl.flock(lock, fcntl.LOCK_EX)
print("held", flush=True)
time.sleep(60)
"""


def test_who_holds_a_lock_keeps_others_out_until_it_ends(tmp_path):
    path = tmp_path / "lock"
    words = [sys.executable, "-c", HOLD, str(path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        other.stdout.readline()
        handle = opened(path)
        assert not taken(handle)
        other.send_signal(signal.SIGKILL)
    assert taken(handle)
    os.close(handle)


def test_a_file_system_without_locks_is_told_once(tmp_path, monkeypatch, caplog):
    def refuse(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    warn_of_missing_locks.cache_clear()
    for _ in range(2):
        assert taken(opened(tmp_path / "lock"))
    assert caplog.messages == ["this file system has no locks: nothing keeps two processes in this folder apart"]
