"""The reliability plot draws observed minus nominal coverage, and names the curves that leave the band."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from csv_files import read_table
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from experiments.evaluation.figures.further.reliability import (
    WITHIN,
    curves_of,
    draw_reliability,
    reliability,
)
from experiments.evaluation.figures.style import LOOKS
from experiments.evaluation.measure.learning.calibration import COVERAGE, CRPS
from experiments.evaluation.number.frames import TRUSTED, rows_of, typed
from experiments.settings.settings import Settings

NOMINAL = np.array([0.25, 0.5, 0.75])


def curves(*places: tuple[str, str, str], after: tuple[float, ...] = ()) -> pd.DataFrame:
    """Made-up curves of cases, limbs and methods: 10 points too low as learned, a point too high scaled, or `after`."""
    parts: list[pd.DataFrame] = []
    for number, (case, limb, method) in enumerate(places):
        off = after[number] if after else 0.01
        shares = {"nominal": NOMINAL, "before": NOMINAL - 0.1, "after": NOMINAL + off}
        place = {"curve": number, "case": case, "limb": limb, "name": limb, "method": method}
        parts.append(pd.DataFrame(shares).assign(**place))
    return pd.concat(parts, ignore_index=True)


def coverage(
    scenario: str, limb: str, pushed: str = "", method: str = "MOB-Net", unit: str = "N m"
) -> list[dict[str, Any]]:
    """Made-up measures of three nominal points and a level of the table that is none of them."""
    place = {"scenario": scenario, "level": "robots", "pushed": pushed, "method": method, "limb": limb, "unit": unit}
    rows: list[dict[str, Any]] = []
    for stage in ("before", "after"):
        of = {**place, "joint": "avg", "network_seed": 0, "test_seed": 1, "stage": stage}
        for share, value in ((0.68, 0.6), *zip(NOMINAL, (0.2, 0.5, 0.8), strict=True)):
            rows.append({**of, "metric": COVERAGE, "share": share, "value": value})
        rows.append({**of, "metric": CRPS, "value": 1.0})
    return rows


def drawn_in(axis: Axes) -> list[Line2D]:
    """Return the lines of curves in a panel."""
    return [line for line in axis.lines if len(np.asarray(line.get_xdata())) == len(NOMINAL)]


def test_lines_are_observed_minus_nominal_in_points_as_learned_and_scaled() -> None:
    learned, scaled = draw_reliability(curves(("walk", "LL", "A")), 0.05).axes
    np.testing.assert_allclose(np.asarray(drawn_in(learned)[0].get_ydata()), -10.0)
    np.testing.assert_allclose(np.asarray(drawn_in(scaled)[0].get_ydata()), 1.0)
    low, high = scaled.get_ylim()
    assert low < -10.0
    assert high > 1.0  # all is seen
    (band,) = scaled.patches
    assert (band.get_y(), band.get_height()) == (-5.0, 10.0)  # type: ignore[attr-defined]


def test_a_scaled_curve_that_leaves_the_band_has_its_methods_colour_and_a_name_and_others_are_grey() -> None:
    places = ("walk", "LL", "MOB-Net"), ("hit", "RA", "MOB-Net"), ("hit", "LL", "FTS-e2e")
    learned, scaled = draw_reliability(curves(*places, after=(0.01, -0.2, -0.21)), 0.05).axes
    for axis in (learned, scaled):
        colours = [line.get_color() for line in drawn_in(axis)]
        assert colours == [WITHIN["color"], LOOKS["MOB-Net"].colour, LOOKS["FTS-e2e"].colour]
    assert not learned.texts
    places = {text.get_text(): text.xy[1] for text in scaled.texts}  # type: ignore[attr-defined]
    assert set(places) == {"RA, hit", "LL, hit"}
    assert places["RA, hit"] - places["LL, hit"] == pytest.approx(4.5)  # a point apart, they would overlap


def test_limbs_are_drawn_with_the_name_of_their_case_and_the_neck_is_not(settings: Settings, tmp_path: Path) -> None:
    section = settings.evaluation.calibration
    measures = typed(
        [
            *coverage("walk_test", "LL"),
            *coverage("motion_test", "N"),
            *coverage("motion_test", "LA"),
            *coverage("hand_wrench", "RA", "RA2"),
            *coverage("knee_swing", "LL", "LL3", "FTS-e2e"),
        ],
        TRUSTED,
    )
    made = curves_of(measures, section, NOMINAL.tolist())
    assert "N" not in section.drawn
    first = made.drop_duplicates("curve")
    assert (first["name"] + ", " + first["case"]).tolist() == [
        "LL, in distribution", "N, in distribution", "LA, in distribution",
        f"RA, {section.names['hand_wrench']}", f"LL, {section.names['knee_swing']}",
    ]  # fmt: skip
    np.testing.assert_allclose(rows_of(made, curve=0)["after"], [0.2, 0.5, 0.8])
    reliability(section, measures, NOMINAL.tolist(), tmp_path)
    rows = read_table(tmp_path / "calibration.csv")
    assert {row.limb for row in rows} == {"LL", "N", "LA", "RA"}

    (hit,) = [row for row in rows if row.limb == "RA" and row.nominal == 0.5]
    assert (hit.case, hit.method) == (section.names["hand_wrench"], "MOB-Net")
    assert (hit.before, hit.after) == (0.5, 0.5)


def test_the_two_units_of_the_base_stay_in_the_order_in_which_they_were_measured(settings: Settings) -> None:
    rows = [*coverage("walk_test", "V", unit="N"), *coverage("walk_test", "V", unit="N m")]
    made = curves_of(typed(rows, TRUSTED), settings.evaluation.calibration, NOMINAL.tolist())
    assert made["name"].unique().tolist() == ["V [N]", "V [N m]"]
