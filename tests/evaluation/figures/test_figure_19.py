"""Figure 19 shows samples of the recordings, evenly thinned and the same in every run."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.store import read_array
from mobnet.evaluation.figures.figure_19 import figure_19, read_dots
from mobnet.evaluation.measure.windows import Pushed

Sets = dict[str, list[str]]


def test_dots_are_samples_in_the_order_of_time(data_sets: Sets) -> None:
    stems = list(map(Path, data_sets["walk"]))
    dots = read_dots(stems, ["LL3", "LL4"], 100)
    whole = np.concatenate([read_array(stem, ["v.LL3", "tau_des.LL3", "v.LL4", "tau_des.LL4"])[0] for stem in stems])
    assert dots.shape == (100, 2, 2)
    np.testing.assert_array_equal(dots.reshape(100, 4), whole[::40])


def test_a_test_without_pushes_gives_no_dots(data_sets: Sets) -> None:
    assert read_dots([Path(data_sets["test"][0])], ["LL3"], 10, Pushed("LL3", 1e6, 0.1)).shape == (0, 1, 2)


def test_every_set_has_the_dots_asked_for(tmp_path: Path, config: dict[str, Any], data_sets: Sets) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    tests = [{"scenario": "walk_test", "recordings": data_sets["test"]}]
    figure_19(config, training, tests, tmp_path)
    rows = list(csv.DictReader((tmp_path / "figure_19.csv").read_text().splitlines()))
    counts = {
        key: sum((row["set"], row["joint"]) == key for row in rows) for key in {(r["set"], r["joint"]) for r in rows}
    }
    assert counts == {(name, joint): 12 for name in training for joint in ("LL2", "LL3")} | {
        ("walk_test", joint): 8 for joint in ("LL2", "LL3")
    }
    assert (tmp_path / "figure_19.png").read_bytes().startswith(b"\x89PNG")


def test_an_unknown_joint_is_named(data_sets: Sets) -> None:
    with pytest.raises(DataError, match=r"v\.XX1"):
        read_dots([Path(data_sets["walk"][0])], ["XX1"], 5)
