"""The C library gives the numbers of this project: residual, estimate and flags, for both kinds of base."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from c_library import OK, Runtime, load, make

from mobnet.core.estimator import Estimate
from mobnet.detection.detector import ALARM_RATIO, GateSignal, LegDetector, LegGate, run_over
from mobnet.detection.signals import Watched
from mobnet.estimation.observer import RobotObserver
from mobnet.estimation.residual import ResidualEstimator
from mobnet.export.model_file import RuntimeDetector, write_model_file
from mobnet.formats.parts import FrictionRow
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers, WatchedSignals
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import deployed
from mobnet.learning.deployed.tensors import GRU_TENSORS
from mobnet.reaction.watchers import LimbWatcher
from mobnet.robot.nominal import NominalModel

from .conftest import GAIN_HZ, GRAVITY, RATE_HZ, chain_of, changed, moving, network_of

EXACT, SINGLE = 1e-9, 1e-5  # shares of the largest number: of double precision, of single precision


def agree(found, wanted, share):
    np.testing.assert_allclose(found, wanted, rtol=0, atol=share * np.abs(wanted).max())


def run(runtime, sensed):
    """Step through samples; return residual, mean, std, torque (T, nv) each, and ratio, signal, watched (T, n, 3)."""
    found, alarms = [], []
    for k in range(len(sensed)):
        assert runtime.step(sensed[k]) == OK
        found.append([runtime.told(name) for name in ("residual", "mean", "std", "tau_ext")])
        alarms.append(runtime.alarms())
    return *np.moveaxis(np.array(found), 1, 0), np.array(alarms)


def estimated(estimator, sensed):
    """Return the estimate of stepping through samples, (T, n)."""
    state, steps = estimator.init(), []
    for k in range(len(sensed)):
        state, estimate = estimator.step(state, sensed[k])
        steps.append(estimate)
    return Estimate(*(np.array([getattr(one, name) for one in steps]) for name in ("tau_ext", "std", "uncertainty")))


def detected(detector, sensed, estimate):
    """Return ratio, signal and whether the leg is watched, of stepping a detector through an estimate, (T, 3)."""
    state, found = detector.init(), []
    for k in range(len(sensed)):
        own = Estimate(estimate.tau_ext[k], estimate.std[k])
        alarm = detector.step(state, sensed[k], own, own.tau_ext)
        watched = state.gate["air"] >= detector.gate.gate.lift_off and not state.gate["landed"]
        found.append((alarm.ratio, alarm.signal, watched and sensed[k].landing[detector.gate.foot] > 0.03))
    return np.array(found, dtype=float)


@pytest.mark.parametrize("torque", ["mean", "sample"])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_residual(runtime, observer_of, machine, torque):
    observer = observer_of(machine, torque)
    sensed = moving(observer.nominal.robot.layout, 500)
    residual, _, _, tau, _ = run(runtime(observer), sensed)
    agree(residual, observer.residual(sensed), EXACT)
    np.testing.assert_array_equal(tau, residual)


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_residual_with_friction_of_the_drives(runtime, observer_of, machine):
    """Both smooth signs, load, offset and scale; a joint of the table may have none of them."""
    plain = observer_of(machine, "sample")
    robot = plain.nominal.robot
    rubbing = {"coulomb_nm": 3.0, "viscous_nms": 0.7, "load": 0.1, "offset_nm": -0.4, "scale": 1.1}
    shapes = [{"smoothing_rad_s": 0.05}, {"smoothing_rad_s": 1.0, "breakaway_rad": 0.02}]
    rows = {joint: FrictionRow(**rubbing, **shapes[k % 2]) for k, joint in enumerate(robot.layout.actuated) if k != 2}
    nominal = NominalModel(replace(robot, friction=rows), plain.nominal.mass_ratio, GRAVITY)
    observer = RobotObserver(nominal, GAIN_HZ, RATE_HZ, "sample")
    sensed = moving(robot.layout, 500)
    residual, _, _, _, _ = run(runtime(observer), sensed)
    agree(residual, observer.residual(sensed), EXACT)
    assert np.abs(residual - plain.residual(sensed))[100:, -robot.layout.nu :].max() > 1.0


def test_the_stored_push(runtime, push, published, felt):
    """A published network, its thresholds and gate on the recording of the demo."""
    estimator, row = push.estimator("MOB-Net-pushed"), push.row
    chain, gate = push.chain, push.gate
    watching = RuntimeDetector("LL", push.joints, row.signals, chain, gate)
    sensed, columns = push.recording.sensed, push.robot.layout.columns(push.joints)
    residual, mean, std, tau, alarms = run(runtime(estimator._observer, [published], [watching]), sensed)
    agree(residual, estimator._observer.residual(sensed), EXACT)
    agree(tau[:, columns], felt.tau_ext, SINGLE)
    np.testing.assert_allclose(std[:, columns], felt.std, rtol=SINGLE)
    agree(mean[:, columns], residual[:, columns] - felt.tau_ext, SINGLE)
    flags = detected(LegDetector(Watched(as_plain(row, WatchedSignals)), gate, chain), sensed, felt)
    level = flags[:, 0].max() / 2  # the push of the demo may raise no alarm
    assert level > 0.1
    for ratio in (level, ALARM_RATIO):
        np.testing.assert_array_equal(alarms[:, 0, 0] > ratio, flags[:, 0] > ratio)
    np.testing.assert_array_equal(alarms[:, 0, 1:], flags[:, 1:])
    agree(alarms[:, 0, 0], flags[:, 0], SINGLE)


@pytest.mark.parametrize("foot", ["as planned", "told to be in the air"])
def test_gate_of_both_legs_on_a_walk(runtime, push, settings, foot):
    """Where the plan has a foot in the air that stands, the gate finds the ground; so does the library's."""
    observer, sensed = push.estimator("MOB")._observer, push.recording.sensed
    if foot != "as planned":
        still = np.arange(len(sensed))[:, None] % 700 < 600
        told = np.repeat(still.astype(float), 2, axis=1)
        sensed = changed(sensed, swing=told, landing=0.14 * told)
    residual, found = observer.residual(sensed), []
    gates = {
        limb: LegGate.of(as_plain(settings.detection.gate, GateNumbers), push.robot, limb, RATE_HZ)
        for limb in ("LL", "RL")
    }
    row, chain = (
        WatchedSignals(signals=("mean",), phases=4),
        chain_of(np.linspace(9.0, 40.0, 24).reshape(4, 6)),
    )
    for limb, gate in gates.items():
        own = residual[:, push.robot.layout.columns(push.robot.layout.limb(limb))]
        estimate = Estimate(own, np.ones_like(own))
        found.append(detected(LegDetector(Watched(row), gate, chain), sensed, estimate))
    detectors = [RuntimeDetector(limb, push.robot.layout.limb(limb), ("mean",), chain, gate)
                 for limb, gate in gates.items()]  # fmt: skip
    *_, alarms = run(runtime(observer, [], detectors), sensed)
    wanted = np.stack(found, axis=1)
    agree(alarms[..., 0], wanted[..., 0], EXACT)
    np.testing.assert_array_equal(alarms[..., 1:], wanted[..., 1:])
    assert wanted[..., 2].any(axis=0).all()
    if foot != "as planned":
        assert not wanted[599::700, :, 2].all(axis=1).any()  # at the end of each told swing a foot has met the ground


