"""The stored push is cut out of a run's files without a change of any number, and the snapshot copies it whole."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from paper_settings import settings_at

from experiments.demo import DATA
from experiments.evaluation.report.demo_data import copy_demo, demo_data
from experiments.evaluation.report.manifest import file_hash
from experiments.plan.demo import SOURCES, demo_needs, demo_outputs
from experiments.plan.plan import make_plan
from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.core.store import read_array

SETTINGS = settings_at()
STORY = SETTINGS.evaluation.story
SHORTER = {"before_s": 0.5, "after_s": 0.25, "settle_s": 0.1}
SEED = read_json(DATA / "recording.json")["seed"]
ROWS = slice(1200, 1950)  # of the stored push, that begins in row 1700
Cut = Callable[..., Path]


@pytest.fixture
def cut(tmp_path: Path) -> Cut:
    """Cut a shorter push out of the stored one, as if that were a run: cut(name, story={}, **needs) -> folder."""
    run = tmp_path / "run"
    shutil.copytree(DATA, run)
    for ending in (".parquet", ".json"):
        (run / f"recording{ending}").rename(run / f"s{SEED}{ending}")

    def make(name: str = "a", story: dict[str, float] = SHORTER, **changes: Any) -> Path:
        needs: dict[str, Any] = {
            "settings": STORY.model_copy(update=story),
            "pushes": SETTINGS.scenarios[STORY.scenario].pushes,
            "recording": run / f"s{SEED}",
            "estimates": {method: run / "estimates" / method for method in STORY.methods},
            "copied": {name: run / name for name in ("networks/MOB-Net-pushed-LL/run.json", "fits/MOB-fric-dahl.json")},
            "detections": {name: run / f"{name}.csv" for name in ("collisions", "thresholds", "detected")},
        }
        out = tmp_path / name / SOURCES
        demo_data(scale="default", layout=SETTINGS.layout, limb="LL", out=out, **{**needs, **changes})
        return out.parent

    return make


def test_samples_and_what_is_said_of_them_are_those_of_the_run(cut: Cut) -> None:
    folder = cut()
    for name in ("recording", *(f"estimates/{method}" for method in STORY.methods)):
        (ours, note), (run, of_run) = read_array(folder / name), read_array(DATA / name)
        np.testing.assert_array_equal(ours, run[ROWS])
        assert note["segments"] == [[0, 750]]
        for key in ("columns", "rate_hz", "scenario", "level", "seed"):
            assert note[key] == of_run[key]
    for name in ("collisions.csv", "thresholds.csv", "detected.csv", "fits/MOB-fric-dahl.json"):
        assert (folder / name).read_bytes() == (DATA / name).read_bytes()


def test_each_file_is_noted_with_what_it_was_made_from(cut: Cut, tmp_path: Path) -> None:
    folder = cut()
    note = read_json(folder / SOURCES)
    assert [note["cut"][key] for key in ("from_row", "to_row")] == [ROWS.start, ROWS.stop]
    assert note["sources"]["recording.parquet"]["file"] == str(tmp_path / "run" / f"s{SEED}.parquet")
    assert note["sources"]["recording.parquet"]["sha256"] == file_hash(DATA / "recording.parquet")
    commit = read_json(DATA / "recording.json")["provenance"]["commit"]
    assert note["sources"]["recording.parquet"]["commit"] == commit
    made = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    noted = set(note["sources"]) | {f"{name[:-8]}.json" for name in note["sources"] if "parquet" in name}
    assert made == noted | {SOURCES}


def test_equal_files_make_an_equal_push_and_another_one_replaces_it(cut: Cut) -> None:
    def content(folder: Path) -> dict[str, bytes]:
        return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}

    first = content(cut("a"))
    assert content(cut("b")) == first
    longer = content(cut("a", {**SHORTER, "before_s": 0.6}))
    assert longer.keys() == first.keys()
    assert longer["recording.parquet"] != first["recording.parquet"]


def test_thresholds_of_other_detectors_and_rows_of_other_pushes_are_left_out(cut: Cut, tmp_path: Path) -> None:
    run = tmp_path / "run"
    for name, old, new in (
        ("collisions", "_knee_front", "_foot_front"), ("thresholds", "MOB-Net-pushed-ratio", "MOB"),
        ("thresholds", "collision", "bump"), ("detected", "LL,5", "LL,4"),
    ):  # fmt: skip
        path = run / f"{name}.csv"
        head, *rows = (DATA / f"{name}.csv").read_text().splitlines()
        others = [row.replace(old, new) for row in rows]
        assert others != rows
        path.write_text("\n".join([head, *others, *rows, ""]))
    folder = cut()
    for name in ("collisions", "thresholds", "detected"):
        assert (folder / f"{name}.csv").read_text() == (DATA / f"{name}.csv").read_text()


def test_a_push_that_is_not_there_or_not_whole_is_told(cut: Cut, tmp_path: Path) -> None:
    with pytest.raises(DataError, match=rf"s{SEED}\.json: segments: .* accepted: rows -300 to 1950 in one segment"):
        cut(story={**SHORTER, "before_s": 2.0})
    with pytest.raises(DataError, match=r"weights\.safetensors: file is missing"):
        cut(copied={"weights.safetensors": tmp_path / "weights.safetensors"})
    with pytest.raises(DataError, match=rf"collisions\.csv: no row of .*, {SEED}, LL, collision_left_foot_side"):
        cut(story={**SHORTER, "push": "collision_left_foot_side"})
    assert not (tmp_path / "a" / SOURCES).exists()


def test_the_snapshot_copies_what_the_description_lists_and_nothing_older_stays(tmp_path: Path) -> None:
    out = tmp_path / "demo"
    (out / "networks").mkdir(parents=True)
    for name in ("old.csv", "networks/old.json"):
        (out / name).write_text("old")
    copy_demo(DATA, out)
    names = {str(path.relative_to(DATA)): path for path in DATA.rglob("*") if path.is_file()}
    assert {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()} == set(names)
    assert all((out / name).read_bytes() == path.read_bytes() for name, path in names.items())
    with pytest.raises(DataError, match=r"sources\.json: file is missing"):
        copy_demo(tmp_path / "none", out)


def test_the_plan_takes_the_first_recording_and_the_networks_of_its_robot() -> None:
    plan = make_plan(SETTINGS, with_pdf=False)
    needs, robot = demo_needs(plan.files), "results/default/robot_1"
    assert (
        str(needs["recording"])
        == f"{robot}/recordings/collisions/robot_1/s{plan.files.robots['robot_1'].test_seeds[0]}"
    )
    weights = needs["copied"]["networks/MOB-Net-pushed-LL/weights.safetensors"]
    assert str(weights) == f"{robot}/networks/MOB-Net-pushed-LL-s101/weights.safetensors"
    (product,) = [one for one in plan.products if one.name == "demo_data"]
    assert f"{robot}/recordings/collisions/robot_1" in product.inputs
    stored = {str(path.relative_to(DATA)) for path in DATA.rglob("*") if path.is_file()}
    assert set(demo_outputs(needs)) == stored
