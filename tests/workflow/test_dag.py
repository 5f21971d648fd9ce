"""The workflow can be planned at every scale, and a bad configuration stops it with one line."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from mobnet.core.config import load_config, read_yaml
from mobnet.core.methods import experiment_row

from .conftest import ROOT, Snakemake

FOLDERS = (("random_walk", "all_uncertainty"), ("forward_walk", "all_uncertainty"))
SCALES = ("smoke", "default", "paper")
Outputs = Callable[[str], dict[str, str]]


@pytest.mark.parametrize("scale", SCALES)
def test_every_scale_can_be_planned(snakemake: Snakemake, scale: str) -> None:
    done = snakemake("-n", "--forceall", "--config", f"scale={scale}")
    assert done.returncode == 0, done.stderr
    assert {"table", "figure_05"} <= set((done.stdout + done.stderr).split())


@pytest.mark.parametrize("scale", SCALES)
def test_every_method_gets_its_networks(outputs: Outputs, scale: str) -> None:
    config = load_config(ROOT / "configs" / "config.yaml", scale)
    networks = [
        len(experiment_row(config, method, limb)["seeds"])
        for method, row in config["methods"].items()
        for limb in row.get("limbs", [])
    ]
    weights = [name for name in outputs(scale) if name.endswith("weights.safetensors")]
    assert len(weights) == sum(networks)


def test_scales_never_share_a_file(outputs: Outputs) -> None:
    made = [set(outputs(scale)) for scale in SCALES]
    assert not made[0] & made[1]
    assert not made[0] & made[2]
    assert not made[1] & made[2]


def test_main_tables_stand_where_a_reader_looks(snakemake: Snakemake) -> None:
    for target in ("tables/table_05.tex", "figures/figure_05.pdf"):
        assert snakemake("-n", "--forceall", target).returncode == 0


def test_training_and_test_recordings_are_disjoint(outputs: Outputs) -> None:
    sizes = load_config(ROOT / "configs" / "config.yaml", "default")["sizes"]
    paths = [Path(name) for name in outputs("default") if "/recordings/" in name and name.endswith(".parquet")]
    seeds = {folder: sorted(int(p.stem[1:]) for p in paths if p.parent.parts[3:] == folder) for folder in FOLDERS}
    assert seeds[FOLDERS[0]] == [1000 + i for i in range(sizes["train"]["walk"]["shards"])]
    assert seeds[FOLDERS[1]] == [1 + i for i in range(sizes["test"]["shards"])]


def test_the_manifest_lists_every_result(snakemake: Snakemake, outputs: Outputs) -> None:
    """All that the workflow makes but the manifest and what follows it: compute, its pages, runs for wandb."""
    done = snakemake("-n", "--forceall", "--quiet", "host", "--config", "scale=smoke")
    listed = re.findall(r"^rule manifest:\n    input: (.+)$", done.stdout + done.stderr, re.MULTILINE)[0].split(", ")
    views = {name for name, rule in outputs("smoke").items() if rule in ("manifest", "compute", "pages", "wandb_runs")}
    assert set(listed) == set(outputs("smoke")) - views


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        ({"observer": {"gain": 100.0}}, "observer: Additional properties are not allowed ('gain' was unexpected)"),
        ({"scales": {"smoke": {"test": {"shard_s": -1.0}}}}, "scales.smoke.test.shard_s: -1.0"),
        ({"methods": {"MOB-Net": {"limbs": ["LL", "tail"]}}}, "methods.MOB-Net.limbs: 'tail' is not accepted"),
        ({"robot": "configs/robots/none.yaml"}, "configs/robots/none.yaml: file is missing"),
    ],
)
def test_bad_configuration_stops_with_one_line(
    tmp_path: Path, snakemake: Snakemake, edit: dict[str, object], message: str
) -> None:
    (tmp_path / "bad.yaml").write_text(yaml.safe_dump(merged(read_yaml(ROOT / "configs" / "config.yaml"), edit)))
    done = snakemake("-n", "--configfile", str(tmp_path / "bad.yaml"))
    assert done.returncode != 0
    told = [line for line in (done.stdout + done.stderr).splitlines() if "onfig" in line and message in line]
    assert len(told) == 1
    assert "Traceback" not in done.stderr


def merged(old: dict[str, object], new: dict[str, object]) -> dict[str, object]:
    """Return a nested mapping with another laid over it."""
    return old | {
        key: merged(old[key], value) if isinstance(value, dict) and isinstance(old.get(key), dict) else value
        for key, value in new.items()
    }
