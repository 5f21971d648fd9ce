"""A file of results is the one that its job of the plan makes, or one line says that it is not, and what to do."""

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest
from made_notes import training_note

from experiments.plan import call, steps
from experiments.plan.plan import Plan, Stamped, make_plan
from experiments.plan.steps import Step
from experiments.running.logs import Account
from experiments.running.stamp import Stamps, is_note
from experiments.settings.load import load_settings
from mobnet.core.files import write_json

RECORDING, OTHER = (f"results/smoke/recordings/random_walk/all_uncertainty/s{seed}.json" for seed in (1000, 1001))
NETWORK = "results/smoke/networks/MOB-Net-LL-s0"
MADE = (
    RECORDING,
    OTHER,
    RECORDING.replace("recordings", "residuals"),
    "results/smoke/motions/random_motion/s1000.json",
    f"{NETWORK}/run.json",
    "results/smoke/fits/MOB-fric.json",
    "results/smoke/estimates/MOB-Net/n0/forward_walk/all_uncertainty/s101.json",
    "results/smoke/scores/forward_walk/all_uncertainty.csv",
    "results/smoke/robot_1/detection/collisions.csv",
)


def plan_with(**changes: Any) -> Plan:
    """Return the plan of the smoke scale with some sections of the configuration replaced."""
    return make_plan(load_settings(overrides={"scale": "smoke", **changes}), with_pdf=False)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return plan_with()


def step_of(plan: Plan, name: str) -> Step:
    """Return the step that makes a file."""
    return next(step for step in plan.steps if name in step.outputs)


def stamps_of(plan: Plan, name: str) -> Stamps:
    """Return what the job of a file stamps on this file."""
    return Stamps({name: step_of(plan, name).job.stamps.given[name]})


def account_of(root: Path, step: Step) -> Path:
    """Return the account of the job of a step."""
    return root / "results" / "smoke" / "logs" / f"{step.work.job}.json"


