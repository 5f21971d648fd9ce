"""What a job of several parts keeps: parts of the same job on the same files, and nothing else."""

from pathlib import Path

import pytest

from experiments.running.stage import Stage


@pytest.fixture
def stage(tmp_path, monkeypatch):
    """A stage that has the first of two files, in a folder with a file that the job reads."""
    monkeypatch.chdir(tmp_path)
    Path("read.csv").write_text("1")
    made = Stage(Path("state/job"), "given", ("read.csv",))
    made.begin()
    write(made, Path("out/a"))
    return made


def write(stage, file):
    stage.place(file).parent.mkdir(parents=True, exist_ok=True)
    stage.place(file).write_text(file.name)


def test_another_start_keeps_what_is_there(stage):
    Stage(stage.folder, "given", ("read.csv",)).begin()
    assert stage.has([Path("out/a")])
    assert not stage.has([Path("out/a"), Path("out/b")])


def test_other_arguments_other_files_and_a_damaged_note_keep_nothing(stage):
    note = (stage.folder / "stage.json").read_text()
    Stage(stage.folder, "other", ("read.csv",)).begin()
    assert not stage.has([Path("out/a")])
    for damage in ('{"given": ', note.replace("given", "gone")):
        write(stage, Path("out/a"))
        (stage.folder / "stage.json").write_text(damage)
        stage.begin()
        assert not stage.has([Path("out/a")])
    write(stage, Path("out/a"))
    Path("read.csv").write_text("22")
    stage.begin()
    assert not stage.has([Path("out/a")])


def test_files_appear_together_and_the_folder_goes(stage, tmp_path):
    write(stage, tmp_path / "b")  # an absolute path has a place in it too
    assert not Path("out").exists()
    assert not (tmp_path / "b").exists()
    stage.publish([Path("out/a"), tmp_path / "b"])
    assert (Path("out/a").read_text(), (tmp_path / "b").read_text()) == ("a", "b")
    assert not stage.folder.exists()
