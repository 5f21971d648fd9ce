"""Small made-up runs: scores with a known mean, and files of a walk whose steps and errors are known."""

import itertools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import write_rows
from made_detections import on_both_plants
from made_notes import training_note

from mobnet.core.columns import FEET, Epoch, Score, residual_columns, torque_columns
from mobnet.core.files import write_json
from mobnet.core.joints import N_VIRTUAL, NQ_BASE, JointLayout
from mobnet.core.metrics import unit_of_metric
from mobnet.core.recording import Recording, Sensed, Truth, read_recording, write_recording
from mobnet.core.store import write_array
from mobnet.evaluation.measure.claims.cells import listed
from mobnet.plan.call import call_of
from mobnet.plan.products import ERRORS, functions
from mobnet.plan.runs import Run
from mobnet.settings.claims import Cell, Claim
from mobnet.settings.evaluation import Evaluation
from mobnet.settings.measures import CalibrationTest
from mobnet.settings.settings import Settings
from mobnet.settings.tables import ErrorRow

RATE_HZ = 100.0
STEP_ROWS = 70  # rows in the air and rows on the ground of the made-up walk
PUSHED_ROWS = range(20, 30)  # of every swing of the made-up walk
JOINTS = [f"LL{i}" for i in range(1, 7)]
FURTHER = ["zero", "MOB-fric-load", "MOB-Kalman", "MOB-Net-gray"]  # baselines, below the paper's methods
LEVELS = {"ideal": ["MOB"], "sensor_noise": ["MOB"], "all_uncertainty": ["MOB", "MOB-Net", "FTS-e2e", *FURTHER]}
MEANS = {"ideal": 0.01, "sensor_noise": 1.2, "MOB": 19.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "zero": 40.0,
         "MOB-fric-load": 2.5, "MOB-Kalman": 3.0, "MOB-Net-gray": 1.4}  # avg [N m]  # fmt: skip
ALONE = ("MOB", "MOB-fric", "zero", "MOB-fric-load", "MOB-fric-dahl", "MOB-Kalman")  # methods without networks
OFF = {"all_uncertainty": 1.0, "exact_model": 0.8, "no_friction": 0.5, "no_load_friction": 1.0, "no_noise": 1.1}


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(5)


@pytest.fixture(scope="session")
def settings(settings: Settings) -> Settings:
    """The configuration with detectors on the plant of section 5.1 too."""
    return on_both_plants(settings)


@pytest.fixture(scope="session")
def evaluation(settings: Settings) -> Evaluation:
    """Tables and figures of made-up runs: few draws, joints and times that they have."""
    whole, methods = settings.evaluation, {"methods": ("MOB", "MOB-Net")}
    collisions = {title: test.model_copy(update=methods) for title, test in whole.figure_10.tests.items()}
    cells, hand = {"phases": 4, "state_cells": 3, "cell_samples": 5}, {"start_s": 0.0, "end_s": 0.5, "every": 5}
    knee = {"drawn": ("MOB-Net",), "against": whole.figure_10.against.model_copy(update=methods)}
    changes: dict[str, dict[str, Any]] = {
        "figure_06": methods,
        "figure_07": {"joints": ("W2", "V3"), **hand},
        "figure_10": {"tests": collisions, **knee},
        "figure_12": hand,
        "figure_18": {"limbs": ("W", "RA"), "methods": ("MOB-Net", "MOB-Net-Single")},
        "figure_19": {"joints": ("LL2", "LL3"), "dots": 200, "test_dots": 100},
        "coverage": {"samples": 400, "every": 2, "cells": 10, "tests": whole.coverage.tests[:1], **cells},
        "calibration": {"points": 9, "methods": ("MOB-Net",)},
        "commands": {"bins": 5},
        "steps": {"bins": 3},
        "data": {"every": 10},
        "kinds": {"variants": ("windows", "printed-rate")},
    }
    sections = {name: getattr(whole, name).model_copy(update=own) for name, own in changes.items()}
    return whole.model_copy(update=sections)


