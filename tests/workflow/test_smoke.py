"""The whole line at the smoke scale: unbroken, again, and killed at random moments."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from browser import Browser, with_browser

from mobnet.core.config import load_config

from .clicks import choose, explain, show, text_of_frame
from .conftest import ROOT, Snakemake

SMOKE = ("--config", "scale=smoke")
NO_OP_S = 15.0
KILLS = 5
LONGEST_S = 20.0

pytestmark = [pytest.mark.slow, pytest.mark.sim]


def reproduce(folder: Path, *words: str, command: str = "all") -> subprocess.Popen[bytes]:
    """Start ./reproduce in a process group of its own."""
    started = [sys.executable, str(folder / "reproduce"), command, *SMOKE, *words]
    with (folder / "out.log").open("ab") as out:
        return subprocess.Popen(started, cwd=folder, stdout=out, stderr=out, start_new_session=True)


def told(folder: Path) -> str:
    """Return what the runs in a folder printed last."""
    return (folder / "out.log").read_text()[-5000:]


def products(folder: Path) -> dict[str, bytes]:
    """Return the content of every table, and of every figure's numbers."""
    found = [*(folder / "tables" / "smoke").iterdir(), *(folder / "figures" / "smoke").glob("*.csv")]
    return {path.name: path.read_bytes() for path in found}


def recordings_of_the_smoke_scale() -> int:
    """Return the number of training and test recordings, as the configuration has them."""
    config = load_config(ROOT / "configs" / "config.yaml", "smoke")
    training = sum(row["shards"] for row in config["sizes"]["train"].values())
    return training + config["sizes"]["test"]["shards"] * sum(map(len, config["tests"].values()))


def networks_of_smoke() -> int:
    """Return the number of networks of the smoke scale: one seed of every method's limbs."""
    methods = load_config(ROOT / "configs" / "config.yaml", "smoke")["methods"]
    return sum(len(row.get("limbs", [])) for row in methods.values())


@pytest.fixture(scope="module")
def unbroken(make_project: Callable[..., Path]) -> Path:
    """A project in which the smoke scale ran on two cores."""
    folder = make_project("unbroken")
    assert reproduce(folder).wait() == 0, told(folder)
    return folder


