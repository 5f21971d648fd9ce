"""The rule `fit`: which methods it takes, and what it writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.files import read_json
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.estimation.fitting import write_fit
from mobnet.estimation.friction import read_friction


def test_what_it_writes_is_what_the_kind_reads(
    full_config: dict[str, Any],
    layout: JointLayout,
    made_up: Callable[..., Recording],
    write_pair: Callable[[Path, Recording], tuple[Path, Path]],
    tmp_path: Path,
) -> None:
    pair, out = write_pair(tmp_path, made_up(1, 1.0)), tmp_path / "fits" / "MOB-fric.json"
    limbs = full_config["methods"]["MOB-fric"]["fitted"]
    write_fit(full_config, "MOB-fric", {limb: [pair] for limb in limbs}, out)
    fitted = {joint for limb in limbs for joint in layout.limb(limb)}
    assert set(read_json(out)["joints"]) == fitted
    chosen = dict(zip(layout.actuated, read_friction(out, layout.actuated).stribeck, strict=True))
    assert {joint: chosen[joint] for joint in fitted} == {
        joint: row["stribeck_rad_s"] for joint, row in read_json(out)["joints"].items()
    }


@pytest.mark.parametrize("method", ["MOB", "MOB-Net", "MOB-fric-BPF"])
def test_methods_that_are_not_fitted_are_refused(method: str, full_config: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(
        ConfigError, match=f"method to fit: '{method}' is not accepted; accepted: MOB-fric, MOB-fric-load"
    ):
        write_fit(full_config, method, {}, tmp_path / "out.json")


def test_other_limbs_than_the_rows_are_refused(full_config: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"limbs to fit of method MOB-fric: \['LL'\] is not accepted"):
        write_fit(full_config, "MOB-fric", {"LL": []}, tmp_path / "out.json")
