"""Indexing a recording's parts keeps all fields aligned in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields

import numpy as np

from mobnet.core.recording import Recording, Sensed, Truth


def test_slicing_takes_the_same_rows_of_every_field(made_up: Callable[..., Recording]) -> None:
    recording = made_up(seconds=0.1)
    rows = slice(20, 50)
    for part in (recording.sensed, recording.truth):
        for name, value in vars(part).items():
            np.testing.assert_array_equal(getattr(part[rows], name), value[rows], err_msg=name)
    assert len(recording.sensed[rows]) == 30


def test_spans_are_the_segments(made_up: Callable[..., Recording]) -> None:
    recording = made_up(seconds=0.1, segments=3)
    assert [(span.start, span.stop) for span in recording.spans()] == list(recording.segments)
    assert sum(span.stop - span.start for span in recording.spans()) == len(recording.sensed)


def test_an_estimator_cannot_reach_the_truth() -> None:
    assert not {field.name for field in fields(Sensed)} & {field.name for field in fields(Truth)}
