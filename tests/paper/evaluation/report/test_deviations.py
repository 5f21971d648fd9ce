"""The paper's table of deviations is that of docs/deviations.md."""

from pathlib import Path

import pytest

from experiments.evaluation.report.deviations import deviations, markdown_rows, tex_text
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError

REPO = Path(__file__).parents[4]
DOC, MAIN = REPO / "docs/deviations.md", REPO / "paper/main.tex"
CHOICES = {  # that a reader of the paper's text would not expect
    "Robot of sections 5.2 to 7", "What the surrogate robots are not", "Results on the robot", "Learning for the robot",
    "Self-collision, section 4.3",
    "Push on the hand, Table 8 and Figure 12", "Collisions, Table 9",
    "Acceleration of the pelvis", "Output for the spread", "Number format", "Epoch that is kept",
}  # fmt: skip


def test_every_row_of_the_document_reaches_the_paper_in_order(tmp_path: Path) -> None:
    deviations(DOC, tmp_path / "d.tex")
    tex = (tmp_path / "d.tex").read_text()
    places = [tex.index(tex_text(row[0]) + " & ") for row in markdown_rows(DOC.read_text(), "d")]
    assert places == sorted(places)
    assert len(places) > 15


def test_code_is_set_as_code_and_specials_are_escaped() -> None:
    assert tex_text("tau_d of `a_b`, 5 %") == r"tau\_d of \texttt{a\_b}, 5 \%"
    assert tex_text("(note [falls](notes/walking.md#falls)) `a`") == r"(note falls) \texttt{a}"


@pytest.mark.parametrize(
    ("text", "says"),
    [("no table", "no table"), ("|a|b|c|d|\n|---|---|---|---|\n|x|y|z|\n", "3 cells in the row of 'x'")],
)
def test_a_table_that_does_not_fit_is_refused(text: str, says: str) -> None:
    with pytest.raises(DataError, match=says):
        markdown_rows(text, "d.md")


def test_a_missing_document_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"none\.md: file is missing"):
        deviations(tmp_path / "none.md", tmp_path / "d.tex")


def test_choices_about_robots_and_networks_have_a_row() -> None:
    assert {row[0] for row in markdown_rows(DOC.read_text(), "d")} >= CHOICES


def test_terrains_are_told_as_they_are_walked(settings: Settings) -> None:
    terrains = {name: set(scenario.terrain) for name, scenario in settings.scenarios.items()}
    assert (terrains["random_walk"], terrains["random_motion"], terrains["motion_test"]) == ({"checks"},) * 3
    walked = [terrains[name] for name in ("robot_walk", "robot_walk_pushed", "walk_test")]
    assert walked == [{"plates", "slope", "flat"}] * 3
    assert terrains["knee_swing"] == terrains["collisions"] == {"flat"}
    (row,) = (row for row in markdown_rows(DOC.read_text(), "d") if row[0] == "Terrain")
    assert "The legs of the surrogate robots learn on plates, a slope and flat ground" in row[3]
    text = " ".join(MAIN.read_text().split())
    assert "surrogate robots learn from walks over plates of 10\\,mm, a slope of 3$^\\circ$ and flat ground" in text


def test_numbers_of_sentences_are_those_of_the_configuration(settings: Settings) -> None:
    text = " ".join(MAIN.read_text().split())
    hand = settings.pushes["right_hand"]
    assert hand.force_n
    assert hand.moment_nm
    (low, high), (least, most) = hand.force_n, hand.moment_nm
    assert rf"forces of {low:g} to {high:g}\,N with a moment of {least:g} to {most:g}\,N\,m, act on the right" in text
    assert f"a force of {low:g} to {high:g} N, the load" in DOC.read_text()
    assert f"a moment of {least:g} to {most:g} N m" in DOC.read_text()
    drive, sensors = settings.surrogate.drive, settings.surrogate.sensors
    assert f"that of the public model times {drive.dry_scale:g}, which one number sets" in DOC.read_text()
    least_ms, most_ms = (1000.0 * late for late in sensors.imu_late_s)
    assert f"the inertial sensor is {least_ms:g} to {most_ms:g} ms late" in DOC.read_text()
