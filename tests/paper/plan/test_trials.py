"""Trials: the same effort for every method, made on their own, on development walks alone."""

from pathlib import Path
from typing import Any

import pytest
from jobs_of import arguments

from experiments.commands.words import TRIALS
from experiments.evaluation.tables.further.falls import ALL
from experiments.plan.plan import Plan, make_plan
from experiments.plan.product import Product
from experiments.plan.seeds import FIRST_TRAINING_SEED
from experiments.settings.load import load_settings
from experiments.settings.trials import Factors, compared, factors_of, sets_of, taught, trial_name, tuned
from mobnet.core.rows import read_texts

FALLS = Path(__file__).parents[3] / "docs/trials/random_torque.csv"


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(overrides={"scale": "default"}), with_pdf=False)


@pytest.fixture
def products(plan: Plan) -> dict[str, Product]:
    return {product.name: product for product in plan.trials}


def test_every_method_is_tried_as_often_as_every_other(plan: Plan) -> None:
    given = plan.settings.trials, plan.settings.methods, plan.settings.development
    trials = list(tuned(*given))
    counts = {base: sum(trial.base == base for trial in trials) for base in plan.settings.trials.tuning.grids}
    assert len(set(counts.values())) == 1, counts
    for table, rows in plan.settings.trials.compared.items():
        sizes = [len(row.methods) * len(row.recipes) * len(row.experiments) for row in rows]
        assert len(list(compared(*given, table))) == sum(sizes)


def test_names_are_distinct_and_can_be_folders(plan: Plan) -> None:
    settings, catalogue = plan.settings, plan.files.catalogue
    grids = list(tuned(settings.trials, settings.methods, settings.development))
    assert len({trial.name for trial in grids}) == len(grids)
    same = {trial.name: (trial.base, trial.changes) for trial in catalogue.trials}  # two tables may share a training
    assert all(same[trial.name] == (trial.base, trial.changes) for trial in catalogue.trials)
    assert not set(catalogue.tried) & set(catalogue.all_methods)
    assert not [name for name in catalogue.tried if Path(f"{name}-LL-s0").suffix]
    assert trial_name("A", {"loss": "beta_likelihood", "rate_first": 0.005}) == "A-beta-likelihood-0-005"


def test_a_trial_changes_what_it_says_and_its_length(plan: Plan) -> None:
    catalogue = plan.files.catalogue
    training = catalogue.training("FTS-e2e-squared-0-01", "LL")
    assert (training.learning.loss, training.learning.rate_first) == ("squared", 0.01)
    assert training.target == "external"
    assert training.learning.may_diverge
    lengths = [catalogue.training(f"MOB-Net-steps-{steps}", "LL") for steps in ("3m-adam", "10m-adam", "39m-adam-half")]
    assert [one.epochs * (one.epoch_samples or 0) for one in lengths] == [3e6, 10e6, 39e6]
    assert {(one.learning.optimizer, one.learning.coarse) for one in lengths} == {("adam", ())}
    assert catalogue.method("MOB-Kalman-300-0").options["walk_nm"] == 300.0


def test_trials_read_development_walks_and_no_test(plan: Plan, products: dict[str, Product]) -> None:
    trial = plan.settings.trials.factorial
    walks = {walk.scenario for walk in plan.settings.development.values()} | {trial.walk, trial.hits}
    walks.add(plan.settings.trials.why.twin)
    for product in (product for name, product in products.items() if name != "random_torque"):
        recorded = [Path(name) for name in product.inputs if "/recordings/" in name or "/residuals/" in name]
        assert recorded
        for path in recorded:
            robot, _, scenario, level = path.parts[-4:]
            seeds = plan.jobs.files_of(robot).seeds_of(scenario, level)
            assert scenario in walks
            assert 501 <= min(seeds) <= max(seeds) < 601


def test_no_product_of_a_run_needs_a_trial_and_none_is_stored(plan: Plan) -> None:
    made = {name for product in plan.trials for name in product.outputs}
    assert not {method for own in plan.files.owners for method, _ in own.learned} & set(plan.files.catalogue.tried)
    assert not made & {name for product in plan.products for name in (*product.inputs, *product.outputs)}


def test_tables_of_trials_are_results_of_their_scale(products: dict[str, Product]) -> None:
    """Those in docs/trials are copies, so that a fresh clone makes them anew where it is asked to."""
    for scale in ("default", "smoke"):
        trials = make_plan(load_settings(overrides={"scale": scale}), with_pdf=False).trials
        folder = f"results/{scale}/trials"
        assert {name for one in trials for name in one.outputs} == {
            f"{folder}/{name}.{ending}" for name in TRIALS for ending in ("csv", "tex", "md")
        }


