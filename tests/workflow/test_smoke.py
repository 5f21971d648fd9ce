"""The whole line at the smoke scale: unbroken, again, and killed at random moments."""

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from browser import with_browser

from experiments.evaluation.report.compute import HOUR_S, WHOLE
from experiments.evaluation.report.cost import costs
from experiments.evaluation.report.rates import measured
from experiments.plan.plan import make_plan
from experiments.plan.work import works_of
from experiments.running.logs import read_account
from experiments.settings.load import load_settings

from .clicks import choose, explain, show, text_of_frame
from .cluster import cluster_in

SMOKE = ("--config", "scale=smoke")
NO_OP = 8.0  # times that the start of Snakemake alone takes; 4.2 to 5.4 were measured, 10 s where nothing else runs
KILLS = 5
LONGEST_S = 20.0
MADE = ("results", "tables", "figures", "paper", ".snakemake")
FIGURES = ("figures/smoke/drift.csv", "tables/smoke/coverage.csv", "tables/smoke/table_11.csv")
LOST = (  # walks of a test and walks that a network learns from: jobs of most kinds run again
    "results/smoke/plant/recordings/foot_hold",
    "results/smoke/robot_1/recordings/robot_walk_plain",
    "results/smoke/robot_1/networks/MOB-Net-plain-LL-s101",
    "results/smoke/scores/foot_hold",
    *FIGURES,
)
WHOLE_CLUSTER, LONGER = "MOBNET_WHOLE_CLUSTER", 1.5  # asks for the whole line on a cluster; its time by the local one

pytestmark = [pytest.mark.slow, pytest.mark.sim]


def reproduce(folder, *words, command="all"):
    started = [sys.executable, str(folder / "reproduce"), command, *SMOKE, *words]
    with (folder / "out.log").open("ab") as out:
        return subprocess.Popen(started, cwd=folder, stdout=out, stderr=out, start_new_session=True)


def told(folder):
    return (folder / "out.log").read_text()[-5000:]


def products(folder):
    found = [*(folder / "tables" / "smoke").iterdir(), *(folder / "figures" / "smoke").glob("*.csv")]
    return {path.name: path.read_bytes() for path in found}


def manifest_of(folder):
    """Return the list of results with their hashes; two runs of the same code have the same."""
    return (folder / "results" / "smoke" / "MANIFEST.sha256").read_text()


def names(folder):
    """Return the names of all files but those that only some runs have: Snakemake's own, reports, caches."""
    places = ("results", "tables", "figures", "paper", ".snakemake/scripts", ".cache/tmp")
    return {str(path.relative_to(folder)) for place in places for path in (folder / place).rglob("*")}


@pytest.fixture(scope="module")
def plan():
    return make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)


@pytest.fixture(scope="module")
def unbroken(make_project):
    """A project in which the smoke scale ran on two cores."""
    folder = make_project("unbroken")
    assert reproduce(folder).wait() == 0, told(folder)
    return folder


def test_smoke_makes_all_that_is_planned(unbroken, plan):
    names = [name for product in plan.products for name in (*product.inputs, *product.outputs)]
    assert [name for name in names if not (unbroken / name).exists()] == []
    assert (unbroken / "figures" / "smoke" / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert "MOB-Net-LL-s0" in (unbroken / "results" / "smoke" / "runs.html").read_text()
    page = (unbroken / "results" / "smoke" / "explore.html").read_text()
    assert '<tr data-method="MOB-Net">' in page
    assert len(page) < 3_000_000


def accounts(folder):
    return list((folder / "results" / "smoke" / "logs").rglob("*.json"))


def test_every_job_left_a_log_and_an_account(unbroken, planned):
    folder = unbroken / "results" / "smoke" / "logs"
    logs = {path.with_suffix(".json") for path in folder.rglob("*.log")}
    assert logs == set(accounts(unbroken))
    names = {str(path.relative_to(folder).with_suffix("")) for path in logs}
    assert names == {job.name for job in planned("smoke") if job.outputs[0]}


def test_the_run_can_be_priced_by_its_own_accounts(unbroken, plan, planned):
    works = works_of(plan, planned("smoke"))
    rates = measured("smoke", works, map(read_account, accounts(unbroken)))
    priced = costs(works, rates.kinds)[WHOLE][1]
    assert priced / HOUR_S == pytest.approx(rates.core_h, rel=0.1)


def processor_s(run):
    """Wait for a process that must succeed, and return what it used of the processor [s]."""
    _, status, used = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)
    assert run.returncode == 0
    return used.ru_utime + used.ru_stime


def test_second_call_does_nothing(unbroken):
    """Its time is compared with another one of the same moment: beside other work a processor is slower."""
    start = subprocess.Popen([sys.executable, "-m", "snakemake", "--version"], stdout=subprocess.DEVNULL)
    shortest = processor_s(start)
    assert processor_s(reproduce(unbroken)) < NO_OP * shortest
    assert "Nothing to be done" in told(unbroken)


def kinds_of_files(names):
    """Return the last file of each folder's kind of file, such as results/smoke/networks and .csv."""
    return {f"{'/'.join(Path(name).parts[:3])}{Path(name).suffix}": name for name in names}


