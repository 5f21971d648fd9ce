"""Patches of other packages: each is for one version, whose code it fits."""

import inspect
import io
import logging
import shlex
import sys
from importlib.metadata import version
from types import SimpleNamespace

import pytest
import yte
from snakemake import cli, profiles, workflow
from snakemake.scheduling import job_scheduler

from experiments.running import patches
from experiments.running.patches import VERSIONS, by_kind


@pytest.mark.parametrize("package", VERSIONS)
def test_the_installed_version_is_the_one_that_patches_are_for(package):
    """With another one, read the places of its patches again; then name the version in `VERSIONS`, or drop them."""
    assert version(package) == VERSIONS[package]


def test_the_scheduler_has_a_rate_limit_that_can_be_dropped():
    source = inspect.getsource(job_scheduler)
    assert "self.job_rate_limiter = (" in source
    assert "if self.job_rate_limiter is not None:" in source
    made = SimpleNamespace(scheduler=SimpleNamespace(job_rate_limiter=1))
    patches.drop_rate_limit(made)
    assert made.scheduler.job_rate_limiter is None


def test_resources_of_a_kind_are_those_of_its_rules_unless_a_rule_has_its_own():
    assert "_parsed_overwrite_resources" in inspect.getsource(workflow)
    asked = cli.parse_set_resources(["train:runtime=8", "train:gpu=1", "train_b:gpu=0"])
    made = SimpleNamespace(resource_settings=SimpleNamespace(overwrite_resources=asked))
    patches.set_resources_by_kind(made, {"train_a": "train", "train_b": "train", "fit_a": "fit"})
    told = {rule: {name: resource.value for name, resource in row.items()} for rule, row in asked.items()}
    assert told == {rule: {"runtime": 8, "gpu": gpu} for rule, gpu in (("train", 1), ("train_a", 1), ("train_b", 0))}


def test_profiles_are_read_by_the_function_that_is_replaced(monkeypatch):
    assert "process_yaml" in inspect.getsource(profiles) + inspect.getsource(cli)
    monkeypatch.setattr(yte, "process_yaml", yte.process_yaml)
    patches.refuse_code()
    stream = io.StringIO("__use_yte__: true")
    stream.name = "config.yaml"
    with pytest.raises(SystemExit, match=r"config\.yaml: key '__use_yte__' is not accepted; accepted: plain YAML"):
        yte.process_yaml(stream, require_use_yte=True)


def test_the_path_of_python_may_have_spaces(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/my folder/python")
    patches.quote_python()
    assert (sys.executable, patches.python()) == (shlex.quote("/my folder/python"), "/my folder/python")


def record_of(message, **extra):
    record = logging.LogRecord("snakemake", logging.INFO, "", 0, message, None, None)
    vars(record).update(extra)
    return record


def test_rules_of_a_kind_are_one_row_and_all_else_stays():
    stats = {"collect_a": 1, "collect_b": 1, "table_05": 1, "total": 3}
    record = record_of("Job stats: ...", stats=stats)
    assert by_kind({"collect_a": "collect", "collect_b": "collect"})(record)
    assert record.getMessage().splitlines() == ["Job stats:", "collect       2", "table_05      1", "total         3"]
    other = record_of("1 of 3 steps (33%) done")
    assert by_kind({})(other)
    assert other.getMessage() == "1 of 3 steps (33%) done"
