"""What tests share: something dear is made once, and who waits or is interrupted behaves as in a terminal."""

import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from once import once
from patience import hear_ctrl_c

TOLD = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"


def test_what_several_ask_for_at_once_is_made_once_and_again_after_a_fault(tmp_path, tmp_path_factory, monkeypatch):
    monkeypatch.setattr(tmp_path_factory, "getbasetemp", lambda: tmp_path / "worker")
    monkeypatch.setenv("PYTEST_XDIST_WORKER", "gw0")
    made = []

    def make(folder):
        made.append(folder)
        if len(made) == 1:
            raise OSError("no room")
        folder.mkdir()

    with pytest.raises(OSError, match="no room"):
        once(tmp_path_factory, "dear", make)
    with ThreadPoolExecutor() as pool:
        found = list(pool.map(lambda _: once(tmp_path_factory, "dear", make), range(3)))
    assert found == [tmp_path / "dear"] * 3
    assert len(made) == 2


def test_ctrl_c_reaches_what_tests_in_the_background_start():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        hear_ctrl_c()
        done = subprocess.run([sys.executable, "-c", TOLD], check=True, capture_output=True, text=True)
    finally:
        signal.signal(signal.SIGINT, before)
    assert done.stdout == "True\n"
