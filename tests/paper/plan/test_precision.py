"""`learning.precision: auto` is one format for all trainings of a scale, whatever machine they run on."""

from pathlib import Path

import pytest
from jobs_of import arguments, network

from experiments.plan import plan
from experiments.plan.plan import PRECISION, auto_precision, make_plan, record_precision, with_precision
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.learning.precision import Precision


@pytest.fixture(scope="module")
def asked() -> Settings:
    """The configuration, which leaves the format to the machine."""
    return load_settings(overrides={"scale": "smoke", "learning": {"precision": "auto"}})


@pytest.fixture
def named() -> Settings:
    """A configuration that leaves nothing to the machine."""
    return load_settings(overrides={"learning": {"precision": "float32"}})


def on(name: Precision, monkeypatch: pytest.MonkeyPatch) -> None:
    """Go on as on a machine that learns faster in a format."""
    monkeypatch.setattr(plan, "of_processor", lambda: name)


def test_what_one_machine_recorded_another_one_keeps(
    asked: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    on("bfloat16", monkeypatch)
    assert auto_precision(asked, tmp_path) == "bfloat16"
    record_precision(tmp_path, "bfloat16")
    on("float32", monkeypatch)
    assert auto_precision(asked, tmp_path) == "bfloat16"
    assert auto_precision(asked, tmp_path, is_dry=True) == "bfloat16"
    assert auto_precision(asked, tmp_path / "other") == "float32"
    record_precision(tmp_path, "float32")
    assert auto_precision(asked, tmp_path) == "bfloat16"


def test_a_dry_run_tries_nothing_before_there_are_results(
    asked: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    on("bfloat16", monkeypatch)
    assert auto_precision(asked, tmp_path / "new", is_dry=True) == "float32"
    # Results whose record was deleted, so that it is decided again: trainings may be there, of one of the formats.
    assert auto_precision(asked, tmp_path, is_dry=True) == "bfloat16"


def test_nothing_is_tried_or_recorded_where_each_format_is_named(
    named: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(plan, "of_processor")
    assert auto_precision(named, tmp_path) is None
    assert with_precision(named, None) == named
    record_precision(tmp_path, None)
    assert not list(tmp_path.iterdir())


def test_a_named_format_stays_and_that_of_a_method_is_named_too(tmp_path: Path) -> None:
    both = load_settings(
        overrides={"learning": {"precision": "float32"}, "methods": {"GRU": {"learning": {"precision": "auto"}}}}
    )
    record_precision(tmp_path, "bfloat16")
    found = Catalogue(with_precision(both, auto_precision(both, tmp_path)))
    assert (found.learned("MOB-Net").precision, found.learned("GRU").precision) == ("float32", "bfloat16")


@pytest.mark.parametrize("name", ["float32", "bfloat16"])
def test_a_training_of_the_plan_has_a_named_format(asked: Settings, name: Precision) -> None:
    made = make_plan(with_precision(asked, name), with_pdf=False)
    assert arguments(made, "train", **network("MOB-Net-LL-s0"))["training"].learning.precision == name


def test_a_damaged_record_is_named(asked: Settings, tmp_path: Path) -> None:
    (tmp_path / PRECISION).parent.mkdir()
    (tmp_path / PRECISION).write_text('{"auto": "float8"}')
    with pytest.raises(DataError, match=r"precision.json: auto: 'float8' is not accepted"):
        auto_precision(asked, tmp_path)
