"""Values that a type accepts and that mean nothing: ranges, rates, names and lists that do not fit each other."""

import re
import resource
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from experiments.settings.load import load_settings
from mobnet.settings.lab import CONFIGS

from .mutations import FILES, LONGEST_S, VALUES, Load, dumped, refusal

ROOT = Path(__file__).parents[2]
PARTS = {section: name for name, values in VALUES.items() for section in values if FILES[name].parent == CONFIGS}
OWN = ("robot", "published", "claims")  # files of one section
MEANINGLESS: list[tuple[str, Any, str]] = [
    # rates, plant and levels
    ("rates.plant_hz", 2001.0, "a whole multiple of data_hz"),
    ("rates.plant_hz", 500.0, "a whole multiple"),
    ("rates.data_hz", 1500.0, "a whole multiple"),
    ("rates.data_hz", 1.0e9, "a number from 50"),
    ("observer.gain_hz", 600.0, "at most 500, half of data_hz"),
    ("plant.gravity_m_s2", -9.81, "a number from 1"),
    ("plant.gravity_m_s2", 9810.0, "to 30"),
    ("plant.loss_time_constant_s", 0.0005, "at least 0.001, two steps"),
    ("plant.solver_iterations", 8.0, "a whole number"),
    ("levels.all_uncertainty.friction", ["load"] * 2, "each value o"),
    ("levels.ideal.nominal_mass_ratio", 900.0, "to 3"),
    ("plant.noise.joint_velocity_rad_s", 2.0, "to 1"),
    # how walks are recorded
    ("recording.clearance_hz", 60.0, "data_hz, 1000.0, divided by a whole number"),
    ("recording.chunk_s", 0.0015, "a whole number of samples"),
    ("recording.chunk_s", 100.0, "to 10"),
    ("recording.episode_s", 0.5, "below 0.5, episode_s"),
    ("recording.fall_height_m", 0.95, "below 0.9.*, walking.pelvis"),
    ("recording.episode_steps", 100, "the steps of an episode"),
    ("recording.settle_s", 2000.0, "to 60"),
    # the walking controller
    ("walking.foot_spacing_m", 0.5, "foothold_y_m"),
    ("walking.pelvis_height_m", 1.2, "of stretched legs"),
    ("walking.leg_reach_m", 0.7, "of stretched legs"),
    ("walking.step_min_s", 0.7, "at most 0.6"),
    ("walking.swing_apex", 0.9, "at most 0.8"),
    ("walking.sole_x_m", [0.15, -0.09], "the lower one first"),
    ("walking.sole_x_m.1", 0.25, "the robot's sole"),
    ("walking.sole_y_m", 0.2, "half the robot's sole"),
    ("walking.leg_stiffness_nm_rad", [2000.0] * 5, "6, one for"),
    ("walking.joint_speed_max_rad_s", 40.0, "velocity limit"),
    ("walking.foothold_y_m.0", 0.1, "width of the robot's"),
    ("walking.touch_force_n", 900.0, "half the weight"),
    ("walking.dcm_gain", 2500.0, "to 20"),
    ("walking.pelvis_sink_max_m", 1.0, "to 0.3"),
    ("walking.stand_shift_m", [0.8, 0.4], "half the robot's sole"),
    # the robot, printed numbers and claims
    ("robot.name", "../tocabi", "robot.*name"),
    ("robot.joints.0.id", "LL2", "'id LL2' 2 times"),
    ("robot.hands.left", "R_Wrist2_Link", "limb of the left side"),
    ("claims.real-time.at.column", "worth", "column: 'worth' is not"),
    # what is developed, tried and shown
    ("methods.MOB-fric.fitted", ["V"], "joints that have motors"),
    ("development.plant_leg.scenario", "walk_test", "scenario apart from tests"),
    ("trials.compared.lengths.0.methods", ["MOB"], "method with networks"),
    ("trials.tuning.references", ["MOB-Net"], "method without networks"),
    ("evaluation.tables.table_05.columns.1.joints", ["LL", "LL1"], "each joint once"),
    ("evaluation.noise.paper.table_05", "nothing", "place of a row"),
    ("evaluation.figure_08.methods", ["MOB"], "method with networks"),
    ("evaluation.fine_tuning.joint", "LX", "joint: 'LX' is not"),
    ("evaluation.fine_tuning.sweep", "hides", "sweep: 'hides' is not"),
    ("methods.MOB-Net-plain.learning", {"labels": "swing"}, "a method with `start`"),
    ("methods.MOB-Net-other.start", "FTS-e2e", "the same target"),
    ("methods.MOB-Net-other.start", "MOB-Net-Single", "a method that trains LL"),
    ("methods.MOB-Net-other.network.hidden", 151, "the same GRU for LL"),
    ("evaluation.learning_curve.data", "/etc/passwd", "docs/trials"),
    ("evaluation.drift.steps", 9, "the steps that begin in the longest push"),
    ("evaluation.latency.method", "MOB", "method with networks"),
    # terrains and commands
    ("terrain.checks.bevel_m", 0.2, "half of cell_m"),
    ("terrain.plates.gap_m", 1.7, "a plate of 0.9 m"),
    ("terrain.plates.period_m", 1.0, "its square above"),
    ("terrain.checks.height_m.1", 0.05, "lowest foot_height_m"),
    ("terrain.checks.height_m", [0.02, 0.01], "the lower one first"),
    ("training_sets.motion.sizes.default.held_out", 24, "below 24"),
    ("terrain.slope.angle_deg", 60.0, "to 30"),
    ("commands.step_x_m", [0.05, 0.2], "a range that contains 0"),
    ("commands.step_x_m.1", 0.6, "where a foot may stand"),
    ("commands.duration_s", [0.9, 0.6], "numbers that rise"),
    ("commands.random.kinds.forward", 0.5, "the sum 1"),
    ("commands.random.hold_steps", [12, 3], "the lower one first"),
    ("scenarios.forward_walk.commands.step_x_m", 0.3, "-0.15 to 0.2"),
    ("commands.turn_deg.1", 2000.0, "to 90"),
    ("scenarios.walk_test.narrowed.duration_s", [1.2], "0.6 to 0.9"),
    # random torques and motions
    ("random_torque.arms_nm", [3.0] * 7, "8, one for each joint of LA"),
    ("random_torque.neck_nm", 20.0, "at most 10, the least"),
    ("random_torque.period_s", [0.5, 0.1], "the lower one first"),
    ("random_torque.legs_waist_nm", 400.0, "at most 166"),
    ("motions.random_motion.waist_rad", [[-0.1, 0.1]] * 2, "3, one for each joint of W"),
    ("motions.random_motion.arm_rad.0", [-3.0, 0.9], "within -2.09 to 1.54"),
    ("motions.random_motion.gain", 0.0, "above"),
    ("motions.random_motion.arm_rad.0", [0.5, 0.9], "its posture 0.3 inside"),
    ("motions.random_motion.band_hz.1", 30.0, "to 20"),
    ("motions.random_motion.clearance_least_m", 0.1, "at most .*, clearance_m"),
    ("motions.random_motion.knot_hz", 5000.0, "to 1000"),
    ("motions.random_motion.leg_poses_rad.0.3", 12.0, "range of LL4"),
    # pushes and scenarios
    ("pushes.torso.share", [0.3, 0.7], "`during` a swing or a support only"),
    ("pushes.left_foot.share", [0.3, 70.0], "to 1"),
    ("pushes.hip_pitch.at_s", [5.0, 5.05], "the end of the push before"),
    ("pushes.hip_pitch.at_s.4", 65.0, "at most 29.9"),
    ("pushes.torso.at_s", [1.0], "`pause_s` or `at_s`"),
    ("pushes.torso.force_n", [60.0, 10.0], "the lower one first"),
    ("pushes.left_hand_10.force_n", [-10.0, -10.0], "from 0"),
    ("pushes.hip_pitch.moment_nm", [1.0, 2.0], "beside a force only"),
    ("pushes.hip_pitch.direction", "any", "`joint` and `torq"),
    ("scenarios.stand.pushes", ["left_foot"], "where nobody walks"),
    ("scenarios.hand_load_10.terrain", ["flat"], "the same"),
    ("scenarios.random_walk.draws", "random_walk_plain", "scenario: "),
    ("scenarios.forward_walk.narrowed", {"duration_s": [0.7]}, "`uniform` only"),
    ("scenarios.random_walk.terrain", ["flat", "flat"], "each value once"),
    # sets, scales and sizes
    ("training_sets.walk_plain.scenario", "random_walk", "what set walk does not record"),
    ("training_sets.walk.sizes.smoke.shards", 1_000_000_000, "to 500"),
    ("scales.default.test.shards", 101, "to 100"),
    ("scales.default.test.first_seed", 401, "to 400"),
    ("scales.default.experiments.left_leg.seeds", list(range(100)), "recordings, residuals, networks and estimates"),
    ("scales.default.test.shard_s", 10.0005, "a whole number of samples"),
    ("scales.default.test.shard_s", 10.0, "at most"),
    ("scales.smoke.figure_start_s", 9.0, "gait cycles before the end"),
    ("scales.smoke.batch_size", 4000, "the horizons"),
    ("scales.smoke.stream_s", 0.01, "from 0.05"),
    ("scales.smoke.stream_s", 60.0, "shard_s"),
    ("scales.default.experiments.kinds.epoch_samples", 100, "a batch"),
    ("scales.paper.experiments.sweep.seeds", [1, 1], "each value once"),
    ("scales.paper.experiments.sweep.seeds", [101], "below 101, the seeds of robots"),
    ("scales.default.robots.printed.seeds", [101], "below 101, the seeds of robots"),
    ("scales.default.robots.magic", {"epochs": 1}, "experiment: 'magic' is not accepted; accepted: .*printed"),
    (
        "scales.paper.reactions.cases.wall",
        {"runs": 1, "compared": 1, "longest_s": 9.0},
        "case: 'wall' is not acc.*door",
    ),
    ("scales.default.experiments.left_leg.epochs", 18_000, "to 1000"),
    # networks, learning, methods and sweeps
    ("networks.LL.hidden", 150.0, "a whole number"),
    ("networks.LL.window_steps", 50, "hidden of a cell GRU"),
    ("networks.LL.horizon_steps", 100_000, "to 10000"),
    ("methods.TCN.network.dilations", [], "a list of 1 or more|dilations"),
    ("methods.TCN.network.dilations", [2, 4, 80], "below window_steps"),
    ("methods.TCN.network.window_steps", 500, "at most .*, horizon_steps"),
    ("methods.TCN.network.kernel_steps", 300, "kernel_steps: 300"),
    ("methods.GRU-spectral.network.spectral", False, "input_gain"),
    ("learning.optimizer_betas", [0.999, 0.9], "the lower one first"),
    ("learning.coarse", [{"stride": 2, "share": 0.2}, {"stride": 4, "share": 0.2}], "each smaller than the one before"),
    ("learning.coarse", [{"stride": 4, "share": 0.6}, {"stride": 2, "share": 0.4}], "shares of 1 in sum"),
    ("learning.optimizer", "sgd", "'adam', 'soap'"),
    ("methods.MOB-Net-other.learning.coarse", [{"stride": 2, "share": 0.2}], r"\[\] of a method with `start`"),
    ("trials.compared.lengths.0.recipes", ["magic"], "recipe: 'magic' is not accepted; accepted: adam"),
    ("trials.compared.lengths.0.task", "tail", "task of development: 'tail' is not accepted; accepted: plant_leg"),
    ("learning.optimizer_betas", [0.9, 1.0], "below 1"),
    ("learning.calibration_levels", [0.95, 0.9, 0.68], "numbers that rise"),
    ("learning.calibration_share", 0.7, "one of"),
    ("learning.validation_share", 0.9, "to 0.5"),
    ("learning.rate_first", 5.0, "to 1"),
    ("methods.MOB-Net.limbs", ["LL", "WB"], "without joints of LL"),
    ("methods.MOB-Net.target", "external", "uncertainty"),
    ("methods.FTS-e2e.target", "uncertainty", "external"),
    ("methods.MOB.network", {"hidden": 3}, "with `limbs`"),
    ("methods.MOB-fric.options.terms", ["coulomb"] * 2, "each value once"),
    ("methods.MOB-fric-BPF.of", "MOB-fric-BPF", "method that runs on its own"),
    ("methods.MOB-fric-BPF.options.band_hz", [2.0, 600.0], "below half of data_hz"),
    ("methods.mob", {"kind": "residual"}, "capitals"),
    ("methods.MOB-Net-hidden-44", {"kind": "residual"}, "sweep hidden does not give"),
    ("methods.a/b", {"kind": "residual"}, "key 'a/b'"),
    ("levels.all_*", VALUES["plant"]["levels"]["ideal"], "key 'all_"),
    ("walking.dcm_gain", 0.25, "a number above 1"),
    ("networks.LL.hidden", 151, "values with 151, that of Table 1"),
    ("sweeps.hidden.limb", "RL", "method that trains RL: 'FTS-e2e'"),
    ("sweeps.data_parts.section", "network", "sweeps.data_parts: key: 'data_parts'"),
    # what tables, figures and claims show
    ("evaluation.explore.scenes.hip_step.joint", "LL4", "a joint of LL that its push turns"),
    ("evaluation.explore.scenes.hand_robot.methods", ["MOB"], "methods with MOB-Net, that of the gate"),
    ("evaluation.figure_07.end_s", 31.0, "at most 30, for hand_load_30 lasts 30.0 s"),
    ("scales.default.durations_s.leg_sines", 50.5, "at most 0.5, for leg_sines lasts 50.5 s"),
    ("evaluation.figure_05.start_s", 28.0, "at most"),
    ("evaluation.figure_06.joint", "LL4", "joint pushed in hip_pitch_step"),
    ("evaluation.figure_08.methods", ["MOB-Net", "FTS-e2e"], "a list of 1"),
    ("evaluation.figure_08.limb", "LA", "leg: 'LA'"),
    ("evaluation.figure_07.place", "nowhere", "place of a row: 'nowhere'"),
    ("evaluation.figure_09.table", "table_05", "place of a row: 'rmse_nm'"),
    ("evaluation.figure_09.drawn", ["RA2"], "joint of a leg: 'RA2'"),
    ("evaluation.figure_17.limb", "RL", "that trains RL"),
    ("evaluation.figure_17.best", ["GRU"], "6, one for each of `methods`"),
    ("evaluation.figure_17.best.0", "MOB-Net", "a method with the network of GRU-adam"),
    ("evaluation.figure_17.best.0", "GRU-adam", "a method apart from `methods`"),
    ("evaluation.table_01.method", "MOB", "a row of Table 1"),
    ("evaluation.figure_20.samples", "hidden", "section learning"),
    ("evaluation.tables.table_05.rows.2.further", ["MOB"], "methods that are not among"),
    ("evaluation.tables.table_06.rows.2.further", ["FTS-e2e"], "methods that estimate W1 in motion_test, all_unc"),
    ("evaluation.peaks.tests.0.scenario", "walk_test", "scenario with pushes"),
    ("evaluation.peaks.tests.0.limbs", ["W"], "methods that estimate W1"),
    ("evaluation.bode.limb", "LA", "leg: 'LA'"),
    ("evaluation.bode.bands_hz", [1.0, 2.0], "one for each line on LL1"),
    ("evaluation.bode.scenario", "foot_hold", "a test with sines on joints of LL"),
    ("evaluation.bode.shown", ["LL3", "RL3"], "joint with sines"),
    ("pushes.sines_ll4.joint", "LL3", "sines, each on its own joint"),
    ("evaluation.figure_10.against.scenario", "knee_swing", "scenario without pushes"),
    ("evaluation.sigma.lags_ms", [10, 5000], "at most longest_s"),
    ("evaluation.hourly.known", ["dancing"], "test of section changed: 'dancing'"),
    ("evaluation.sigma.against", {"random motion": "dancing"}, "test of sigma"),
    ("evaluation.sigma.against", {"random motion": "random motion"}, "another test of sigma than itself"),
    ("evaluation.methods.0.metric", "rmse_pushed", "test with a window around pushes"),
    ("pushes.sines_ll1.shape", "step", "both or neither"),
    ("pushes.sines_ll1.sines.share", [1.0, 1.0], "a share for each line"),
    ("evaluation.tables.table_06.columns.6.joints", ["V1", "V4"], "one unit"),
    ("evaluation.tables.table_11.columns.3.metrics", ["rmse_push_5"], "rmse_push_4"),
    ("evaluation.coverage.tests.1.pushed", "RL3", "joint pushed in knee_swing"),
    ("evaluation.coverage.range", [0.99, 0.01], "the lower one"),
    ("evaluation.calibration.methods", ["MOB"], "method with networks"),
    ("evaluation.methods.0.columns.LL", ["LL9"], "column of LL"),
    ("evaluation.figure_18.methods", ["FTS-e2e"], "methods that estimate W1 in motion_test"),
    ("evaluation.statistics.confidence", 0.05, "from 0.5"),
    ("evaluation.windows.walk_test", {"before_s": 0.0, "after_s": 0.0}, "scenario with pushes"),
    ("claims.mob-exact.cells.0.2", "LL9", "limb or joint: 'LL9'"),
    ("claims.mob-exact.at.scenario", "forward_wolk", "at.scenario: 'forward_wolk'"),
    ("claims.step-mob.at.metric", "rmse_pusht", "metric"),
    ("claims.gru-validation.at.metric", "validation los", "metric"),
    ("claims.mob-exact.quantity", "values", "'value', 'ratio'"),
    ("claims.delay-mob.sign", [0.5, 0.1], "low <= high"),
    ("claims.mob-exact.rule", "exact", "'about', 'at most'"),
    ("claims.reacts-foot.bar", [None, 0.05], "no share of 171 reaches with its interval"),
    ("claims.reacts-foot.decided_at", ["default"], "no share of 18 reaches with its interval"),
    ("claims.sensorless-falls.bar", [None, 1.0], "no count in 4.50 h reaches with its interval"),
    ("claims.sensorless-falls.decided_at", ["default"], "no count in 0.25 h reaches with its interval"),
    ("claims.printed-rate.bar", [None, 0.4], "no share of 4 reaches"),
    ("claims.found-mob-front.decided_at", ["default"], "no share of 18 reaches"),
    ("claims.base-torque-noise.cause.without.cells.0.level", "no_nothing", "cause.without.cells.0.level"),
    ("claims.zero-waist.cause.without.at.joint", "LL9", "cause.without.at.joint"),
    ("claims.found-mob.sign_of.at.column", "worth", "column: 'worth' is not"),
    ("detection.legs", ["LA"], "leg: 'LA'"),
    ("detection.place", "walk_test_2", "scenario without pushes"),
    ("detection.sweep", "collisions", "a test of its own"),
    ("evaluation.table_09.kind", "larger", "rule of thresholds"),
    ("evaluation.figure_13.cells", ["hip front"], "cell of collisions"),
    ("evaluation.sigma.tests.random walking.methods", ["MOB"], "method with networks"),
    ("claims.rte-coverage.at.table", "covered", "table: 'covered'"),
    ("claims.rte-coverage.at", {"table": "coverage"}, "all of them"),
    ("claims.swing-best.cells.1", "MOBB", "method: 'MOBB'"),
    ("evaluation.coverage.tests.0.level", "ideal", "level of test walk_test"),
    ("claims.gru-validation.cells.1", "MOB", "method of Figure 17 or 20"),
    ("claims.mob-exact.cells", [{"method": "MOB"}], "all of them"),
    ("published.data.sets.walk.durations", 60.0, "key 'durations'"),
    # the robot, beside tests/settings/test_robot.py
    ("robot.joints.3.range", [180.0, 360.0], "a number from -12.6"),
    ("robot.joints.0.axis", [0.0, 0.0, -1.0], "of a leg that walks"),
    ("robot.posture.LA.angle_rad.0", 2.0, "range of LA1"),
    ("robot.leg.link_length", 0.4, "between the bodies"),
    ("robot.sole.height", -0.2, "the box's lower face"),
    ("robot.feet.left.limb", "RL", "at the end of limb"),
    ("robot.hands.right", "L_Wrist2_Link", "R_Wrist2_Link"),
    ("robot.groups.W", ["W2", "W1", "W3"], "in the order of"),
    ("robot.bodies.16.inertia", [60.2, 75.6, 75.6, 0.0, 0.0, 0.0], "radius of gyration"),
    ("robot.networks.W.Q", ["V"], "limb with motors"),
    ("robot.joints.3.torque_limit", 289_000.0, "to 5000"),
    ("robot.shapes.2.segment", [0.0] * 6, "two points that differ"),
    ("robot.looks.shapes.2.segment", [0.0] * 6, "two points that differ"),
    ("robot.looks.shapes.2.tone", "pink", "tone"),
    ("robot.looks.shapes.3.name", "left_hip_yaw", "each name once"),
]


