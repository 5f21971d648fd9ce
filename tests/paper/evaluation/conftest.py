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
from made_runs import write_predicted, write_steps, write_walk
from made_scores import (
    JOINTS,
    cells_of,
    claimed_scores,
    limb_scores,
    made_up_scores,
    measured_scores,
    push_scores,
    table_scores,
)

from experiments.plan.files import Files
from experiments.plan.items import errors
from experiments.plan.product import Context, Folders
from experiments.plan.products import all_items
from experiments.plan.runs import Run
from experiments.records.scores import Score
from experiments.settings.catalogue import Catalogue
from experiments.settings.claims import Claim
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import CalibrationTest
from experiments.settings.settings import Settings
from mobnet.core.epochs import Epoch
from mobnet.core.files import write_json
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.core.recording_file import read_recording, write_recording

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


@pytest.fixture
def write_limb_scores(tmp_path: Path, layout: JointLayout) -> Callable[..., Path]:
    """Write scores of a scenario: write_limb_scores(scenario, means, networks=2) -> CSV."""

    def write(scenario: str, means: dict[str, float], networks: int = 2) -> Path:
        write_rows(tmp_path / f"{scenario}.csv", limb_scores(layout, scenario, means, networks))
        return tmp_path / f"{scenario}.csv"

    return write


@pytest.fixture(scope="session")
def files(settings: Settings) -> Files:
    """What stands where; no test reads it."""
    return Files(Catalogue(settings), Path("results"))


@pytest.fixture
def make_table(tmp_path: Path, settings: Settings, evaluation: Evaluation, files: Files) -> Callable[..., Path]:
    """Write a table as its row says: make_table(name, folder=tmp_path, **files and other settings) -> its CSV."""

    def make(name: str, folder: Path = tmp_path, **changes: Any) -> Path:
        items = {item.name: item for item in all_items()}
        item = errors.error_table_of(name) if name in evaluation.tables else items[name]
        folders = Folders(folder, folder, folder / "figures", folder, folder)
        given = dict(item.given(Context(settings, files, folders)))
        # Sections of made-up runs stand in for those of the configuration.
        for section in Evaluation.model_fields:
            for key, value in given.items():
                if value is getattr(settings.evaluation, section):
                    given[key] = getattr(evaluation, section)
        item.late()(**{**given, **item.written_into(folders), **changes})
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


@pytest.fixture
def write_push_scores(tmp_path: Path) -> Callable[..., Path]:
    """Write scores of a scenario with pushes: write_push_scores(scenario, means, pushes=2) -> CSV."""

    def write(scenario: str, means: dict[str, float], pushes: int = 2) -> Path:
        write_rows(tmp_path / f"{scenario}.csv", push_scores(scenario, means, pushes))
        return tmp_path / f"{scenario}.csv"

    return write


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