def test_smoke_makes_tables_figures_and_networks(unbroken: Path) -> None:
    made = products(unbroken)
    assert {"table_05.csv", "table_05.tex", "table_05.md", "claims.csv", "figure_05.csv"} <= set(made)
    assert {"data.csv", "steps.csv", "coverage.csv", "uncertainty.csv", "figure_19.csv", "commands.csv"} <= set(made)
    assert {"table_01.csv", "kinds.csv", "methods.csv", "calibration.csv"} <= set(made)
    assert {"figure_17.csv", "figure_18.csv", "figure_20.csv"} <= set(made)
    assert all(made.values())
    assert (unbroken / "figures" / "smoke" / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert len(list((unbroken / "results" / "smoke" / "networks").glob("*/weights.safetensors"))) == networks_of_smoke()
    assert "MOB-Net-LL-s0" in (unbroken / "results" / "smoke" / "runs.html").read_text()


def test_every_job_left_a_log_and_a_benchmark(unbroken: Path) -> None:
    logs = {path.stem for path in (unbroken / "results" / "smoke" / "logs" / "collect").iterdir()}
    assert logs == {path.stem for path in (unbroken / "results" / "smoke" / "bench" / "collect").iterdir()}
    assert len(logs) == recordings_of_the_smoke_scale()


def test_second_call_does_nothing(unbroken: Path) -> None:
    before = time.monotonic()
    assert reproduce(unbroken).wait() == 0
    assert time.monotonic() - before < NO_OP_S
    assert "Nothing to be done" in told(unbroken)


def kinds_of_files(names: list[str]) -> dict[str, str]:
    """Return the last file of each folder's kind of file, such as results/smoke/networks and .csv."""
    return {f"{'/'.join(Path(name).parts[:3])}{Path(name).suffix}": name for name in names}


def test_verify_names_every_file_in_which_a_byte_is_flipped_and_no_other(unbroken: Path) -> None:
    manifest = "results/smoke/MANIFEST.sha256"
    words = [sys.executable, str(unbroken / "reproduce"), "verify", "--manifest", manifest]
    assert subprocess.run(words, cwd=unbroken, check=False, capture_output=True).returncode == 0
    names = [line.split("  ", 1)[1] for line in (unbroken / manifest).read_text().splitlines()]
    flipped = sorted(kinds_of_files(names).values())
    endings = {".parquet", ".json", ".safetensors", ".csv", ".tex", ".md", ".pdf", ".png", ".html"}
    assert {Path(name).suffix for name in flipped} == endings
    before = {name: ((unbroken / name).read_bytes(), (unbroken / name).stat()) for name in flipped}
    for name, (whole, _) in before.items():
        middle = len(whole) // 2
        (unbroken / name).write_bytes(whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :])
    done = subprocess.run(words, cwd=unbroken, check=False, capture_output=True, text=True)
    for name, (whole, times) in before.items():
        (unbroken / name).write_bytes(whole)
        os.utime(unbroken / name, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert done.returncode == 1
    assert sorted(line.split(": hash ")[0] for line in done.stdout.splitlines() if ": hash " in line) == flipped


def test_compute_counts_every_job_that_left_a_benchmark(unbroken: Path) -> None:
    rows = (unbroken / "results" / "smoke" / "compute.csv").read_text().splitlines()
    jobs = len(list((unbroken / "results" / "smoke" / "bench").rglob("*.tsv")))
    assert f"all jobs,jobs,{jobs},-" in rows
    assert any(row.startswith("elapsed,cores,") for row in rows)


def test_report_is_made_by_one_command(unbroken: Path) -> None:
    assert reproduce(unbroken, command="report").wait() == 0, told(unbroken)
    assert (unbroken / "report.html").stat().st_size > 1_000_000


@with_browser
def test_report_shows_tables_figures_and_trainings(unbroken: Path, open_page: Callable[..., Browser]) -> None:
    browser = open_page(unbroken / "report.html")
    choose(browser, "Tables")
    show(browser, "table_05", "iframe")
    assert "MOB-Net" in text_of_frame(browser)
    browser = open_page(unbroken / "report.html")
    choose(browser, "Trainings")
    show(browser, "runs", "iframe")
    assert "MOB-Net-LL-s0" in text_of_frame(browser)
    assert "SNAKEMAKE RULE runs" in explain(browser, "runs")


def test_comment_reruns_nothing_and_an_edit_just_what_depends_on_it(unbroken: Path, snakemake: Snakemake) -> None:
    path = unbroken / "src" / "mobnet" / "evaluation" / "tables" / "errors.py"
    text = path.read_text()
    path.write_text(text + "# a comment\n")
    assert "Nothing to be done" in snakemake("-n", *SMOKE, folder=unbroken).stdout
    path.write_text(text + "ADDED = 1\n")
    planned = snakemake("-n", *SMOKE, folder=unbroken).stdout
    path.write_text(text)
    assert {"table", "numbers", "paper", "manifest"} <= set(planned.split())
    assert not {"collect", "observe", "train", "estimate", "score"} & set(planned.split())


def test_damaged_recording_stops_with_one_line_and_nothing_half_written(
    unbroken: Path, make_project: Callable[..., Path], snakemake: Snakemake
) -> None:
    folder = make_project("damaged", unbroken)
    place = Path("results") / "smoke" / "recordings" / "forward_walk" / "ideal"
    (folder / place).mkdir(parents=True)
    for ending in ("json", "parquet"):
        content = (unbroken / place / f"s1.{ending}").read_bytes()
        (folder / place / f"s1.{ending}").write_bytes(content[: len(content) // 2] if ending == "parquet" else content)
    target = "results/smoke/residuals/forward_walk/ideal/s1.parquet"
    done = snakemake(*SMOKE, "--rerun-triggers", "mtime", "--", target, folder=folder)
    assert done.returncode != 0
    assert (done.stdout + done.stderr).count(f"{place}/s1.parquet: truncated or damaged") == 1
    assert not (folder / target).exists()


def test_killed_at_random_moments_ends_with_the_same_tables(unbroken: Path, make_project: Callable[..., Path]) -> None:
    folder = make_project("killed", unbroken)
    moments = random.Random(2023)
    for kill in range(KILLS):
        run = reproduce(folder, "--cores", "1")
        time.sleep(moments.uniform(1.0, LONGEST_S))
        if kill % 2:
            os.killpg(run.pid, signal.SIGKILL)
        else:
            run.kill()  # its jobs live on and keep the lock until they end
        run.wait()
    assert reproduce(folder, "--cores", "1").wait() == 0, told(folder)
    assert products(folder) == products(unbroken)
