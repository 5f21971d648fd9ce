"""When .venv is made again, what is checked before, and that a set-up that was stopped is begun again."""

from pathlib import Path

import pytest

from experiments.commands import setup
from experiments.commands.tools import Tools
from experiments.running.one_run import held_folder
from mobnet.core.errors import CommandError

SITE = Path(".venv/lib/python3.12/site-packages")


@pytest.fixture
def project(tmp_path):
    """A folder with an environment of one package."""
    for path in (tmp_path / name for name in setup.LOCKS):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("one==1.0\n")
    fill(tmp_path)
    stamp(tmp_path)
    return tmp_path


def fill(root):
    """Put a Python and a package into .venv."""
    record = root / SITE / "one-1.0.dist-info" / "RECORD"
    texts = {
        root / ".venv/bin/python": "",
        root / SITE / "one/__init__.py": "",
        root / SITE / "one/data, more.txt": "",
        root / SITE / "mobnet.pth": setup.CODE,
        record: 'one/__init__.py,sha256=x,0\n"one/data, more.txt",,\none-1.0.dist-info/RECORD,,\n',
    }
    for path, text in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def stamp(root):
    """Say that .venv is whole."""
    (root / ".venv" / setup.STAMP).write_text(f"{setup.lock_hash(root)} cpu\none-1.0.dist-info")


def test_the_environment_of_a_run_that_goes_on_is_left_alone(project):
    (project / "environment.lock").write_text("one==2.0\n")
    with held_folder(project, ["all"]), pytest.raises(CommandError, match="a run goes on in this folder"):
        setup.set_up(project)
    assert (project / ".venv" / setup.STAMP).exists()


def test_a_whole_environment_is_left_alone(project):
    assert setup.fault_of(project, None) is None
    assert setup.fault_of(project, "cpu") is None


@pytest.mark.parametrize(("gone", "fault"), [
    (".venv/bin/python", "the Python of .venv is gone"),
    (".venv/installed", "the last set-up did not end"),
    (f"{SITE}/one/__init__.py", "one/__init__.py of one-1.0 is missing in .venv"),
    (f"{SITE}/one/data, more.txt", "one/data, more.txt of one-1.0 is missing in .venv"),
    (f"{SITE}/one-1.0.dist-info/RECORD", "one-1.0.dist-info/RECORD of one-1.0 is missing in .venv"),
    (f"{SITE}/mobnet.pth", "mobnet.pth is missing in .venv"),
])  # fmt: skip
def test_what_is_missing_is_named(project, gone, fault):
    (project / gone).unlink()
    assert setup.fault_of(project, None) == fault


def test_another_lock_or_build_is_told(project):
    assert setup.fault_of(project, "cuda") == "--cuda is asked for, and .venv has the build cpu"
    (project / "environment.lock").write_text("one==1.1\n")
    assert setup.fault_of(project, None) == "environment.lock has changed"


def test_the_environment_of_a_moved_folder_is_whole(project, tmp_path):
    project.rename(tmp_path.with_name("it's moved"))
    assert setup.fault_of(tmp_path.with_name("it's moved"), None) is None


def test_a_command_of_a_whole_environment_waits_for_nobody(project, monkeypatch):
    monkeypatch.setattr(setup, "wait_for", lambda _: pytest.fail("it waits"))
    setup.set_up(project)


def test_what_another_set_up_has_made_meanwhile_is_not_made_again(project, stubs, monkeypatch):
    (project / ".venv" / setup.STAMP).unlink()
    monkeypatch.setattr(setup, "wait_for", lambda _: stamp(project))
    setup.set_up(project)
    assert stubs == []


@pytest.fixture
def stubs(monkeypatch):
    """The steps of an installation, noted; the last one fills .venv, or fails where it is told to."""
    told = []

    def install(tools, build, *, is_asked):
        told.append(f"install {build}{' asked' * is_asked}")
        fill(tools)
        return build

    monkeypatch.setattr(Tools, "find", lambda root: root)
    monkeypatch.setattr(setup, "make_venv", lambda _: told.append("venv"))
    monkeypatch.setattr(setup, "install", install)
    monkeypatch.setattr(setup, "wanted_build", lambda: "cpu")
    return told


def test_a_stopped_setup_is_begun_again(project, stubs, monkeypatch, capsys):
    (project / "environment.lock").write_text("one==1.1\n")
    with monkeypatch.context() as context:
        context.setattr(setup, "make_venv", stop)
        with pytest.raises(KeyboardInterrupt):
            setup.set_up(project)
    assert not (project / ".venv").exists()
    setup.set_up(project)
    setup.set_up(project)
    assert stubs == ["venv", "install cpu"]
    told = capsys.readouterr().err
    assert "environment.lock has changed" in told
    assert "3.0 GB of disk, or 6.4 GB where no index offers torch's CPU build (" in told
    assert "of memory and 1 to 4 minutes" in told


def stop(_):
    raise KeyboardInterrupt


def test_a_linked_environment_of_another_folder_is_never_removed(project, stubs, tmp_path_factory):
    other = tmp_path_factory.mktemp("other") / ".venv"
    (project / ".venv").rename(other)
    (project / ".venv").symlink_to(other)
    assert setup.fault_of(project, None) is None
    (project / "environment.lock").write_text("one==1.1\n")
    setup.set_up(project, "cuda")
    assert (other / "bin" / "python").exists()
    assert not (project / ".venv").is_symlink()
    assert stubs == ["venv", "install cuda asked"]


def test_a_repair_keeps_the_build(project, stubs):
    path = project / ".venv" / setup.STAMP
    path.write_text(path.read_text().replace("cpu", "cuda"))
    (project / SITE / "one/__init__.py").unlink()
    setup.set_up(project)
    assert stubs == ["venv", "install cuda"]


def test_too_little_disk_is_told_before_anything_is_loaded(project, monkeypatch):
    from experiments.commands.install import check_disk

    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 1.2e9})())
    with pytest.raises(CommandError, match=r"1\.2 GB free, 3\.6 GB needed"):
        check_disk(project, "cpu")
