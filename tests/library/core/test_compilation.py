"""Compiled code is cached by the hash of its code, and its arrays on the stack are laid out like any others."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.errors import NumbaError

from mobnet.control.geometry import multiply
from mobnet.core.code import SOURCE, code_hash
from mobnet.core.compilation import compiled, matrix3, on_stack, vector3
from mobnet.core.machine_code import cache_root

CALLED = """from mobnet.core.compilation import compiled


@compiled
def f(x):
    return x + 1.0
"""
CALLER = CALLED.replace("\n\n\n", "\nfrom mobnet.control.called import f\n\n\n").replace("x + 1.0", "2.0 * f(x)")
CALLER = CALLER.replace("def f", "def g")
TELL = """import sys
from mobnet.control.caller import g
print(g(1.0), sum(g.stats.cache_hits.values()))
"""
FIRST = """import logging, sys
logging.basicConfig(level=logging.INFO, stream=sys.stdout, format="%(message)s")
import numpy as np
from mobnet.control.geometry import clip, dead
clip(0.0, 0.0, 1.0)
dead(0.0, 1.0)
"""


def test_code_divides_by_zero_as_numpy_does() -> None:
    assert compiled(lambda x: 1.0 / x)(0.0) == float("inf")


def test_options_reach_the_compiler() -> None:
    finite = compiled(fastmath={"nnan"})(lambda x: x)
    assert finite.targetoptions["fastmath"] == {"nnan"}
    assert compiled(allocating=True)(lambda n: len([n]))(1) == 1
    with pytest.raises(NumbaError):
        compiled(lambda n: len([n]))(1)


def test_cache_lies_in_a_folder_named_after_the_hash_and_numba_s_settings_stay() -> None:
    before = numba.config.CACHE_DIR
    function = compiled(lambda x: x)
    assert before == numba.config.CACHE_DIR
    assert Path(function.stats.cache_path).parent == cache_root() / code_hash(__file__)


@pytest.mark.slow
def test_cached_code_follows_the_functions_that_it_calls(tmp_path: Path) -> None:
    """The caller's own file stays; what it calls gets another number, then a comment."""
    package = tmp_path / "mobnet"
    for name in (
        "__init__",
        "core/__init__",
        "core/code",
        "core/errors",
        "core/place",
        "core/source",
        "core/source_cache",
        "core/files",
        "core/compilation",
        "core/compile_log",
        "core/machine_code",
        "core/root",
        "control/__init__",
    ):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / f"mobnet/{name}.py", package / f"{name}.py")
    (package / "control/caller.py").write_text(CALLER)
    # Python takes its own old bytecode for that of a file of the same size that was changed in the same second
    fresh = {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    environment = {**os.environ, **fresh}
    told = []
    for text in (CALLED, CALLED.replace("1.0", "2.0"), CALLED.replace("1.0", "2.0") + "# a comment\n"):
        (package / "control/called.py").write_text(text)
        told.append(subprocess.check_output([sys.executable, "-c", TELL], env=environment, text=True).split())
    assert told == [["4.0", "0"], ["6.0", "0"], ["6.0", "1"]]


def test_only_the_process_that_compiles_says_so_once(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    first, second = (
        subprocess.check_output([sys.executable, "-c", FIRST], env=environment, text=True).splitlines() for _ in "ab"
    )
    assert first[0] == "compiling code for this processor, which may take a minute, once"
    assert all(line.startswith("compiling code for this processor: ") for line in first[1:])  # on a busy machine
    assert second == []


wide = on_stack(2, 3, 4)


@compiled
def _shapes(out):
    a, b = vector3(), wide()
    out[0], out[1], out[2], out[3] = a.shape[0], b.shape[0], b.shape[1], b.shape[2]


@compiled
def _cube(a, out):
    square = matrix3()
    multiply(a, a, square)
    multiply(square, a, out)


@compiled
def _kept_apart(out):
    a, b = vector3(), vector3()
    for i in range(3):
        a[i], b[i] = i, 10 + i
    for i in range(3):
        out[i], out[3 + i] = a[i], b[i]


def test_shapes_are_those_asked_for():
    out = np.zeros(4)
    _shapes(out)
    assert out.tolist() == [3, 2, 3, 4]


def test_a_matrix_on_the_stack_is_laid_out_like_any_other():
    a, out = np.random.default_rng(0).normal(size=(3, 3)), np.zeros((3, 3))
    _cube(a, out)
    np.testing.assert_allclose(out, a @ a @ a, rtol=1e-13)


def test_two_arrays_do_not_share_room():
    out = np.zeros(6)
    _kept_apart(out)
    assert out.tolist() == [0, 1, 2, 10, 11, 12]
