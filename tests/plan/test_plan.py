"""The plan names each file once, gives each job what its function takes and no more, and misses nothing."""

from collections import Counter
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest
from made_steps import arguments, maker, recording

from experiments.plan.call import Call, Job, call_of, parameters
from experiments.plan.files import files_in
from experiments.plan.needs import needs_of
from experiments.plan.plan import Plan, make_plan
from experiments.plan.products import Shown, shown
from experiments.plan.runs import SweptSize
from experiments.plan.steps import Step
from experiments.settings.evaluation import PRODUCTS
from experiments.settings.load import load_settings
from experiments.settings.products import MadeBy
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError

SCALES = ("smoke", "quick", "default", "paper")
SOURCES = ("paper/main", "paper/refs", "docs", "src", "workflow")  # files of the repository that products read


@pytest.fixture(scope="module")
def plans() -> dict[str, Plan]:
    """The plan of every scale."""
    return {scale: make_plan(load_settings(overrides={"scale": scale}), with_pdf=True) for scale in SCALES}


@pytest.fixture
def plan(plans: dict[str, Plan]) -> Plan:
    return plans["smoke"]


def made(plan: Plan) -> list[str]:
    """Return every file that the plan makes."""
    return [*plan.stored, *(name for product in plan.products for name in product.outputs)]


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
    told = {product.name: product.job.call.fingerprint for product in before.products}
    return {product.name for product in after.products if told[product.name] != product.job.call.fingerprint}


@pytest.mark.parametrize("scale", SCALES)
def test_every_file_is_made_once_and_read_after_it_is_made(plans: dict[str, Plan], scale: str) -> None:
    names = made(plans[scale])
    assert Counter(names).most_common(1)[0][1] == 1
    known = set(plans[scale].stored)
    for product in plans[scale].products:
        read = {name for name in product.job.inputs if not name.startswith(SOURCES)}
        assert read <= known, product.name
        known |= set(product.outputs)


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
    trained = [name for name in plans[scale].stored if name.endswith("weights.safetensors")]
    assert len(trained) == sum(len(own.network_seeds(*pair)) for own in files.owners for pair in own.learned)


def test_a_limb_with_fewer_seeds_serves_them_in_turn(plans: dict[str, Plan]) -> None:
    files = plans["default"].files
    assert files.network_seeds("MOB-Net", "RL") == (0,)
    assert files.network("MOB-Net", "RL", 2).name == "MOB-Net-RL-s0"
    assert {run.network_seed for run in files.runs("walk_test", "all_uncertainty", ["MOB-Net"])} == {0, 1, 2}
    assert {run.network_seed for run in files.runs("walk_test", "all_uncertainty", ["MOB"])} == {0}


def test_a_method_runs_with_as_many_seeds_as_the_limbs_of_a_test_have(plans: dict[str, Plan]) -> None:
    files = plans["default"].files
    assert files.run_seeds("MOB-Net", "forward_walk", "all_uncertainty") == (0, 1, 2)
    assert files.run_seeds("MOB-Net", "hand_load_10", "all_uncertainty") == (0,)
    assert {run.network_seed for run in files.runs("hand_load_10", "all_uncertainty", ["MOB-Net"])} == {0}


def test_a_network_that_serves_several_seeds_counts_with_the_first_of_them(plans: dict[str, Plan]) -> None:
    runs = plans["default"].files.runs("walk_test", "all_uncertainty", ["MOB", "MOB-Net", "FTS-e2e"])
    repeated = {(run.method, run.network_seed): run.repeated for run in runs}
    assert repeated["MOB", 0] == repeated["MOB-Net", 0] == ()
    assert repeated["MOB-Net", 1] == repeated["MOB-Net", 2] == ("V", "RL", "W", "LA", "N", "RA")
    assert repeated["FTS-e2e", 1] == ()


def test_the_manifest_lists_every_result(plan: Plan) -> None:
    """All but the manifest itself and the folder of runs for wandb."""
    (manifest,) = [product for product in plan.products if product.name == "manifest"]
    views = {name for p in plan.products if p.name in ("manifest", "wandb_runs") for name in p.outputs}
    assert set(manifest.job.inputs) == set(made(plan)) - views


def test_a_walk_gets_the_terrains_and_pushes_that_it_names(plan: Plan) -> None:
    walk = arguments(plan, recording("knee_swing", "robot_1", 101, "robot_1"))["settings"]
    assert set(walk.pushes) == {"left_knee_swing"}
    assert walk.terrain.flat is not None
    assert walk.terrain.checks is None


def estimated(plan: Plan, scenario: str, level: str, robot: str = "") -> Step:
    """Return the step that estimates a test, by way of the estimate of MOB."""
    return maker(plan, robot, "estimates/MOB/n0", scenario, level, f"s{plan.files.test_seeds[0]}.parquet")


def run_of(step: Step, method: str, seed: int) -> Any:
    """Return the run of a method with a network's seed among those of a step."""
    runs: Any = step.job.call.arguments["runs"]
    (found,) = [run for run in runs if run.method == method and f"/{method}/n{seed}/" in str(run.outs[0])]
    return found


