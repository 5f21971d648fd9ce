"""`learning.precision: auto` is one format for all trainings of a scale, whatever machine they run on."""

from pathlib import Path

import pytest
from jobs_of import arguments, network

from experiments.plan.plan import PRECISION, make_plan, record_precision, with_precision
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.learning import precision
from mobnet.learning.precision import of_processor


@pytest.fixture(scope="module")
def asked() -> Settings:
    """The configuration, which leaves the format to the machine."""
    return load_settings(overrides={"scale": "smoke", "learning": {"precision": "auto"}})


@pytest.fixture
def processor(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file in which the system describes the processor of this test."""
    monkeypatch.setattr(precision, "PROCESSOR", tmp_path / "cpuinfo")
    return tmp_path / "cpuinfo"


def test_the_format_is_bfloat16_where_the_processor_computes_in_it(processor: Path) -> None:
    assert of_processor() == "float32"  # a system that describes none
    for flags, name in (("fpu avx512f", "float32"), ("fpu avx512_bf16", "bfloat16"), ("amx_bf16 fpu", "bfloat16")):
        processor.write_text(f"flags\t\t: {flags}\n")
        assert of_processor() == name


def test_what_one_machine_recorded_another_one_keeps(asked: Settings, processor: Path, tmp_path: Path) -> None:
    processor.write_text("flags : avx512_bf16\n")
    assert with_precision(asked, tmp_path).learning.precision == "bfloat16"
    record_precision(tmp_path)
    processor.write_text("flags : fpu\n")
    assert with_precision(asked, tmp_path).learning.precision == "bfloat16"
    assert with_precision(asked, tmp_path / "other").learning.precision == "float32"
    record_precision(tmp_path)
    assert with_precision(asked, tmp_path).learning.precision == "bfloat16"


def test_a_named_format_stays_and_that_of_a_method_is_named_too(asked: Settings, tmp_path: Path) -> None:
    named = load_settings(
        overrides={"learning": {"precision": "float32"}, "methods": {"GRU": {"learning": {"precision": "auto"}}}}
    )
    (tmp_path / PRECISION).parent.mkdir()
    (tmp_path / PRECISION).write_text('{"auto": "bfloat16"}')
    found = Catalogue(with_precision(named, tmp_path))
    assert (found.learned("MOB-Net").precision, found.learned("GRU").precision) == ("float32", "bfloat16")


def test_a_training_of_the_plan_has_a_named_format(asked: Settings, tmp_path: Path) -> None:
    plan = make_plan(with_precision(asked, tmp_path), with_pdf=False)
    assert arguments(plan, "train", **network("MOB-Net-LL-s0"))["training"].learning.precision in (
        "float32",
        "bfloat16",
    )


def test_a_damaged_record_is_named(asked: Settings, tmp_path: Path) -> None:
    (tmp_path / PRECISION).parent.mkdir()
    (tmp_path / PRECISION).write_text('{"auto": "float8"}')
    with pytest.raises(DataError, match=r"precision.json: auto: 'float8' is not accepted"):
        with_precision(asked, tmp_path)
