"""The programs beside the library: the example's flags, a tick without memory, and attempts to break it."""

import re
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from c_library import ROOT, SOURCES, make, program

from mobnet.detection.detector import ALARM_RATIO, LegDetector, LegGate
from mobnet.detection.signals import Watched
from mobnet.export.export import main as export
from mobnet.export.model_file import RuntimeDetector, write_model_file
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers, WatchedSignals

from .conftest import network_of, watching

SAMPLES, MODELS = 100_000, 2000
LIMBS = {"robot": ("V", "LL", "RL", "W", "LA", "RA"), "arm": ("A",)}
ARITHMETIC = {
    "memcpy", "memset", "memcmp", "sin", "cos", "sincos", "sqrt", "fmin", "fmax", "exp", "tanh", "expf", "logf",
}  # fmt: skip
BY_COMPILERS = {"_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail", "__memcpy_chk", "__memset_chk"}


@pytest.fixture
def model(observer_of, settings, tmp_path):
    """A function of a machine that writes its model, a small network and a detector for each limb, and returns it."""

    def write(machine):
        observer, cell = observer_of(machine), {"cell": "GRU", "hidden": 4}
        robot = observer.nominal.robot
        networks = [network_of(robot.layout, limb, cell, seed) for seed, limb in enumerate(LIMBS[machine])]
        gates = {
            limb: LegGate.of(as_plain(settings.detection.gate, GateNumbers), robot, limb, 1000.0)
            for limb in robot.layout.legs.values()
        }
        detectors = [watching(robot.layout, limb, ("ratio",), gate=gates.get(limb)) for limb in LIMBS[machine]]
        write_model_file(tmp_path / f"{machine}.bin", observer, networks, detectors)
        return tmp_path / f"{machine}.bin"

    return write


def test_the_example_prints_the_flags_of_the_project(built, push, published, felt, tmp_path):
    import pandas as pd

    row = push.row
    chain, gate = push.chain, push.gate
    watching = RuntimeDetector("LL", push.joints, row.signals, chain, gate)
    write_model_file(tmp_path / "model.bin", push.estimator("MOB-Net-pushed")._observer, [published], [watching])
    csv = tmp_path / "recording.csv"
    pd.read_parquet(push.folder / "recording.parquet").astype("float64").to_csv(csv, index=False)
    header, *lines = program(make("example", built), tmp_path / "model.bin", csv)
    watched = Watched(as_plain(row, WatchedSignals))
    gated = gate.run(push.recording.sensed, felt.tau_ext)
    alarm = LegDetector(watched, gate, chain).run(gated, push.recording.sensed, felt)
    rows = np.flatnonzero(alarm.ratio > ALARM_RATIO)
    names = watched.names(push.joints)
    assert header == "row,time_s,detector,signal,ratio"
    assert [line.split(",")[0] for line in lines] == [str(k) for k in rows]
    assert [line.split(",")[2:4] for line in lines] == [["LL", names[k]] for k in alarm.signal[rows]]
    np.testing.assert_allclose([float(line.split(",")[4]) for line in lines], alarm.ratio[rows], rtol=1e-5)
    header, *lines = program(make("example", built), tmp_path / "model.bin", csv, "torque")
    columns = [header.split(",").index(f"tau_ext.{joint}") for joint in push.joints]
    found = np.array([line.split(",") for line in lines], dtype=float)[:, columns]
    np.testing.assert_allclose(found, felt.tau_ext, rtol=0, atol=1e-5 * np.abs(felt.tau_ext).max())


