"""The names that programs of others import from `mobnet`: robot, observer, estimators, detectors, and their files.

All units are SI. Generalized positions q (nq,) are those of the base, its place [m] and quaternion w x y z, and the
angles of the joints [rad]. Velocities v (nv,) are those of the base, linear [m/s] in world axes and angular [rad/s] in
its own axes, and of the joints [rad/s]. A robot with a fixed base has its joints alone. A *sample* holds these at one
tick, 1-D arrays; *samples* of T ticks have time as their first axis. `Robot.sample` makes both.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mobnet.core.arrays import check_finite
from mobnet.core.columns import recording_columns
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.errors import MobnetError as MobnetError
from mobnet.core.estimator import Estimate
from mobnet.core.place import check_extra
from mobnet.core.recording import ABSENT, PLANNED, Recording, Sensed, SensedRecording, Truth
from mobnet.detection import contact
from mobnet.detection.contact import Contact
from mobnet.detection.detector import ALARM_RATIO, LegDetector
from mobnet.estimation.observer import ObserverState, RobotObserver
from mobnet.estimation.residual import ResidualEstimator
from mobnet.estimation.sampling import Sampling, check_drives, check_sampling, estimator_of
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import ContactNumbers, Strategy
from mobnet.kernel.drive import TorqueKind
from mobnet.reaction.handler import Handler, Reacted
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.reaction.watchers import LegWatcher, LimbWatcher, some
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

if TYPE_CHECKING:
    import pandas as pd
    import pinocchio as pin
    from matplotlib.figure import Figure

    from mobnet.formats.limb_thresholds import LimbThresholds
    from mobnet.settings.lab import Lab

FEW = 8  # joints that a line names
FIELDS = {"acc": "acc_base_in_base"}  # argument of `sample` -> field, where their names differ


@cache
def lab() -> "Lab":
    """Return the configuration of a lab."""
    from mobnet.settings.lab import load_lab

    return load_lab()


class Robot:
    """A robot: the names of its joints and limbs, and its model.

    Attributes:
        name: of its table.
        joints: names of the generalized velocities (nv,); those of a floating base are V1 to V6 and come first.
        motors: names of the joints with a motor (nu,).
        limbs: limb -> names of its joints.
        notes: what its file or its model does not say and what was taken for it, a line each; none of a table.
    """

    def __init__(self, description: RobotDescription) -> None:
        """Take a description; `read` makes one of a file, `from_model` of a model in memory."""
        self.description = description
        self.name = description.name
        self.joints = description.layout.names
        self.motors = description.layout.actuated
        self.limbs = dict(description.layout.groups)
        self.notes = description.notes
        columns = recording_columns(description.layout)
        self._widths = {name: len(columns[name]) for name in Sensed.__dataclass_fields__}  # once, not at each tick

    @classmethod
    def read(cls, path: str | Path) -> "Robot":
        """Read a robot from its table (.yaml), or from a URDF or MJCF file, as `mobnet robot` makes a table of it.

        Raises:
            ConfigError: the table cannot be read, or a value is not accepted.
            DataError: the file is no robot, or a table cannot hold it.
        """
        from mobnet.robot.given import robot_of_file

        return cls(robot_of_file(Path(path)))

    @classmethod
    def from_model(
        cls, model: "pin.Model", limbs: Mapping[str, Sequence[str]] | None = None, name: str | None = None
    ) -> "Robot":
        """Take a robot from a model of Pinocchio that a program holds; joints stay in the model's order.

        Limits, inertia of rotors and limbs that the model does not have are as of a URDF; `notes` tells them.

        Args:
            model: hinges on a base that is fixed, or a free-flyer.
            limbs: limb -> names of its joints, in the model's order and all joints; chains without a branch if None.
            name: of the robot; that of the model if None.

        Raises:
            DataError: a joint is no hinge, or gravity or the base is one that a table cannot hold.
            ConfigError: a name or a number is not accepted, or a joint is in no limb.
        """
        from mobnet.robot.import_model import robot_of_model

        return cls(robot_of_model(model, lab().plant.gravity_m_s2, limbs, name))

    def __repr__(self) -> str:
        """Return what a notebook shows, such as `Robot two-link arm: J1, J2; fixed base`."""
        named = (
            self.motors
            if len(self.motors) <= FEW
            else [f"{limb} ({len(joints)})" for limb, joints in self.limbs.items()]
        )
        return f"Robot {self.name}: {', '.join(named)}; {'floating' if self.description.floating else 'fixed'} base"

    def sample(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau_motor: ArrayLike,
        tau_des: ArrayLike | None = None,
        acc: ArrayLike | None = None,
        swing: ArrayLike | None = None,
        landing: ArrayLike | None = None,
        command: ArrayLike | None = None,
    ) -> Sensed:
        """Return what the robot senses at one tick (1-D arrays), or at T ticks (2-D); what is not given is zero.

        Args:
            q: generalized position (..., nq) [m, -, rad].
            v: generalized velocity (..., nv) [m/s, rad/s].
            tau_motor: torque of the motors behind their gears (..., nu) [N m].
            tau_des: torque that the motors were asked for (..., nu) [N m]; `tau_motor` where it is not given.
            acc: specific force of a floating base (..., 3) [m/s^2], gravity included, in its axes.
            swing: 1 where a foot is planned to be in the air, left and right (..., 2) [-].
            landing: time until it is planned to land (..., 2) [s].
            command: the step that a walking robot makes (..., 5), as in Table 2.

        Raises:
            DataError: an array has another shape, or a number is not finite.
        """
        given = {
            "q": q,
            "v": v,
            "tau_motor": tau_motor,
            "tau_des": tau_motor if tau_des is None else tau_des,
            "acc": acc,
            "swing": swing,
            "landing": landing,
            "command": command,
        }
        values = {}
        for name, array in given.items():
            field = FIELDS.get(name, name)
            wanted = (*np.shape(q)[:-1], self._widths[field])
            taken = np.zeros(wanted) if array is None else np.asarray(array, dtype=np.float64)
            if taken.shape != wanted:
                raise DataError(not_accepted(f"{name}: shape", taken.shape, [wanted]))
            check_finite(name, taken)
            values[field] = taken
        return Sensed(**values)


class Observer:
    """The momentum observer: the residual r of (9), the external torque behind a low-pass, and errors of the model.

    Attributes:
        joints: names of its joints, those of the robot (nv,).
        rate_hz: samples per second [Hz].
    """

    def __init__(
        self, robot: Robot, rate_hz: float, gain_hz: float | None = None, torque: TorqueKind = "sample"
    ) -> None:
        """Make the observer of a robot.

        Args:
            robot: the robot.
            rate_hz: samples per second [Hz].
            gain_hz: gain K_0 [1/s], the inverse of the low-pass's time constant; that of the configuration if None.
            torque: whether `tau_motor` is a `sample` at the tick, or the `mean` over the interval before it.

        Raises:
            ConfigError: a number or a word is not accepted.
        """
        numbers = lab()
        nominal = NominalModel(robot.description, gravity_m_s2=numbers.plant.gravity_m_s2)
        gain_hz = numbers.observer.gain_hz if gain_hz is None else gain_hz
        self.joints = robot.joints
        self.rate_hz = rate_hz
        self._observer = RobotObserver(nominal, gain_hz, rate_hz, torque)

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        return f"Observer: {_joints(self.joints)}, {self.rate_hz:g} Hz, gain {self._observer.gain_hz:g} 1/s"

    def init(self) -> ObserverState:
        """Return the state before the first sample."""
        return self._observer.init()

    def step(self, state: ObserverState, sample: Sensed) -> tuple[ObserverState, NDArray[np.float64]]:
        """Return the state after a sample, and the residual (nv,) [N, N m]."""
        return self._observer.step(state, sample)

    def residual(self, samples: Sensed) -> NDArray[np.float64]:
        """Return the residual of samples without a gap (T, nv) [N, N m], from a fresh state."""
        return self._observer.residual(samples)


class Estimator:
    """The external torque of the joints of some limbs, by observer and networks, eq. (15).

    Attributes:
        joints: names of the estimated joints (n,).
        rate_hz: samples per second, that of the training [Hz].
    """

    def __init__(self, estimator: ResidualEstimator, rate_hz: float) -> None:
        """Take an estimator; `from_folder` reads one."""
        self.joints = estimator.joints
        self.rate_hz = rate_hz
        self._estimator = estimator

    @classmethod
    def from_folder(cls, robot: Robot, folder: str | Path) -> "Estimator":
        """Read the network of a limb, as `mobnet learn` writes it, or a folder of such folders, one for each limb.

        Raises:
            DataError: a file is missing or damaged, a network is another robot's or was trained with other friction
                than that of its table, two are of one limb, or the networks differ in their rate or observer.
        """
        from mobnet.core.files import RUN
        from mobnet.estimation.own import read_network_folder
        from mobnet.learning.deployed.loading import load_limb_networks

        folder = Path(folder)
        layout = robot.description.layout
        numbers = lab()
        folders = [folder] if (folder / RUN).exists() else sorted(path.parent for path in folder.glob(f"*/{RUN}"))
        networks = [read_network_folder(network, layout, numbers) for network in folders or [folder]]
        first = networks[0]
        of_limbs: dict[str, Path] = {}
        for network in networks:
            check_drives(network.folder, network.sampling.drives, robot.description)
            check_sampling(network.folder, network.sampling, first.sampling, first.folder)
            if network.limb in of_limbs:
                text = f"{of_limbs[network.limb]} is of limb {network.limb}, too; accepted: one of each limb"
                raise DataError(f"{network.folder}: {text}")
            of_limbs[network.limb] = network.folder
        together = load_limb_networks(of_limbs, layout)
        gravity_m_s2 = numbers.plant.gravity_m_s2
        return cls(estimator_of(robot.description, gravity_m_s2, first.sampling, together), first.sampling.rate_hz)

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        return f"Estimator: {_joints(self.joints)}, {self.rate_hz:g} Hz"

    def init(self) -> Any:
        """Return the state before the first sample."""
        return self._estimator.init()

    def step(self, state: Any, sample: Sensed) -> tuple[Any, Estimate]:
        """Return the state after a sample, and its estimate: `tau_ext` and `std` (n,) [N, N m]."""
        return self._estimator.step(state, sample)

    def estimate(self, samples: Sensed) -> Estimate:
        """Return the estimate of samples without a gap: `tau_ext` and `std` (T, n) [N, N m], from a fresh state."""
        return self._estimator.estimate(samples)


@dataclass(frozen=True)
class Alarm:
    """What a detector says of a sample.

    Attributes:
        is_on: whether something pushes the limb.
        ratio: of the highest signal to its threshold [-]; zero while the limb is not watched.
        joint: the joint of this signal.
        estimate: external torque of the limb's joints, `tau_ext` and `std` (n,) [N m].
    """

    is_on: bool
    ratio: float
    joint: str
    estimate: Estimate


class Detector:
    """Says, sample by sample, whether something pushes a limb, as `mobnet detect` does for a whole log.

    Attributes:
        joints: names of the limb's joints (n,).
        rate_hz: samples per second [Hz].
    """

    def __init__(self, robot: RobotDescription, estimator: ResidualEstimator, thresholds: "LimbThresholds") -> None:
        """Take the estimator and the thresholds of a limb; `from_files` reads them, `from_free_motion` finds them."""
        self.joints = thresholds.joints
        self.rate_hz = thresholds.rate_hz
        self.thresholds = thresholds
        self._columns = np.array([estimator.joints.index(joint) for joint in thresholds.joints])
        self._estimator, self._watcher = estimator, watcher_of(robot, thresholds, self._columns)
        self.reset()

    @classmethod
    def from_files(cls, robot: Robot, network: str | Path | None, thresholds: str | Path) -> "Detector":
        """Read the network of `mobnet learn`, None for the observer alone, and the thresholds of `mobnet calibrate`.

        Thresholds that are those of the observer alone leave the network out, as `mobnet detect` does.

        Raises:
            ConfigError: a file or a value is not accepted.
            DataError: network, thresholds and robot do not belong together.
        """
        from mobnet.detection.threshold_file import check_thresholds, read_thresholds, sampling_of
        from mobnet.estimation.own import read_network_folder

        numbers = lab()
        path = Path(thresholds)
        description = robot.description
        of_limb = read_thresholds(path)
        network_read = (
            read_network_folder(Path(network), description.layout, numbers) if network and of_limb.network else None
        )
        check_thresholds(path, of_limb, description, network_read)
        sampling = sampling_of(of_limb)
        if network_read:
            check_sampling(path, sampling, network_read.sampling, network_read.folder)
        estimator = estimator_of(
            description, numbers.plant.gravity_m_s2, sampling, network_read and network_read.networks
        )
        return cls(description, estimator, of_limb)

    @classmethod
    def from_free_motion(
        cls,
        robot: Robot,
        samples: Sensed,
        rate_hz: float,
        limb: str | None = None,
        rate_per_h: float = 1.0,
        gain_hz: float | None = None,
        torque: TorqueKind = "sample",
    ) -> "Detector":
        """Find the thresholds of the observer from samples while nothing touches the limb, as `mobnet calibrate` does.

        Args:
            robot: the robot.
            samples: T samples without a gap, of 200 s or more.
            rate_hz: samples per second [Hz].
            limb: the limb; the robot's only one if None.
            rate_per_h: wanted false alarms in an hour [1/h].
            gain_hz: gain K_0 of the observer [1/s]; that of the configuration if None.
            torque: whether `tau_motor` is a `sample` at the tick, or the `mean` over the interval before it.

        Raises:
            DataError: the samples are too few or never change, or the rate of alarms is above what they can hold.
            ConfigError: the limb is unknown, or a number is not accepted.
        """
        from mobnet.detection.limb import OwnRecording, calibrate_limb
        from mobnet.detection.limb_report import thresholds_of
        from mobnet.estimation.estimate import only
        from mobnet.estimation.own import limb_of

        numbers = lab()
        description = robot.description
        limb = limb_of(description.layout, limb)
        gain_hz = numbers.observer.gain_hz if gain_hz is None else gain_hz
        sampling = Sampling(rate_hz, gain_hz, torque, description.drives)
        estimator = estimator_of(description, numbers.plant.gravity_m_s2, sampling, None)
        estimate = only(estimator.estimate(samples), estimator.joints, description.layout.limb(limb))
        absent = () if samples.swing.any() else PLANNED  # without a walking plan a leg is watched all the time
        recording = SensedRecording(samples, ((0, len(samples)),), rate_hz, {ABSENT: absent})
        free = OwnRecording(Path("samples"), recording, estimate)
        calibrated = calibrate_limb([free], description, limb, "mean", rate_per_h, numbers)
        return cls(description, estimator, thresholds_of(calibrated, rate_per_h, numbers, sampling, None))

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        promised = f"false alarms promised: {self.thresholds.rate_per_h:g} 1/h"
        return f"Detector of limb {self.thresholds.limb}: {_joints(self.joints)}, {self.rate_hz:g} Hz, {promised}"

    def reset(self) -> None:
        """Begin anew, as after a gap in the samples."""
        self._state: Any = self._estimator.init()
        self._watched: Any = self._watcher.init()

    def step(self, sample: Sensed) -> Alarm:
        """Take the next sample (1-D arrays); return what it tells."""
        self._state, whole = self._estimator.step(self._state, sample)
        ratio = self._watcher.ratio(self._watched, sample, whole)
        joint = self.joints[self._watcher.highest(self._watched)]
        return Alarm(ratio > ALARM_RATIO, ratio, joint, some(whole, self._columns))


class ContactFinder:
    """Names where on a limb something presses, and how hard, from the external torques of one sample.

    Attributes:
        joints: names of the joints whose torques it takes (n,).
    """

    def __init__(self, robot: Robot, limb: str, joints: Sequence[str] | None = None) -> None:
        """Find contacts with the bodies of a limb, whose table needs `shapes`; torques are those of its own joints.

        On a floating base give the `joints` of both legs and of the base, which tell much more (docs/detection.md).

        Raises:
            ConfigError: limb or joints are unknown, or the limb has no shapes.
        """
        names = robot.description.layout.limb(limb) if joints is None else tuple(joints)
        numbers = as_plain(lab().contact_point, ContactNumbers)
        self._finder = contact.ContactLocator.of(numbers, robot.description, limb, names)
        self.joints = self._finder.joints

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        return f"ContactFinder: {_joints(self.joints)}"

    def locate(
        self, q: NDArray[Any], tau: NDArray[Any], std: NDArray[Any], standing: Sequence[str] = ()
    ) -> Contact | None:
        """Return the contact that explains external torques; None where no force that presses does.

        Args:
            q: generalized position (nq,) [m, -, rad].
            tau: external torque of the joints (n,) [N m], of V1 to V3 [N].
            std: standard deviation of its error (n,), in the same units; without one, the error that is usual.
            standing: bodies on which the ground acts with a wrench that is not known.

        Returns:
            The body, the `point` in its axes and the `place` in world axes (3,) [m], the `force` on the robot in world
            axes (3,) [N], and `spread_m`, the error of the point to expect [m].

        Raises:
            DataError: torques or standard deviations are not one of each joint.
            ConfigError: a body is unknown.
        """
        return self._finder.locate(q, tau, std, standing)


class ReactionHandler:
    """The pipeline of section 7 in a walking controller: which steps answer a push, sample by sample."""

    def __init__(
        self,
        robot: Robot,
        estimator: Estimator,
        detectors: Sequence[Detector],
        foot_spacing_m: float,
        strategy: Strategy = "compliant",
    ) -> None:
        """Make a handler.

        Args:
            robot: a robot with two legs.
            estimator: of the joints of legs and arms, and of the base.
            detectors: one for each limb that is watched; all take what the estimator says.
            foot_spacing_m: how far apart the controller sets the feet [m].
            strategy: `compliant`, steps along the force, or `rewind`, back on the previous footsteps.

        Raises:
            ConfigError: the estimator lacks a joint that a detector watches.
        """
        from mobnet.settings.reaction import load_reaction

        description = robot.description
        self._estimator = estimator
        self._layout = description.layout
        self._columns = description.layout.columns(estimator.joints)
        watchers = {}
        for detector in detectors:
            if missing := [joint for joint in detector.joints if joint not in estimator.joints]:
                raise ConfigError(not_accepted("joint of a detector", missing[0], estimator.joints))
            columns = description.layout.columns(detector.joints)
            watchers[detector.thresholds.limb] = watcher_of(description, detector.thresholds, columns)
        self._limbs = list(watchers)
        self._handler = Handler(
            description, as_plain(load_reaction(), ReactionNumbers), foot_spacing_m, watchers, strategy
        )
        self.reset()

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        return f"ReactionHandler: watches {', '.join(self._limbs)}"

    def reset(self) -> None:
        """Begin anew."""
        self._state, self._estimated = self._handler.init(), self._estimator.init()

    def step(self, sample: Sensed) -> Reacted | None:
        """Take the next sample (1-D arrays); return a reaction when it begins, else None.

        Returns:
            The `limb` that was hit, the `direction` in which to step, horizontal in the world (2,), the unexpected
            `wrench` on the base (6,) [N, N m], and the `steps` (k, 5): x, y [m], turn [rad], duration [s] and foot
            height [m], as in Table 2; the first one is for the step that is being made.
        """
        self._estimated, estimate = self._estimator.step(self._estimated, sample)
        return self._handler.step(self._state, sample, self._whole(estimate))

    def _whole(self, estimate: Estimate) -> Estimate:
        """Return an estimate of all joints (nv,), zero where there is none."""
        tau = np.zeros(len(self._layout.names))
        tau[self._columns] = estimate.tau_ext
        if estimate.std is None:
            return Estimate(tau)
        std = np.ones(len(tau))
        std[self._columns] = estimate.std
        return Estimate(tau, std)


@dataclass(frozen=True, repr=False)
class LabRecording(SensedRecording):
    """What a robot sensed, with the names of its columns.

    Attributes:
        robot: the robot.
    """

    robot: Robot

    def __repr__(self) -> str:
        """Return what a notebook shows."""
        seconds = len(self.sensed) / self.rate_hz
        parts = f"{len(self.segments)} segment{'s' if len(self.segments) > 1 else ''}"
        return f"Recording of {self.robot.name}: {seconds:.1f} s at {self.rate_hz:g} Hz, {parts}"

    def frame(self) -> "pd.DataFrame":
        """Return a table of pandas: a row for each sample, a column for each signal, the time [s] as index."""
        check_extra("logs")
        from mobnet.robotlog.shown import frame_of

        return frame_of(self, self.robot.description.layout)

    def plot(self) -> "Figure":
        """Return a figure of matplotlib: positions [rad], velocities [rad/s] and torques of the motors [N m]."""
        check_extra("logs")
        from mobnet.robotlog.shown import plot_of

        return plot_of(self, self.robot.motors, FEW)


def _joints(names: Sequence[str]) -> str:
    """Return the names of joints, or how many there are of many."""
    return ", ".join(names) if len(names) <= FEW else f"{len(names)} joints"


def watcher_of(
    robot: RobotDescription, thresholds: "LimbThresholds", columns: NDArray[np.intp]
) -> LegWatcher | LimbWatcher:
    """Return what watches a limb with thresholds, on an estimate in which the limb's joints have these columns."""
    from mobnet.detection.threshold_file import setup_with, watched_of
    from mobnet.detection.watch import LegSetup

    watched = watched_of(thresholds)
    setup = setup_with(thresholds, lab().detection, robot)
    chain = setup.chain(np.array([thresholds.thresholds]))
    if thresholds.watched == "always" or not isinstance(setup, LegSetup):
        return LimbWatcher(watched, chain, columns, round(thresholds.settle_s * thresholds.rate_hz))
    return LegWatcher(LegDetector(watched, setup.gate, chain), columns)


