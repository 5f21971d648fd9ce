"""A training small enough for a test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.recording import Recording


@dataclass(frozen=True)
class Small:
    """A small configuration and its data on disk."""

    config: dict[str, Any]
    recordings: list[Path]
    residuals: list[Path]


@pytest.fixture
def small(
    full_config: dict[str, Any],
    tmp_path: Path,
    made_up: Callable[..., Recording],
    write_pair: Callable[[Path, Recording], tuple[Path, Path]],
) -> Small:
    networks = full_config["networks"] | {"LL": full_config["networks"]["LL"] | {"hidden": 16, "horizon_steps": 25}}
    learning = full_config["learning"] | {"batch_size": 4, "stream_s": 0.5}
    sizes = {"experiments": {"left_leg": {"epochs": 5, "seeds": [0]}}}
    stems = [write_pair(tmp_path / "data", made_up(seed, 4.0, segments=2)) for seed in (0, 1)]
    config = full_config | {"networks": networks, "learning": learning, "sizes": sizes}
    return Small(config, [a for a, _ in stems], [b for _, b in stems])