def test_the_example_says_what_it_misses(built, model, tmp_path):
    (tmp_path / "short.csv").write_text("q.J1,q.J2\n0,0\n")
    model("arm")
    told = {
        "arm.bin": "column v.J1 is missing",
        "short.csv": "the model file is not",
        "none": "this file cannot be read",
    }
    for name, text in told.items():
        words = name, "short.csv"
        done = subprocess.run(
            [make("example", built), *words], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 1
        assert text in done.stderr


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_a_step_never_asks_for_memory(built, model, machine):
    *_, calls = program(make("bench", built), model(machine), 200)
    assert calls == "0"


def test_the_bench_compares_a_tick_with_one_read_of_all_weights(built, observer_of, tmp_path):
    """Each number of the matrices, the four biases of a hidden unit and the linear layer is counted once."""
    observer, hidden = observer_of("arm"), 300
    network = network_of(observer.nominal.robot.layout, "A", {"cell": "GRU", "hidden": hidden})
    write_model_file(tmp_path / "arm.bin", observer, [network], [])
    inputs, joints = len(network.note.inputs), len(network.note.joints)
    median, *_, read, read_p99, share, size, _ = map(float, program(make("bench", built), tmp_path / "arm.bin", 100))
    assert size == 4 * (3 * hidden * (inputs + hidden) + 4 * hidden + 2 * joints * (hidden + 1))
    assert 0.0 < read <= read_p99
    assert share == pytest.approx(read / median, rel=1e-3)  # of a single turn


def test_the_library_owns_no_memory_and_calls_only_arithmetic(built):
    done = subprocess.run(["nm", make("libmobnet.a", built)], capture_output=True, text=True, check=True)
    symbols = [line.split() for line in done.stdout.splitlines() if len(line.split()) > 1]
    kinds = {
        kind: {fields[-1] for fields in symbols if fields[-2] == kind} for kind in {fields[-2] for fields in symbols}
    }
    assert not {*kinds} & set("BbCDGgSs")  # variables; read-only tables and pointers to them are none
    own = kinds["T"]
    assert kinds["U"] - own <= ARITHMETIC | BY_COMPILERS
    assert all(name.startswith("mobnet_") for name in own)  # no function of a program has the name of one of them


def test_the_header_serves_cpp(tmp_path):
    (tmp_path / "use.cpp").write_text('#include "mobnet.h"\nint main() { return mobnet_text(MOBNET_OK) == nullptr; }\n')
    words = ["-std=c++11", "-Wall", "-Wextra", "-Werror", "-pedantic", f"-I{SOURCES}", "-fsyntax-only", "use.cpp"]
    found = subprocess.run(["cc", "-x", "c++", *words], cwd=tmp_path, capture_output=True, text=True, check=False)
    if "cc1plus" in found.stderr:
        pytest.skip("no C++ compiler (Debian: g++)")
    assert found.returncode == 0, found.stderr


def test_the_code_of_the_guide_compiles(built, tmp_path):
    (code,) = re.findall(r"```c\n(.*?)```", (ROOT / "docs" / "runtime.md").read_text(), re.DOTALL)
    (tmp_path / "guide.c").write_text(f"{code}\nint main(void) {{ return run(NULL, 0, NULL, 0) != MOBNET_NULL; }}\n")
    library = make("libmobnet.a", built)
    words = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        f"-I{SOURCES}",
        "guide.c",
        library,
        "-lm",
        "-o",
        "guide",
    ]
    subprocess.run(["cc", *words], cwd=tmp_path, check=True)
    program(tmp_path / "guide")


def test_the_commands_of_the_guide_print_the_estimates_of_the_demo(tmp_path, monkeypatch):
    for name in ("docs", "src"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "runtime.md").read_text()
    (words,) = re.findall(r"^ {4}\./reproduce export (docs/demo.*)$", page, re.MULTILINE)
    assert export(words.split()) == 0
    lines = re.findall(r"^ {4}((?:make|\.venv/bin/python -c|build/example) .*)$", page, re.MULTILINE)
    assert len(lines) == 3
    for line in lines:
        command = line.replace(".venv/bin/python", sys.executable)
        done = subprocess.run(command, shell=True, check=True, capture_output=True, text=True)
    rows = done.stdout.splitlines()
    assert "LL1" in rows[0]
    assert len(rows) == 1 + len(pd.read_csv("walk.csv"))


@pytest.fixture(scope="session")
def fuzz(built):
    """The program that tries to break the library, with the compiler's checks of addresses and undefined behaviour."""
    return make("fuzz", built)


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_random_samples_leave_a_finite_state(fuzz, model, machine):
    (accepted,) = program(fuzz, "samples", model(machine), SAMPLES, 1)
    assert 0.3 * SAMPLES < int(accepted) < 0.9 * SAMPLES


@pytest.mark.slow
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_a_million_random_samples(fuzz, model, machine):
    (accepted,) = program(fuzz, "samples", model(machine), 10 * SAMPLES, 2)
    assert int(accepted) > 3 * SAMPLES


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_damaged_models_with_a_right_checksum_break_nothing(fuzz, model, machine):
    """They are refused, or run: a changed weight is another weight."""
    (accepted,) = program(fuzz, "models", model(machine), MODELS, 1)
    assert 0 < int(accepted) < MODELS
