"""Walk a scenario and look at it: `python -m experiments.look --help`."""

import argparse
import contextlib
import logging
import math
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path

from experiments.jobs.motions import make_motion
from experiments.plan.jobs import walk_settings
from experiments.running.environment import quieten
from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.sections import accepted_names
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.control.upper_body import UpperBody
from mobnet.core.code import ROOT
from mobnet.core.errors import ConfigError, DrawingError, MobnetError, not_accepted
from mobnet.robot.description import WalkingRobot, dressed
from mobnet.settings.lab import CONFIGS
from mobnet.simulation.clip import check_ending, save_clip
from mobnet.simulation.record import REPORT_WALL_S, read_motion
from mobnet.simulation.render import Pixels, draw_frames, picture_model, save_picture
from mobnet.simulation.simulator import Simulator
from mobnet.simulation.view import LOOKED_FOR_S, SYNC_S, has_display, upright, walk, walk_to_mid_stride, watch

log = logging.getLogger(__name__)
SECONDS, MOTION_S = 10.0, 120.0  # walked, and moved by the upper body, where no time is given
FRAMES_HZ = 12.5  # of a clip
CLIP_WIDTHS = (160, 1920)  # accepted [pixels]
HEIGHT_OF_WIDTH = 0.75
INTERRUPTED = 130  # exit code, as the shell's
DESCRIPTION = """Walk a scenario and look at it. Opens MuJoCo's viewer where there is a display; --picture and --video
draw without one. A robot that falls ends the walk; the exit code is then 1."""


def main(words: list[str] | None = None) -> int:
    """Simulate, show or draw as asked, report steps and falls; return the exit code."""
    quieten(ROOT)
    options = _parse(words)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    try:
        return _look(options)
    except (MobnetError, OSError) as error:  # OSError: a folder that cannot be written
        log.error("error: %s", error)
        return 1
    except KeyboardInterrupt:
        log.error("interrupted; no unfinished file is left")
        return INTERRUPTED


