"""Logs that come through a pipe, as `zcat log.csv.gz | ./reproduce observe -` gives them."""

import gzip
import os
import threading
from pathlib import Path

import numpy as np
import pytest
from made_logs import as_csv, as_mcap

from mobnet.core.errors import DataError
from mobnet.core.options import observe_parser
from mobnet.robotlog import piped
from mobnet.robotlog.formats import stem_of
from mobnet.robotlog.observe import converted_log
from mobnet.robotlog.piped import as_file


@pytest.fixture
def pipe():
    """Return a function that makes a pipe through which some bytes come, as a shell's `<(...)` does."""
    reading = list[int]()

    def made(content):
        reader, writer = os.pipe()
        reading.append(reader)

        def write():
            with os.fdopen(writer, "wb") as file:
                file.write(content)

        threading.Thread(target=write, daemon=True).start()
        return Path("/dev/fd", str(reader))

    yield made
    for reader in reading:
        os.close(reader)


def packed(table, folder):
    path = folder / "packed"
    path.write_bytes(gzip.compress(as_csv(table, folder).read_bytes()))
    return path


@pytest.mark.parametrize("write", [as_csv, packed, as_mcap])
def test_a_log_through_a_pipe_is_read_as_its_file_is(write, clean, arm, settings, pipe, tmp_path):
    path = pipe(write(clean[:100], tmp_path).read_bytes())
    sensed = converted_log(path, arm.layout, None, settings.robotlog).recording.sensed
    np.testing.assert_allclose(sensed.tau_motor[:, 1], clean["tau_motor.J2"][:100], atol=1e-12)


def test_the_copy_of_a_pipe_is_gone_afterwards_and_a_file_is_not_copied(pipe, tmp_path):
    path = pipe(b"t,a\n0,1\n1,2\n")
    assert stem_of(path) == "stdin"
    with as_file(path) as file:
        assert (file.name, file.read_bytes()) == ("stdin.csv", b"t,a\n0,1\n1,2\n")
    assert not file.exists()
    (tmp_path / "log.csv").write_text("t,a\n0,1\n1,2\n")
    with as_file(tmp_path / "log.csv") as file:
        assert file == tmp_path / "log.csv"


def test_standard_input_is_a_minus_and_no_terminal(monkeypatch):
    assert observe_parser().parse_args(["-"]).log == piped.STDIN
    assert observe_parser().parse_args(["log.csv"]).log == Path("log.csv")
    monkeypatch.setattr(piped, "STDIN", Path(os.devnull))
    with (
        pytest.raises(DataError, match="standard input is a terminal or a device; accepted: a log"),
        as_file(piped.STDIN),
    ):
        pass
