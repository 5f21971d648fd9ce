"""Scores of made-up runs with known errors."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.compare.pair import read_pair
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.measure.estimates.scores import limb_values, score, score_run
from experiments.evaluation.number.rows import read_scores
from experiments.plan.runs import Run
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import Bode, Scoring
from experiments.settings.metrics import METRICS, SECTIONS, metric_of
from experiments.settings.runs import LimbRuns, PushWindow, Runs
from experiments.settings.verdicts import SHUFFLED
from mobnet.core.columns import residual_columns, torque_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.recording_file import read_recording, write_recording
from mobnet.core.rows import read_rows
from mobnet.core.store import read_array, write_array

Walk = Callable[..., Run]
RATE = {"rate_hz": 100.0}


def rows_of(layout: JointLayout, run: Run, asked: Scoring) -> list[Score]:
    """Return the scores of a run, without those of its estimate half a walk late."""
    return [row for row in score_run(run, Scene(run.recording, layout, asked)) if row.method != SHUFFLED]


def values_of(rows: list[Score], metric: str) -> list[float]:
    """Return the values of one metric, in order."""
    return [row.value for row in rows if row.metric == metric]


def around(before_s: float, after_s: float) -> Scoring:
    """Return a window around pushes, and nothing else that is asked for."""
    return Scoring(window=PushWindow(before_s=before_s, after_s=after_s))


def test_constant_error_is_scored_as_that_constant_in_every_joint(walk: Walk, layout: JointLayout) -> None:
    """A closed form."""
    rows = rows_of(layout, walk(-3.0), Scoring())
    assert [row.joint for row in rows if row.metric == "rmse"] == [*layout.limb("LL"), "avg"]
    assert values_of(rows, "rmse") == pytest.approx([3.0] * 7, rel=1e-5)
    named = {(row.limb, row.unit, row.scenario, row.method) for row in rows if row.metric == "rmse"}
    assert named == {("LL", "N m", "forward_walk", "MOB-Net")}


def test_errors_of_mob_net_half_a_walk_late_follow_as_a_control(walk: Walk, layout: JointLayout) -> None:
    """The truth changes in a walk, so that an exact estimate which comes late errs; only its errors are scored."""
    for method in ("MOB-Net", "FTS-e2e"):
        run = walk(0.0, method=method)
        pair = read_pair(run, layout)
        late = pair.estimate[(np.arange(len(pair.estimate)) - len(pair.estimate) // 2) % len(pair.estimate)]
        expected = np.sqrt(np.mean((late - pair.truth) ** 2, axis=0))
        rows = [row for row in score_run(run, Scene(run.recording, layout, Scoring())) if row.method == SHUFFLED]
        found = [row.value for row in rows if row.metric == "rmse" and row.joint != "avg"]
        assert found == pytest.approx(expected if method == "MOB-Net" else [], rel=1e-4)
        assert {row.metric for row in rows} <= {"rmse", "rmse_raw", "rmse_label"}


def test_an_error_against_the_label_stands_beside_that_against_the_truth(walk: Walk, layout: JointLayout) -> None:
    """Where foot sensors label a recording: their error adds to that of the estimate."""
    run = walk(-3.0)
    assert not values_of(rows_of(layout, run, Scoring()), "rmse_label")
    array, meta = read_array(run.residual)
    labelled = np.concatenate([array, array[:, layout.nv :] + 1.0], axis=1)
    write_array(run.residual, labelled, residual_columns(layout, labelled=True), RATE, meta["segments"])
    rows = rows_of(layout, run, Scoring())
    assert values_of(rows, "rmse") == pytest.approx([3.0] * 7, rel=1e-5)
    assert values_of(rows, "rmse_label") == pytest.approx([4.0] * 7, rel=1e-5)


def test_a_constant_error_does_not_change_the_roughness(walk: Walk, layout: JointLayout) -> None:
    """Invariant under an offset of the estimate."""
    one, two = (values_of(rows_of(layout, walk(error), Scoring()), "roughness") for error in (0.5, 4.0))
    assert one == pytest.approx(two, rel=1e-4)


def test_average_is_the_mean_of_the_joints_and_base_units_stay_apart(layout: JointLayout) -> None:
    rows = limb_values(layout, {"V1": 3.0, "V2": 5.0, "V4": 1.0, "LL1": 2.0, "LL2": 4.0})
    averages = {(limb, unit): value for limb, joint, value, unit in rows if joint == "avg"}
    assert averages == {("V", "N"): 4.0, ("V", "N m"): 1.0, ("LL", "N m"): 3.0}


def test_order_of_rows_is_that_of_the_runs(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    score(layout, [walk(1.0), replace(walk(2.0), test_seed=2)], Scoring(), tmp_path / "scores.csv")
    rows = read_rows(tmp_path / "scores.csv", Score)
    half = len(rows) // 2
    assert [row.test_seed for row in rows] == [1] * half + [2] * half
    assert [row.joint for row in rows[:half]] == [row.joint for row in rows[half:]]


def test_a_limb_whose_network_has_run_under_an_earlier_seed_counts_once(walk: Walk, layout: JointLayout) -> None:
    first, again = walk(1.0), replace(walk(1.0), network_seed=1, repeated=("LL",))
    assert {row.limb for row in rows_of(layout, first, Scoring())} == {"LL"}
    assert not rows_of(layout, again, Scoring())


def test_files_that_do_not_belong_together_are_refused(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    run, stem = walk(1.0), tmp_path / "std"
    write_array(stem, np.ones((560, 1)), [("std.LL1", "N m", "joint")], RATE)
    for changed, says in (
        (
            replace(run, residual=walk(1.0, steps=3).residual),
            r"rows: 560 is not accepted; accepted: 420, as in .*residual\.json",
        ),
        (replace(run, estimate=stem), r"no column tau_ext\.<joint>; it holds std\.LL1"),
        (replace(run, residual=stem), r"column 'tau_ext_lp\.LL1' is missing"),
    ):
        with pytest.raises(DataError, match=says):
            rows_of(layout, changed, Scoring())


def test_pushes_are_scored_each_and_together(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    run, rows = walk(2.0), np.arange(560)
    pushed = np.isin(rows, [*range(100, 110), *range(300, 330)])
    error = np.where(rows < 200, 1.0, 3.0) * pushed
    raw = np.column_stack([pushed, np.zeros((len(rows), layout.nv))])  # the truth before the low-pass is zero
    columns = [("pushed", "-", "scenario"), *torque_columns(layout, ["tau_ext"], layout.names)]
    write_array(tmp_path / "recording", raw, columns, RATE)
    truth, _ = read_array(run.residual, ["tau_ext_lp.LL3"])
    write_array(tmp_path / "e", truth + error[:, None], [("tau_ext.LL3", "N m", "joint")], RATE)
    run = replace(run, recording=tmp_path / "recording", estimate=tmp_path / "e")
    scored = rows_of(layout, run, around(0.0, 0.0))
    values = {row.metric: row.value for row in scored if row.joint == "LL3"}
    assert values["rmse_raw"] == pytest.approx(np.sqrt(np.mean((truth[:, 0] + error) ** 2)), rel=1e-5)
    expected = {"rmse_push_1": 1.0, "rmse_push_2": 3.0, "rmse_pushed": 7.0**0.5, "rmse": (280 / 560) ** 0.5}
    assert {name: values[name] for name in expected} == pytest.approx(expected, rel=1e-5)
    wide = rows_of(layout, run, around(0.1, 0.2))
    assert values_of(wide, "rmse_push_1")[0] == pytest.approx(0.5, rel=1e-5)


def test_without_a_push_or_a_window_there_is_no_row_of_pushes(walk: Walk, layout: JointLayout) -> None:
    for run, asked in ((walk(2.0, calm=True), around(0.1, 0.2)), (walk(2.0), Scoring())):
        assert {row.metric for row in rows_of(layout, run, asked)} == {"rmse", "rmse_raw", "roughness", "r_rmse"}


def test_relative_error_is_a_percentage_and_left_out_where_there_is_no_torque(
    tmp_path: Path, walk: Walk, layout: JointLayout
) -> None:
    names = [f"tau_ext_lp.LL{k}" for k in range(1, 7)]
    residual, _ = read_array(walk(3.0).residual, names)
    residual[:, 2] = 0.0
    write_array(tmp_path / "r", residual, [(name, "N m", "joint") for name in names], RATE)
    scored = rows_of(layout, replace(walk(3.0), residual=tmp_path / "r"), Scoring())
    rows = [row for row in scored if row.metric == "r_rmse"]
    assert [row.joint for row in rows] == ["LL1", "LL2", "LL4", "LL5", "LL6", "avg"]
    assert {row.unit for row in rows} == {"%"}
    assert rows[0].value == pytest.approx(300.0 / np.abs(residual[:, 0]).max(), rel=1e-5)


def test_every_metric_that_a_run_can_write_passes_the_reader(
    tmp_path: Path, walk: Walk, layout: JointLayout, evaluation: Evaluation
) -> None:
    """All sections ask for one walk that is pushed, labelled and has standard deviations: no metric is left out."""
    test = {"scenario": "forward_walk", "level": "all_uncertainty", "methods": ("MOB-Net",)}
    limbs, drift = {"tests": (LimbRuns(**test, limbs=("LL",)),)}, {"tests": {"it": Runs(**test)}}
    own = {name: drift if name == "drift" else limbs for name in SECTIONS if name != "bode"}
    sections = {name: getattr(evaluation, name).model_copy(update=shown) for name, shown in own.items()}
    sections["changed"] = sections["changed"].model_copy(update={"window_s": 2.0})
    sections["bode"] = Bode(**test, limb="LL", shown=("LL3",), bands_hz=(0.5, 2.0))
    window = PushWindow(before_s=0.1, after_s=0.2)
    numbers = {"touch_down_s": 0.1, "stuck_rad_s": 0.1, "cover_share": 0.68, "lines": {"LL3": (0.5, 2.0)}}
    run = walk(-3.0, steps=8, std=2.0)
    walked = read_recording(run.recording, layout)
    pushed = replace(walked.truth, tau_push=20.0 * walked.truth.pushed * np.ones(layout.nv))
    write_recording(run.recording, replace(walked, truth=pushed), layout)
    array, meta = read_array(run.residual)
    labelled = np.concatenate([array, array[:, layout.nv :] + 1.0], axis=1)
    columns = residual_columns(layout, labelled=True)
    write_array(run.residual, labelled, columns, {**RATE, "gain_hz": 20.0}, meta["segments"])
    score(layout, [run], Scoring(window=window, sections=sections, **numbers), tmp_path / "scores.csv")
    written = {metric_of(row.metric) for row in read_scores(tmp_path / "scores.csv")}
    assert [metric.names for metric in METRICS if metric not in written] == []
