"""How large the random torque may be: falls an hour of random walking against its amplitude (section 4.3).

The paper makes the random torque "as large as possible until the robot maintains its stability".
`python -m benchmarks.torque_amplitude [--amplitudes 25 50 75 100] [--seconds 900] [--seed 531]` walks on every kind of
terrain with all uncertainty, seeds of development, the same walks for each amplitude.
"""

import argparse
import logging
import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.__main__ import Row, misses, table

from experiments.evaluation.measure.data.random_torque import falls_with
from experiments.plan.jobs import walk_settings
from experiments.settings.load import load_settings
from mobnet.settings.walking import WalkSettings

AMPLITUDES_NM, SECONDS, SEED = (25.0, 50.0, 75.0, 100.0), 900.0, 531
TERRAINS = ("checks", "plates", "slope", "flat")
HOUR_S = 3600.0


def main(amplitudes: Sequence[float] = AMPLITUDES_NM, seconds: float = SECONDS, seed: int = SEED) -> list[Row]:
    """Return a row for each amplitude [N m]: falls an hour."""
    logging.disable(logging.WARNING)  # the lines that tell of falls
    settings = load_settings()
    walked = settings.scenarios["random_walk"].model_copy(update={"terrain": TERRAINS})
    settings = settings.model_copy(update={"scenarios": {**settings.scenarios, "random_walk": walked}})
    walk = walk_settings(settings, "random_walk", "all_uncertainty")
    return [_row(walk, amplitude, seconds, seed) for amplitude in amplitudes]


def _row(walk: WalkSettings, amplitude: float, seconds: float, seed: int) -> Row:
    """Return the falls an hour with one amplitude [N m] on legs and waist."""
    falls = falls_with(walk, seed, amplitude, seconds)
    print(f"{amplitude:g} N m: {falls} falls in {seconds:g} s", file=sys.stderr, flush=True)
    return {"name": f"falls an hour with {amplitude:g} N m", "ours": falls * HOUR_S / seconds, "unit": "1/h"}


def _options() -> dict[str, Any]:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.torque_amplitude", description=(__doc__ or "").split("\n\n")[0]
    )
    parser.add_argument("--amplitudes", type=float, nargs="+", default=AMPLITUDES_NM, help="on legs and waist [N m]")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="simulated time for each amplitude")
    parser.add_argument("--seed", type=int, default=SEED)
    return vars(parser.parse_args())


if __name__ == "__main__":
    shown = main(**_options())
    print(table(shown))
    sys.exit(any(map(misses, shown)))
