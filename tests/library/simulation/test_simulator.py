"""Episodes of a scenario: what they share, what they draw, and that each begins on the ground."""

import mujoco
import numpy as np
import pytest
from scipy.stats import kstest

from mobnet.control.steps import DURATION, FOOT_HEIGHT
from mobnet.control.upper_body import UpperBody, follow
from mobnet.robot.description import SIDES
from mobnet.robot.plant import sole_name
from mobnet.simulation.simulator import STREAMS, Simulator
from mobnet.simulation.start import CLEARANCE_M
from mobnet.simulation.world import ground_height

TERRAINS = ["checks", "plates", "slope", "flat"]
LEVEL = "all_uncertainty"
PUSH = {"point": "torso", "at_s": [0.0], "force_n": [40.0, 60.0], "duration_s": [0.1, 0.3], "direction": "any"}
P_VALUE = 1e-3


@pytest.fixture
def prepare(walk_of):
    """A function (name, level, seed, upper, sections, **row) -> a random walk over all terrains, changed by the row."""

    def make(name, level=LEVEL, seed=7, upper=None, sections=None, **row):
        alone = {"terrain": TERRAINS, "commands": "random", "random_torque": False}
        settings = walk_of(name, level, scenarios={"alone": alone, name: {**alone, **row}}, **(sections or {}))
        return Simulator(settings, seed, upper)

    return make


def streams(simulator):
    return {name: rng.bit_generator.state["state"] for name, rng in simulator.rng.items()}


def begun(simulator):
    simulator.start()
    return simulator.setting.terrain, simulator.commands.tobytes(), simulator.plant.qpos.tobytes()


@pytest.mark.parametrize("change", [{"pushes": ["shove"]}, {"random_torque": True}])
def test_scenarios_that_draw_the_same_differ_in_pushes(prepare, run, change):
    """Terrain, place, commands and noise are the same, to the bit until the first push or random torque."""
    pushes = {"pushes": {"shove": {**PUSH, "shape": "half_sine"}}}
    alone, disturbed = prepare("alone"), prepare("disturbed", sections=pushes, draws="alone", **change)
    for _ in range(4):
        assert begun(alone) == begun(disturbed)
    until = 2.0 if "pushes" in change else 0.0  # s after an episode's start
    if until:
        np.testing.assert_array_equal(run(alone, until).rows, run(disturbed, until).rows)
    quiet, moved = run(alone, 0.3), run(disturbed, 0.3)
    assert np.abs(quiet["q"] - moved["q"]).max() > 1e-4
    ours, theirs = streams(alone), streams(disturbed)
    theirs |= {name: ours[name] for name in ("torque", "pushes")}
    assert theirs == ours


def test_other_scenarios_and_other_seeds_draw_otherwise(prepare):
    first = begun(prepare("alone"))
    for simulator in (prepare("another"), prepare("alone", seed=8)):
        other = begun(simulator)
        assert (other[1] != first[1], other[2] != first[2]) == (True, True)


def test_streams_of_random_numbers_are_independent_of_each_other(prepare):
    simulator = prepare("alone")
    assert set(simulator.rng) == set(STREAMS)
    draws = np.array([rng.standard_normal(2000) for rng in simulator.rng.values()])
    assert np.abs(np.corrcoef(draws) - np.eye(len(STREAMS))).max() < 0.1


@pytest.mark.parametrize("seed", [1000, 1001])
def test_kinds_of_episodes_take_turns_in_an_order_that_the_seed_decides(prepare, seed):
    kinds = ["stand", "random"]
    simulator = prepare("both", seed=seed, terrain=["flat"], commands=kinds)
    seen = []
    for _ in range(5):
        simulator.start()
        seen.append("stand" if simulator.state.standing else "random")
    assert seen == [kinds[(seed + episode) % 2] for episode in range(5)]


