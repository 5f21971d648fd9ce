"""What the files of detectors tell where little or nothing was watched."""

import pytest

from experiments.evaluation.measure.detection.results import hours_per_swing
from experiments.evaluation.number.frames import PROMISES, frame_of
from mobnet.core.detections import COLLISION, Promise


def promise(swings: int, hours: float) -> Promise:
    return Promise("MOB", "LL", COLLISION, swings, hours, 1.0, 1.0, 0.2, 5.0)


def test_a_swing_takes_its_share_of_the_hours_of_all_promises() -> None:
    assert hours_per_swing(frame_of([promise(30, 0.5), promise(20, 0.5)], PROMISES)) == pytest.approx(1.0 / 50)


@pytest.mark.parametrize("promises", [[], [promise(0, 0.0)]], ids=["no promise", "no swing"])
def test_where_no_swing_was_promised_it_takes_no_time(promises: list[Promise]) -> None:
    assert hours_per_swing(frame_of(promises, PROMISES)) == 0.0