@pytest.mark.parametrize("estimates", ["uncertainty", "external"])
@pytest.mark.parametrize("cell", [{"cell": "GRU", "hidden": 33}, {"cell": "constant"}])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_networks_and_watched_limbs(runtime, observer_of, machine, cell, estimates):
    """Random weights, a hidden state that no block of rows divides, and a detector of three kinds of signals."""
    observer = observer_of(machine)
    layout, limb = observer.nominal.robot.layout, "W" if machine == "robot" else "A"
    network, sensed, columns = (
        network_of(layout, limb, cell, estimates=estimates),
        moving(layout, 300),
        layout.limb(limb),
    )
    row = WatchedSignals(signals=("std", "ratio", "mean"))
    chain = chain_of(np.full((1, 3 * len(columns)), 2.0))
    watching = RuntimeDetector(limb, columns, row.signals, chain)
    _, mean, std, tau, alarms = run(runtime(observer, [network], [watching]), sensed)
    held, model = layout.columns(columns), deployed(network.tensors, network.note)
    if machine == "robot":
        wanted = estimated(ResidualEstimator(observer, layout, LimbNetworks([model], layout)), sensed)
        predicted, std_wanted = wanted.uncertainty, wanted.std
    else:
        inputs = np.concatenate([sensed.q, sensed.v, sensed.tau_des], axis=1, dtype=np.float32)
        (prediction,) = model.run_all([inputs])
        predicted, std_wanted = prediction.mean, prediction.std
    agree(mean[:, held], predicted, SINGLE)
    np.testing.assert_allclose(std[:, held], std_wanted, rtol=SINGLE)
    torque = predicted if estimates == "external" else observer.residual(sensed)[:, held] - predicted
    agree(tau[:, held], torque, SINGLE)
    watcher = LimbWatcher(Watched(row), chain, np.arange(len(held)))
    state = watcher.init()
    wanted = [watcher.ratio(state, sensed[k], Estimate(torque[k], std_wanted[k])) for k in range(len(sensed))]
    np.testing.assert_allclose(alarms[:, 0, 0], wanted, rtol=20 * SINGLE)
    assert alarms[:, 0, 2].all()