def made_up_scores(networks: int = 2, tests: int = 3) -> list[Score]:
    """Return scores of every level and method whose means over runs are MEANS, joint by joint up to a factor."""
    rows = []
    for level, method in ((level, method) for level, methods in LEVELS.items() for method in methods):
        mean = MEANS.get(level, MEANS[method])
        seeds = range(1 if method in ALONE else networks)
        for network, test in itertools.product(seeds, range(1, tests + 1)):
            off = 1 + 0.1 * (test - (tests + 1) / 2) + 0.04 * (network - (len(seeds) - 1) / 2)
            for i, joint in enumerate([*JOINTS, "avg"]):
                factor = 1.0 if joint == "avg" else (i + 1) / 3.5
                run = ("forward_walk", level, method, network, test, "LL", joint)
                rows.append(Score(*run, "rmse", mean * factor * off, "N m"))
                rows.append(Score(*run, "rmse_raw", (mean + 5.0) * factor * off, "N m"))
                rows.append(Score(*run, "roughness", 50.0 * mean**0.1 * off, "N m/s"))
    return rows


def limb_scores(layout: JointLayout, scenario: str, means: dict[str, float], networks: int = 2) -> list[Score]:
    """Return scores of LL, W and RA on two tests: `means` of every joint and average [N m], up to a factor per run."""
    rows = []
    for method, mean in means.items():
        seeds = range(1 if method in ALONE else networks)
        for network, test in itertools.product(seeds, (1, 2)):
            value = mean * (1 + 0.1 * (test - 1.5) + 0.04 * (network - (len(seeds) - 1) / 2))
            for limb in ("LL", "W", "RA"):
                for joint in (*layout.limb(limb), "avg"):
                    run = (scenario, "all_uncertainty", method, network, test, limb, joint)
                    rows += [Score(*run, "rmse", value, "N m"), Score(*run, "rmse_raw", value + 1.0, "N m")]
    return rows


@pytest.fixture
def write_limb_scores(tmp_path: Path, layout: JointLayout) -> Callable[..., Path]:
    """Write scores of a scenario: write_limb_scores(scenario, means, networks=2) -> CSV."""

    def write(scenario: str, means: dict[str, float], networks: int = 2) -> Path:
        write_rows(tmp_path / f"{scenario}.csv", limb_scores(layout, scenario, means, networks))
        return tmp_path / f"{scenario}.csv"

    return write


def table_scores(layout: JointLayout, rows: list[ErrorRow], metrics: tuple[str, ...]) -> list[Score]:
    """Return scores of every joint that rows of a table ask for: 2 networks where there are any, 3 tests.

    The k-th joint errs by k times 0.1, 4 of MOB, 3 of MOB-fric, 1 of MOB-Net, 2 of others, up to a factor per run.
    """
    sizes = {"MOB": 4.0, "MOB-fric": 3.0, "MOB-Net": 1.0}
    scores: list[Score] = []
    for row, method in ((each, name) for each in rows for name in (*each.methods, *each.further)):
        networks = 1 if method in ALONE else 2
        for network, test in itertools.product(range(networks), (1, 2, 3)):
            off = 1 + 0.1 * (test - 2) + 0.04 * (network - (networks - 1) / 2)
            for limb, joints in layout.groups.items():
                for joint in joints:
                    run = (row.scenario, row.level, method, network, test, limb, joint)
                    value = 0.1 * sizes.get(method, 2.0) * (layout.names.index(joint) + 1) * off
                    scores += [
                        Score(*run, metric, value * (k + 1), "%" if metric == "r_rmse" else layout.unit(joint))
                        for k, metric in enumerate(metrics)
                    ]
    return list(dict.fromkeys(scores))


