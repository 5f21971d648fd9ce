"""The whole line at the smoke scale, unbroken: what it made, and what would run again."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from browser import with_browser
from paper_settings import settings_at

from experiments.evaluation.report.compute import HOUR_S, WHOLE
from experiments.evaluation.report.cost import costs
from experiments.plan.plan import make_plan
from experiments.plan.work import works_of
from experiments.running.accounts import read_account
from experiments.site.rates import measured

from .clicks import choose, explain, show, text_of_frame
from .smoke import SMOKE, accounts, reproduce, told

NO_OP = 8.0  # times that the start of Snakemake alone takes; 4.2 to 5.4 were measured, 10 s where nothing else runs

pytestmark = [pytest.mark.slow, pytest.mark.sim]


@pytest.fixture(scope="module")
def plan():
    return make_plan(settings_at("smoke"), with_pdf=False)


@pytest.fixture(scope="module")
def unbroken(smoke_run):
    """A project in which the smoke scale ran on two cores."""
    return smoke_run / "run"


def test_smoke_makes_all_that_is_planned(unbroken, plan):
    names = [name for product in plan.products for name in (*product.inputs, *product.outputs)]
    assert [name for name in names if not (unbroken / name).exists()] == []
    assert (unbroken / "figures" / "smoke" / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert "MOB-Net-LL-s0" in (unbroken / "results" / "smoke" / "runs.html").read_text()
    page = (unbroken / "results" / "smoke" / "explore.html").read_text()
    assert '<tr data-method="MOB-Net">' in page
    assert len(page) < 3_000_000


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
    "src/mobnet/formats/names.py": ("if name not in", "if name and name not in"),
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


def test_a_set_that_somebody_removed_is_made_again(unbroken, snakemake):
    """Also one that only other sets were made from."""
    place = unbroken / "results/smoke/plant/residuals/forward_walk/ideal"
    aside = unbroken / "aside"
    place.rename(aside)
    planned = snakemake("-n", "--quiet", "host", *SMOKE, folder=unbroken).stdout
    aside.rename(place)
    assert "output: results/smoke/plant/residuals/forward_walk/ideal\n" in planned
    assert "rule collect:" not in planned
