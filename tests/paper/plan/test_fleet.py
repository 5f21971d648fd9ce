"""A test at the level of the fleet is walked by each of its robots, with networks of that robot's own recordings."""

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from jobs_of import arguments, network, reads

from experiments.plan.plan import Plan, make_plan, with_precision
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError

ROBOTS = ("robot_1", "robot_2", "robot_3")
RESULTS = Path("results/smoke")


@pytest.fixture(scope="module")
def plan() -> Plan:
    """The plan of the smoke scale with all robots."""
    settings = load_settings(
        overrides={"scale": "smoke", "scales": {"smoke": {"fleet": len(ROBOTS), "fleet_whole": len(ROBOTS)}}}
    )
    return make_plan(with_precision(settings, "float32"), with_pdf=False)


def folders(paths: Sequence[Path]) -> set[str]:
    """Return the first folders of paths below the results."""
    return {path.relative_to(RESULTS).parts[0] for path in paths}


def test_each_robot_is_a_run_and_has_one_seed(plan: Plan) -> None:
    """Of a method without networks too, so that an interval is over robots."""
    for method in ("MOB", "MOB-Net"):
        runs = plan.files.runs("walk_test", "robots", [method])
        assert [run.network_seed for run in runs] == [101, 102, 103]
        assert [run.recording.relative_to(RESULTS).parts[:-1] for run in runs] == [
            (robot, "recordings", "walk_test", robot) for robot in ROBOTS
        ]
        assert {run.level for run in runs} == {"robots"}


def test_a_variant_is_another_plant_for_the_same_networks(plan: Plan) -> None:
    """The next robot in the place of one, or joints that rub by (23)."""
    runs = plan.files.runs("changed_walk", "robots_other", ["MOB-Net"])
    assert [run.recording.parts[-2] for run in runs] == [f"{robot}_robots_other" for robot in ROBOTS]

    def level(robot: str, name: str) -> Any:
        return arguments(plan, "collect", robot, scenario="changed_walk", level=f"{robot}_{name}")["settings"].level

    assert [level(robot, "robots_other").surrogate.seed for robot in ROBOTS] == [2, 3, 4]
    law = level("robot_1", "robots_law")
    assert (law.surrogate.parts, law.friction) == (("body", "sensors"), ("stribeck", "load", "loss"))
    body = level("robot_1", "robots_body")  # without drives and without friction
    assert (body.surrogate.parts, body.friction) == (("body",), ())
    same, other = (plan.files.robots["robot_1"].networks("MOB-Net", 101, "changed_walk", name)
                   for name in ("robot_1", "robot_1_robots_other"))  # fmt: skip
    assert same == other


def test_a_variant_may_walk_otherwise_or_carry_more(plan: Plan) -> None:
    """In training as in tests: its gait replaces the scenario's, its gains are a share of all robots'."""
    for scenario in ("changed_walk", "robot_walk"):
        own, gains, gait, payload = (
            arguments(plan, "collect", "robot_2", scenario=scenario, level=f"robot_2{name}")["settings"]
            for name in ("", "_robots_gains", "_robots_gait", "_robots_payload")
        )
        soft, stiff = gains.walking.leg_stiffness_nm_rad, own.walking.leg_stiffness_nm_rad
        assert soft == pytest.approx([0.8 * one for one in stiff])
        assert gait.scenario.narrowed.duration_s == (1.0,)
        assert (
            gait.model_copy(update={"scenario": own.scenario, "level_name": own.level_name, "level": own.level}) == own
        )
        assert (own.level.surrogate.payload_kg, payload.level.surrogate.payload_kg) == (0.0, 5.0)


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_learns_from_its_own_recordings(plan: Plan, robot: str) -> None:
    """Networks and fits; what it walks on is that of the set which takes the place of the one that a network names."""
    training = reads(plan, "train", robot, **network(f"MOB-Net-LL-s{101 + ROBOTS.index(robot)}"))
    for read in (training, reads(plan, "fit", robot, method="MOB-fric")):
        sets = [Path(name) for name in read if "/state/" not in name]
        assert folders(sets) == {robot}
    assert all("/robot_walk/" in name for name in training if "/state/" not in name)