def test_verify_names_every_file_in_which_a_byte_is_flipped_and_no_other(unbroken):
    manifest = "results/smoke/MANIFEST.sha256"
    words = [sys.executable, str(unbroken / "reproduce"), "verify", "--manifest", manifest]
    assert subprocess.run(words, cwd=unbroken, check=False, capture_output=True).returncode == 0
    names = [line.split("  ", 1)[1] for line in (unbroken / manifest).read_text().splitlines()]
    flipped = sorted(kinds_of_files(names).values())
    endings = {".parquet", ".json", ".safetensors", ".csv", ".tex", ".md", ".rst", ".pdf", ".svg", ".png", ".webp",
               ".gif", ".html"}  # fmt: skip
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


def test_every_file_of_results_passes_a_check(unbroken):
    results = unbroken / "results/smoke"
    folders = [str(results / name) for name in ("motions", "scores")]
    for robot in ("plant", "robot_1"):
        folders += [str(place) for place in (results / robot).iterdir() if place.name != "state"]
    words = [sys.executable, str(unbroken / "reproduce"), "check", *folders, str(unbroken / "results/smoke/logs")]
    done = subprocess.run(words, cwd=unbroken, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    accepted = {line.partition(": ok: ")[0] for line in done.stdout.splitlines() if ": ok: " in line}
    made = [path for folder in folders for path in Path(folder).rglob("*")]
    assert accepted >= {str(path) for path in made if path.suffix in (".json", ".csv", ".safetensors")}


def test_compute_counts_every_job_before_it(unbroken):
    rows = (unbroken / "results" / "smoke" / "compute.csv").read_text().splitlines()
    after = {"compute", "paper", "pages", "manifest"}
    jobs = [path for path in accounts(unbroken) if path.stem not in after]
    assert f"all jobs,jobs,{len(jobs)},-" in rows
    assert any(row.startswith("elapsed,cores,") for row in rows)


def test_report_is_made_by_one_command(unbroken):
    assert reproduce(unbroken, command="report").wait() == 0, told(unbroken)
    assert (unbroken / "report.html").stat().st_size > 1_000_000


def pages_below(folder):
    """Return the content of all files of a folder but the one that Snakemake adds."""
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != ".snakemake_timestamp"]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_documentation_is_made_by_one_command_and_verify_does_not_mind(unbroken, site):
    """It is that of another process in another folder, to the byte."""
    assert reproduce(unbroken, command="docs").wait() == 0, told(unbroken)
    made = unbroken / "results" / "smoke" / "docs"
    assert "MOB-Net, reproduced" in (made / "index.html").read_text()
    pages, again = pages_below(site), pages_below(made)
    assert pages.keys() == again.keys()
    assert [name for name, content in pages.items() if again[name] != content] == []
    words = ["verify", "--manifest", "results/smoke/MANIFEST.sha256"]
    done = subprocess.run([sys.executable, str(unbroken / "reproduce"), *words], cwd=unbroken, check=False)
    assert done.returncode == 0


@with_browser
def test_report_shows_tables_figures_and_trainings(unbroken, open_page):
    browser = open_page(unbroken / "report.html")
    choose(browser, "Tables")
    show(browser, "table_05", "iframe")
    assert "MOB-Net" in text_of_frame(browser)
    browser = open_page(unbroken / "report.html")
    choose(browser, "Trainings")
    show(browser, "runs", "iframe")
    assert "MOB-Net-LL-s0" in text_of_frame(browser)
    assert "SNAKEMAKE RULE runs_page" in explain(browser, "runs")


SIMULATION = "src/mobnet/simulation"
DECORATED, DEFINED = "\n@compiled\n", "\n\n\ndef "
WORDS = {  # file -> what is replaced in it by what: none of these can change a result
    "src/mobnet/core/store.py": ("}: file is missing", "}: there is no file"),
    "src/mobnet/learning/train.py": ("done after epoch", "ended after epoch"),
    f"{SIMULATION}/friction.py": (DECORATED, f"\n# a comment{DECORATED}"),
    "src/mobnet/settings/names.py": ("if name not in", "if name and name not in"),
}
LAW = {f"{SIMULATION}/friction.py": (DECORATED, f"\nADDED = 1\n\n{DECORATED}")}
PRODUCTS = {
    "configs/evaluation.yaml": ("every: 10\n", "every: 11\n"),
    "src/experiments/evaluation/tables/further/steps.py": (DEFINED, f"\n\nADDED = 1{DEFINED}"),
}
MUJOCO = {"environment.lock": ("\nmujoco==", "\nmujoco==9")}


