"""Every error raised on purpose is a MobnetError that says what is accepted."""

from mobnet.core.errors import ConfigError, DataError, MobnetError, SimulationError, TrainingError, not_accepted


def test_every_error_has_one_root_and_its_message_names_the_value_and_the_accepted_ones_in_order() -> None:
    assert {ConfigError, DataError, SimulationError, TrainingError} <= set(MobnetError.__subclasses__())
    assert not_accepted("limb", "x", ["b", "a"]) == "limb: 'x' is not accepted; accepted: a, b"