@pytest.fixture
def make_table(tmp_path: Path, settings: Settings, evaluation: Evaluation) -> Callable[..., Path]:
    """Write a table as its rule does: make_table(name, folder=tmp_path, **needs and other settings) -> its CSV."""

    def make(name: str, folder: Path = tmp_path, **changes: Any) -> Path:
        function = ERRORS if name in evaluation.tables else functions()[name]
        printed = settings.published.tables.get(name) or getattr(settings.published, name, None)
        section = evaluation.tables.get(name) or getattr(evaluation, name, None)
        own = {"name": name, "settings": section, "published": printed, "layout": settings.layout, "table_dir": folder}
        own |= {"figure_dir": folder / "figures", "tables": {}}
        shared = {"statistics": evaluation.statistics, "figure_17": evaluation.figure_17}
        known = {**dict(settings), **shared, **own, **changes}
        call_of(function, known).run()
        return folder / f"{name}.csv"

    return make


@pytest.fixture
def write_table_scores(tmp_path: Path, layout: JointLayout, evaluation: Evaluation) -> Callable[..., list[Path]]:
    """Write the scores that a table needs: write_table_scores(name, *metrics) -> CSV files, one of each test."""

    def write(name: str, *metrics: str) -> list[Path]:
        found: list[Path] = []
        rows = evaluation.tables[name].rows
        for shown in dict.fromkeys((row.scenario, row.level) for row in rows):
            found.append(tmp_path / f"{name}_{'_'.join(shown)}.csv")
            own = [row for row in rows if (row.scenario, row.level) == shown]
            write_rows(found[-1], table_scores(layout, own, metrics))
        return found

    return write


def measured_scores(layout: JointLayout, tests: Iterable[Any], metrics: Mapping[str, tuple[float, str]]) -> list[Score]:
    """Return scores of the methods of tests, limb by limb: each metric's value, a tenth more of each later method.

    There are two walks; MOB has one network, others have two.
    """
    rows: list[Score] = []
    for test in tests:
        for k, method in enumerate(test.methods):
            for network, walk in itertools.product(range(1 if method == "MOB" else 2), (1, 2)):
                off = (1 + 0.1 * k) * (1 + 0.1 * (walk - 1.5) + 0.04 * (network - 0.5) * (method != "MOB"))
                for limb, (metric, (value, unit)) in itertools.product(test.limbs, metrics.items()):
                    for joint in (*layout.limb(limb), "avg"):
                        run = (test.scenario, test.level, method, network, walk, limb, joint, metric)
                        rows.append(Score(*run, value * off, unit))
    return rows


@pytest.fixture
def write_measured(tmp_path: Path, layout: JointLayout) -> Callable[..., list[Path]]:
    """Write scores of some tests: write_measured(tests, {metric: (value, unit)}) -> CSV files, one of each test."""

    def write(tests: Iterable[Any], metrics: Mapping[str, tuple[float, str]]) -> list[Path]:
        rows, found = measured_scores(layout, tests, metrics), list[Path]()
        for scenario in dict.fromkeys(row.scenario for row in rows):
            found.append(tmp_path / f"measured_{scenario}.csv")
            own = dict.fromkeys(row for row in rows if row.scenario == scenario)
            write_rows(found[-1], list(own))
        return found

    return write


@pytest.fixture
def write_budget_scores(tmp_path: Path, layout: JointLayout) -> Callable[..., Path]:
    """Write errors of three tests with sources of error off: write_budget_scores(factors=OFF, cut="") -> CSV.

    Joint k of a limb errs by k, times its level's factor; joint `cut` errs by 0 as soon as any source is off.
    """

    def write(factors: dict[str, float] = OFF, cut: str = "") -> Path:
        rows = []
        for (level, factor), test in itertools.product(factors.items(), (1, 2, 3)):
            for limb, joints in layout.groups.items():
                for k, joint in enumerate(joints, start=1):
                    value = k * factor * (1 + 0.1 * (test - 2)) * (joint != cut or level == "all_uncertainty")
                    run = ("motion_test", level, "MOB", 0, test, limb, joint)
                    rows.append(Score(*run, "rmse", value, layout.unit(joint)))
        write_rows(tmp_path / "budget_scores.csv", rows)
        return tmp_path / "budget_scores.csv"

    return write


