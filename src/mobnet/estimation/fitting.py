"""The rule `fit`: what a method without networks learns from the training sets."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import write_json
from mobnet.core.methods import method_row
from mobnet.estimation.methods import fitted_kind

log = logging.getLogger(__name__)


def write_fit(
    config: Mapping[str, Any], method: str, training: Mapping[str, Sequence[tuple[Path, Path]]], out: Path
) -> None:
    """Fit a method to training sets and write what `build` of its kind reads, as JSON; section 5.2 fits MOB-fric.

    Args:
        config: resolved configuration.
        method: row of its methods, which names `fitted` limbs.
        training: limb -> stems of the recordings and residuals of the limb's training set.
        out: file to write.

    Raises:
        ConfigError: the method is unknown or is not fitted, or the limbs are not those of its row.
        DataError: a recording is damaged.
    """
    kind, limbs = fitted_kind(config, method), method_row(config, method)["fitted"]
    if set(limbs) != set(training):
        raise ConfigError(not_accepted(f"limbs to fit of method {method}", sorted(training), [sorted(limbs)]))
    write_json(out, kind.fit(config, method, training))
    log.info("%s: %s of %s", out, method, ", ".join(limbs))
