"""The worked example of CONTRIBUTING.md: one file and one row make an estimator that keeps the contract."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mobnet.estimation
from mobnet.core.config import check_config
from mobnet.core.errors import ConfigError
from mobnet.core.estimator import Estimator
from mobnet.core.recording import Sensed
from mobnet.estimation.methods import build_estimator

from .checks import CHECKS

ROOT = Path(__file__).parents[2]
LEVEL, RATE_HZ = "all_uncertainty", 1000.0


def example(language: str) -> str:
    """Return the guide's only block of a language."""
    (block,) = re.findall(rf"^ *```{language}\n(.*?)^ *```$", (ROOT / "CONTRIBUTING.md").read_text(), re.DOTALL | re.M)
    return textwrap.dedent(block)


@pytest.fixture(scope="module")
def config() -> dict[str, Any]:
    """The configuration with the example's row, as a user has it in the file."""
    config = yaml.safe_load((ROOT / "configs" / "config.yaml").read_text())
    config["robot"] = str(ROOT / config["robot"])
    config["methods"] |= yaml.safe_load(example("yaml"))
    return config


@pytest.fixture
def added(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The example's file among the modules of the package."""
    (tmp_path / "dead_band.py").write_text(example("python"))
    monkeypatch.setattr(mobnet.estimation, "__path__", [*mobnet.estimation.__path__, str(tmp_path)])
    yield
    sys.modules.pop("mobnet.estimation.dead_band", None)


@pytest.fixture
def estimator(config: dict[str, Any], added: None) -> Estimator:
    return build_estimator(config, "MOB-quiet", {}, LEVEL, RATE_HZ)


def test_one_row_is_a_valid_configuration(config: dict[str, Any]) -> None:
    check_config(config)


@pytest.mark.parametrize("check", CHECKS, ids=[check.__name__ for check in CHECKS])
def test_the_example_keeps_the_contract(
    check: Callable[[Estimator, Sensed], None], estimator: Estimator, sensed: Sensed
) -> None:
    check(estimator, sensed)


def test_the_example_does_what_it_says(config: dict[str, Any], estimator: Estimator, sensed: Sensed) -> None:
    """The residual, nearer to zero by the band's half width."""
    residual = build_estimator(config, "MOB", {}, LEVEL, RATE_HZ).estimate(sensed).tau_ext
    quiet = estimator.estimate(sensed).tau_ext
    width = config["methods"]["MOB-quiet"]["options"]["width_nm"]
    np.testing.assert_allclose(np.abs(residual - quiet), np.minimum(np.abs(residual), width), atol=1e-9)


def test_without_its_file_the_kind_is_named(config: dict[str, Any]) -> None:
    with pytest.raises(
        ConfigError, match="kind of method MOB-quiet: 'dead_band' is not accepted; accepted: band_pass, "
    ):
        build_estimator(config, "MOB-quiet", {}, LEVEL, RATE_HZ)


def test_the_example_is_in_the_house_style(tmp_path: Path) -> None:
    """What a newcomer copies passes the linter."""
    path = tmp_path / "dead_band.py"
    path.write_text(example("python"))
    for check in (["check"], ["format", "--check"]):
        command = [sys.executable, "-m", "ruff", *check, "--config", str(ROOT / "pyproject.toml"), str(path)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
