"""A job tells an expected error in one line and ends with status 1."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.core.logs import job


def fail(error: Exception) -> None:
    raise error


def test_expected_error_is_one_line_in_log_and_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "logs" / "a.log"
    with pytest.raises(SystemExit) as caught, job(path):
        fail(DataError("a.parquet: truncated"))
    assert caught.value.code == 1
    assert path.read_text().splitlines()[-1].endswith("ERROR a.parquet: truncated")
    assert capsys.readouterr().err == path.read_text()


def test_a_fault_of_the_program_keeps_its_traceback(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), job(tmp_path / "a.log"):
        fail(ZeroDivisionError())


def test_logging_is_as_before_afterwards(tmp_path: Path) -> None:
    before = logging.getLogger().handlers[:]
    with job(tmp_path / "a.log"):
        logging.getLogger("mobnet.some").info("progress")
    assert logging.getLogger().handlers == before
    assert (tmp_path / "a.log").read_text().endswith("INFO progress\n")