def test_narrowed_commands_replace_their_range_alone(prepare):
    ranges = {"duration_s": [0.7], "foot_height_m": [0.055]}
    wide, narrow = prepare("wide", terrain=["flat"]), prepare("narrow", terrain=["flat"], narrowed=ranges)
    wide.start()
    narrow.start()
    assert set(narrow.commands[:, DURATION]) == {0.7}
    assert set(narrow.commands[:, FOOT_HEIGHT]) == {0.055}
    for column in range(DURATION):
        assert narrow.commands[:, column].min() == pytest.approx(wide.commands[:, column].min())
        assert narrow.commands[:, column].max() == pytest.approx(wide.commands[:, column].max())


def test_episodes_begin_anywhere_on_any_terrain_facing_anywhere(prepare):
    """Yaw and place are uniform; a terrain is drawn anew each time and comes once a round after the first episode."""
    simulator = prepare("walk", terrain=["flat", "checks"], sections={"recording": {"episode_steps": 10}})
    yaws, places, settings = [], [], []
    for _ in range(80):
        simulator.start()
        yaws.append(simulator.state.yaw / np.pi)
        places.append(simulator.plant.qpos[:2] / simulator.world.period)
        settings.append(simulator.setting)
    assert kstest(yaws, "uniform", args=(-1, 2)).pvalue > P_VALUE
    names = [setting.terrain for setting in settings[1:-1]]
    assert all({"flat", "checks"} == set(names[i : i + 2]) for i in range(0, len(names), 2))
    assert len({tuple(names[i : i + 2]) for i in range(0, len(names), 2)}) == 2
    fields = [setting.world.terrain for setting in settings if setting.terrain == "checks"]
    assert len({(len(field.pieces), field.pieces[0].height) for field in fields}) == len(fields)
    assert (np.ptp(places, axis=0) > 0.9).all()


def test_walks_of_one_episode_come_to_every_terrain_equally_often(prepare):
    simulators = [prepare("walk", seed=seed) for seed in range(241, 241 + len(TERRAINS))]
    for simulator in simulators:
        simulator.start()
    assert sorted(simulator.setting.terrain for simulator in simulators) == sorted(TERRAINS)


def soles_over_ground(simulator):
    """Return the least height of each sole over the ground under it [m], looked at every centimetre."""
    model, data, heights = simulator.world.model, simulator.world.data, []
    mujoco.mj_forward(model, data)
    for side in SIDES:
        sole = model.geom(sole_name(side)).id
        half = model.geom_size[sole]
        x, y = (np.linspace(-h, h, round(2 * h / 0.01) + 1) for h in half[:2])
        grid = np.array([(a, b, -half[2]) for a in x for b in y])
        points = data.geom_xpos[sole] + grid @ data.geom_xmat[sole].reshape(3, 3).T
        heights.append((points[:, 2] - ground_height(simulator.world, points[:, :2])).min())
    return heights


@pytest.mark.sim
@pytest.mark.parametrize("commands", ["stand", "random"])
@pytest.mark.parametrize("terrain", TERRAINS)
def test_start_stands_on_the_ground_anywhere(prepare, run, terrain, commands):
    """Just over the highest point under a sole, in no solid; the feet soon carry the weight, after a bump at most."""
    simulator = prepare("begin", "ideal", 3, terrain=[terrain], commands=commands)
    weight = simulator.robot.mass * simulator.walker.gravity
    for _ in range(8):
        simulator.start()
        over = soles_over_ground(simulator)
        assert min(over) == pytest.approx(CLEARANCE_M, abs=2e-4)
        assert max(over) < 0.015
        assert simulator.world.data.ncon == 0
        log = run(simulator, 0.4)
        assert log.done == 400
        force = log["wrench_left_foot"][:, 2] + log["wrench_right_foot"][:, 2]
        assert force.max() < 6 * weight
        assert force[200:].mean() == pytest.approx(weight, rel=0.15)
        assert log["contact"][50:].any(axis=1).all()


@pytest.fixture
def motion():
    """Twenty seconds of small sines of the 21 joints above the legs about zero, 50 knots a second."""
    time, joint = np.arange(1000)[:, None] / 50.0, np.arange(21)
    return UpperBody(0.05 * np.sin((1.0 + 0.1 * joint) * time + joint), 50.0, np.zeros(1))