@pytest.fixture
def write_training(tmp_path: Path) -> Callable[..., Path]:
    """Write a made-up training: write_training(method, seed=0, loss=-4.0, epochs=3, **changes of run.json) -> folder.

    Its validation loss falls by one an epoch to `loss` at the last but one, and ends half above it.
    """

    def write(method: str, seed: int = 0, loss: float = -4.0, epochs: int = 3, **changes: Any) -> Path:
        folder = tmp_path / f"{method}-LL-s{seed}"
        course = [loss + epochs - 2 - k for k in range(epochs - 1)] + [loss + 0.5] * (epochs > 0)
        epochs_done = [Epoch(k + 1, x - 0.25, x, 10.0 + x, 0.005, 1.5, 1) for k, x in enumerate(course)]
        write_rows(folder / "metrics.csv", epochs_done, Epoch)
        own = {"samples": 1620000, "on_windows": {"loss": loss + 0.125, "rmse": 7.0}, **changes}
        write_json(folder / "run.json", training_note(folder.name, course, **own))
        return folder

    return write


def cells_of(claims: list[Claim]) -> list[Cell]:
    """Return all cells of claims and of their causes."""
    return [cell for claim in claims for made in (claim, *claim.numbers.values()) for cell in made.cells]


def claimed_scores(layout: JointLayout, claims: list[Claim], means: dict[str, float], pushes: bool) -> list[Score]:
    """Return the scores that claims name, and the plain error: 0.01 where all is ideal, else a method's mean [N m]."""
    networks = {"MOB": 1, "MOB-fric": 1, "MOB-fric-load": 1, "MOB-Net-Single": 2, "zero": 1}
    rows = {}
    for cell in (cell for cell in cells_of(claims) if cell.joint):
        metrics = {"rmse", *listed(cell.metric or "rmse")}
        kept = [name for name in sorted(metrics) if pushes or "push" not in name]
        mean = 0.01 if cell.level == "ideal" else means[str(cell.method)]
        joints = [joint for name in listed(cell.joint or ()) for joint in layout.groups.get(name, (name,))]
        limbs = [next(limb for limb, own in layout.groups.items() if joint in own) for joint in joints]
        seeds = range(networks.get(str(cell.method), 3))
        for (limb, joint), name, network, test in itertools.product(
            zip(limbs, joints, strict=True), kept, seeds, (1, 2)
        ):
            run = (str(cell.scenario), str(cell.level), str(cell.method), network, test, limb, joint, name)
            rows[run] = Score(*run, mean * (1 + 0.01 * (test - 1.5)), unit_of_metric(name, "N m"))
    return list(rows.values())


@pytest.fixture
def write_results(tmp_path: Path, layout: JointLayout, write_training: Callable[..., Path]) -> Callable[..., Any]:
    """Write what claims name: write_results(claims, means, pushes=True) -> files of scores, folders of trainings.

    Losses rise from method to method in the order in which claims name them.
    """

    def write(claims: list[Claim], means: dict[str, float], pushes: bool = True) -> tuple[list[Path], list[Path]]:
        write_rows(tmp_path / "claimed.csv", claimed_scores(layout, claims, means, pushes))
        named = [str(cell.method) for cell in cells_of(claims) if not cell.joint and not cell.table]
        losses = {method: -4.0 + 0.1 * k for k, method in enumerate(dict.fromkeys(named))}
        folders = [
            write_training(method, seed, loss + 0.05 * seed) for method, loss in losses.items() for seed in (0, 1)
        ]
        return [tmp_path / "claimed.csv"], folders

    return write


@pytest.fixture
def make_scores() -> Callable[..., list[Score]]:
    """Make scores of any number of networks and tests: make_scores(networks=2, tests=3)."""
    return made_up_scores


