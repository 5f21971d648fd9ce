"""The C library as a test calls it: compiled by the machine's compiler, through ctypes."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / "src" / "runtime"
REASON = "no C compiler or make (Debian: gcc libc6-dev make)"
HAS_COMPILER = shutil.which("cc") is not None and shutil.which("make") is not None
TEXTS = ("mobnet_text", "mobnet_column_name", "mobnet_joint_name", "mobnet_detector_name", "mobnet_signal_kind",
         "mobnet_signal_joint")  # fmt: skip
PARTS = ("q", "v", "tau_motor", "tau_des", "acc_base_in_base", "swing", "landing")
(OK, NULL, HOST, TRUNCATED, MAGIC, VERSION, CHECKSUM, SECTION, VALUE, MEMORY, SAMPLE, NOT_FINITE) = range(12)


class Sample(ctypes.Structure):
    _fields_ = [(name, ctypes.POINTER(ctypes.c_double)) for name in PARTS]


class Alarm(ctypes.Structure):
    _fields_ = [("ratio", ctypes.c_double), ("signal", ctypes.c_int), ("watched", ctypes.c_int)]


class Result(ctypes.Structure):
    _fields_ = [
        ("residual", ctypes.POINTER(ctypes.c_double)),
        ("tau_ext", ctypes.POINTER(ctypes.c_double)),
        ("mean", ctypes.POINTER(ctypes.c_float)),
        ("std", ctypes.POINTER(ctypes.c_float)),
        ("alarms", ctypes.POINTER(Alarm)),
        ("fault", ctypes.c_size_t),
    ]


class Sizes(ctypes.Structure):
    _fields_ = [
        *[(name, ctypes.c_size_t) for name in ("nq", "nv", "nu", "feet", "columns", "networks", "detectors")],
        ("floating", ctypes.c_int),
        ("rate_hz", ctypes.c_double),
    ]


def make(target, out, *words):
    """Run make in a folder of its own, warnings being errors, and return the target."""
    command = ["make", "-s", "-C", str(SOURCES), f"OUT={out}", *words, f"{out}/{target}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return out / target


def program(path, *words):
    """Run a program that must succeed; return the words that it prints."""
    done = subprocess.run([str(path), *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.split()


def load(path):
    """Return the library with the types of its functions."""
    library = ctypes.CDLL(str(path))
    for name in TEXTS:
        getattr(library, name).restype = ctypes.c_char_p
    library.mobnet_sizes_of.restype = Sizes
    return library


class Runtime:
    """A model in the library's memory."""

    def __init__(self, library, model):
        self.library, size, self.handle = library, ctypes.c_size_t(), ctypes.c_void_p()
        self.status = library.mobnet_size(model, ctypes.c_size_t(len(model)), ctypes.byref(size))
        self.size = size.value
        if self.status == OK:
            self.memory = ctypes.create_string_buffer(size.value)
            words = self.memory, size, model, ctypes.c_size_t(len(model)), ctypes.byref(self.handle)
            self.status = library.mobnet_init(*words)
        self.result = Result()
        if self.status == OK:
            self.sizes = library.mobnet_sizes_of(self.handle)

    def step(self, sensed):
        """Take a sample (1-D arrays); return the status."""
        kept = [np.ascontiguousarray(getattr(sensed, name), dtype=np.float64) for name in PARTS]
        sample = Sample(*(part.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for part in kept))
        return self.library.mobnet_step(self.handle, ctypes.byref(sample), ctypes.byref(self.result))

    def reset(self):
        self.library.mobnet_reset(self.handle)

    def told(self, name):
        """Return a copy of an array of the last result (nv,)."""
        return np.array(getattr(self.result, name)[: self.sizes.nv])

    def alarms(self):
        """Return ratio, signal and whether it watches of each detector."""
        return [(a.ratio, a.signal, a.watched) for a in self.result.alarms[: self.sizes.detectors]]

    def name(self, kind, *place):
        """Return a name, as text."""
        found = getattr(self.library, f"mobnet_{kind}")(self.handle, *map(ctypes.c_size_t, place))
        return found.decode() if found else None