@pytest.mark.parametrize("motion_s", [0.0, 3.0, 7.25])
def test_motion_meets_the_first_kept_sample(prepare, run, motion, motion_s):
    """The episode begins the time to settle earlier, with the joints where the motion is then."""
    simulator = prepare("move", "ideal", 1, motion, terrain=["flat"], commands="stand")
    simulator.start(motion_s)
    settle, upper = simulator.settings.recording.settle_s, simulator.walker.upper
    q, v = np.zeros(21), np.zeros(21)
    follow(motion._replace(start=np.zeros(1)), motion_s - settle, q, v)
    np.testing.assert_allclose(simulator.plant.qpos[7 + upper :], q, atol=1e-12)
    np.testing.assert_allclose(simulator.plant.qvel[6 + upper :], v, atol=1e-12)
    run(simulator, settle)
    follow(motion._replace(start=np.zeros(1)), motion_s, q, v)
    np.testing.assert_allclose(simulator.walker.posture, q, atol=1e-4)
    np.testing.assert_allclose(simulator.plant.qpos[7 + upper :], q, atol=0.02)


def test_motors_can_move_what_friction_holds_and_keep_the_table_s_limit(simulate):
    simulator = simulate("flat_place", "all_uncertainty")
    plant, table, limits = simulator.settings.plant, simulator.robot.torque_limits, simulator.plant.limits
    least = plant.motor_limit_min_nm
    assert (limits >= least).all()
    assert least > plant.friction.coulomb_nm + plant.friction.loss_others_nm
    np.testing.assert_array_equal(limits[table >= least], table[table >= least])


def test_nothing_of_an_episode_is_left_in_the_next(prepare, run):
    pushes = {"shove": {**PUSH, "duration_s": [90.0, 90.0], "shape": "step"}}
    simulator = prepare("pushed", "ideal", 1, sections={"pushes": pushes}, terrain=["flat"], pushes=["shove"])
    simulator.start()
    run(simulator, 2.2)
    assert np.abs(simulator.plant.xfrc_applied).max() > 20
    simulator.start()
    for left in (simulator.plant.xfrc_applied, simulator.sensors.wrenches, simulator.state.integral):
        np.testing.assert_array_equal(left, 0)
    assert simulator.pushes.state["active"].tolist() == [0]
    assert simulator.state.clock == -simulator.settings.recording.settle_s


def taken_apart(simulator, row):
    """Simulate a sample with arguments that are taken apart for it alone."""
    simulator._held = None
    simulator.run(row)


def test_samples_one_by_one_are_to_the_bit_those_of_a_stretch(prepare):
    """In a loop with an estimator each sample is a call, whose arguments were taken apart at the first one."""
    simulators = [prepare("walk", "robot_1", random_torque=True) for _ in range(3)]
    rows = [np.zeros((1000, simulator.width), np.float32) for simulator in simulators]
    for episode in range(2):
        for simulator in simulators:
            simulator.start()
        stretch, singles, anew = simulators
        stretch.run(rows[0])
        for k in range(1000):
            singles.run(rows[1][k : k + 1])
        for k in range(100):
            taken_apart(anew, rows[2][k : k + 1])
        anew.run(rows[2][100:])
        assert np.abs(rows[0]).max() > 0.0
        for other in rows[1:]:
            np.testing.assert_array_equal(other, rows[0], err_msg=f"episode {episode}")


def test_parts_that_are_replaced_are_those_that_run(simulate):
    """Arguments are held while they are the same objects."""
    simulator = simulate("flat_walk", "ideal")
    simulator.run(np.zeros((10, simulator.width), np.float32))
    simulator.plant = simulator.plant._replace(every=1)
    simulator.state = simulator.state.copy()
    before = simulator.state.clock
    simulator.run(np.zeros((10, simulator.width), np.float32))
    assert simulator.state.clock - before == pytest.approx(10 * simulator.plant.dt)
