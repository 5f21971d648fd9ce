"""What hosts, archives and indexes read agrees with the citation, the published network and the test command."""

import json
import re
from pathlib import Path

import pytest
import yaml

from experiments.site import deposit, model_card
from mobnet.core.errors import DataError

ROOT = Path(__file__).parents[3]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text())


@pytest.mark.parametrize(("path", "made"), [(deposit.CODEMETA, deposit.codemeta), (deposit.ZENODO, deposit.zenodo)])
def test_what_archives_read_is_made_from_the_citation(path, made):
    assert json.loads((ROOT / path).read_text()) == made(CITATION)


def test_another_version_changes_both_files():
    newer = {**CITATION, "version": "9.8.7"}
    assert deposit.codemeta(newer)["version"] == deposit.zenodo(newer)["version"] == "9.8.7"


def test_the_model_card_is_that_of_the_stored_network_and_of_the_published_tables():
    card = model_card.card(ROOT / model_card.DEMO, ROOT / model_card.RESULTS)
    assert (ROOT / model_card.CARD).read_text() == card
    run = json.loads(next((ROOT / "docs/demo/networks").glob("*/run.json")).read_text())
    assert f"{run['parameters']:,} parameters" in card
    assert run["provenance"]["commit"] in card


def test_a_folder_without_one_network_is_one_line(tmp_path):
    with pytest.raises(DataError, match=r"0 networks are not accepted; accepted: one, with run\.json"):
        model_card.card(tmp_path, ROOT / model_card.RESULTS)


def test_a_code_host_runs_the_test_command_in_the_image_of_the_container():
    path = ROOT / ".github" / "workflows" / "tests.yml"
    host = yaml.load(path.read_text(), yaml.BaseLoader)  # as text: YAML 1.1 takes `on` for a boolean
    (job,) = host["jobs"].values()
    commands = [step["run"] for step in job["steps"] if "run" in step]
    assert commands[-1] == ".ci/run"
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111
    assert f"\nFROM {job['container']}\n" in (ROOT / "Dockerfile").read_text()
    assert set(host["on"]) == {"push", "pull_request", "workflow_dispatch"}
    assert int(job["timeout-minutes"]) >= 90


def test_tables_of_foreign_robots_name_a_licence_whose_text_is_here_and_in_the_wheel():
    marked = {}
    for path in sorted((ROOT / "configs" / "robots").glob("*.yaml")):
        found = re.search(r"^# SPDX-License-Identifier: (\S+)$", path.read_text(), re.MULTILINE)
        if found:
            marked[path.stem] = found[1]
            assert re.match(r"# SPDX-FileCopyrightText: \S", path.read_text())
    assert set(marked) == {"panda", "g1"}
    texts = {path.stem for path in (ROOT / "LICENSES").glob("*.txt")}
    assert texts == set(marked.values())
    assert 'license-files = ["LICENSE", "LICENSES/*.txt"]' in (ROOT / "pyproject.toml").read_text()
