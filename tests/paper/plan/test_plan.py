"""The plan names each file once, gives each job what its function takes and no more, and misses nothing."""

import inspect
import re
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name
from types import SimpleNamespace
from typing import Any

import pytest
from jobs_of import arguments, network, reads
from paper_settings import settings_at

from experiments.plan.files import files_in, made_by_jobs
from experiments.plan.plan import Plan, make_plan
from experiments.plan.product import Call
from experiments.plan.products import Shown, shown
from experiments.plan.runs import SweptSize
from experiments.plan.sheets import Sheets
from experiments.settings.settings import Settings

SCALES = ("smoke", "quick", "default", "paper")


@pytest.fixture(scope="module")
def plans() -> dict[str, Plan]:
    """The plan of every scale."""
    return {scale: make_plan(settings_at(scale), with_pdf=True) for scale in SCALES}


@pytest.fixture
def plan(plans: dict[str, Plan]) -> Plan:
    return plans["smoke"]


def made(plan: Plan) -> list[str]:
    """Return every file that products are made of."""
    return [name for product in plan.products for name in product.outputs]


def changed(settings: Settings, *keys: str, **values: Any) -> Plan:
    """Return the plan after a change of the section that keys lead to."""
    sections = [settings]
    for key in keys:
        sections.append(sections[-1][key] if isinstance(sections[-1], dict) else getattr(sections[-1], key))
    section: Any = sections[-1].model_copy(update=values)
    for key, above in zip(reversed(keys), reversed(sections[:-1]), strict=True):
        section = {**above, key: section} if isinstance(above, dict) else above.model_copy(update={key: section})
    return make_plan(section, with_pdf=True)


def rerun(before: Plan, after: Plan) -> set[str]:
    """Return the products whose arguments differ."""
    told = {product.name: repr(product.arguments) for product in before.products}
    return {product.name for product in after.products if told[product.name] != repr(product.arguments)}


@pytest.mark.parametrize("scale", SCALES)
def test_every_file_of_a_product_is_made_once(plans: dict[str, Plan], scale: str) -> None:
    names = made(plans[scale])
    assert Counter(names).most_common(1)[0][1] == 1


def test_scales_never_share_a_file_and_the_main_one_stands_where_a_reader_looks(plans: dict[str, Plan]) -> None:
    names = [name for plan in plans.values() for name in made(plan)]
    assert len(set(names)) == len(names)
    assert {"tables/table_05.tex", "figures/figure_05.pdf", "paper/main.pdf"} <= set(made(plans["default"]))
    assert {"tables/smoke/table_05.tex", "results/smoke/paper/main.pdf"} <= set(made(plans["smoke"]))
    without_tex = make_plan(plans["smoke"].settings, with_pdf=False)
    assert not [name for name in made(without_tex) if name.endswith("main.pdf")]


def test_quick_makes_every_product_with_one_robot_and_one_network_of_each(plans: dict[str, Plan]) -> None:
    quick = plans["quick"]
    assert [product.name for product in quick.products] == [product.name for product in plans["default"].products]
    assert list(quick.files.robots) == ["robot_1"]
    assert {len(own.network_seeds(*network)) for own in quick.files.owners for network in own.learned} == {1}


def test_training_and_test_recordings_are_disjoint(plans: dict[str, Plan]) -> None:
    files = plans["default"].files
    train, test = files.training("recordings", "walk"), files.tests("forward_walk", "all_uncertainty")
    assert [path.name for path in train] == [f"s{1000 + k}" for k in range(files.training_size("walk").shards)]
    sizes = files.settings.sizes.test
    assert [path.name for path in test] == [f"s{sizes.first_seed + k}" for k in range(sizes.shards)]
    chosen_on = files.development("recordings", "plant_leg")
    assert [path.name for path in chosen_on] == [f"s{501 + k}" for k in range(files.settings.sizes.development.shards)]


@pytest.mark.parametrize("scale", SCALES)
def test_every_method_gets_its_networks(plans: dict[str, Plan], scale: str) -> None:
    """Those of the left leg on the plant of section 5.1 or on robots; each is trained once for each seed.

    A method that is fine-tuned stands for those of its sweep alone.
    """
    files = plans[scale].files
    rows = files.catalogue.all_methods.items()
    learned = {pair for own in files.owners for pair in own.learned}
    swept = {base for sweep in files.settings.sweeps.values() for base in sweep.of}
    assert {name for name, _ in learned} == {
        name for name, row in rows if row.limbs and not (row.start and name in swept)
    }
    assert len(files.all_networks()) == sum(
        len(own.network_seeds(*pair)) for own in files.owners for pair in own.learned
    )


