"""A step goes from one touch-down to the next of the other foot, and is measured from the stance foot."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.measure.data.steps import WalkedSteps, ankle_places, measure, read_steps, step_bounds
from experiments.plan.runs import Run
from mobnet.core.errors import DataError
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.robot.nominal import NominalModel

LEG_M, SPACING_M = 0.7, 0.205  # of thigh and shank; between the feet


def gait(feet: str) -> tuple[np.ndarray, np.ndarray]:
    """Return swing flags (T, 2) and commands (T, 5): ten rows a letter, six of them in the air; `-` stands."""
    swing, command = np.zeros((10 * len(feet), 2), dtype=bool), np.ones((10 * len(feet), 5))
    for k, foot in enumerate(feet):
        if foot == "-":
            command[10 * k : 10 * k + 10] = 0.0
        else:
            swing[10 * k + 2 : 10 * k + 8, "LR".index(foot)] = True
    return swing, command


def bounds(feet: str, segments: tuple[tuple[int, int], ...] | None = None) -> list[tuple[int, int, int]]:
    swing, command = gait(feet)
    return list(step_bounds(swing, command, segments or ((0, len(swing)),)))


def test_a_step_goes_from_touch_down_to_touch_down() -> None:
    assert bounds("LRL") == [(8, 18, 1), (18, 28, 0)]
    assert bounds("LRLR", ((0, 20), (20, 40))) == [(8, 18, 1), (28, 38, 1)]  # none crosses a fall


def test_a_step_that_stands_or_repeats_a_foot_is_none() -> None:
    assert bounds("LR-LR") == [(8, 18, 1), (38, 48, 1)]
    assert bounds("LLR") == [(18, 28, 1)]
    assert bounds("--") == []


def posture(nominal: NominalModel, **angles: float) -> np.ndarray:
    """Return generalized positions (1, nq) with some joints turned."""
    q = np.zeros((1, nominal.robot.layout.nq))
    q[0, 3] = 1.0
    for joint, angle in angles.items():
        q[0, NQ_BASE + nominal.robot.layout.actuated.index(joint)] = angle
    return q


def test_a_straight_leg_has_the_closed_form_of_a_circle_about_the_hip(nominal: NominalModel) -> None:
    rest = ankle_places(nominal, posture(nominal))[0][0]
    pitched = ankle_places(nominal, posture(nominal, LL3=0.3))[0][0]
    np.testing.assert_allclose(pitched[0] - rest[0], [-LEG_M * np.sin(0.3), 0, LEG_M * (1 - np.cos(0.3))], atol=1e-12)
    rolled = ankle_places(nominal, posture(nominal, RL2=-0.2))[0][0]
    np.testing.assert_allclose(rolled[1] - rest[1], [0, -LEG_M * np.sin(0.2), LEG_M * (1 - np.cos(0.2))], atol=1e-12)
    np.testing.assert_allclose(rolled[0], rest[0], atol=1e-12)


def test_the_hips_yaw_is_the_feets_yaw(nominal: NominalModel) -> None:
    yaw = ankle_places(nominal, posture(nominal, LL1=0.25, RL1=-0.4))[1][0]
    np.testing.assert_allclose(yaw, [0.25, -0.4], atol=1e-12)


@pytest.mark.parametrize("foot", [0, 1])
def test_steps_of_straight_legs_have_the_closed_form_of_their_hips(nominal: NominalModel, foot: int) -> None:
    side, out = "LR"[foot], (1, -1)[foot]
    for angles, step in (
        ({}, [0, 0, 0]),
        ({f"{side}L3": -0.2}, [LEG_M * np.sin(0.2), 0, 0]),
        ({f"{side}L2": out * 0.1}, [0, out * LEG_M * np.sin(0.1), 0]),
        ({f"{side}L1": 0.3}, [0, 0, 0.3]),
    ):
        moved = measure(nominal, posture(nominal, **angles), np.array([foot]), SPACING_M)
        np.testing.assert_allclose(moved, [step], atol=1e-12)


def test_a_step_is_invariant_to_where_the_robot_is_and_faces(nominal: NominalModel) -> None:
    q = posture(nominal, LL1=0.2, LL3=-0.3, LL4=0.4, RL2=-0.1, RL3=0.2)
    here = measure(nominal, q, np.array([0]), SPACING_M)
    q[0, :7] = [3.0, -2.0, 1.0, np.cos(1.2), 0.0, 0.0, np.sin(1.2)]
    np.testing.assert_allclose(measure(nominal, q, np.array([0]), SPACING_M), here, atol=1e-12)


def test_the_foot_on_the_side_stepped_to_leads() -> None:
    commanded = np.array([[0.0, 0.1, -20.0, 0.7, 0.05], [0.1, 0.1, -20.0, 0.7, 0.05], [0.0, 0.0, 0.0, 0.7, 0.05]])
    steps = WalkedSteps(np.array([0, 1, 0]), commanded, np.zeros(3), np.zeros((3, 40)))
    assert steps.follows(0).tolist() == [False, True, False]
    assert steps.follows(1).tolist() == [True, False, False]
    assert steps.follows(2).tolist() == [False, True, False]
    assert steps.follows(3).all()


def test_files_give_their_steps_in_order(nominal: NominalModel, data_sets: dict[str, list[Path]]) -> None:
    layout = nominal.robot.layout
    parts = [read_steps([stem], layout) for stem in data_sets["motion"]]
    whole = read_steps(data_sets["motion"], layout)
    assert len(whole) == sum(map(len, parts)) > 20
    measured = whole.measured(nominal, SPACING_M)
    np.testing.assert_array_equal(measured, np.concatenate([part.measured(nominal, SPACING_M) for part in parts]))
    np.testing.assert_allclose(measured[:, 3], 0.7)
    assert np.all(whole.commanded[:, 3] >= 0.6)
    assert 5.0 < np.abs(whole.commanded[:, 2]).max() < np.rad2deg(0.3)


def test_recordings_without_a_step_are_named(layout: JointLayout, walk: Callable[..., Run]) -> None:
    with pytest.raises(DataError, match="no step is made"):
        read_steps([walk(1.0).recording], layout)