def test_falls_are_counted_of_every_robot_in_walks_of_no_training_and_no_test(plan: Plan) -> None:
    """The first robot has the first seed; nothing but the largest torque differs between its walks."""
    robots = list(plan.files.whole_robots)
    counted = tuple(f"results/default/{robot}/falls.csv" for robot in robots)
    assert plan.product("random_torque").inputs == counted
    seeds: list[Any] = [arguments(plan, "falls", robot)["seed"] for robot in robots]
    assert seeds == [701, 702, 703]
    assert max(plan.files.development_seeds) < min(seeds)
    assert max(seeds) < FIRST_TRAINING_SEED


def test_cells_of_the_factorial_differ_in_their_factors_alone(plan: Plan) -> None:
    """All have one size and one length of training, and draw alike where their commands are alike."""
    settings, catalogue = plan.settings, plan.files.catalogue
    trial = settings.trials.factorial
    cells = {name: factors_of(settings.training_sets, settings.scenarios, name) for name in trial.cells}
    assert len(set(cells.values())) == len(cells) == 2**3
    assert cells[trial.same_day] == factors_of(settings.training_sets, settings.scenarios, trial.another_day)
    assert cells[trial.same_day] == Factors(random_torque=False, pushes=False, commands="random")
    sizes = [settings.training_sets[name].sizes for name in sets_of(trial)]
    assert all(size == sizes[0] for size in sizes)
    draws: dict[str, set[str]] = {}
    for name, factors in cells.items():
        own = settings.training_sets[name].scenario
        draws.setdefault(factors.commands, set()).add(settings.scenarios[own].draws or own)
    assert {len(drawn) for drawn in draws.values()} == {1}
    variants = [one for one in taught(settings.trials, settings.methods) if one.base == trial.method]
    trainings = [catalogue.training(one.name, trial.limb) for one in variants]
    assert [one.network.data for one in trainings] == list(sets_of(trial))
    assert len(trainings) == 9
    assert all(one.learning == trainings[0].learning for one in trainings)
    assert {(one.epochs, one.epoch_samples) for one in trainings} == {(5, 1_300_000)}


def test_each_robot_of_the_factorial_walks_and_learns_by_itself(plan: Plan) -> None:
    product: Any = plan.product("factorial").arguments
    robots = product["robots"]
    assert list(robots) == list(plan.settings.trials.factorial.robots)
    seen: set[Any] = set()
    for name, robot in robots.items():
        files = plan.files.robots[name]
        walked = {path.name for task in (robot.walk, robot.hits) for path in task.recordings}
        assert walked == {f"s{seed}" for seed in files.development_seeds}
        assert not walked & seen
        seen |= walked
        folders = [folder for one in robot.walk.tried for folder in one.networks.values()]
        assert {folder.parts[2] for folder in folders} == {name}
        assert len({folder.name.rpartition("-")[2] for folder in folders}) == 1
    first = next(iter(robots.values()))
    assert [one.base for one in first.walk.tried if not one.networks] == ["MOB-fric", "zero", "MOB"]
    day = plan.files.robots["robot_4"].settings.levels["robot_4_robots_another_day"].surrogate
    same = plan.files.robots["robot_4"].settings.levels["robot_4"].surrogate
    assert day is not None
    assert same is not None
    assert (day.seed, day.parts, day.day, same.day) == (same.seed, same.parts, 1, 0)


@pytest.mark.skipif(not FALLS.is_file(), reason="docs/trials has no copy of this trial")
def test_the_random_torque_on_legs_is_the_one_that_the_trial_chose(plan: Plan) -> None:
    rows = read_texts(FALLS)
    (chosen,) = {float(row["amplitude_nm"]) for row in rows if (row["robot"], row["chosen"]) == (ALL, "1")}
    assert plan.settings.random_torque.legs_waist_nm == chosen


def test_a_gray_box_is_tried_on_its_fit_and_a_filter_without_networks(products: dict[str, Product]) -> None:
    tried: Any = products["tuning"].arguments["tasks"]["plant_leg"].tried
    gray = next(one for one in tried if one.base == "MOB-Net-gray")
    kalman = next(one for one in tried if one.base == "MOB-Kalman")
    assert [path.name for path in (gray.fitted, kalman.fitted)] == ["MOB-fric-load.json"] * 2
    assert (list(gray.networks), kalman.networks) == (["LL"], {})
    assert {"mobnet.estimation.kinds.kalman", "mobnet.estimation.kinds.gray"} <= set(products["tuning"].modules)


@pytest.mark.parametrize(("name", "kept"), [
    ("learning_curve", "docs/trials/lengths.csv"),
    ("why_share", "docs/trials/why.csv"),
    ("hit_path", "docs/trials/why.csv"),
])  # fmt: skip
def test_a_figure_of_a_trial_is_drawn_where_its_data_are(
    plan: Plan, monkeypatch: Any, tmp_path: Path, name: str, kept: str
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("experiments.plan.project.ROOT", tmp_path)
    assert name not in {product.name for product in make_plan(plan.settings, with_pdf=False).products}
    (tmp_path / "docs/trials").mkdir(parents=True)
    (tmp_path / kept).touch()
    products = {product.name: product for product in make_plan(plan.settings, with_pdf=False).products}
    assert products[name].inputs == (kept,)