def push_scores(scenario: str, means: dict[str, float], pushes: int) -> list[Score]:
    """Return scores of LL3 around pushes: `means` of all [N m], a tenth more of each later one, one less of no push."""
    rows, level = [], "all_uncertainty" if scenario == "hip_pitch_step" else "robots"
    for method, mean in means.items():
        for network, test in itertools.product(range(1 if method == "MOB" else 2), (1, 2)):
            run = (scenario, level, method, network, test, "LL", "LL3")
            value = mean * (1 + 0.1 * (test - 1.5) + 0.04 * (network - 0.5) * (method != "MOB"))
            each = {f"rmse_push_{k}": value * (1 + 0.1 * (k - 1)) for k in range(1, pushes + 1)}
            measured = {"rmse": value - 1.0} | each | ({"rmse_pushed": value} if pushes else {})
            rows += [Score(*run, metric, number, "N m") for metric, number in measured.items()]
    return rows


@pytest.fixture
def write_push_scores(tmp_path: Path) -> Callable[..., Path]:
    """Write scores of a scenario with pushes: write_push_scores(scenario, means, pushes=2) -> CSV."""

    def write(scenario: str, means: dict[str, float], pushes: int = 2) -> Path:
        write_rows(tmp_path / f"{scenario}.csv", push_scores(scenario, means, pushes))
        return tmp_path / f"{scenario}.csv"

    return write


def write_walk(
    folder: Path, layout: JointLayout, error: float, steps: int, method: str, joints: list[str], std: float | None,
    calm: bool,
) -> Run:  # fmt: skip
    """Write recording, residual and estimate of a made-up walk of some gait cycles, pushed in every swing unless calm.

    Of every joint the estimate has a constant error and a standard deviation, or none; the residual errs by 5 [N m].
    """
    rows = 2 * STEP_ROWS * steps
    phase = np.arange(rows) % (2 * STEP_ROWS)
    air = (phase < STEP_ROWS).astype(float)
    load = np.where(air > 0, 0.0, 60.0 * np.sin(np.pi * (phase - STEP_ROWS) / STEP_ROWS))
    truth = load[:, None] * np.linspace(-1, 1, layout.nv)
    zeros = np.zeros
    q, acc = np.tile(np.eye(1, layout.nq, 3), (rows, 1)), np.tile([0.0, 0.0, 9.81], (rows, 1))
    sensed = Sensed(q, zeros((rows, layout.nv)), acc, zeros((rows, layout.nu)),
                    zeros((rows, layout.nu)), np.stack([air, 1 - air], axis=1), zeros((rows, 5)),
                    zeros((rows, 2)))  # fmt: skip
    wrench, pushed = zeros((rows, 6)), (np.isin(phase, PUSHED_ROWS) & (not calm)).astype(float)[:, None]
    push = zeros((rows, layout.nv))
    unseen = Truth(truth, wrench, wrench, zeros((rows, 2)), pushed, zeros((rows, layout.nu)), push, zeros((rows, 4)))
    recording = Recording(sensed, ((0, rows),), RATE_HZ, {}, unseen)
    write_recording(folder / "recording", recording, layout)
    written = np.concatenate([truth + 5, truth], axis=1)
    write_array(folder / "residual", written, residual_columns(layout), {"rate_hz": RATE_HZ})
    columns = torque_columns(layout, ["tau_ext"], joints)
    estimate = truth[:, layout.columns(joints)] + error
    if std is not None:
        columns += torque_columns(layout, ["std"], joints)
        estimate = np.concatenate([estimate, np.full(estimate.shape, std)], axis=1)
    write_array(folder / "estimate", estimate, columns, {"rate_hz": RATE_HZ})
    return run_of(folder, method)


def run_of(folder: Path, method: str) -> Run:
    """Return the run of a method whose files stand in a folder."""
    stems = (folder / name for name in ("recording", "residual", "estimate"))
    return Run("forward_walk", "all_uncertainty", method, 0, 1, *stems)


