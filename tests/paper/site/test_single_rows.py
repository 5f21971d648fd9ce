"""The snapshot has a row for each collision and each walk, from which the tables' numbers follow."""

import csv
import gzip
from dataclasses import replace
from pathlib import Path

import pytest
from made_detections import write_detections
from made_trials import HIT, LEANS, write_trials

from experiments.records.reactions import TRIALS
from experiments.site.single_rows import COLLISIONS, COLUMNS, FOLDER, WALKS, write_single_rows

Rows = list[dict[str, str]]


@pytest.fixture
def rows(tmp_path: Path) -> tuple[Rows, Rows]:
    """The rows of walks and of collisions of a made-up snapshot."""
    detections = write_detections(tmp_path / "detection", ("all_uncertainty", "robot_1"))
    reactions = write_trials(tmp_path / "reactions", [HIT, replace(LEANS, level="robot_2", seed=241)])
    write_single_rows(detections, reactions, ["foot"], tmp_path)
    walks, collisions = (gzip.decompress((tmp_path / FOLDER / name).read_bytes()) for name in (WALKS, COLLISIONS))
    return list(csv.DictReader(walks.decode().splitlines())), list(csv.DictReader(collisions.decode().splitlines()))


def test_each_walk_has_a_row_with_its_robot_seed_and_impulse(rows: tuple[Rows, Rows]) -> None:
    walks, _ = rows
    assert tuple(walks[0]) == TRIALS
    assert [(row["level"], row["seed"], row["impulse_ns"]) for row in walks] == [
        ("robot_1", "240", "9"),
        ("robot_2", "241", "300"),
    ]


def test_each_collision_has_a_row_for_each_detector_and_rule(rows: tuple[Rows, Rows]) -> None:
    _, collisions = rows
    assert tuple(collisions[0]) == COLUMNS
    own = [
        row
        for row in collisions
        if (row["level"], row["scenario"], row["kind"]) == ("robot_1", "collisions", "largest")
    ]
    found = {
        name: sum(row["delay_s"] != "" for row in own if row["detector"] == name) for name in ("MOB-Net-OR", "MOB")
    }
    assert found == {"MOB-Net-OR": 24, "MOB": 0}  # of 24, as table_09 has it
    assert {row["hit_link"] for row in own} == {"foot", "ankle", "knee"}


def test_the_same_rows_make_the_same_bytes(tmp_path: Path) -> None:
    made = []
    for name in ("a", "b"):
        detections = write_detections(tmp_path / name / "detection", ("robot_1",))
        write_single_rows(detections, write_trials(tmp_path / name, [HIT]), ["foot"], tmp_path / name / "out")
        made.append([(tmp_path / name / "out" / FOLDER / file).read_bytes() for file in (WALKS, COLLISIONS)])
    assert made[0] == made[1]
