"""Joint ranges and hand speeds are those of the samples looked at."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.core.store import read_array
from mobnet.evaluation.measure.upper_body import upper_body
from mobnet.robot.nominal import NominalModel


def test_ranges_are_those_of_all_recordings(nominal: NominalModel, data_sets: dict[str, list[Path]]) -> None:
    stems = data_sets["motion"]
    found = {(quantity, part): value for quantity, part, value, _ in upper_body(10, stems, nominal)}
    angles = np.concatenate([read_array(stem, ["q.LA2"])[0][::10, 0] for stem in stems])
    joint = next(joint for joint in nominal.robot.joints if joint.id == "LA2")
    assert found["smallest position", "LA2"] == pytest.approx(angles.min())
    assert found["largest position", "LA2"] == pytest.approx(angles.max())
    assert found["upper limit", "LA2"] == joint.range[1]
    share = np.ptp(angles) / np.ptp(joint.range)
    assert found["joint range visited", "LA2"] == pytest.approx(share)
    shares = [found["joint range visited", f"LA{i}"] for i in range(1, 9)]
    assert found["joint range visited", "limb LA"] == pytest.approx(np.mean(shares))
    assert 0 < found["mean hand speed", "left"] < found["largest hand speed", "left"]