@pytest.fixture
def walk(tmp_path: Path, layout: JointLayout) -> Callable[..., Run]:
    """Write a made-up walk: walk(error, steps=4, method="MOB-Net", joints=JOINTS, std=None, calm=False) -> its run."""

    def write(
        error: float, steps: int = 4, method: str = "MOB-Net", joints: list[str] = JOINTS, std: float | None = None,
        calm: bool = False,
    ) -> Run:  # fmt: skip
        folder = tmp_path / f"{method}-{error}-{steps}-{joints[0]}-{std}-{calm}"
        return write_walk(folder, layout, error, steps, method, joints, std, calm)

    return write


def write_steps(stem: Path, layout: JointLayout, seed: int, size: float = 1.0, stands: bool = False) -> Path:
    """Write a recording of 20 s of random steps and motion, and its residual beside it; return the recording's stem.

    The residual's name ends in `_residual`. `size` is that of velocities [rad/s] and, times 40, of desired torques
    [N m]; a robot that stands does so in the second half.
    """
    rng, rows = np.random.default_rng(seed), 2000
    time = np.arange(rows) / RATE_HZ
    speed = 2 * np.pi * rng.uniform(0.2, 2.0, layout.nu)
    phase = speed * time[:, None] + rng.uniform(0, 6.3, layout.nu)
    q, v = np.zeros((rows, layout.nq)), np.zeros((rows, layout.nv))
    q[:, 3], q[:, NQ_BASE:] = 1.0, -size * (np.cos(phase) / speed)[:, ::-1]
    v[:, N_VIRTUAL:] = size * np.sin(phase)[:, ::-1]
    step = np.arange(rows) // STEP_ROWS
    low, high = np.array([-0.15, -0.1, -0.3, 0.6, 0.04]), np.array([0.2, 0.1, 0.3, 0.9, 0.07])
    command = rng.uniform(low, high, (step[-1] + 1, len(low)))[step]
    swing = np.stack([step % 2 == 0, step % 2 == 1], axis=1) & (np.arange(rows) % STEP_ROWS > 5)[:, None]
    if stands:
        command[rows // 2 :], swing[rows // 2 :] = 0.0, False
    torque = 40.0 * size * rng.normal(size=(rows, layout.nu))
    acc = rng.normal(size=(rows, 3)) + [0.0, 0.0, 9.81]
    sensed = Sensed(q, v, acc, torque, np.clip(torque, -25.0, 25.0), swing.astype(float), command, np.zeros((rows, 2)))
    wrench, pushed = np.zeros((rows, 6)), np.zeros((rows, 1))
    still, external = (np.zeros_like(torque), np.zeros_like(v), np.zeros((rows, 4))), rng.normal(size=v.shape)
    truth = Truth(external, wrench, wrench, 1.0 - swing, pushed, *still)
    meta = {"falls": seed % 2, "terrains": ["checks", "flat"]}
    spans = ((0, rows // 2), (rows // 2, rows))
    write_recording(stem, Recording(sensed, spans, RATE_HZ, meta, truth), layout)
    residual = np.concatenate([size * 20.0 * rng.normal(size=v.shape), truth.tau_ext], axis=1)
    beside = stem.with_name(f"{stem.name}_residual")
    write_array(beside, residual, residual_columns(layout), {"rate_hz": RATE_HZ}, spans)
    return stem


def write_predicted(folder: Path, layout: JointLayout, seed: int, scale: float | None) -> Run:
    """Write an estimate of the left leg whose errors have the spread that it predicts, ten times that around pushes.

    The recording has only the columns that show pushes. A scale is noted beside the standard deviations.
    """
    rng, rows = np.random.default_rng(seed), 2000
    air = (np.arange(rows) % (2 * STEP_ROWS) < STEP_ROWS).astype(float)
    pushed = np.isin(np.arange(rows) % (10 * STEP_ROWS), range(30, 40))
    columns = [(f"swing.{FEET[0]}", "-", "plan"), (f"contact.{FEET[0]}", "-", "ground"),
               ("tau_ext.LL3", "N m", "joint")]  # fmt: skip
    array = np.stack([air, 1.0 - air, 30.0 * pushed], axis=1)
    write_array(folder / "recording", array, columns, {"rate_hz": RATE_HZ})
    truth, std = 20.0 * rng.normal(size=(rows, layout.nv)), rng.uniform(0.5, 3.0, (rows, len(JOINTS)))
    write_array(folder / "residual", truth, torque_columns(layout, ["tau_ext_lp"], layout.names), {"rate_hz": RATE_HZ})
    near = np.convolve(pushed, np.ones(11))[:rows] > 0  # a push and the tenth of a second after it
    error = std * rng.normal(size=std.shape) * np.where(near, 10.0, 1.0)[:, None]
    columns = [(f"{kind}.{joint}", "N m", "joint") for kind in ("tau_ext", "std") for joint in JOINTS]
    meta = {"rate_hz": RATE_HZ} | ({} if scale is None else {"std_scale": dict.fromkeys(JOINTS, scale)})
    estimate = np.concatenate([truth[:, layout.columns(JOINTS)] + error, std], axis=1)
    write_array(folder / "estimate", estimate, columns, meta)
    return run_of(folder, "MOB-Net")


@pytest.fixture
def predicted(tmp_path: Path, layout: JointLayout) -> Callable[..., tuple[CalibrationTest, list[Run]]]:
    """Write a run that predicts its own spread: predicted(seed, scale=1.0, pushed=None) -> test, runs."""

    def write(seed: int, scale: float | None = 1.0, pushed: str | None = None) -> tuple[CalibrationTest, list[Run]]:
        run = write_predicted(tmp_path / f"predicted{seed}-{pushed}", layout, seed, scale)
        scenario, level = "knee_swing" if pushed else "walk_test", "all_uncertainty"
        test = CalibrationTest(scenario=scenario, level=level, pushed=pushed, methods=("MOB-Net",), limbs=("LL",))
        return test, [run]

    return write


@pytest.fixture(scope="session")
def data_sets(tmp_path_factory: pytest.TempPathFactory, layout: JointLayout) -> dict[str, list[Path]]:
    """Stems of the made-up recordings of three training sets, two each, and of a test."""
    folder = tmp_path_factory.mktemp("sets")
    sets = {"walk": (1.0, False), "walk_plain": (0.7, False), "motion": (0.5, True), "test": (0.9, False)}
    return {
        name: [write_steps(folder / f"{name}{k}", layout, 10 * k + len(name), *kind) for k in range(2)]
        for name, kind in sets.items()
    }


@pytest.fixture
def explored(tmp_path: Path, layout: JointLayout, data_sets: dict[str, list[Path]], rng: np.random.Generator) -> Path:
    """A walk whose desired torque answers a step of the random torque of LL3 by a decay to a quarter of it, and W1 not.

    The decay has a time constant of 0.05 s. The other joints have no random torque. Torques of the gait are noise here.
    """
    walk = read_recording(data_sets["walk"][0], layout)
    rows = len(walk.sensed)
    random, answer = np.zeros((rows, layout.nu)), np.zeros((rows, layout.nu))
    for k, share in ((layout.actuated.index("LL3"), 0.25), (layout.actuated.index("W1"), 1.0)):
        left = 0.0
        for row in range(rows):
            if row and row % 15 == 0:
                random[row:, k] = rng.uniform(-50, 50)
                left += (1 - share) * (random[row, k] - random[row - 1, k])
            answer[row, k] = share * random[row, k] + left
            left *= np.exp(-1 / (walk.rate_hz * 0.05))
    torque = rng.normal(size=random.shape) + answer
    changed = replace(walk.sensed, tau_des=torque), replace(walk.truth, tau_random=random)
    whole = Recording(changed[0], walk.segments, walk.rate_hz, walk.meta, changed[1])
    write_recording(tmp_path / "explored", whole, layout)
    return tmp_path / "explored"
