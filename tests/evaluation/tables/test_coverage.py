"""The table of coverage keeps its golden numbers."""

from collections.abc import Callable
from pathlib import Path

from csv_files import check_golden

from mobnet.settings.evaluation import Evaluation
from mobnet.settings.settings import Settings


def test_coverage_is_the_golden_one(
    make_table: Callable[..., Path], settings: Settings, evaluation: Evaluation, data_sets: dict[str, list[Path]]
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    ports = settings.robot.networks[evaluation.coverage.limb]
    check_golden(make_table("coverage", ports=ports, training=training, tests=[data_sets["test"]]))