def test_an_estimate_reads_weights_fits_and_recordings(plan: Plan) -> None:
    job = estimated(plan, "walk_test", "robot_1", "robot_1").job
    array, own = f"s{plan.files.test_seeds[0]}.parquet", "results/smoke/robot_1"
    assert [Path(name).name for name in job.inputs][:2] == [array, array]
    assert {f"{own}/fits/MOB-fric.json", f"{own}/networks/FTS-e2e-LL-s101/weights.safetensors"} <= set(job.inputs)
    assert {"mobnet.estimation.kinds.band_pass", "mobnet.estimation.kinds.friction"} <= set(job.modules)


def test_a_test_runs_the_networks_of_its_limbs_alone(plan: Plan) -> None:
    def run(method: str, scenario: str, robot: str = "robot_1") -> tuple[list[str], tuple[str, ...]]:
        seed, level = (101, robot) if robot else (0, "all_uncertainty")
        found = run_of(estimated(plan, scenario, level, robot), method, seed if method != "MOB" else 0)
        return list(found.networks), found.joints

    layout = plan.settings.layout
    assert run("MOB-Net", "knee_swing") == (["LL"], layout.limb("LL"))
    assert run("MOB", "knee_swing") == ([], layout.limb("LL"))
    limbs, joints = run("MOB-Net-Single", "hand_wrench")
    assert limbs == ["WB"]
    assert set(joints) == {*layout.limbs(["V", "W", "LA", "RA"])}
    limbs, joints = run("MOB-Net", "motion_test", robot="")
    assert len(limbs) == 7
    assert set(joints) == set(layout.names)


def test_all_recordings_of_a_test_are_estimated_by_one_job_and_each_has_its_file(plans: dict[str, Plan]) -> None:
    plan = plans["default"]
    step = estimated(plan, "forward_walk", "all_uncertainty")
    runs = [run for run in plan.files.runs("forward_walk", "all_uncertainty", ["MOB-Net"]) if run.network_seed == 1]
    assert len(runs) == plan.settings.sizes.test.shards
    assert list(run_of(step, "MOB-Net", 1).outs) == [run.estimate for run in runs]
    assert step.job.call.arguments["residuals"] == tuple(run.residual for run in runs)


@pytest.mark.parametrize("scale", SCALES)
def test_steps_have_rules_of_their_own_and_are_few(plans: dict[str, Plan], scale: str) -> None:
    """A rule's name is that of its account, with an underscore for every other sign."""
    steps = [*plans[scale].steps, *plans[scale].trial_steps]
    names = [step.rule for step in steps] + [product.name for product in plans[scale].products]
    assert len(set(names)) == len(names)
    assert len(plans[scale].steps) + len(plans[scale].products) <= 500


def test_trainings_of_a_step_are_alike_and_share_what_they_read(plans: dict[str, Plan]) -> None:
    """One data set, one basis; those with the same inputs follow each other, and a long one stands alone."""
    steps = [step for step in plans["default"].steps if step.work.kind == "train"]
    for step in steps:
        networks: Any = step.job.call.arguments["networks"]
        assert len({(one.training.network.data, one.training.learning.labels) for one in networks}) == 1
        limbs = [(one.training.limb, one.training.target) for one in networks]
        assert len(list(groupby(limbs))) == len(set(limbs))
        steps_m = sum(amount for name, amount in step.work.amounts.items() if name.endswith(" step")) / 1e6
        assert len(networks) == 1 or steps_m <= 30.0
    alone = maker(plans["paper"], "networks/MOB-Net-LL-s0/weights.safetensors").job.call.arguments["networks"]
    assert len(alone) == 1


def test_a_fine_tuning_is_no_part_of_the_step_that_makes_its_start(plans: dict[str, Plan]) -> None:
    for step in plans["default"].steps:
        assert not set(step.job.inputs) & set(step.outputs)


def test_what_a_step_keeps_depends_on_its_arguments_and_its_code(plan: Plan) -> None:
    job = estimated(plan, "forward_walk", "ideal").job
    stage: Any = job.call.arguments["stage"]
    bare = {key: value for key, value in job.call.arguments.items() if key != "stage"}
    assert stage.given == Job(Call(job.call.function, bare), job.inputs, job.modules).given
    assert stage.inputs == job.inputs
    assert stage.folder == Path("results/smoke/state/estimate/forward_walk-ideal")


def test_a_setting_reruns_what_reads_it_and_nothing_else(plan: Plan) -> None:
    settings = plan.settings
    assert rerun(plan, changed(settings, "evaluation", "figure_07", every=11)) == {"figure_07"}
    assert rerun(plan, changed(settings, "evaluation", "steps", bins=8)) == {"steps"}
    assert rerun(plan, changed(settings, "evaluation", "compute", pause_s=61.0)) == {"compute"}
    observing = {"data_card", "bode", "label_error", "contact_points"}
    assert rerun(plan, changed(settings, "observer", gain_hz=50.0)) <= observing
    walk = recording("forward_walk", "ideal", 101)
    before, after = (maker(one, walk).job.call for one in (plan, changed(settings, "observer", gain_hz=50.0)))
    assert after.fingerprint != before.fingerprint  # the job that records a walk observes it, too
    table = {**settings.evaluation.tables, "table_07": settings.evaluation.tables["table_10"]}
    assert rerun(plan, changed(settings, "evaluation", tables=table)) >= {"table_07"}


