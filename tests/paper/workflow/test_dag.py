"""The workflow can be planned at every scale, and a bad configuration stops it with one line."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.evaluation.report.compute import HOUR_S, WHOLE
from experiments.evaluation.report.cost import costs
from experiments.evaluation.report.paper import missing_packages
from experiments.jobs.inputs import placed
from experiments.plan.dry_run import dry_run
from experiments.plan.files import made_by_jobs
from experiments.plan.gpu import GPU_RATES, GpuNote, fitted
from experiments.plan.limits import MB_OF_MIB, MINUTE_S, SNAKEMAKE_MB
from experiments.plan.plan import make_plan
from experiments.plan.prices import RATES, RatesNote, kind_of, priced
from experiments.plan.work import works_of
from experiments.settings.load import load_settings
from experiments.site.machines import ASKED, PAGE, block_of, row, table
from mobnet.core.notes import read_note

ROOT = Path(__file__).parents[3]
SCALES = ("smoke", "quick", "default", "paper")
MOST_RULES, MOST_ARROWS = 40, 150
QUICK_S = 2.3 * HOUR_S  # processor time of the scale `quick`


@pytest.mark.parametrize("scale", SCALES)
def test_rules_make_all_that_is_planned_once_and_say_what_they_need(planned, scale):
    plan = make_plan(load_settings(overrides={"scale": scale}), with_pdf=not missing_packages())
    made = [name for job in planned(scale) for name in job.outputs if name]
    assert len(set(made)) == len(made)
    assert set(made) >= {name for product in plan.products for name in product.outputs}
    without = [job.rule for job in planned(scale) if not {"mem_mb", "runtime"} <= job.resources.keys()]
    assert set(without) <= {"all", "tables", "figures", "paper_core"}  # which run nothing


@pytest.mark.parametrize("scale", SCALES)
def test_the_manifest_names_all_that_other_jobs_make(planned, scale):
    jobs = planned(scale)
    (manifest,) = (job for job in jobs if job.rule == "manifest")
    others = [job for job in jobs if job.rule not in ("manifest", "all", "wandb_runs")]
    made = {name for job in others for name in job.outputs}
    assert set(manifest.inputs) == made


@pytest.mark.parametrize("side_by_side", [False, True])
def test_no_job_gets_the_name_of_a_file_that_its_rule_does_not_read(planned, side_by_side):
    """Inputs stand in the rules, names of many files in the arguments of their functions."""
    stacks = {"side_by_side": side_by_side}
    plan = make_plan(load_settings(overrides={"scale": "smoke", "stacks": stacks}), with_pdf=not missing_packages())
    checked = set()
    for job in planned("smoke", side_by_side=side_by_side):
        rule = "react" if job.rule == "walk_freely" else job.rule
        if hasattr(plan.jobs, rule):
            named = made_by_jobs(getattr(plan.jobs, rule)(job.w))
            read = {name for name in named if "/state/" not in name}  # of a training's checkpoint
        elif job.outputs[0]:
            read = set(plan.product(Path(job.name).name).inputs)
        else:
            continue
        assert read <= set(job.inputs), job.name
        checked.add(job.rule)
    assert {"train", "estimate", "score", "detect", "react", "table", "figure", "claims", "pages"} <= checked


@pytest.mark.parametrize("scale", SCALES)
def test_a_job_in_the_folder_of_the_project_gets_the_names_of_its_files_as_they_are(planned, scale):
    """A folder of results may be named as the end of another one: the tables of the main scale, and their captions."""
    plan = make_plan(load_settings(overrides={"scale": scale}), with_pdf=not missing_packages())
    checked = set()
    for job in planned(scale):
        if hasattr(plan.jobs, job.rule) or job.rule == "walk_freely" or not job.outputs[0]:
            continue
        given = plan.product(Path(job.name).name).arguments
        assert placed(given, [*job.inputs, *job.outputs]) == given, job.name
        checked.add(job.rule)
    assert {"table", "figure", "claims", "pages", "paper", "manifest"} <= checked


def test_what_no_product_reads_is_not_made(planned):
    """Of trials nothing, and of everything else what somebody reads."""
    plan = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)
    names = {job.name for job in planned("smoke")}
    assert not [name for name in names if any(f"/{trial}-" in name for trial in plan.files.catalogue.tried)]
    scored = {f"score/{scenario}-{level}" for scenario, level in plan.files.scored}
    assert {name for name in names if name.startswith("score/")} <= scored


def test_every_network_is_trained_by_a_job_of_its_own(planned):
    plan = make_plan(load_settings(overrides={"scale": "default"}), with_pdf=False)
    trained = [job for job in planned("default") if job.rule == "train"]
    folders = {str(Path(job.outputs[0]).parent) for job in trained}
    assert len(trained) == len(folders)
    assert folders == set(map(str, plan.files.all_networks()))


@pytest.mark.parametrize("scale", ["smoke", "paper"])
def test_networks_learn_side_by_side_where_it_is_asked_for(planned, scale):
    """A dry run ends at a cycle. All other jobs are the same."""
    settings = load_settings(overrides={"scale": scale, "stacks": {"side_by_side": True}})
    plan = make_plan(settings, with_pdf=False)
    jobs = planned(scale, side_by_side=True)
    stacks = [job for job in jobs if job.rule == "train_stack"]
    assert sorted(job.wildcards["stack"] for job in stacks) == sorted(plan.jobs.stacks.members)
    made = {job.outputs[0] for job in stacks}
    taught = [job for job in jobs if job.rule == "train" and made & set(job.inputs)]
    assert len(taught) == len(plan.jobs.stacks.names)
    others = [job.name for job in jobs if job.rule != "train_stack"]
    assert sorted(others) == sorted(job.name for job in planned(scale))


def test_the_core_of_the_paper_is_section_5_1_alone(planned):
    """Where networks learn alone, nothing of a surrogate robot is made, and no leg that its tables do not show."""
    jobs = planned("paper", "paper_core")
    shown = {job.name for job in jobs if job.rule in ("table", "figure_with_bars")}
    assert shown == {"table/table_05", "table/table_06", "figure/figure_05"}
    assert {job.wildcards.get("robot", "plant") for job in jobs} == {"plant"}
    trained = {(job.wildcards["method"], job.wildcards["limb"]) for job in jobs if job.rule == "train"}
    assert {("MOB-Net", limb) for limb in ("LL", "LA", "RA", "W", "V")} | {("FTS-e2e", "LL")} <= trained
    assert ("MOB-Net", "RL") not in trained


@pytest.mark.parametrize("asked", ASKED, ids=lambda asked: asked.name)
def test_the_page_says_what_each_scale_takes_on_which_machine(planned, asked):
    """`python -m experiments.site machines` renews it."""
    alone, beside = (planned(asked.scale, asked.target, side_by_side=yes) for yes in (False, True))
    expected = row(asked, alone, beside, ROOT)
    text = block_of((ROOT / PAGE).read_text())
    (found,) = [line for line in text.splitlines() if line.startswith(f"| {asked.name} |")]
    assert found == table([expected]).splitlines()[-1]


def test_the_list_of_rules_is_the_same_at_every_scale_and_a_page(snakemake):
    lists = [snakemake("--list-rules", "--config", f"scale={scale}").stdout.split() for scale in ("smoke", "paper")]
    assert lists[0] == lists[1]
    assert {"collect", "observe", "train", "estimate", "score", "react", "table", "figure"} <= set(lists[0])
    assert len(lists[0]) <= MOST_RULES


def drawn_in(graph):
    """Return rule -> all rules behind it, of a graph in the words of dot or in the picture that dot makes of it."""
    names = re.findall(r'^\s*(\d+)\[label = "(\w+)"', graph, re.MULTILINE)
    names += re.findall(r"<title>(\d+)</title>.*?<text[^>]*>(\w+)</text>", graph, re.DOTALL)
    names = dict(names)
    behind = {name: set() for name in names.values()}
    for first, last in re.findall(r"\b(\d+) ?(?:->|&#45;&gt;) ?(\d+)\b", graph):
        behind[names[last]].add(names[first])
    for _ in names:
        for found in behind.values():
            found.update(*(behind[earlier] for earlier in list(found)))
    return behind


def test_the_graph_of_rules_is_a_page(snakemake):
    """That of a table of errors is the way from a motion to its numbers."""
    alone = "stacks={side_by_side: false}"  # as on a machine without a GPU
    whole = snakemake("all", "--config", "scale=default", alone, "--rulegraph").stdout
    assert 0 < whole.count("->") <= MOST_ARROWS
    assert drawn_in((ROOT / "docs" / "rules.svg").read_text()) == drawn_in(whole)
    boxes = re.findall(
        r'label = "(\w+)"', snakemake("tables/smoke/table_06.tex", "--config", alone, "--rulegraph").stdout
    )
    assert set(boxes) == {"motion", "collect", "observe", "fit", "train", "estimate", "score", "table"}


def test_inputs_stand_in_the_rules_and_go_through_the_scripts():
    """As paths, lookups in sheets, or what other rules make; no rule asks the plan for them."""
    rules = []
    for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")):
        rules += re.split(r"^(?:use )?rule ", path.read_text(), flags=re.MULTILINE)[1:]
    reading = [rule for rule in rules if "\n    input:\n" in rule]
    assert len(reading) > 30
    for rule in reading:
        read = re.search(r"\n    input:\n((?: {8}.*\n)+)", rule)[1]
        assert re.search(r'"|\brules\.|PLAN\.sets', read), rule
        assert not re.search(r"lambda|PLAN\.product|JOBS", read), rule
        for script in re.findall(r'"\.\./scripts/(\w+\.py)"', rule):
            assert "snakemake.input" in (ROOT / "workflow" / "scripts" / script).read_text(), script


def test_no_rule_is_made_in_a_loop():
    files = [ROOT / "Snakefile", *(ROOT / "workflow" / "rules").glob("*.smk")]
    assert [path.name for path in files if re.search(r"^for .* in .*:$", path.read_text(), re.MULTILINE)] == []


WORDS_OF_SNAKEMAKE = [  # words -> rules that must run, and rules that must not
    (("--forceall", "--until", "score"), {"collect", "train", "estimate", "score"}, {"table", "figure", "paper"}),
    (("--forceall", "--omit-from", "train"), {"motion", "collect", "observe"}, {"train", "manifest", "paper"}),
    (("--forcerun", "train"), {"train", "paper"}, set()),
    (("-R", "table"), {"table", "paper"}, set()),
]


@pytest.mark.parametrize(("words", "run", "spared"), WORDS_OF_SNAKEMAKE)
def test_snakemake_s_own_words_work(snakemake, words, run, spared):
    done = snakemake("-n", "--quiet", "all", "--config", "scale=smoke", *words)
    assert done.returncode == 0, done.stderr
    counted = dict(re.findall(r"^(\w+) +(\d+)$", done.stdout + done.stderr, re.MULTILINE))
    assert run <= counted.keys()
    assert not spared & counted.keys()
    assert counted.keys() - {"total"} <= set(snakemake("--list-rules", "--config", "scale=smoke").stdout.split())


def test_a_configuration_file_is_read(snakemake, tmp_path):
    (tmp_path / "mine.yaml").write_text("scale: smoke\nobserver: {gain_hz: 31}\n")
    done = snakemake("-n", "--configfile", str(tmp_path / "mine.yaml"), "--", "tables/smoke/table_06.tex")
    assert done.returncode == 0, done.stderr
    (tmp_path / "mine.yaml").write_text("scale: smoke\nobserver: {gain_hz: -1}\n")
    done = snakemake("-n", "--configfile", str(tmp_path / "mine.yaml"))
    assert "observer.gain_hz: -1 is not accepted" in done.stdout + done.stderr


def test_another_workflow_can_use_the_rules(snakemake, tmp_path):
    """As a module, in the folder of the project."""
    (tmp_path / "Snakefile").write_text(
        f'module mobnet:\n    snakefile: "{ROOT}/Snakefile"\n    config: {{"scale": "smoke"}}\n\n'
        "use rule * from mobnet as mobnet_*\n\n"
        'rule mine:\n    default_target: True\n    input: "tables/smoke/table_06.csv"\n    output: "mine.txt"\n'
        '    shell: "cp {input} {output}"\n'
    )
    words = ("-n", "--forceall", "--quiet", "all", "--snakefile", str(tmp_path / "Snakefile"), "--directory", str(ROOT))
    done = snakemake(*words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"^mobnet_collect +\d+$", done.stdout + done.stderr, re.MULTILINE)


@pytest.mark.parametrize(("target", "line"), [
    ("tables/smoke/table_99.tex", r"tables/smoke/table_99\.tex: is no target; did you mean tables/smoke/table_"),
    ("trian", "trian: is no target; did you mean "),
    (
        "results/smoke/plant/recordings/forward_walk/ideal/s101.parquet",
        "is a file of a set; the target is its folder, results/smoke/plant/recordings/forward_walk/ideal",
    ),
])  # fmt: skip
def test_a_mistyped_target_is_one_line(snakemake, target, line):
    done = snakemake("-n", target)
    assert done.returncode != 0
    told = [text for text in (done.stdout + done.stderr).splitlines() if target in text]
    assert len(told) == 1
    assert re.search(line, told[0])


def test_resources_are_asked_for_by_the_name_of_a_rule(snakemake, planned):
    words = ("-n", "--quiet", "host", "--forceall", "--config", "scale=smoke", "--set-resources", "train:mem_mb=777")
    done = snakemake(*words)
    assert (done.stdout + done.stderr).count("mem_mb=777,") == len([j for j in planned("smoke") if j.rule == "train"])


def test_what_is_out_of_date_of_a_target_is_priced():
    """As many jobs as a dry run counts; all of them where nothing is made yet."""
    target = "tables/smoke/table_06.tex"
    config = ("scale=smoke", "observer={gain_hz: 31}")  # so that a run in this folder has not made it
    listed = dry_run([target], config)
    words = (sys.executable, "-m", "experiments.evaluation.report.cost", target, "--config", *config)
    told = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    rated = read_note(ROOT / RATES, RatesNote).kinds
    counted = [job for job in listed if job.name.partition("/")[0] in rated or job.rule == "table"]
    assert len(counted) > 0
    assert f"| all jobs | {len(counted)} |" in told


def test_each_larger_scale_costs_more_and_quick_fits_into_its_hour(planned):
    """By the published rates: 75 minutes on two cores, some of which a run does not use."""
    rates = read_note(ROOT / RATES, RatesNote).kinds
    found = {}
    for scale in SCALES:
        plan = make_plan(load_settings(overrides={"scale": scale}), with_pdf=False)
        _, found[scale], _ = costs(works_of(plan, planned(scale)), rates)[WHOLE]
    assert list(found.values()) == sorted(set(found.values()))
    assert found["quick"] < QUICK_S


@pytest.mark.parametrize(("scale", "side_by_side"), [*((scale, False) for scale in SCALES), ("paper", True)])
def test_no_job_takes_more_than_half_of_what_it_asks_for(planned, scale, side_by_side):
    """By its price, in memory and time: a slower processor, or a job that takes more than others of its kind, may."""
    stacks = {"side_by_side": side_by_side}
    plan = make_plan(load_settings(overrides={"scale": scale, "stacks": stacks}), with_pdf=not missing_packages())
    rates = read_note(ROOT / RATES, RatesNote)
    gpu = fitted(read_note(ROOT / GPU_RATES, GpuNote)) if side_by_side else None
    jobs = priced(plan, rates, gpu, planned(scale, side_by_side=side_by_side))
    assert [job.work.job for job in jobs if kind_of(job.work, rates.kinds) is None] == []
    over = []
    for job in jobs:
        asked = job.planned.resources
        held_mb = job.peak_mib * MB_OF_MIB + SNAKEMAKE_MB
        minutes = (job.cpu_s + job.gpu_s) / MINUTE_S
        if 2 * held_mb > int(asked["mem_mb"]) or 2 * minutes > int(asked["runtime"]):
            over.append(
                f"{job.work.job}: {held_mb:.0f} of {asked['mem_mb']} MB, {minutes:.0f} of {asked['runtime']} min"
            )
    assert len(jobs) > len(rates.kinds)
    assert over == []


@pytest.mark.parametrize(("given", "message"), [
    ("methods={MOB: {kind: magic}}", "'magic' is not accepted; accepted: "),
    ("robot=configs/robots/none.yaml", "--config: robot: 'configs/robots/none.yaml' is not accepted"),
])  # fmt: skip
def test_bad_configuration_stops_with_one_line(snakemake, given, message):
    done = snakemake("-n", "--config", given)
    assert done.returncode != 0
    assert len([line for line in (done.stdout + done.stderr).splitlines() if message in line]) == 1
    assert "Traceback" not in done.stderr
