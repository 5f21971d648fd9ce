"""The rule `fit`: it fits a method without networks to the training sets."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import write_json
from mobnet.core.joints import JointLayout
from mobnet.estimation.recipe import kind_of, options_of
from mobnet.settings.methods import Method, ObserverSettings
from mobnet.settings.networks import Network

log = logging.getLogger(__name__)


def write_fit(
    layout: JointLayout,
    observer: ObserverSettings,
    method: Method,
    networks: Mapping[str, Network],
    training: Mapping[str, Sequence[tuple[Path, Path]]],
    out: Path,
) -> None:
    """Fit a method to training sets and write what `build` of its kind reads, as JSON; section 5.2 fits MOB-fric.

    For each of the method's `fitted` limbs there are its network of Table 1, whose joints are fitted, and the stems of
    the recordings and residuals of its training set.

    Raises:
        ConfigError: the method's kind is not one that is fitted, or the limbs are not those that the method names.
        DataError: a recording is damaged.
    """
    kind = kind_of(out.stem, method)
    if not hasattr(kind, "fit") or not method.fitted:
        raise ConfigError(
            f"{out}: method of kind {method.kind!r} with `fitted` {list(method.fitted)} is not fitted; "
            "accepted: a kind with a function `fit`, and one or more limbs"
        )
    if set(method.fitted) != set(training):
        raise ConfigError(not_accepted(f"{out}: limbs to fit", sorted(training), [sorted(method.fitted)]))
    write_json(out, kind.fit(layout, observer, options_of(out.stem, method, kind.Options), networks, training))
    log.info("%s is fitted to %s", out.stem, ", ".join(method.fitted))
