"""The model file: what is written is what the format says, and no damaged file is accepted."""

import re
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
from c_library import CHECKSUM, MAGIC, OK, SECTION, SOURCES, TRUNCATED, VALUE, VERSION, Runtime
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mobnet.control.kinematics import update
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.files import RUN, WEIGHTS
from mobnet.detection.detector import LegGate
from mobnet.detection.leg import make_leg
from mobnet.estimation.observer import RobotObserver
from mobnet.export import model_file
from mobnet.export.contract import ObserverContract
from mobnet.export.export import MODEL, main, model_of
from mobnet.export.model_file import RuntimeDetector, leg_record, write_model_file
from mobnet.export.trained import contract_of, read_trained
from mobnet.formats import base
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.parts import FrictionRow
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel

from .conftest import GRAVITY, RATE_HZ, chain_of, moving, network_of, watching

RELAXED = settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
GRU = {"cell": "GRU", "hidden": 3}
FAR = 1e30  # a number that no field accepts


@pytest.fixture(scope="session")
def model(observer_of, tmp_path_factory):
    """The bytes of a model of the arm."""
    observer, path = observer_of("arm"), tmp_path_factory.mktemp("model") / "arm.bin"
    layout = observer.nominal.robot.layout
    write_model_file(path, observer, [network_of(layout, "A", GRU)], [watching(layout, "A", ("mean", "ratio"))])
    return path.read_bytes()


def sections(content):
    """Return kind and bytes of each section, by the description in docs/runtime.md."""
    (count,), found = struct.unpack_from("<I", content, 24), []
    for k in range(count):
        kind, _, offset, size, _ = struct.unpack_from("<IIQQQ", content, 64 + 32 * k)
        assert offset % 64 == 0
        found.append((kind, content[offset : offset + size]))
    return found


def status_of(library, content):
    return Runtime(library, content).status


def test_the_file_is_as_described(model):
    assert model[:8] == b"MOBNETRT"
    checksum, version, size = struct.unpack_from("<IIQ", model, 8)
    assert (checksum, version, size) == (zlib.crc32(model[12:]), 1, len(model))
    assert len(model) % 64 == 0
    kinds = [kind for kind, _ in sections(model)]
    assert kinds == [1, 2, 3, 4, 5, 6]
    assert model_file.file_of(sections(model)) == model


def test_drives_follow_the_observer_and_have_no_other_place(observer_of, library, tmp_path):
    plain = observer_of("arm")
    row = FrictionRow(coulomb_nm=1.0, viscous_nms=0.0, smoothing_rad_s=0.01)
    robot = replace(plain.nominal.robot, friction={"J2": row})
    observer = RobotObserver(NominalModel(robot), 100.0, RATE_HZ)
    write_model_file(tmp_path / "arm.bin", observer, [network_of(robot.layout, "A", GRU)], [])
    found = sections((tmp_path / "arm.bin").read_bytes())
    assert [kind for kind, _ in found] == [1, 2, 3, 4, 7, 5]
    assert struct.unpack_from("<7d", found[4][1], 56) == (1.0, 0.0, 0.0, 0.0, 1.0, 0.01, 0.0)
    assert status_of(library, model_file.file_of(found)) == OK
    for places in ([0, 1, 2, 3, 5, 4], [0, 1, 2, 4, 3, 5], [0, 1, 2, 3, 4, 4, 5]):
        assert status_of(library, model_file.file_of([found[k] for k in places])) == SECTION
    narrow = bytearray(found[4][1])
    struct.pack_into("<d", narrow, 40, 0.0)  # the width of a sign divides
    assert status_of(library, model_file.file_of([*found[:4], (7, bytes(narrow)), found[5]])) == VALUE


def test_the_same_model_is_the_same_file(model, observer_of, tmp_path):
    layout = observer_of("arm").nominal.robot.layout
    parts = [network_of(layout, "A", GRU)], [watching(layout, "A", ("mean", "ratio"))]
    write_model_file(tmp_path / "again.bin", observer_of("arm"), *parts)
    assert (tmp_path / "again.bin").read_bytes() == model


@RELAXED
@given(data=st.data())
def test_any_changed_byte_is_noticed(library, model, data):
    place = data.draw(st.integers(0, len(model) - 1))
    changed = bytearray(model)
    changed[place] ^= data.draw(st.integers(1, 255))
    wanted = MAGIC if place < 8 else VERSION if 12 <= place < 16 else TRUNCATED if 16 <= place < 24 else CHECKSUM
    assert status_of(library, bytes(changed)) == wanted


