"""The line on the terminal that says that a command is at work: only there, between the lines of the log, then gone."""

import io
import logging
import time
from pathlib import Path

import pytest

from mobnet.core import heartbeat as beating
from mobnet.core.heartbeat import ERASE, Heartbeat, heartbeat, last_line, telling


class Terminal(io.StringIO):
    """A stream that says that it is a terminal, or is not one."""

    def __init__(self, is_terminal: bool) -> None:
        super().__init__()
        self.is_terminal = is_terminal

    def isatty(self) -> bool:
        return self.is_terminal


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """A line that comes at once."""
    monkeypatch.setattr(beating, "QUIET_S", 0.0)
    monkeypatch.setattr(beating, "EVERY_S", 0.001)


def wait_for(stream: io.StringIO, text: str) -> None:
    """Wait until a stream holds a text, at most for some seconds."""
    end = time.monotonic() + 20.0
    while text not in stream.getvalue() and time.monotonic() < end:
        time.sleep(0.001)
    assert text in stream.getvalue()


@pytest.mark.usefixtures("quick")
def test_a_terminal_shows_what_is_done_and_keeps_nothing_of_it() -> None:
    stream = Terminal(is_terminal=True)
    steps = ["one"]
    with Heartbeat(lambda: steps[-1], stream):
        wait_for(stream, f"{ERASE}one: 0 s")
        steps.append("x" * 200)
        wait_for(stream, f"{ERASE}xxx")
    assert stream.getvalue().endswith(ERASE)
    assert max(map(len, stream.getvalue().split(ERASE))) < 80
    assert "\n" not in stream.getvalue()


@pytest.mark.usefixtures("quick")
def test_a_pipe_gets_nothing() -> None:
    stream = Terminal(is_terminal=False)
    with Heartbeat(stream=stream):
        time.sleep(0.05)
    assert not stream.getvalue()


@pytest.mark.usefixtures("quick")
def test_a_line_of_the_log_takes_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = Terminal(is_terminal=True)
    monkeypatch.setattr("sys.stderr", stream)
    handler = logging.StreamHandler(stream)
    logging.getLogger().addHandler(handler)
    try:
        with heartbeat(lambda: "at work"):
            wait_for(stream, "at work: 0 s")
            logging.getLogger("mobnet.x").error("a line")
            wait_for(stream, f"{ERASE}a line\n")
        assert not handler.filters
    finally:
        logging.getLogger().removeHandler(handler)


def test_a_word_within_time_keeps_the_line_away() -> None:
    stream = Terminal(is_terminal=True)
    with Heartbeat(stream=stream) as line:
        line.erase()
    assert not stream.getvalue()


def test_a_job_logs_what_a_program_says_now_and_then(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(beating, "LOGGED_S", 0.001)
    caplog.set_level(logging.INFO)
    said = tmp_path / "program.log"
    said.write_text("reading  [ 34%] a\n\n")
    with telling(logging.getLogger("job"), lambda: last_line(said)):
        end = time.monotonic() + 20.0
        while not caplog.messages and time.monotonic() < end:
            time.sleep(0.001)
    told = len(caplog.messages)
    assert caplog.messages[0] == "reading [ 34%] a: 0 s"
    time.sleep(0.05)
    assert len(caplog.messages) == told
