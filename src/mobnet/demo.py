"""`mobnet demo`: a push on a walking robot, as the observer alone and a trained network estimate it.

Recording and network come with the package, from the published run; nothing is trained or simulated.
"""

import logging
from collections.abc import Iterator, Sequence

import numpy as np

from mobnet.commands import demo_parser
from mobnet.core.columns import EXTERNAL, PUSH_TORQUE, named
from mobnet.core.place import DEMO
from mobnet.core.printed import printed
from mobnet.core.store import read_array
from mobnet.estimation import observer
from mobnet.interface import Estimator, Observer, Robot, lab, read_recording
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import describe
from mobnet.robotlog.pieces import root_mean_square

NETWORK = DEMO / "networks" / "MOB-Net-pushed-LL"
RECORDING = DEMO / "recording"
log = logging.getLogger(__name__)


def lines() -> Iterator[str]:
    """Yield what the command prints."""
    numbers = lab()
    robot = Robot(describe(numbers.robot))
    recording = read_recording(RECORDING, robot)
    samples = recording.sensed
    rate_hz = recording.rate_hz
    estimator = Estimator.from_folder(robot, NETWORK)
    joints = list(estimator.joints)
    places = [robot.joints.index(joint) for joint in joints]
    residual = Observer(robot, rate_hz, torque=numbers.observer.torque).residual(samples)[:, places]
    estimate = estimator.estimate(samples).tau_ext
    layout = robot.description.layout
    gain_hz = numbers.observer.gain_hz
    external = low_pass(read_array(RECORDING, named(EXTERNAL, joints), layout)[0], gain_hz, rate_hz)
    push = low_pass(read_array(RECORDING, named(PUSH_TORQUE, joints), layout)[0], gain_hz, rate_hz)
    # Observer and network start from zero, and settle meanwhile.
    settled = slice(round(numbers.robotlog.settle_s * rate_hz), None)
    yield f"{len(samples) / rate_hz:.0f} s of a walking humanoid that is pushed at a leg; torques in N m"
    yield f"{'joint':<7}{'largest of the push':>20}{'error of the observer':>23}{'with the network':>18}"
    alone = root_mean_square((residual - external)[settled])
    learned = root_mean_square((estimate - external)[settled])
    for joint, largest, error, rest in zip(joints, np.abs(push).max(axis=0), alone, learned, strict=True):
        yield f"{joint:<7}{largest:>20.1f}{error:>23.1f}{rest:>18.1f}"
    yield f"errors are root mean squares after {numbers.robotlog.settle_s:g} s; files: {DEMO}"


def main(words: Sequence[str]) -> int:
    """Run the command; return its exit status."""
    demo_parser().parse_args(words)
    logging.getLogger(observer.__name__).setLevel(logging.WARNING)  # it tells of each segment
    return printed(log, lines)
