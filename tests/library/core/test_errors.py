"""Every error raised on purpose is a MobnetError that says what is accepted."""

from mobnet.core.errors import (
    ConfigError,
    DataError,
    MobnetError,
    SimulationError,
    TrainingError,
    near_names,
    not_accepted,
)


def test_every_error_has_one_root_and_its_message_names_the_value_and_the_accepted_ones_in_order() -> None:
    assert {ConfigError, DataError, SimulationError, TrainingError} <= set(MobnetError.__subclasses__())
    assert not_accepted("limb", "x", ["b", "a"]) == "limb: 'x' is not accepted; accepted: a, b"


def test_of_many_names_the_nearest_are_shown_and_how_many_there_are() -> None:
    joints = [f"L{limb}{k}" for limb in "LA" for k in range(1, 9)]
    line = "joint: 'LL9' is not accepted; accepted: LL1, LL2, LL3, LL4, LL5 (the nearest of 16)"
    assert not_accepted("joint", "LL9", joints) == line


def test_a_path_is_found_by_the_name_of_its_file() -> None:
    paths = ["figures/bode.pdf", "figures/figure_05.pdf", "tables/table_05.tex"]
    assert near_names(paths, "figure_99", 1) == ["figures/figure_05.pdf"]
    assert near_names(paths, "tabels/table_05.tex", 1) == ["tables/table_05.tex"]
