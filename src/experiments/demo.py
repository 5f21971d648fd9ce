"""One push as several methods feel it: `./reproduce demo`, and its estimators for programs of others (docs/demo.md).

Weights, fit and recording are those of the published run (docs/demo); nothing is trained or simulated.
"""

import logging
import sys
from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.story import StoredPush
from experiments.evaluation.report.demo import draw, lines_of, title_of
from experiments.running.environment import quieten
from experiments.running.words import demo_parser
from experiments.settings.load import load_settings
from mobnet.core.code import ROOT
from mobnet.core.errors import MobnetError, not_accepted
from mobnet.core.estimator import TorqueEstimator
from mobnet.core.heartbeat import heartbeat
from mobnet.core.printed import to_output
from mobnet.core.recording import Sensed

DATA = ROOT / "docs" / "demo"
PICTURE = ROOT / "results" / "demo.png"
ENDINGS = (".png", ".pdf", ".svg")
log = logging.getLogger(__name__)


def load(method: str = "MOB-Net-pushed", folder: Path = DATA) -> tuple[TorqueEstimator, Sensed]:
    """Return the estimator of a method, and samples of a walking robot that is pushed, to step through one by one.

    The estimator has `joints` (n,), `init()` and `step(state, sample)`, which returns the next state and an `Estimate`
    with tau_ext and, where the method has one, std (n,) [N m]. Samples are at 1 kHz, their units are those of `Sensed`.

    Raises:
        ConfigError: the method is none of those whose files are stored.
        DataError: a file is missing or damaged.
    """
    push = StoredPush(folder, load_settings())
    return push.estimator(method), push.recording.sensed


def main(words: Sequence[str]) -> int:
    """Run the command; return its exit status."""
    parser = demo_parser()
    options = parser.parse_args(words)
    data = options.data or DATA
    out = options.out or PICTURE
    if out.suffix not in ENDINGS:
        parser.error(not_accepted("--out: ending", out.suffix, ENDINGS))
    output = to_output()
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it warns that it makes its cache of fonts, once
    quieten(ROOT)
    try:
        with heartbeat():
            show(StoredPush(data, load_settings()), out)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    return 1 if output.is_cut else 0


def show(stored: StoredPush, out: Path) -> None:
    """Print what each method shows of a stored push, and write the picture.

    Raises:
        DataError: a file is missing or damaged, or the picture cannot be written.
    """
    log.info("%s", title_of(stored))
    push = stored.scene({method: stored.estimate(method) for method in stored.story.methods})
    for line in lines_of(stored, push):
        log.info("%s", line)
    draw(stored, push, out)
    log.info("%s", out)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