def test_a_limb_with_fewer_seeds_serves_them_in_turn(plans: dict[str, Plan]) -> None:
    files = plans["default"].files
    assert files.network_seeds("MOB-Net", "RL") == (0,)
    assert files.network("MOB-Net", "RL", 2).name == "MOB-Net-RL-s0"
    assert {run.network_seed for run in files.runs("walk_test", "all_uncertainty", ["MOB-Net"])} == {0, 1, 2}
    assert {run.network_seed for run in files.runs("walk_test", "all_uncertainty", ["MOB"])} == {0}


def test_a_method_runs_with_as_many_seeds_as_the_limbs_of_a_test_have(plans: dict[str, Plan]) -> None:
    files = plans["default"].files
    assert files.run_seeds("MOB-Net", "forward_walk", "all_uncertainty") == (0, 1, 2)
    assert files.run_seeds("MOB-Net", "hand_load_10", "all_uncertainty") == (0, 1, 2)
    assert {run.network_seed for run in files.runs("hand_load_10", "all_uncertainty", ["MOB-Net"])} == {0, 1, 2}


def test_a_network_that_serves_several_seeds_counts_with_the_first_of_them(plans: dict[str, Plan]) -> None:
    runs = plans["default"].files.runs("walk_test", "all_uncertainty", ["MOB", "MOB-Net", "FTS-e2e"])
    repeated = {(run.method, run.network_seed): run.repeated for run in runs}
    assert repeated["MOB", 0] == repeated["MOB-Net", 0] == ()
    assert repeated["MOB-Net", 1] == repeated["MOB-Net", 2] == ("RL", "N", "RA")
    assert repeated["FTS-e2e", 1] == ()


def test_a_walk_gets_the_terrains_and_pushes_that_it_names(plan: Plan) -> None:
    walk = arguments(plan, "collect", "robot_1", scenario="knee_swing", level="robot_1")["settings"]
    assert set(walk.pushes) == {"left_knee_swing"}
    assert walk.terrain.flat is not None
    assert walk.terrain.checks is None


def test_an_estimate_reads_weights_fits_and_recordings(plan: Plan) -> None:
    test = {"robot": "robot_1", "scenario": "walk_test", "level": "robot_1"}
    read = reads(plan, "estimate", **test)
    own = "results/smoke/robot_1"
    assert {f"{own}/recordings/walk_test/robot_1", f"{own}/residuals/walk_test/robot_1"} <= set(read)
    assert {f"{own}/fits/MOB-fric.json", f"{own}/networks/FTS-e2e-LL-s101/weights.safetensors"} <= set(read)
    modules = plan.jobs.estimated_by(SimpleNamespace(**test))
    assert {"mobnet.estimation.kinds.band_pass", "mobnet.estimation.kinds.friction"} <= set(modules)


def test_a_test_runs_the_networks_of_its_limbs_alone(plan: Plan) -> None:
    def run(method: str, scenario: str, robot: str = "robot_1") -> tuple[list[str], tuple[str, ...]]:
        level = "all_uncertainty" if robot == "plant" else robot
        runs = arguments(plan, "estimate", robot, scenario=scenario, level=level)["runs"]
        found = next(one for one in runs if one.method == method)
        return list(found.networks), found.joints

    layout = plan.settings.layout
    assert run("MOB-Net", "knee_swing") == (["LL"], layout.limb("LL"))
    assert run("MOB", "knee_swing") == ([], layout.limb("LL"))
    limbs, joints = run("MOB-Net-Single", "hand_wrench")
    assert limbs == ["WB"]
    assert set(joints) == {*layout.limbs(["W", "LA", "RA"])}
    limbs, joints = run("MOB-Net", "motion_test", robot="plant")
    assert limbs == ["V", "W", "LA", "N", "RA"]
    assert set(joints) == {*layout.limbs(limbs)}


