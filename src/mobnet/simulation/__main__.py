"""Walk a scenario and look at it: `python -m mobnet.simulation --help`."""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

import numpy as np

from mobnet.core.config import load_config
from mobnet.core.errors import ConfigError, MobnetError
from mobnet.core.recording import recording_width
from mobnet.simulation.record import Simulator
from mobnet.simulation.render import save_picture

log = logging.getLogger(__name__)
MID_STRIDE = 0.6  # of a step's time; the swinging foot is then ahead of the other and still in the air
LOOKED_FOR_S = 3.0  # a left step comes within this time
FRAME_S = 0.01  # between two looks at the stride


def main(words: list[str] | None = None) -> int:
    """Simulate, report steps and falls, and draw the robot in mid-stride if asked; return the exit code."""
    options = _parse(words)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    try:
        return _walk(options)
    except MobnetError as error:
        log.error("error: %s", error)
        return 1


def _parse(words: list[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="python -m mobnet.simulation", description="Walk a scenario and look at it.")
    parser.add_argument("--scenario", default="forward_walk", help="key of `scenarios` in the configuration")
    parser.add_argument("--level", default="all_uncertainty", help="key of `levels` in the configuration")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3.0, help="simulated time")
    parser.add_argument("--picture", type=Path, help="PNG of the first left step in mid-stride after that time")
    parser.add_argument("--config", type=Path, default=Path("configs/config.yaml"))
    return parser.parse_args(words)


def _walk(options: argparse.Namespace) -> int:
    """Walk as the options say; a machine that cannot draw is no failure, a fall is.

    Raises:
        ConfigError: the configuration or an option is not accepted.
    """
    if not options.seconds > 0:
        raise ConfigError(f"--seconds: {options.seconds} is not accepted; accepted: > 0")
    config = load_config(options.config)
    simulator = Simulator(config, options.scenario, options.level, options.seed)
    simulator.start()
    rate = config["rates"]["data_hz"]
    walked = _advance(simulator, wanted := round(options.seconds * rate))
    frames = round(LOOKED_FOR_S / FRAME_S) if options.picture and walked == wanted else 0
    for _ in range(frames):
        if _in_mid_stride(simulator):
            break
        walked += _advance(simulator, round(FRAME_S * rate))
    upright = simulator.world.data.qpos[2] > config["recording"]["fall_height_m"]
    end = "" if upright else ", then a fall"
    log.info("%s, %s: %d steps in %.2f s%s", options.scenario, options.level, simulator.state.steps, walked / rate, end)
    if options.picture is not None:
        terrain = simulator.settings["terrain"]
        save_picture(config, simulator.robot, terrain, simulator.world.data.qpos, options.picture)
    return 0 if upright else 1


def _advance(simulator: Simulator, samples: int) -> int:
    """Simulate some samples that nobody keeps; return how many came before a fall."""
    return simulator.run(np.zeros((samples, recording_width(simulator.robot.layout)), dtype=np.float32))


def _in_mid_stride(simulator: Simulator) -> bool:
    """Return whether the left foot is in the air and ahead of the right one."""
    s = simulator.state
    return s.swinging == 1 and s.side < 0 and s.t > MID_STRIDE * s.total


if __name__ == "__main__":
    sys.exit(main())
