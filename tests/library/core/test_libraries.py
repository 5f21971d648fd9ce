"""In a terminal that names libraries of ROS, Pinocchio gets its own, and other software keeps its folders."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.running.environment import quieten
from mobnet.core.code import ROOT
from mobnet.core.libraries import VARIABLE, drop_foreign_libraries, own_folder

ARM = ROOT / "tests" / "data" / "arm.urdf"
PROGRAMS = {"the package": ("-P", "-m", "mobnet"), "a checkout": (str(ROOT / "reproduce"),)}


@pytest.fixture
def ros(tmp_path: Path) -> Path:
    """A folder with a library that has the name of one of Pinocchio's, and cannot be loaded."""
    folder = tmp_path / "ros" / "lib"
    folder.mkdir(parents=True)
    (folder / "libeigenpy.so").write_text("of another version")
    return folder


def test_folders_with_a_library_of_our_names_go_and_all_others_stay(
    ros: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cuda = tmp_path / "cuda"
    cuda.mkdir()
    (cuda / "libcudart.so.12").touch()
    kept = [str(place) for place in (cuda, own_folder(), tmp_path / "nowhere")]
    monkeypatch.setenv(VARIABLE, os.pathsep.join([str(ros), *kept]))
    assert drop_foreign_libraries()
    assert os.environ[VARIABLE].split(os.pathsep) == kept
    assert not drop_foreign_libraries()
    monkeypatch.delenv(VARIABLE)
    assert not drop_foreign_libraries()
    assert VARIABLE not in os.environ


def test_jobs_of_a_run_do_not_get_them(ros: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "environ", {VARIABLE: str(ros)})
    quieten(tmp_path)
    assert os.environ[VARIABLE] == ""


def test_the_library_would_break_the_import(ros: Path) -> None:
    words = [sys.executable, "-c", "import pinocchio"]
    done = subprocess.run(words, env={**os.environ, VARIABLE: str(ros)}, capture_output=True, text=True, check=False)
    assert "libeigenpy.so" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_command_runs_where_ros_is_sourced(name: str, ros: Path, tmp_path: Path) -> None:
    words = [sys.executable, *PROGRAMS[name], "robot", str(ARM), "--base", "fixed", "--out", "arm.yaml"]
    variables = {**os.environ, VARIABLE: str(ros)}
    done = subprocess.run(words, cwd=tmp_path, env=variables, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "arm.yaml").is_file()