def test_all_recordings_of_a_test_are_estimated_by_one_job_with_each_network(plans: dict[str, Plan]) -> None:
    plan = plans["default"]
    job = arguments(plan, "estimate", scenario="forward_walk", level="all_uncertainty")
    runs = [run for run in plan.files.runs("forward_walk", "all_uncertainty", ["MOB-Net"]) if run.network_seed == 1]
    assert len(runs) == plan.settings.sizes.test.shards
    assert Sheets(plan).tests["plant/forward_walk/all_uncertainty"]["seeds"] == [run.test_seed for run in runs]
    assert [run.network_seed for run in job["runs"] if run.method == "MOB-Net"] == [0, 1, 2]


FUNCTIONS = {  # rule -> function of its job
    "motion": "experiments.jobs.motions:make_motion",
    "collect": "experiments.jobs.walks:collect_walks",
    "observe": "experiments.jobs.observing:observe_walks",
    "fit": "experiments.jobs.fitting:write_fit",
    "train": "experiments.jobs.trainings:train",
    "train_stack": "experiments.jobs.stacks:train_stack",
    "estimate": "experiments.jobs.estimates:estimate",
    "score": "experiments.evaluation.measure.estimates.scores:score",
    "detect": "experiments.jobs.detect:detect",
    "watch": "experiments.jobs.calm:watch",
    "react": "experiments.jobs.react:react",
    "falls": "experiments.evaluation.measure.data.random_torque:count_falls",
}
JOBS: dict[str, dict[str, str]] = {  # rule -> wildcards of one of its jobs
    "motion": {"motion": "random_motion", "seed": "1000"},
    "collect": {"scenario": "forward_walk", "level": "ideal"},
    "observe": {"scenario": "forward_walk", "level": "ideal"},
    "fit": {"method": "MOB-fric"},
    "train": network("MOB-Net-LL-s0"),
    "train_stack": {"stack": "plant-MOB-Net-LL-s0"},
    "estimate": {"scenario": "forward_walk", "level": "ideal"},
    "score": {"scenario": "forward_walk", "level": "ideal"},
    "detect": {"robot": "robot_1"},
    "watch": {"robot": "robot_1"},
    "react": {"robot": "robot_1", "case": "knee"},
    "falls": {"robot": "robot_1"},
}


@pytest.mark.parametrize("rule", FUNCTIONS)
def test_a_job_gets_what_its_function_takes(plan: Plan, rule: str) -> None:
    """Besides what its script takes from the rule: files, and the place of its results."""
    module, name = FUNCTIONS[rule].split(":")
    signature = inspect.signature(getattr(import_module(module), name))
    script = (Path(__file__).parents[3] / "workflow" / "scripts" / f"{rule}.py").read_text()
    assert f"from {module} import {name}\n" in script
    taken = re.findall(r"\b(\w+)=", script)
    assert "out" in taken
    signature.bind(**arguments(plan, rule, **JOBS[rule]), **dict.fromkeys(taken))


def test_a_network_with_a_fit_is_told_of_the_observer(plan: Plan) -> None:
    """The friction of the fit is filtered as the observer filters; no other training reruns with its gain."""
    assert arguments(plan, "train", **network("MOB-Net-gray-LL-s0"))["observer"] == plan.settings.observer
    assert "observer" not in arguments(plan, "train", **network("MOB-Net-LL-s0"))


@pytest.mark.parametrize("rule", FUNCTIONS)
def test_arguments_are_told_by_what_they_hold(plan: Plan, rule: str) -> None:
    """Snakemake compares their text with that of the last run: it must not hold a place in memory, nor a set."""
    told = repr(arguments(plan, rule, **JOBS[rule]))
    assert " object at 0x" not in told
    assert "{'" not in re.sub(r"\{'[^']*':", "", told)


def test_a_setting_reruns_what_reads_it_and_nothing_else(plan: Plan) -> None:
    settings = plan.settings
    assert rerun(plan, changed(settings, "evaluation", "figure_07", every=11)) == {"figure_07"}
    assert rerun(plan, changed(settings, "evaluation", "steps", bins=8)) == {"steps"}
    assert rerun(plan, changed(settings, "evaluation", "compute", pause_s=61.0)) == {"compute"}
    observing = {"data_card", "bode", "label_error", "contact_points"}
    other = changed(settings, "observer", gain_hz=50.0)
    assert rerun(plan, other) <= observing
    for rule, reads_it in (("collect", False), ("observe", True), ("estimate", True), ("train", False)):
        before, after = (repr(arguments(one, rule, **JOBS[rule])) for one in (plan, other))
        assert (before != after) == reads_it, rule
    table = {**settings.evaluation.tables, "table_07": settings.evaluation.tables["table_10"]}
    assert rerun(plan, changed(settings, "evaluation", tables=table)) >= {"table_07"}