def _parse(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m experiments.look", description=DESCRIPTION)
    parser.add_argument("--scenario", default="forward_walk", help="key of `scenarios` (%(default)s)")
    parser.add_argument("--level", default="all_uncertainty", help="key of `levels` (%(default)s)")
    parser.add_argument("--terrain", help="key of `terrain`; without it, one of the scenario's is drawn")
    parser.add_argument("--seed", type=int, default=1, help="seed of commands, noise, terrain and place (%(default)s)")
    parser.add_argument(
        "--seconds", type=float, help=f"simulated time ({SECONDS:g}; in the viewer: until it is closed)"
    )
    parser.add_argument("--video", type=Path, metavar="FILE", help=".gif, .webp, or .mp4 where there is an ffmpeg")
    parser.add_argument("--width", type=int, default=400, metavar="PIXELS", help="width of the video (%(default)s)")
    parser.add_argument(
        "--picture", type=Path, metavar="FILE", help=".png of the first left step in mid-stride after that time"
    )
    parser.add_argument("--config", type=Path, default=CONFIGS, metavar="FOLDER", help="folder with these keys")
    return parser.parse_args(words)


def _look(options: argparse.Namespace) -> int:
    """Walk as the options say; a machine that cannot draw is no failure, a fall is."""
    _check(options)
    window = not (options.video or options.picture) and has_display()
    seconds = options.seconds or (math.inf if window else SECONDS)
    simulator = _simulator(options, seconds)
    begin = simulator.state.clock
    if window:
        watch(simulator, seconds)
    else:
        _draw(simulator, options, seconds)
    end = "" if upright(simulator) else ", then a fall"
    what = f"{options.scenario}, {options.level}, {simulator.setting.terrain}"
    log.info("%s: %d steps in %.2f s%s", what, simulator.state.steps, simulator.state.clock - begin, end)
    return 1 if end else 0


def _check(options: argparse.Namespace) -> None:
    """Check what argparse does not; a ConfigError names the option."""
    if options.seconds is not None and not 0 < options.seconds < math.inf:
        raise ConfigError(f"--seconds: {options.seconds} is not accepted; accepted: > 0")
    if options.seed < 0:
        raise ConfigError(f"--seed: {options.seed} is not accepted; accepted: >= 0")
    if not CLIP_WIDTHS[0] <= options.width <= CLIP_WIDTHS[1]:
        raise ConfigError(f"--width: {options.width} is not accepted; accepted: {CLIP_WIDTHS[0]} to {CLIP_WIDTHS[1]}")
    if options.picture is not None and options.picture.suffix != ".png":
        raise ConfigError(not_accepted("--picture", options.picture.name, ["NAME.png"]))
    if options.video is not None:
        check_ending(options.video)


def _simulator(options: argparse.Namespace, seconds: float) -> Simulator:
    """Return a started simulator; its upper body moves for the seconds to come, for some time if they have no end."""
    settings = _settings(options)
    motion = settings.scenarios[options.scenario].motion
    upper = None
    if motion is not None:
        moved_s = min(seconds, MOTION_S) + LOOKED_FOR_S
        log.info("%.0f s of motion of the upper body are made first", moved_s)
        upper = _motion(settings, motion, options.seed, moved_s)
    simulator = Simulator(walk_settings(settings, options.scenario, options.level), options.seed, upper)
    simulator.start()
    return simulator


def _settings(options: argparse.Namespace) -> Settings:
    """Return the configuration in which the scenario walks on the terrain that is asked for."""
    settings = load_settings(options.config)
    if options.scenario not in settings.scenarios:
        raise ConfigError(not_accepted("--scenario", options.scenario, settings.scenarios))
    if options.level not in settings.levels:
        raise ConfigError(not_accepted("--level", options.level, settings.levels))
    if options.terrain is None:
        return settings
    accepted = accepted_names(Catalogue(settings))["terrain"]
    if options.terrain not in accepted:
        raise ConfigError(not_accepted("--terrain", options.terrain, accepted))
    # not by an override, which is refused where a scenario draws as another one does
    moved = settings.scenarios[options.scenario].model_copy(update={"terrain": (options.terrain,)})
    return settings.model_copy(update={"scenarios": {**settings.scenarios, options.scenario: moved}})


def _motion(settings: Settings, name: str, seed: int, seconds: float) -> UpperBody:
    """Return a motion of the upper body as the workflow makes it."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / name
        make_motion(settings.seed, settings.robot, settings.motions[name], name, seed, seconds, out)
        return read_motion(out)


def _draw(simulator: Simulator, options: argparse.Namespace, seconds: float) -> None:
    """Walk for the seconds and draw the video and the picture that are asked for; without EGL, walk only."""
    end = simulator.state.clock + seconds
    if options.video:
        with _tolerant():
            save_clip(_frames(simulator, options.width, seconds), FRAMES_HZ, options.video)
    deque(walk(simulator, end - simulator.state.clock, SYNC_S), maxlen=0)  # what no video has walked
    if options.picture:
        if upright(simulator):
            walk_to_mid_stride(simulator)
        with _tolerant():
            save_picture(_seen(simulator), simulator.world.terrain, simulator.world.data.qpos, options.picture)


@contextlib.contextmanager
def _tolerant() -> Iterator[None]:
    """Say what a machine lacks for a drawing, and go on."""
    try:
        yield
    except DrawingError as error:
        log.warning("not drawn: %s", error)


def _seen(simulator: Simulator) -> WalkingRobot:
    """Return the robot of a simulator as pictures show it."""
    return dressed(simulator.robot, simulator.settings.robot.looks)


def _frames(simulator: Simulator, width: int, seconds: float) -> Iterator[Pixels]:
    """Yield the frames of a walk, reporting how many while it takes long; sizes are even, as MP4 asks for."""
    size = width // 2 * 2, round(width * HEIGHT_OF_WIDTH / 2) * 2
    model = picture_model(_seen(simulator), simulator.world.terrain, size)
    reported = time.perf_counter()
    for number, frame in enumerate(draw_frames(model, walk(simulator, seconds, 1 / FRAMES_HZ))):
        yield frame
        if time.perf_counter() - reported > REPORT_WALL_S:
            log.info("%d of %d frames", number + 1, 1 + round(seconds * FRAMES_HZ))
            reported = time.perf_counter()


if __name__ == "__main__":
    sys.exit(main())