@RELAXED
@given(data=st.data())
def test_a_shorter_or_longer_file_is_refused(library, model, data):
    short = model[: data.draw(st.integers(0, len(model) - 1))]
    assert status_of(library, short) == TRUNCATED
    assert status_of(library, model + data.draw(st.binary(min_size=1, max_size=200))) == TRUNCATED


@RELAXED
@given(data=st.data())
def test_a_section_of_another_length_is_refused(library, model, data):
    """Shorter or longer than what it says of itself, with a right checksum."""
    parts = sections(model)
    k = data.draw(st.integers(0, len(parts) - 1))
    kind, content = parts[k]
    parts[k] = kind, content[: data.draw(st.integers(0, len(content) - 1))]
    assert status_of(library, model_file.file_of(parts)) == VALUE
    parts[k] = kind, content + bytes(data.draw(st.integers(1, 100)))
    assert status_of(library, model_file.file_of(parts)) == SECTION


@RELAXED
@given(data=st.data())
def test_missing_doubled_and_exchanged_sections_are_refused(library, model, data):
    parts = sections(model)
    order = data.draw(st.lists(st.sampled_from(range(len(parts))), max_size=8).filter(
        lambda ks: [k for k in ks if k < 4] != [0, 1, 2, 3] or ks != sorted(ks)))  # fmt: skip
    assert status_of(library, model_file.file_of([parts[k] for k in order])) in (SECTION, VALUE)