def test_a_push_reruns_the_walks_that_it_comes_in(plan: Plan) -> None:
    pushes = {**plan.settings.pushes, "left_knee_swing": plan.settings.pushes["left_knee_support"]}
    after = make_plan(plan.settings.model_copy(update={"pushes": pushes}), with_pdf=True)
    calls = [{s.work.job: s.job.call for s in p.steps if s.work.kind == "collect"} for p in (plan, after)]
    assert [name for name, call in calls[0].items() if call != calls[1][name]] == [
        "collect/robot_1/knee_swing-robot_1-s101"
    ]


def test_scores_and_runs_follow_from_the_section_of_a_product(plan: Plan) -> None:
    settings = plan.settings.evaluation
    figure, rows, panels = settings.figure_06, settings.methods, settings.figure_18
    own: Any = needs_of(plan.files, PRODUCTS["figure_06"], figure)
    assert own == {
        "runs": plan.files.first_runs(figure),
        "scores": plan.files.scores([(figure.scenario, figure.level)]),
    }
    for name, section, tests in (
        ("figure_06", figure, [(figure.scenario, figure.level)]),
        ("methods", rows, [(row.scenario, row.level) for row in rows]),
        ("figure_18", panels, [(test, panels.level) for test in panels.panels]),
        (
            "fine_tuning",
            settings.fine_tuning,
            [
                ("changed_walk", level)
                for level in ("robots_other", "robots", "robots_gains", "robots_gait", "robots_payload")
            ],
        ),
    ):
        own = needs_of(plan.files, PRODUCTS[name], section)["scores"]
        assert own == plan.files.scores(tests), name
        assert len(own) == len(set(tests)), name
    with pytest.raises(ConfigError, match=r"need of a.b:c: 'scors' is not accepted; accepted: scores, "):
        needs_of(plan.files, MadeBy("a.b:c", needs={"scores": "scors"}), settings.steps)
    with pytest.raises(AttributeError, match="'Steps' object has no"):  # a bug is no fault of the configuration
        needs_of(plan.files, PRODUCTS["figure_06"], settings.steps)


def behind(plan: Plan, target: str) -> set[str]:
    """Return every file that the jobs of a product and of its scores read."""
    product = next(one for one in plan.products if one.name == target)
    reads = {output: step.job.inputs for step in plan.steps for output in step.outputs}
    return {read for name in product.job.inputs for read in reads[name]}


def test_a_table_needs_the_levels_that_it_shows_alone(plans: dict[str, Plan]) -> None:
    """Table 6 shows the plant of section 5.1, Table 8 the same test on surrogate robots."""
    for plan in plans.values():
        owners = [
            {plan.files.owner_of(Path(name))[0].robot for name in behind(plan, table)}
            for table in ("table_06", "table_08")
        ]
        assert owners == [{""}, set(plan.files.robots)]


def test_a_caption_is_optional() -> None:
    assert shown("figures/figure_07.png") == Shown(
        "figures", "Figure 7: a load of 30 N on the left hand", Path("workflow/report/figures/figure_07.rst")
    )
    assert shown("results/smoke/pages/other.html") == Shown("tables", "other", None)
    assert shown("tables/table_05.csv") is None


def test_a_call_takes_what_the_signature_names() -> None:
    call = call_of("experiments.plan.plan:make_plan", {"settings": 1, "other": 2})
    assert call.arguments == {"settings": 1}
    assert parameters("experiments.plan.call:call_of") == (("function", "available"), ())
    with pytest.raises(ConfigError, match="make_plan: parameter: 'settings' is not accepted; accepted: other"):
        call_of("experiments.plan.plan:make_plan", {"other": 2})
    with pytest.raises(
        ConfigError, match=r"function of experiments\.plan\.plan: 'unmake' is not accepted; accepted: .*make_plan"
    ):
        parameters("experiments.plan.plan:unmake")


def test_a_call_runs_its_function_and_its_fingerprint_tells_arguments_apart(tmp_path: Path) -> None:
    call = Call("mobnet.core.files:write_text", {"path": tmp_path / "a.txt", "text": "a"})
    call.run()
    assert (tmp_path / "a.txt").read_text() == "a"
    assert call.fingerprint != Call(call.function, {**call.arguments, "text": "b"}).fingerprint


def test_files_are_found_behind_stems_networks_and_dataclasses() -> None:
    stem, folder, file = Path("results/recordings/a/s1"), Path("results/networks/A-LL-s0"), Path("results/a.csv")
    needs = {"a": [stem, (file, "text", 3)], "b": SweptSize("parameters", "A", (folder,))}
    assert [path.name for path in files_in(needs)] == ["s1.parquet", "a.csv", "run.json", "metrics.csv"]
