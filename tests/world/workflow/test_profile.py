"""The profile for a SLURM cluster has words that Snakemake and its plug-in know."""

import re

import pytest
import yaml
from snakemake.cli import parse_args

from .conftest import ROOT

PROFILE = ROOT / "workflow" / "profiles" / "slurm" / "config.yaml"
MARKED = re.compile(r"^# (set-resources:|  - )", re.MULTILINE)  # what is to be used on nodes with GPUs
TRAINING = {"train", "train_stack"}


@pytest.fixture
def parsed(tmp_path):
    """Return a function that takes a profile's text apart as Snakemake does."""

    def parse(text):
        (tmp_path / "config.yaml").write_text(text)
        return parse_args(["--profile", str(tmp_path), "--workflow-profile", "none"])[1]

    return parse


def test_snakemake_and_its_plug_in_know_each_word(parsed):
    text = PROFILE.read_text()
    options = parsed(text)
    assert {name.replace("-", "_") for name in yaml.safe_load(text)} <= vars(options).keys()
    assert options.slurm_efficiency_report
    assert options.set_resource_scopes["runtime"] == "local"
    with pytest.raises(SystemExit):
        parsed(text + "slurm-efficiency-reports: true\n")


def test_without_marks_the_block_of_gpus_gives_each_training_one(parsed):
    options = parsed(MARKED.sub(r"\1", PROFILE.read_text()))
    assert options.set_resources.keys() == TRAINING
    for asked in options.set_resources.values():
        assert set(asked) == {"gpu", "slurm_partition", "constraint"}


def test_each_group_of_the_profile_is_one_of_a_rule():
    rules = "\n".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    named = set(re.findall(r'group:\n\s+"(\w+)"', rules))
    grouped = {word.split("=")[0] for word in yaml.safe_load(PROFILE.read_text())["group-components"]}
    assert grouped <= named
