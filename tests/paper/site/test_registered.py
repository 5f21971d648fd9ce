"""What was fixed before the published run: the configuration is the registered one, but for words."""

from pathlib import Path

import pytest

from experiments.settings.load import load_settings
from experiments.site.registered import (
    check_registered,
    fingerprints,
    registered,
    registration,
)
from experiments.site.snapshot import note_entry
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

REPO = Path(__file__).parents[3]
SETTINGS = load_settings(overrides={"scale": "default"})
CLAIM = SETTINGS.claims["mob-net-cut"]


def test_configuration_is_the_registered_one() -> None:
    check_registered(SETTINGS)


def test_published_results_are_of_what_was_registered() -> None:
    note = read_json(REPO / "docs" / "results" / "provenance.json").get("registered", {})
    first = (REPO / "CHANGELOG.md").read_text().split("\n## ")[1]
    if note and not first.startswith("Not released"):  # of a release, after which work goes on
        assert {name: note[name] for name in registered()} == registered()


def test_words_may_change_and_numbers_may_not() -> None:
    reworded = SETTINGS.claims | {"mob-net-cut": CLAIM.model_copy(update={"says": "The same in better English."})}
    assert fingerprints(SETTINGS.model_copy(update={"claims": reworded})) == fingerprints(SETTINGS)
    widened = SETTINGS.claims | {"mob-net-cut": CLAIM.model_copy(update={"published": 0.9})}
    changed = SETTINGS.model_copy(update={"claims": widened})
    assert fingerprints(changed)["claims"] != fingerprints(SETTINGS)["claims"]
    with pytest.raises(DataError, match=r"registered\.json: claims differ from configs"):
        check_registered(changed)


def test_note_of_a_snapshot_names_what_was_registered(tmp_path: Path) -> None:
    write_json(tmp_path / "provenance.json", {"scale": "default"})
    note_entry(tmp_path, "registered", registration())
    note = read_json(tmp_path / "provenance.json")
    assert note["registered"] == {"commit": note["registered"]["commit"], **registered()}
    assert note["scale"] == "default"
