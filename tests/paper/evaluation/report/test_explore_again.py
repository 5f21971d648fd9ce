"""The published page of pushes is written again from what it holds, with its numbers or not at all."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from made_scenes import pushed_scene

from experiments.evaluation.report.explore import as_stored, page_of
from experiments.evaluation.report.explore_again import AGAIN, DATA, TOLD, explore_again, kept_cells, scenes_of
from experiments.plan.products import TEMPLATES
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

REPO = Path(__file__).parents[4]
PUBLISHED = REPO / "docs" / "results"
TEMPLATE = REPO / TEMPLATES / "explore.html"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the published page."""
    shutil.copyfile(PUBLISHED / "explore.html", tmp_path / "explore.html")
    write_json(tmp_path / "provenance.json", {"scale": "default"})
    return tmp_path


def test_torques_of_a_page_are_those_that_were_stored_in_it(robot, settings) -> None:
    own = settings.evaluation
    made = pushed_scene(robot)
    page = page_of({"story": made}, None, own.explore, own.story, settings.detection, own.peaks, robot, TEMPLATE)
    (told,) = TOLD.findall(page)
    (data,) = DATA.findall(page)
    note = {"scenes": json.loads(told)["scenes"]}
    found = scenes_of(note, data)["story"]
    stored = as_stored(made.push, own.explore.step_nm)
    assert list(found.estimates) == list(stored.estimates)
    np.testing.assert_allclose(found.truth, stored.truth, atol=1e-9)
    for method, torque in stored.estimates.items():
        np.testing.assert_allclose(found.estimates[method], torque, atol=1e-9)
    assert all((found.flags[key] == stored.flags[key]).all() for key in found.flags)
    assert (found.start, found.end, found.settled) == (stored.start, stored.end, stored.settled)


def test_the_published_page_is_that_of_the_present_template(settings, folder: Path) -> None:
    """Its recordings stay to the letter; the note says that it was written later."""
    explore_again(settings, folder, TEMPLATE)
    again, published = ((place / "explore.html").read_text() for place in (folder, PUBLISHED))
    assert DATA.findall(again) == DATA.findall(published)
    assert again == published, "python -m experiments.evaluation.report.explore_again writes it again"
    assert read_json(folder / "provenance.json") == {"scale": "default", "explore": AGAIN}
    assert read_json(PUBLISHED / "provenance.json").get("explore") in (AGAIN, None)  # that of a run has no such note


def test_the_page_gives_the_error_that_the_demo_gives() -> None:
    """One push, one window, one number."""
    page = (PUBLISHED / "explore.html").read_text()
    scene = page[page.index('<tbody data-scene="story">') :].split("</tbody>")[0]
    demo = dict(re.findall(r"^(MOB\S*) .*RMSE ([\d.]+) N m over", (REPO / "docs/demo.md").read_text(), re.MULTILINE))
    assert set(demo) == {"MOB", "MOB-fric-dahl", "MOB-Net-pushed"}
    for method, error in demo.items():
        (row,) = re.findall(rf'<tr data-method="{method}">.*?</tr>', scene, re.DOTALL)
        assert f">{error}</td>" in row


def test_a_page_whose_numbers_would_change_is_refused(settings, folder: Path) -> None:
    page = (folder / "explore.html").read_text()
    peak = kept_cells(page)[0][1]
    (folder / "explore.html").write_text(page.replace(f">{peak}</td>", ">1.0</td>", 1))
    before = (folder / "explore.html").read_text()
    with pytest.raises(DataError, match="numbers of its tables would change"):
        explore_again(settings, folder, TEMPLATE)
    assert (folder / "explore.html").read_text() == before
    (folder / "explore.html").write_text("<html></html>")
    with pytest.raises(DataError, match="its recordings are missing"):
        explore_again(settings, folder, TEMPLATE)
