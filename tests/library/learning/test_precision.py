"""What `auto` stands for is the format in which this machine learns faster; it is tried once."""

from collections.abc import Callable
from pathlib import Path

import pytest

from mobnet.learning import precision
from mobnet.learning.precision import of_processor

FLAGS = "model name\t: A\nflags\t\t: fpu avx512_bf16 amx_bf16\ncpu MHz\t: 2000.0\n"
Trial = Callable[[float, float], list[int]]


@pytest.fixture
def processor(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file in which the system describes the processor of this test, and a cache of its own."""
    monkeypatch.setattr(precision, "PROCESSOR", tmp_path / "cpuinfo")
    monkeypatch.setattr(precision, "caches", lambda: tmp_path / "cache")
    return tmp_path / "cpuinfo"


@pytest.fixture
def trial(monkeypatch: pytest.MonkeyPatch) -> Trial:
    """A function of the times [ms] that a trial finds, float32 and bfloat16; it returns a list with a 1 for each."""
    made: list[int] = []

    def finds(float32_ms: float, bfloat16_ms: float) -> list[int]:
        def tried_ms() -> tuple[float, float]:
            made.append(1)
            return float32_ms, bfloat16_ms

        monkeypatch.setattr(precision, "tried_ms", tried_ms)
        return made

    return finds


@pytest.mark.parametrize("flags", [None, "flags : fpu avx2 avx512f\n"])
def test_a_processor_without_a_unit_for_bfloat16_is_not_tried(processor: Path, trial: Trial, flags: str | None) -> None:
    made = trial(2.0, 1.0)
    if flags:
        processor.write_text(flags)
    assert (of_processor(), made) == ("float32", [])


@pytest.mark.parametrize(("bfloat16_ms", "name"), [(14.0, "bfloat16"), (19.5, "float32"), (25.0, "float32")])
def test_the_faster_format_is_taken_and_kept(processor: Path, trial: Trial, bfloat16_ms: float, name: str) -> None:
    processor.write_text(FLAGS)
    made = trial(20.0, bfloat16_ms)
    assert of_processor() == name
    trial(20.0, 39.0 - bfloat16_ms)  # another hour, which would say the other
    processor.write_text(FLAGS.replace("2000", "3000"))
    assert (of_processor(), made) == (name, [1])


def test_each_kind_of_processor_has_its_own(processor: Path, trial: Trial) -> None:
    processor.write_text(FLAGS)
    trial(20.0, 14.0)
    assert of_processor() == "bfloat16"
    processor.write_text(FLAGS.replace(": A", ": B"))  # a node with the same folder
    trial(20.0, 25.0)
    assert of_processor() == "float32"
    processor.write_text(FLAGS)
    assert of_processor() == "bfloat16"


def test_a_damaged_record_is_made_again(processor: Path, trial: Trial, tmp_path: Path) -> None:
    processor.write_text(FLAGS)
    made = trial(20.0, 14.0)
    of_processor()
    (record,) = (tmp_path / "cache").rglob("*.json")
    for damage in ("", '{"precision": "auto", "float32_ms": 1.0, "bfloat16_ms": 1.0}'):
        record.write_text(damage)
        assert of_processor() == "bfloat16"
    assert made == [1, 1, 1]


def test_nothing_has_to_be_kept(processor: Path, trial: Trial, tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("no folder")
    processor.write_text(FLAGS)
    trial(20.0, 14.0)
    assert of_processor() == "bfloat16"


def test_a_trial_times_both_formats() -> None:
    assert all(0 < taken < 1e4 for taken in precision.tried_ms())
