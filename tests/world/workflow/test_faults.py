"""A run is stopped, killed or finds no room: one line, nothing is left behind, and the same command goes on."""

import contextlib
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

import psutil
import pytest
from patience import HANGS_S, start_s, wait_for

SMOKE = ("--config", "scale=smoke")
QUICK, SLOW = "tables/smoke/table_01.csv", "results/smoke/plant/recordings/forward_walk/ideal"
ONE_CORE = ("--cores", "1", *SMOKE, "--")
MOMENTS_S = (0.3, 1.0, 2.0, 4.0, 8.0)  # after the start: before and while the workflow is planned, while jobs run
SOON = 10.0  # times that a start of Snakemake takes
STOPPED = r"(reproduce: )?stopped; (\d+ of \d+ jobs? (is|are) made; )?the same command goes on from here"

pytestmark = [pytest.mark.slow, pytest.mark.sim]


@pytest.fixture(scope="module")
def project(make_project):
    return make_project("faults")


@contextlib.contextmanager
def small_disk(folder, size, how="rw"):
    """Mount an empty file system on a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    words = ["mount", "-t", "tmpfs", "-o", f"size={size},{how}", "none", str(folder)]
    if os.geteuid() != 0 or subprocess.run(words, check=False, capture_output=True).returncode != 0:
        pytest.skip("only root can mount a small file system")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def processes(folder):
    """Return the processes that work in a project."""
    found = [process.info for process in psutil.process_iter(["cwd", "pid", "status"])]
    return [info for info in found if info["cwd"] == str(folder) and info["status"] != psutil.STATUS_ZOMBIE]


def left_behind(folder):
    """Return unfinished files and the like."""
    places = ("results/**/.partial.*", ".snakemake/scripts/*")
    return [path for place in places for path in folder.glob(place)]


@pytest.mark.parametrize("moment_s", MOMENTS_S)
def test_ctrl_c_ends_soon_and_says_how_to_go_on(project, moment_s):
    words = [sys.executable, str(project / "reproduce"), "all", *SMOKE]
    with (project / "out.log").open("w+") as out:
        soon_s = SOON * start_s()
        run = subprocess.Popen(words, cwd=project, stdout=out, stderr=out, start_new_session=True)
        try:
            time.sleep(moment_s)
            out.seek(0)
            before = out.read()
            os.killpg(run.pid, signal.SIGINT)  # as a terminal does
            status = run.wait(soon_s)
        finally:
            run.kill()
        out.seek(0)
        after = out.read().removeprefix(before)
    assert_is_free(project)
    if status == -signal.SIGINT:
        assert after == ""  # Python itself had not begun
        return
    assert status == 128 + signal.SIGINT
    assert re.fullmatch(STOPPED, after.splitlines()[-1])
    assert after.count("stopped") == 1
    assert "Traceback" not in after


def assert_is_free(project):
    """Assert that a run has left no process, no half file and no lock."""
    assert processes(project) == left_behind(project) == []
    assert not list((project / ".snakemake" / "locks").glob("*"))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_run_leaves_one_line_on_a_terminal(project, number):
    """By snakemake itself, while a job runs: no line of a job stays, and no word of Snakemake comes after ours."""
    shutil.rmtree(project / SLOW, ignore_errors=True)
    primary, secondary = pty.openpty()
    environment = {**os.environ, "PYTHONPATH": str(project / "src"), "TERM": "xterm"}
    words = [sys.executable, "-m", "snakemake", *ONE_CORE, SLOW]
    with subprocess.Popen(
        words, cwd=project, env=environment, stdout=secondary, stderr=secondary, start_new_session=True
    ) as run:
        os.close(secondary)
        screen = Screen(primary)
        wait_for(lambda: "record plant" in screen.text())
        run.send_signal(number)
        assert run.wait(HANGS_S) == 128 + number
    screen.join()
    after = screen.text().rpartition("\x1b[J")[2]  # which clears what stood there
    assert re.fullmatch(f"{STOPPED}\r\n", after)
    assert not (project / SLOW).exists()
    assert_is_free(project)


class Screen(threading.Thread):
    """Reads what is written on a terminal, until nobody has it open any more."""

    def __init__(self, primary):
        super().__init__(daemon=True)
        self._primary, self._read = primary, []
        self.start()

    def run(self):
        with contextlib.suppress(OSError), os.fdopen(self._primary, "rb", buffering=0) as primary:
            while new := primary.read(65536):
                self._read.append(new)

    def text(self):
        return b"".join(self._read).decode()


def test_after_a_kill_the_same_command_goes_on_and_what_was_left_is_removed(project):
    unfinished, foreign = project / "results/smoke/.partial.abcd_123.s1.parquet", project / "results/smoke/.mine.s1"
    unfinished.parent.mkdir(parents=True, exist_ok=True)
    for path in (unfinished, foreign):
        path.write_text("half")
    words = [sys.executable, str(project / "reproduce"), SLOW, "--cores", "1"]
    with (project / "out.log").open("w+") as out:
        run = subprocess.Popen(words, cwd=project, stdout=out, stderr=out, start_new_session=True)
        wait_for(lambda: list((project / ".snakemake/scripts").glob("*")))  # of the job
        os.killpg(run.pid, signal.SIGKILL)
        run.wait()
    unfinished.write_text("half")
    subprocess.run(words, cwd=project, capture_output=True, check=True)
    assert (project / SLOW / "s101.parquet").is_file()
    assert not unfinished.exists()
    assert foreign.exists()


FULL, READ_ONLY = r"needed: \S+ Mi?B, free: ", "cannot be written: Read-only file system"


@pytest.mark.parametrize(("folder", "size", "how", "target", "told"), [
    ("results", "4m", "rw", SLOW, FULL),
    ("tables/smoke", "64k", "rw", QUICK, FULL),
    (".cache", "64k", "rw", QUICK, FULL),
    (".snakemake", "64k", "rw", QUICK, FULL),
    ("tables/smoke", "1m", "ro", QUICK, READ_ONLY),
])  # fmt: skip
def test_a_disk_without_room_is_one_line(project, snakemake, folder, size, how, target, told):
    for left in (target, SLOW):
        subprocess.run(["rm", "-rf", str(project / left)], check=True)
    with small_disk(project / folder, size, how):
        done = snakemake(*ONE_CORE, target, folder=project)
    assert done.returncode != 0
    printed = done.stdout + done.stderr
    (line,) = [line for line in printed.splitlines() if re.search(told, line)]
    assert line.startswith(str(project / folder))
    assert "Traceback" not in printed
    assert snakemake(*ONE_CORE, QUICK, folder=project).returncode == 0
    assert (project / QUICK).is_file()


def test_a_disk_that_fills_while_a_job_writes_is_told_by_the_job(project, snakemake):
    with small_disk(project / "results", "16m"):
        words = [sys.executable, "-m", "snakemake", *ONE_CORE, SLOW]
        environment = {**os.environ, "PYTHONPATH": str(project / "src")}
        run = subprocess.Popen(words, cwd=project, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        wait_for(lambda: list((project / "results").rglob(".partial.*")), 0.05)
        fill = project / "results" / "fill"
        fill.write_bytes(bytes(shutil.disk_usage(fill.parent).free))
        output = run.communicate()[0].decode()
        assert run.returncode != 0
        assert f"{SLOW}/s101.parquet: cannot be written: No space left on device; needed: more than" in output
        assert "Traceback" not in output
        assert left_behind(project) == []
        fill.unlink()
        assert snakemake(*ONE_CORE, SLOW, folder=project).returncode == 0


def test_without_git_a_run_says_that_results_name_no_commit(project, snakemake):
    done = snakemake("--forceall", *ONE_CORE, QUICK, folder=project)
    assert done.returncode == 0
    assert (done.stdout + done.stderr).count("(commit: unknown)") == 1