def test_a_level_of_one_robot_is_walked_by_it_alone(plan: Plan) -> None:
    """Its methods are those of all robots and its own."""
    runs = plan.files.runs("motion_test", "robot_1", ["MOB-Net", "MOB-Net-Single"])
    assert {(run.level, run.network_seed, run.recording.parts[2]) for run in runs} == {("robot_1", 101, "robot_1")}
    assert {run.estimate for run in runs} >= {plan.files.runs("motion_test", "robots", ["MOB-Net"])[0].estimate}
    trained = [{method for method, _ in plan.files.robots[robot].learned} for robot in ROBOTS]
    assert ["GRU-windows" in methods for methods in trained] == [True, False, False]
    read = reads(plan, "train", "robot_1", **network("MOB-Net-plain-LL-s101"))
    assert {Path(name).parts[2] for name in read} == {"robot_1"}
    assert {path.parts[2] for path in plan.files.training("recordings", "robot_walk_plain")} == set(ROBOTS)


def test_a_fine_tuning_begins_with_the_robot_s_own_network_and_learns_from_the_changed_one(plan: Plan) -> None:
    def given(method: str) -> Any:
        return arguments(plan, "train", "robot_2", **network(f"{method}-LL-s102"))

    def learned_from(method: str) -> Any:
        return plan.jobs.learned_from(SimpleNamespace(robot="robot_2", **network(f"{method}-LL-s102")))

    tuned = given("MOB-Net-other-swing-data-s-10")
    read = learned_from("MOB-Net-other-swing-data-s-10")
    assert read["start"] == RESULTS / "robot_2/networks/MOB-Net-LL-s102/weights.safetensors"
    assert read["recordings"] == (RESULTS / "robot_2/recordings/robot_walk/robot_2_robots_other/s1000",)
    swings = plan.settings.evaluation.changed
    assert tuned["margins"] == (swings.lift_off_s, swings.landing_s)
    learning = tuned["training"].learning
    assert (learning.data_s, learning.labels) == (10, "swing")
    assert "margins" not in given("MOB-Net-other-data-s-10")
    assert "start" not in learned_from("MOB-Net")


def test_names_of_networks_differ_and_motions_are_shared(plan: Plan) -> None:
    networks = plan.files.all_networks()
    assert len({folder.name for folder in networks}) == len(networks)
    assert {folder.relative_to(RESULTS).parts[0] for folder in networks} == {"plant", *ROBOTS}
    motions = {path for own in plan.files.robots.values() for path in own.motion("random_motion", 1000)}
    assert motions == set(plan.files.motion("random_motion", 1000))


def test_every_run_of_a_test_is_scored(plan: Plan) -> None:
    """A file of scores has all robots of a level."""
    read = reads(plan, "score", scenario="walk_test", level="robots")
    assert folders([Path(name) for name in read]) == set(ROBOTS)


def test_a_scale_may_have_fewer_robots() -> None:
    """Of variants the smoke scale walks the first one alone; the next one still takes its place."""
    files = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False).files
    assert list(files.whole_robots) == ["robot_1"]
    assert [run.recording.parts[-2] for run in files.runs("changed_walk", "robots_other", ["MOB"])] == [
        "robot_1_robots_other"
    ]