@pytest.mark.parametrize(("edits", "touched", "spared"), [
    (WORDS, set(), set()),
    (LAW, {"collect"}, {"deviations", "motion"}),
    (PRODUCTS, {"figure_with_bars", "table"}, {"collect", "observe", "train"}),
    (MUJOCO, {"collect", "motion"}, {"deviations"}),
], ids=["words", "friction law", "a figure's setting and a table's code", "version of MuJoCo"])  # fmt: skip
def test_edits_rerun_exactly_what_depends_on_them(unbroken, snakemake, edits, touched, spared):
    before = {path: (path.read_text(), path.stat()) for path in (unbroken / name for name in edits)}
    for (path, (text, _)), (old, new) in zip(before.items(), edits.values(), strict=True):
        assert old in text
        path.write_text(text.replace(old, new, 1))
    try:
        planned = snakemake("-n", *SMOKE, folder=unbroken).stdout
    finally:
        for path, (text, times) in before.items():
            path.write_text(text)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert ("Nothing to be done" in planned) == (not touched)
    changed = re.findall(r"params have changed since last execution:\n +(.+(?:\n {8}.+)*)", planned)
    found = {word.strip() for line in changed for word in line.split(",")}
    assert found == touched or (edits is MUJOCO and found > touched)  # whatever else simulates
    assert not spared & set(planned.split())


def test_damaged_recording_stops_with_one_line_and_nothing_half_written(unbroken, make_project, snakemake):
    folder = make_project("damaged", unbroken)
    own = Path("results") / "smoke" / "plant"
    place = own / "recordings" / "forward_walk" / "ideal"
    for made in (place, own / "residuals" / "forward_walk" / "ideal"):
        shutil.copytree(unbroken / made, folder / made)
    whole = (unbroken / place / "s101.parquet").read_bytes()
    (folder / place / "s101.parquet").write_bytes(whole[: len(whole) // 2])
    target = str(own / "estimates" / "forward_walk" / "ideal")
    done = snakemake("--cores", "1", *SMOKE, "--rerun-triggers", "mtime", "--", target, folder=folder)
    assert done.returncode != 0
    assert (done.stdout + done.stderr).count(f"{place}/s101.parquet: truncated or damaged") == 1
    assert not (folder / target).exists()


def run_on_cluster(folder, place, *targets):
    """Make targets of a project on a cluster of this machine, whose files go to a place; return how long it took [s].

    At this scale trainings take seconds, so that they go into the queue together too.
    """
    groups = (
        "motions=20", "walks=25", "residuals=25", "fits=10", "networks=33", "estimates=120", "scores=20", "tables=100",
    )  # fmt: skip
    words = ["--profile", "workflow/profiles/slurm", "--cores", "1"]
    command = [sys.executable, str(folder / "reproduce"), *targets, *SMOKE, *words, "--group-components", *groups]
    with cluster_in(place) as cluster, (folder / "out.log").open("w") as out:
        before = time.monotonic()
        done = subprocess.run(cluster.words(*command), cwd=folder, stdout=out, stderr=out, check=False)
    assert done.returncode == 0, told(folder)
    return time.monotonic() - before


def with_losses(make_project, unbroken, name):
    """Return a copy of a project with its results, of which some are lost."""
    folder = make_project(name, unbroken)
    for part in MADE:
        shutil.copytree(unbroken / part, folder / part, symlinks=True, dirs_exist_ok=True)
    for place in (folder / name for name in LOST):
        shutil.rmtree(place) if place.is_dir() else place.unlink()
    return folder


def numbers_below(place):
    """Return the content of a file, or of all files of a folder but notes, which tell when and where they were made."""
    found = place.rglob("*") if place.is_dir() else [place]
    return {path.name: path.read_bytes() for path in found if path.is_file() and path.suffix != ".json"}


def test_a_cluster_makes_the_same_files(unbroken, make_project, tmp_path_factory):
    folder = with_losses(make_project, unbroken, "on_cluster")
    run_on_cluster(folder, tmp_path_factory.mktemp("cluster"), *FIGURES)
    for place in LOST:
        assert numbers_below(folder / place) == numbers_below(unbroken / place) != {}
    assert products(folder) == products(unbroken)


if WHOLE_CLUSTER in os.environ:  # it takes as long as all other tests together

    def test_a_cluster_makes_all_files_in_half_as_much_time_again(unbroken, make_project, tmp_path_factory):
        folder = make_project("all_on_cluster", unbroken)
        took_s = run_on_cluster(folder, tmp_path_factory.mktemp("cluster"), "all")
        assert products(folder) == products(unbroken)
        assert manifest_of(folder) == manifest_of(unbroken)
        jobs = [read_account(path) for path in accounts(unbroken)]
        assert took_s <= LONGER * (max(job.end_s for job in jobs) - min(job.start_s for job in jobs))


def test_killed_at_random_moments_ends_with_the_same_tables(unbroken, make_project):
    folder = with_losses(make_project, unbroken, "killed")
    moments = random.Random(2023)
    for kill in range(KILLS):
        run = reproduce(folder, "--cores", "1")
        time.sleep(moments.uniform(1.0, LONGEST_S))
        if kill % 2:
            os.killpg(run.pid, signal.SIGKILL)
        else:
            run.kill()  # its jobs live on until they end
        run.wait()
        assert reproduce(folder, "--unlock").wait() == 0, told(folder)
    assert reproduce(folder, "--cores", "3").wait() == 0, told(folder)  # whatever the number of cores is
    assert products(folder) == products(unbroken)
    assert manifest_of(folder) == manifest_of(unbroken)
    assert names(folder) == names(unbroken)
