"""The tables of docs/runtime.md name every key."""

import json
import re
from pathlib import Path

from mobnet.export.contract import Contract, NetworkContract
from mobnet.formats.limb_thresholds import LimbThresholds

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "runtime.md").read_text()


def keys_below(heading):
    """Return the keys in the first column of the tables below a heading, or below words of the page."""
    part = re.split(r"\n## |\nA network has\n|\nA detector has ", PAGE.split(heading)[1])[0]
    rows = [line.split("|")[1] for line in part.splitlines() if line.startswith("| `")]
    return set(re.findall(r"`(\w+)`", "".join(rows)))


def test_the_page_names_every_key_of_the_contract(demo):
    contract = json.loads((demo / "contract.json").read_text())
    assert keys_below("## The contract\n") == set(contract) == set(Contract.model_fields)
    assert keys_below("\nA network has\n") == set(NetworkContract.model_fields)
    inner = {*contract["networks"][0]["inputs"][0], "formula", *contract["networks"][0]["outputs"][0]}
    assert all(f"`{key}`" in PAGE for key in {*inner, *contract["observer"]})


def test_the_page_names_the_keys_of_a_detector_that_a_program_needs():
    part = PAGE.split("\nA detector has ")[1].split("\n## ")[0]
    used = {"limb", "joints", "signal", "thresholds", "low_pass_hz", "hold_s", "settle_s", "watched"}
    assert used <= set(LimbThresholds.model_fields)
    assert all(f"`{key}`" in part for key in used)