def test_a_push_reruns_the_walks_that_it_comes_in(plan: Plan) -> None:
    pushes = {**plan.settings.pushes, "left_knee_swing": plan.settings.pushes["left_knee_support"]}
    after = make_plan(plan.settings.model_copy(update={"pushes": pushes}), with_pdf=True)
    found: list[tuple[str, str]] = []
    for own in plan.files.owners:
        for scenario, level in dict.fromkeys((scenario, level) for scenario, level, _ in own.recorded()):
            place = {"robot": own.robot or "plant", "scenario": scenario, "level": level}
            if arguments(plan, "collect", **place) != arguments(after, "collect", **place):
                found.append((scenario, level))
    assert found == [("knee_swing", "robot_1"), ("knee_swing", "robot_2")]


def test_scores_and_runs_follow_from_the_section_of_a_product(plan: Plan) -> None:
    settings = plan.settings.evaluation
    figure, rows, panels = settings.figure_06, settings.methods, settings.figure_18
    given = plan.product("figure_06").arguments
    assert given["runs"] == plan.files.first_runs(figure)
    assert given["scores"] == plan.files.scores([(figure.scenario, figure.level)])
    for name, tests in (
        ("figure_06", [(figure.scenario, figure.level)]),
        ("methods", [(row.scenario, row.level) for row in rows]),
        ("figure_18", [(test, panels.level) for test in panels.panels]),
        (
            "fine_tuning",
            [
                ("changed_walk", level)
                for level in ("robots_other", "robots", "robots_gains", "robots_gait", "robots_payload")
            ],
        ),
    ):
        read: Any = plan.product(name).arguments["scores"]
        assert read == plan.files.scores(tests), name
        assert len(read) == len(set(tests)), name


def test_a_table_needs_the_levels_that_it_shows_alone(plans: dict[str, Plan]) -> None:
    """Table 6 shows the plant of section 5.1, Table 8 the same test on surrogate robots."""
    for plan in plans.values():
        owners: list[set[str]] = []
        for table in ("table_06", "table_08"):
            found: set[str] = set()
            for scores in map(Path, plan.product(table).inputs):
                read = reads(plan, "score", scenario=scores.parent.name, level=scores.stem)
                found.update(Path(name).parts[2] for name in read)
            owners.append(found)
        assert owners == [{"plant"}, set(plan.files.whole_robots)]


def test_a_caption_is_optional() -> None:
    assert shown("figures/figure_07.png") == Shown(
        "figures", "Figure 7: a load of 30 N on the left hand", Path("workflow/report/figures/figure_07.rst")
    )
    assert shown("results/smoke/pages/other.html") == Shown("tables", "other", None)
    assert shown("tables/table_05.csv") is None


def late_write() -> Callable[..., None]:
    from mobnet.core.files import write_text

    return write_text


def test_a_call_imports_its_function_late_and_a_job_finds_it_by_its_name(plan: Plan, tmp_path: Path) -> None:
    Call(late_write, {"path": tmp_path / "a.txt", "text": "a"}).run()
    assert (tmp_path / "a.txt").read_text() == "a"
    for name in ("table_07", "links", "paper"):
        call = plan.product(name).call
        assert resolve_name(call.name) is call.late


def test_files_are_found_behind_stems_networks_and_dataclasses() -> None:
    stem, folder, file = Path("results/recordings/a/s1"), Path("results/networks/A-LL-s0"), Path("results/a.csv")
    needs = {"a": [stem, (file, "text", 3)], "b": SweptSize("parameters", "A", (folder,))}
    assert [path.name for path in files_in(needs)] == [
        "s1.parquet", "a.csv", "weights.safetensors", "metrics.csv", "run.json",
    ]  # fmt: skip


def test_a_set_is_read_as_the_folder_that_its_job_makes() -> None:
    robot = Path("results/smoke/robot_1")
    estimates = [robot / "estimates/walk_test/robot_1/MOB-Net/n101" / f"s{seed}" for seed in (101, 102)]
    assert made_by_jobs(estimates) == ["results/smoke/robot_1/estimates/walk_test/robot_1"]
    assert made_by_jobs([Path("results/smoke/motions/a/s1")]) == ["results/smoke/motions/a/s1.parquet"]
