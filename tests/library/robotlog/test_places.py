"""Where a command's results shall go is looked at before its input, which may take long to read, is."""

from pathlib import Path

import pytest

from mobnet.export import export
from mobnet.robot import import_table
from mobnet.robotlog import identify, learn, motion, observe

ARM = Path("tests/data/arm.yaml").resolve()
COMMANDS = {
    export: ["missing_net", "--robot", ARM],
    identify: ["missing.csv", "--robot", ARM],
    import_table: ["missing.urdf"],
    learn: ["missing_observed", "--robot", ARM],
    motion: ["--robot", ARM],
    observe: ["missing.csv", "--robot", ARM],
}


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.__name__.rpartition(".")[2])
def test_a_place_that_cannot_be_written_to_is_told_before_any_work(command, saying, tmp_path):
    (tmp_path / "file").touch()
    status, said = saying(command.main, *COMMANDS[command], "--out", tmp_path / "file" / "below" / "made.csv")
    assert status == 1
    assert len(said) == 1
    assert said[0].startswith(f"{tmp_path / 'file'}: cannot be written")