def read_recording(path: str | Path, robot: Robot) -> LabRecording:
    """Read what a robot sensed: `sensed` (T samples), `segments` without a gap as (start, end), `rate_hz`, and `meta`.

    Its `frame()` is a table of pandas, its `plot()` a figure.

    Args:
        path: the file without its ending; both NAME.parquet and NAME.json are read, as `mobnet observe` writes them.
        robot: the robot, whose columns the file must have.

    Raises:
        DataError: a file is missing or damaged, or a column is missing.
    """
    from mobnet.core.recording_file import read_sensed

    read = read_sensed(Path(path), robot.description.layout)
    return LabRecording(read.sensed, read.segments, read.rate_hz, read.meta, robot)


def write_recording(
    path: str | Path,
    robot: Robot,
    samples: Sensed,
    rate_hz: float,
    segments: Sequence[tuple[int, int]] | None = None,
    tau_ext: NDArray[Any] | None = None,
) -> None:
    """Write NAME.parquet and NAME.json, which `mobnet learn`, `calibrate` and `read_recording` take.

    Args:
        path: the file without its ending.
        robot: the robot.
        samples: what it sensed, T samples, as `Robot.sample` makes them.
        rate_hz: samples per second [Hz].
        segments: stretches without a gap, (start, end) each; all samples are one if None.
        tau_ext: external torque where it is known (T, nv) [N, N m]; zero if None.

    Raises:
        DataError: the file cannot be written.
    """
    from mobnet.core.recording_file import write_recording as write_whole

    layout = robot.description.layout
    columns = recording_columns(layout)
    values = {name: np.zeros((len(samples), len(columns[name]))) for name in Truth.__dataclass_fields__}
    if tau_ext is not None:
        values["tau_ext"] = np.asarray(tau_ext)
    spans = ((0, len(samples)),) if segments is None else tuple(segments)
    meta = {"scenario": "log", "level": "robot", "seed": 0}
    write_whole(Path(path), Recording(samples, spans, rate_hz, meta, Truth(**values)), layout)


def export_networks(
    folders: Sequence[str | Path], robot: Robot, out: str | Path, thresholds: Sequence[str | Path] = ()
) -> Path:
    """Write networks as ONNX files, the model of the C library, and their contract, as `mobnet export` does.

    Args:
        folders: of one trained network for each limb.
        robot: the robot.
        out: the folder of what is made.
        thresholds: files of `mobnet calibrate`, one for each limb that is watched.

    Returns:
        The path of the contract.

    Raises:
        DataError: a file is missing or damaged, or networks, thresholds and robot do not belong together.
        ConfigError: thresholds are not accepted.
    """
    paths = [Path(path) for path in folders]
    limits = [Path(path) for path in thresholds]
    check_extra("export")
    from mobnet.export.contract import CONTRACT
    from mobnet.export.export import Given, export_folders  # ONNX, which comes with an extra

    export_folders(paths, robot.description, limits, Given(), lab(), Path(out))
    return Path(out) / CONTRACT
