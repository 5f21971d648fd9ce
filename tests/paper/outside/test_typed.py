"""Whatever a user types behind `./reproduce check`: each word that cannot be checked is one line, and nothing hangs."""

import os
import subprocess
import sys

import pytest
from patience import HANGS_S

from experiments.check import main


def test_pipes_and_folders_are_one_line_each(tmp_path):
    for name in ("pipe.yaml", "pipe.csv", "pipe.json", "pipe.safetensors", "full/pipe.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        os.mkfifo(tmp_path / name)
    for name in ("empty", "folder.json", "folder.parquet", "full/folder.yaml"):
        (tmp_path / name).mkdir()
    words = sorted(path.name for path in tmp_path.iterdir())
    run = [sys.executable, "-m", "experiments.check", *words]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=HANGS_S)
    told = dict(line.split(": ", 1) for line in done.stdout.splitlines()[:-1])
    assert sorted(told) == sorted([*(word for word in words if word != "full"), "full/pipe.csv"])
    assert all("accepted; accepted: " in line for line in told.values())
    assert told["full/pipe.csv"] == "a pipe or a device is not accepted; accepted: a file"
    assert (done.returncode, done.stderr) == (1, "")


def test_the_array_of_a_note_may_be_a_pipe(copied):
    (copied / "recording.parquet").unlink()
    os.mkfifo(copied / "recording.parquet")
    run = [sys.executable, "-m", "experiments.check", "recording.json"]
    done = subprocess.run(run, cwd=copied, capture_output=True, text=True, check=False, timeout=HANGS_S)
    assert done.stdout == "recording.parquet: a pipe or a device is not accepted; accepted: a file\n"


@pytest.mark.parametrize(("words", "says"), [
    (["--rate", "nan", "x.csv"], "--rate: nan is not accepted; accepted: a number above 0"),
    (["--rate", "-1", "x.csv"], "--rate: -1.0 is not accepted"),
    ([f"{'x' * 300}.csv"], "File name too long; accepted: files that you may read"),
])  # fmt: skip
def test_words_that_cannot_be_are_told(words, says, capsys):
    with pytest.raises(SystemExit, match="2"):
        main(words)
    assert says in capsys.readouterr().err.splitlines()[-1]