@RELAXED
@given(data=st.data())
def test_numbers_that_are_not_finite_are_refused(library, model, data):
    """Every double and every float of the robot, the observer and the network's weights."""
    parts, bad = sections(model), data.draw(st.sampled_from([np.nan, np.inf, -np.inf]))
    kind, first, form = data.draw(st.sampled_from([(1, 16, "<d"), (4, 0, "<d"), (5, 32 + 20 + 6 * 4 + 2 * 4, "<f")]))
    content, size = bytearray(parts[kind - 1][1]), struct.calcsize(form)
    last = (16 if kind == 4 else len(content)) - size
    place = first + size * data.draw(st.integers(0, (last - first) // size))
    if kind == 1 and (place - 40) % 392 == 0:  # the number of a parent
        return
    struct.pack_into(form, content, place, bad)
    parts[kind - 1] = kind, bytes(content)
    assert status_of(library, model_file.file_of(parts)) == VALUE


@pytest.mark.parametrize(("kind", "place", "form", "value"), [
    (1, 0, "<I", 2), (1, 4, "<I", 1), (1, 4, "<I", 300), (1, 8, "<I", 3),  # floating, links, feet
    (1, 40 + 392, "<q", 1), (1, 40 + 392, "<q", -1),  # a parent behind its link
    (2, 0, "<B", 0), (2, 31, "<B", 65),  # a name without letters, without an end
    (3, 32, "<d", FAR), (4, 0, "<d", 1.5), (4, 8, "<d", 0.0), (4, 16, "<I", 2),  # a bound, pole, rate, torque
    (5, 32, "<I", 5), (5, 36, "<I", 9000), (5, 40, "<I", 0), (5, 44, "<I", 2), (5, 48, "<f", 0.0),  # sizes, std_min
    (5, 52, "<H", 9), (5, 54, "<H", 2), (5, 52, "<H", 3), (5, 76, "<I", 1),  # source, place, no IMU, a joint twice
    (6, 32, "<I", 0), (6, 36, "<I", 4), (6, 40, "<I", 3), (6, 52, "<I", 0), (6, 56, "<I", 0),  # sizes, kind, hold
    (6, 60, "<I", 1), (6, 68, "<I", 1), (6, 80, "<d", -0.1), (6, 88, "<d", 0.0),  # gate, residual, pole, threshold
])  # fmt: skip
def test_values_that_are_not_accepted_are_refused(library, model, kind, place, form, value):
    parts = sections(model)
    content = bytearray(parts[kind - 1][1])
    struct.pack_into(form, content, place, value)
    parts[kind - 1] = kind, bytes(content)
    assert status_of(library, model_file.file_of(parts)) in (VALUE, SECTION)


@pytest.mark.parametrize(("place", "value"), [
    (8, 1), (8, 2**40), (8, 2**64 - 64), (8, 64), (16, 2**63), (16, 4096), (0, 9), (0, 3),
])  # fmt: skip  # where a section is, its size, its kind
def test_a_section_elsewhere_in_the_file_is_refused(library, model, place, value):
    """The entry of the last section, with a right checksum; its bytes may be the same as before."""
    changed, entry = bytearray(model), 64 + 32 * 5
    struct.pack_into("<Q" if place else "<I", changed, entry + place, value)
    struct.pack_into("<I", changed, 8, zlib.crc32(changed[12:]))
    assert status_of(library, bytes(changed)) == SECTION


def test_a_section_that_is_not_aligned_or_ends_behind_the_file_is_refused(library, model):
    """Even if what it says of itself would lead a reader there."""
    entry = 64 + 32 * 5
    offset, size = struct.unpack_from("<QQ", model, entry + 8)
    for place, length, phases in ((offset + 8, size - 8, 1), (offset, size + 8 * 4 * 99, 100)):
        changed = bytearray(model)
        struct.pack_into("<QQ", changed, entry + 8, place, length)
        struct.pack_into("<I", changed, offset + 52, phases)
        struct.pack_into("<I", changed, 8, zlib.crc32(changed[12:]))
        assert status_of(library, bytes(changed)) == SECTION


def test_a_joint_has_one_network(library, model):
    parts = sections(model)
    assert status_of(library, model_file.file_of([*parts[:5], parts[4], parts[5]])) == VALUE


def test_a_ratio_needs_a_network(library, observer_of, tmp_path):
    observer = observer_of("arm")
    write_model_file(tmp_path / "m.bin", observer, [], [watching(observer.nominal.robot.layout, "A", ("ratio",))])
    assert status_of(library, (tmp_path / "m.bin").read_bytes()) == VALUE


def test_what_the_library_does_not_run_is_not_written(observer_of, tmp_path):
    observer, path = observer_of("arm"), tmp_path / "m.bin"
    layout = observer.nominal.robot.layout
    network, lstm = network_of(layout, "A", GRU), network_of(layout, "A", {"cell": "LSTM", "hidden": 3})
    with pytest.raises(DataError, match=r"cell: 'LSTM' is not accepted; accepted: .*GRU"):
        write_model_file(path, observer, [lstm], [])
    with pytest.raises(DataError, match="joint of two networks: 'J1'"):
        write_model_file(path, observer, [network, network], [])
    unknown = replace(network, note=network.note.model_copy(update={"inputs": ["acc.x", *network.note.inputs[1:]]}))
    with pytest.raises(
        DataError,
        match=r"input of a network: 'acc.x' is not accepted; accepted: q.<joint>, tau_des.<joint>, v.<joint>$",
    ):
        write_model_file(path, observer, [unknown], [])
    for thresholds, norm in (([[1.0]], False), ([[1.0, 1.0]], True)):
        detector = RuntimeDetector("A", layout.names, ("mean",), chain_of(thresholds)._replace(norm=norm))
        with pytest.raises(ConfigError, match="detector A: number of thresholds"):
            write_model_file(path, observer, [], [detector])
    with pytest.raises(ConfigError, match="1 to 31 bytes"):
        write_model_file(path, observer, [], [replace(watching(layout, "A"), name="A" * 32)])
    assert not path.exists()


def _thresholds(robot, limb, method, signal, watched):
    joints = robot.layout.limb(limb)
    rates = {"rate_per_h": 1.0, "expected_per_h": 1.0, "low_per_h": 0.5, "high_per_h": 2.0, "confidence": 0.95}
    made = {"low_pass_hz": 15.0, "hold_s": 0.005, "rate_hz": RATE_HZ, "gain_hz": 100.0, "torque": "mean"}
    told = {"robot": robot.name, "limb": limb, "joints": joints, "method": method, "signal": signal, "watched": watched}
    return LimbThresholds(**told, thresholds=(3.0,) * len(joints), **made, **rates)


def test_from_exported_networks_and_their_contract(library, push, settings):
    """What `./reproduce export` passes on, for a leg in its swing and for arms that are always watched."""
    robot, folder = describe(push.settings.robot), push.folder / "networks" / "MOB-Net-pushed-LL"
    trained, gate = read_trained(folder, robot.layout), as_plain(settings.detection.gate, GateNumbers)
    rows = {"LL": ("MOB-Net", "ratio", "swing"), "RL": ("MOB", "mean", "swing"), "RA": ("MOB", "mean", "always")}
    thresholds = [_thresholds(robot, limb, *row) for limb, row in rows.items()]
    observing = ObserverContract(gain_hz=100.0, torque="mean", gravity_m_s2=GRAVITY)
    contract = contract_of(robot.name, robot.layout, [trained], RATE_HZ, observing, thresholds)
    model = model_of(robot, contract, [trained], gate)
    assert model is not None
    found = Runtime(library, model)
    assert found.status == OK
    assert [found.name("detector_name", k) for k in range(3)] == list(rows)
    assert [found.name("signal_kind", k, 0) for k in range(3)] == ["ratio", "mean", "mean"]
    sensed = moving(robot.layout, 40)
    assert [found.step(sensed[k]) for k in range(40)] == [OK] * 40
    assert [watched for _, _, watched in found.alarms()] == [0, 0, 1]
    assert {path.name for path in folder.iterdir()} >= {WEIGHTS, RUN}


def test_the_command_writes_a_model_that_runs(library, push, felt, tmp_path):
    """Robot, rate and observer of the configuration are those of the stored push, and so is the estimate."""
    assert main([str(push.folder / "networks" / "MOB-Net-pushed-LL"), "--out", str(tmp_path)]) == 0
    found, columns = Runtime(library, (tmp_path / MODEL).read_bytes()), push.robot.layout.columns(push.joints)
    for k in range(200):
        assert found.step(push.recording.sensed[k]) == OK
        np.testing.assert_allclose(found.told("tau_ext")[columns], felt.tau_ext[k], rtol=1e-5, atol=1e-3)


def test_soles_stay_where_the_robot_has_them(robot, settings, observer_of):
    """In any pose the foot and the corners of its sole are the link's place and the points of the file, turned."""
    leg, gate = make_leg(robot, "LL"), LegGate.of(as_plain(settings.detection.gate, GateNumbers), robot, "LL", RATE_HZ)
    record, link = leg_record(observer_of("robot").nominal, gate), robot.layout.actuated.index("LL6") + 1
    update(leg.tree, np.random.default_rng(0).normal(size=robot.layout.nq), leg.still, 0.0, leg.pose)
    for foot, place in ((leg.foot, 72), (leg.other, 72 + 8 + 15 * 8)):
        found, *numbers = struct.unpack_from("<q15d", record, place)
        assert found == link if foot == leg.foot else found == link + 6
        body = leg.tree.body_of_joint[found - 1]
        points = leg.pose.position[body] + np.reshape(numbers, (5, 3)) @ leg.pose.rotation[body].T
        corners = leg.pose.position[foot] + leg.corners @ leg.pose.rotation[foot].T
        np.testing.assert_allclose(points, [leg.pose.position[foot], *corners], atol=1e-12)


def test_bounds_are_those_of_the_library(library, observer_of, tmp_path):
    """Each number as low and as high as files of thresholds and notes may have it makes a model that runs."""
    sources = "".join((SOURCES / name).read_text() for name in ("cursor.h", "parts.c"))
    told = {name: float(value) for name, value in re.findall(r"\b([A-Z_]+) = ([0-9.e-]+)", sources)}
    assert (told["LEAST"], told["MOST"]) == model_file.BOUNDS
    assert (told["MOST_SAMPLES"], told["MOST_UNITS"]) == (model_file.MOST_SAMPLES, model_file.MOST_UNITS)
    nominal = observer_of("arm").nominal
    layout, path = nominal.robot.layout, tmp_path / "m.bin"
    for rate, gain, threshold in zip(base.RATE_HZ, base.GAIN_HZ, base.THRESHOLD, strict=True):
        write_model_file(path, RobotObserver(nominal, gain, rate), [], [watching(layout, "A", threshold=threshold)])
        assert status_of(library, path.read_bytes()) == OK


@pytest.mark.parametrize(("change", "text"), [
    ({"thresholds": np.full((1, 2), 1e300)}, r"detector of A: threshold: 1e\+300 is not accepted; accepted: a num"),
    ({"hold": 10_001}, "detector of A: samples of its hold: 10001 is not accepted; accepted: a number from 1 to 10000"),
])  # fmt: skip
def test_a_number_that_the_library_refuses_is_not_written(change, text, library, observer_of, tmp_path):
    observer = observer_of("arm")
    good = watching(observer.nominal.robot.layout, "A")
    with pytest.raises(DataError, match=text):
        write_model_file(tmp_path / "m.bin", observer, [], [replace(good, chain=good.chain._replace(**change))])
    assert not (tmp_path / "m.bin").exists()