@pytest.fixture
def root(plan: Plan, tmp_path: Path) -> Path:
    """A project with one file, or one network, of each kind, stamped as a job does it."""
    for name in MADE:
        path, step = tmp_path / name, step_of(plan, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        if is_note(name):
            write_json(path, {"rows": 3, "half": 0.1})
        else:
            path.write_text("value\n1\n")
        if name == f"{NETWORK}/run.json":
            write_json(path, training_note("MOB-Net-LL-s0", [-1.0]))
            (path.parent / "weights.safetensors").write_bytes(b"weights")
            (path.parent / "metrics.csv").write_text("epochs")
        stamps = stamps_of(plan, name).write(tmp_path)
        account = Account(step.work.job, 0.0, 1.0, 1.0, 1.0, 1.0, succeeded=True, stamps=stamps)
        write_json(account_of(tmp_path, step), asdict(account))
    return tmp_path


def told(plan: Plan, root: Path, *names: str) -> list[str]:
    return list(Stamped(plan, root).foreign(names or MADE))


def test_what_the_jobs_of_the_plan_make_is_accepted(plan: Plan, root: Path) -> None:
    weights = [f"{NETWORK}/{name}" for name in ("weights.safetensors", "metrics.csv")]
    assert told(plan, root, *MADE, *weights, RECORDING.replace(".json", ".parquet")) == []


def test_a_stamp_is_the_last_key_of_a_note_whose_other_lines_stay(plan: Plan, root: Path) -> None:
    text = (root / RECORDING).read_text()
    assert list(json.loads(text)) == ["rows", "half", "stamp"]
    step_of(plan, RECORDING).job.stamps.__class__(
        {RECORDING: step_of(plan, RECORDING).job.stamps.given[RECORDING]}
    ).write(root)
    assert (root / RECORDING).read_text() == text


Swap = Callable[[Path], Any]
SWAPS: dict[str, tuple[str, Swap]] = {
    "a recording of another seed": (
        RECORDING,
        lambda root: (root / RECORDING).write_bytes((root / OTHER).read_bytes()),
    ),
    "the recording in place of its residual": (
        MADE[2],
        lambda root: (root / MADE[2]).write_bytes((root / RECORDING).read_bytes()),
    ),
    "a changed note": (RECORDING, lambda root: write_json(root / RECORDING, {**read(root / RECORDING), "rows": 4})),
    "a note without a stamp": (RECORDING, lambda root: write_json(root / RECORDING, {"rows": 3, "half": 0.1})),
    "a damaged note": (RECORDING, lambda root: (root / RECORDING).write_text("{")),
    "a note that is gone": (RECORDING, lambda root: (root / RECORDING).unlink()),
    "weights of another seed": (
        f"{NETWORK}/weights.safetensors",
        lambda root: (root / NETWORK / "weights.safetensors").write_bytes(b"others"),
    ),
    "epochs of another seed": (
        f"{NETWORK}/metrics.csv",
        lambda root: (root / NETWORK / "metrics.csv").write_text("others"),
    ),
    "scores of another level": (MADE[7], lambda root: (root / MADE[7]).write_text("value\n2\n")),
    "detections of another robot": (MADE[8], lambda root: (root / MADE[8]).write_text("value\n2\n")),
}


def read(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text())


@pytest.mark.parametrize("name", SWAPS)
def test_a_file_that_is_swapped_is_one_line_with_a_remedy(name: str, plan: Plan, root: Path) -> None:
    path, swap = SWAPS[name]
    swap(root)
    (line,) = told(plan, root, path)
    assert line == (
        f"{path}: made by another configuration or code, which is not accepted; "
        f"accepted: what `./reproduce {path} --force` makes"
    )


def test_scores_whose_account_is_gone_are_refused(plan: Plan, root: Path) -> None:
    account_of(root, step_of(plan, MADE[7])).unlink()
    assert len(told(plan, root, MADE[7])) == 1


def test_a_file_that_no_job_makes_is_refused_and_others_are_left_alone(plan: Plan, root: Path) -> None:
    (line,) = told(plan, root, "results/smoke/estimates/MOB-Nett/n0/walk_test/ideal/s101.json")
    assert line.endswith("accepted: a file that a job of this configuration makes")
    assert (
        told(plan, root, "results/smoke/compute.csv", "results/smoke/state/x.json", "results/smoke/logs/a.json") == []
    )
    assert told(plan, root, "lab/s1.json", "results/bench.csv") == []


CHANGES: dict[str, tuple[dict[str, Any], set[str]]] = {
    "the observer's gain": ({"observer": {"gain_hz": 50.0}}, {*MADE[:3], *MADE[5:7]}),
    "the seed of all": ({"seed": 7}, {*MADE[:5]}),
}


@pytest.mark.parametrize("name", CHANGES)
def test_files_of_another_configuration_are_told(name: str, root: Path) -> None:
    changes, touched = CHANGES[name]
    lines = told(plan_with(**changes), root)
    assert {line.partition(": ")[0] for line in lines} >= touched


def test_files_of_other_code_are_told(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hashed = call.code_hash
    changed = "experiments.jobs.trainings"
    monkeypatch.setattr(call, "code_hash", lambda *names: hashed(*names) + "x" * (changed in names))
    assert [line.partition(": ")[0] for line in told(plan_with(), root)] == [f"{NETWORK}/run.json"]


def stamps(plan: Plan) -> dict[str, str]:
    """Return what is stamped on every file of a plan."""
    return {name: given for step in plan.steps for name, given in step.job.stamps.given.items()}


@pytest.fixture
def divided(monkeypatch: pytest.MonkeyPatch) -> Plan:
    """The plan whose steps have one part each, as far as parts can be divided."""
    monkeypatch.setattr(steps, "PART_S", 0.0)
    monkeypatch.setattr(steps, "PART_STEPS", 0.0)
    return plan_with()


def test_stamps_do_not_depend_on_how_parts_are_divided_among_jobs(plan: Plan, divided: Plan) -> None:
    assert len(divided.steps) > len(plan.steps) + 50
    assert stamps(divided) == stamps(plan)


def test_every_file_of_results_has_a_stamp(plan: Plan) -> None:
    names = {name for name in plan.stored if not name.endswith((".parquet", ".safetensors", "metrics.csv"))}
    assert stamps(plan).keys() == names