def test_a_robot_of_a_leg_walks_the_tests_of_a_leg_alone() -> None:
    """With the named methods; networks and fits are those of this leg, from its own walks."""
    files = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False).files
    fleet = files.settings.fleet
    own = files.robots["robot_2"]
    assert not own.is_whole
    assert {(scenario, level) for scenario, level, _ in own.recorded()} == {
        ("robot_walk", "robot_2"),
        *((scenario, "robot_2") for scenario in fleet.leg_tests),
    }
    trained = {(name.method, name.limb) for name in own.own_networks}
    learned = [name for name in fleet.leg_methods if files.settings.methods[name].limbs]
    assert trained == {(method, fleet.leg) for method in learned}
    assert set(own.catalogue.tests["walk_test"]["robot_2"]) <= {*fleet.leg_methods}
    assert own.catalogue.method("MOB-fric").fitted == (fleet.leg,)
    seeds = {run.network_seed for run in files.runs("walk_test", "robots", ["MOB-Net"])}
    assert seeds == {101, 102}
    assert {run.network_seed for run in files.runs("walk_test", "robots", ["MOB-Net-gray"])} == {101}
    assert {run.network_seed for run in files.runs("motion_test", "robots", ["MOB-Net"])} == {101}


def test_each_robot_walks_seeds_of_its_own() -> None:
    files = make_plan(load_settings(), with_pdf=False).files
    walked = [seed for own in files.owners for seed in own.test_seeds]
    assert len(walked) == len(set(walked))
    assert files.robots["robot_2"].duration_s(["walk_test"], files.robots["robot_2"].test_seeds[0]) == 30.0


def test_a_method_may_run_networks_of_another_one() -> None:
    """The legs of the pushed MOB-Net are its own; all other networks are those of MOB-Net, which are trained once."""
    own = make_plan(load_settings(), with_pdf=False).files.robots["robot_1"]
    seed = own.network_seeds("MOB-Net-pushed")[0]
    assert own.network("MOB-Net-pushed", "LL", seed).name == f"MOB-Net-pushed-LL-s{seed}"
    assert own.network("MOB-Net-pushed", "RA", seed).name == f"MOB-Net-RA-s{seed}"
    trained = {(name.method, name.limb) for name in own.own_networks}
    assert ("MOB-Net", "RA") in trained
    assert ("MOB-Net-pushed", "RA") not in trained


def test_products_can_show_the_fleet(plan: Plan) -> None:
    """A figure of one recording shows the first robot; networks shown by themselves are those of every robot."""
    trained = plan.files.network_folders(["GRU-adam"], "LL", "robots")
    assert {folder.relative_to(RESULTS).parts[0] for folder in trained} == {*ROBOTS}
    shown = next(product for product in plan.products if product.name == "figure_17")
    assert folders([Path(name) for name in shown.inputs]) == set(ROBOTS)


@pytest.mark.parametrize(("sections", "text"), [
    ({"fleet": {"robots": ["ideal"]}}, "level of a surrogate robot: 'ideal' is not accepted"),
    ({"fleet": {"sets": {"walk": "walk"}}}, "sets.walk: walk is not accepted; accepted: a set at one of the levels"),
    ({"fleet": {"variants": {"robot_1": {"other": True}}}}, "fleet.variants.robot_1: robot_1 is not accepted"),
    ({"fleet": {"variants": {"odd": {"friction": ["load"], "parts": ["drives"]}}}}, "odd.friction: ['load'] is not"),
    (
        {"fleet": {"variants": {"robots_late": {"numbers": {"sensors": {"imu_late": [0.0, 0.1]}}}}}},
        "fleet.variants.robots_late.numbers.sensors.imu_late",
    ),
    ({"levels": {"robot_1": {"friction": ["load"]}}}, "levels.robot_1.friction: ['load'] is not accepted"),
    ({"surrogate": {"limbs": {"N": {"coulomb_nm": [1.0]}}}}, "1 numbers is not accepted; accepted: 2"),
    ({"training_sets": {"walk": {"level": "robots"}}}, "training_sets.walk.level: robots is not accepted"),
    (
        {"development": {"plant_leg": {"level": "robots"}}},
        "development.plant_leg.level: level of one plant: 'robots' is not accepted",
    ),
])  # fmt: skip
def test_what_does_not_fit_is_told(sections: dict[str, Any], text: str) -> None:
    with pytest.raises(ConfigError) as told:
        load_settings(overrides=sections)
    assert text in str(told.value)