@pytest.mark.parametrize(("key", "value", "words"), MEANINGLESS, ids=[key for key, *_ in MEANINGLESS])
def test_what_means_nothing_is_refused_with_its_place(load_with: Load, key: str, value: Any, words: str) -> None:
    section, *rest = (int(part) if part.isdigit() else part for part in key.split("."))
    file, place = (section, rest) if section in OWN else (PARTS[section], [section, *rest])
    assert re.search(words, "\n".join(refusal(load_with, file, dumped(file, tuple(place), value))))


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["scale=smok"], "--config: scale: 'smok' is not accepted; accepted: smoke, "),
        (["observer={gain_hz: 600}"], "--config: observer.gain_hz: 600.0 is not accepted; accepted: at most 500, half"),
        (["observer={gain: 10}"], "--config: observer.gain: key: 'gain' is not accepted; accepted: gain_hz"),
    ],
)  # fmt: skip
def test_a_run_refuses_within_seconds_in_one_line(words: list[str], line: str) -> None:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = [sys.executable, "-m", "snakemake", "-n", "--config", *words]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    told = [text for text in done.stderr.splitlines() if "accepted" in text]
    assert done.returncode == 1
    assert len(told) == 1
    assert told[0].startswith(line)
    assert "Traceback" not in done.stderr
    after = resource.getrusage(resource.RUSAGE_CHILDREN)  # other tests may slow the clock down
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < LONGEST_S


def test_settings_of_what_is_accepted_come_back() -> None:
    assert load_settings(overrides={"observer": {"gain_hz": "50"}}).observer.gain_hz == 50.0