@pytest.mark.parametrize("raw", [-40.0, 0.0, 60.0])
def test_standard_deviations_at_their_ends(runtime, observer_of, raw):
    """Neither end of the softplus overflows, and below the smallest one there is the smallest one, (N10)."""
    observer = observer_of("arm")
    network = network_of(observer.nominal.robot.layout, "A", {"cell": "constant"})
    network.tensors["head.bias"][2:] = raw
    _, _, std, _, _ = run(runtime(observer, [network]), moving(observer.nominal.robot.layout, 3))
    unit = network.tensors["target.std"] * network.tensors["std.scale"]
    wanted = {-40.0: network.note.std_min, 0.0: np.log(2.0), 60.0: 60.0}[raw]
    np.testing.assert_allclose(std, np.tile(wanted * unit, (3, 1)), rtol=1e-6)


def test_a_limb_is_watched_once_its_estimate_has_settled(runtime, observer_of):
    observer = observer_of("arm")
    layout, sensed = observer.nominal.robot.layout, moving(observer.nominal.robot.layout, 150)
    chain = chain_of([[1.0, 1.0]])
    detector = RuntimeDetector("A", layout.limb("A"), ("mean",), chain, settle=100)
    *_, alarms = run(runtime(observer, [], [detector]), sensed)
    gate = GateSignal(np.arange(150) >= 100, np.zeros(150))
    wanted = run_over(chain, observer.residual(sensed), gate)
    np.testing.assert_allclose(alarms[:, 0, 0], wanted.ratio, rtol=EXACT)
    np.testing.assert_array_equal(alarms[:, 0, 2], gate.watched)
    assert not wanted.ratio[103]
    assert wanted.ratio[104] > ALARM_RATIO  # after the time for which a signal must last


def test_a_detector_of_the_residual_does_not_see_the_network(runtime, observer_of):
    observer = observer_of("arm")
    layout, sensed = observer.nominal.robot.layout, moving(observer.nominal.robot.layout, 200)
    network, chain = network_of(layout, "A", {"cell": "GRU", "hidden": 5}), chain_of([[1.0, 1.0]])
    both = [RuntimeDetector("A", layout.limb("A"), ("mean",), chain, residual=residual) for residual in (True, False)]
    with_network, without = runtime(observer, [network], both), runtime(observer, [], both[1:])
    *_, alarms = run(with_network, sensed)
    *_, alone = run(without, sensed)
    np.testing.assert_array_equal(alarms[:, 0], alone[:, 0])
    assert not np.array_equal(alarms[:, 1], alone[:, 0])


def test_weights_in_bfloat16_would_move_the_mean_of_the_demo(push, published):
    """The reason why weights are float32: beyond the bound of docs/runtime.md, .01 [sigma]."""
    sensed, layout = push.recording.sensed, push.robot.layout
    (kept,) = LimbNetworks([deployed(published.tensors, published.note)], layout).run_all([sensed])
    moved = []
    for names in (GRU_TENSORS[:2], GRU_TENSORS[:1], GRU_TENSORS[1:2]):
        rounded = {name: torch.from_numpy(published.tensors[name]).bfloat16().float().numpy() for name in names}
        network = deployed({**published.tensors, **rounded}, published.note)
        (found,) = LimbNetworks([network], layout).run_all([sensed])
        moved.append((found.mean - kept.mean) / kept.std)
    both, inputs, states = (np.sqrt(np.mean(np.square(one))) for one in moved)
    np.testing.assert_allclose([both, inputs, states], [0.029, 0.026, 0.008], atol=0.002)
    assert np.abs(moved[0]).max() == pytest.approx(0.1, abs=0.01)


def test_every_optimisation_gives_the_same_bits(tmp_path, push, published):
    """No compiler may fuse or reorder sums, so that numbers do not depend on the machine that a robot has."""
    write_model_file(tmp_path / "model.bin", push.estimator("MOB")._observer, [published], [])
    model, found = (tmp_path / "model.bin").read_bytes(), []
    for name, words in {"plain": ["CFLAGS=-O0"], "native": ["MARCH=native"]}.items():
        found.append(
            run(Runtime(load(make("libmobnet.so", tmp_path / name, *words)), model), push.recording.sensed[:300])
        )
    for plain, native in zip(*found, strict=True):
        np.testing.assert_array_equal(plain, native)
