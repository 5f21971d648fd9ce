"""Seeds tell what a recording is for, and with that how long it is: at both ends of each range of seeds."""

from pathlib import Path

import pytest

from experiments.plan.files import Files
from experiments.plan.seeds import FIRST_DEVELOPMENT_SEED, FIRST_TRAINING_SEED
from experiments.settings.catalogue import Catalogue
from experiments.settings.fleet import OWN_TESTS
from experiments.settings.load import load_settings

SCENARIO = "random_walk"  # of training sets, and of walks on which methods are chosen
TEST_S, DEVELOPMENT_S = 11.0, 13.0


@pytest.fixture(scope="module")
def files() -> Files:
    """Files of a configuration whose tests, walks of development and training sets last for different times."""
    settings = load_settings()
    sizes = settings.sizes
    longer = {
        "durations_s": {SCENARIO: TEST_S},
        "development": sizes.development.model_copy(update={"shard_s": DEVELOPMENT_S}),
    }
    scales = {settings.scale: sizes.model_copy(update=longer)}
    return Files(Catalogue(settings.model_copy(update={"scales": scales})), Path("results"))


@pytest.mark.parametrize("seed", [1, FIRST_DEVELOPMENT_SEED - 1, OWN_TESTS, 2 * OWN_TESTS + 1])
def test_a_seed_of_a_test_has_a_test_s_duration(files: Files, seed: int) -> None:
    assert files.duration_s([SCENARIO], seed) == TEST_S


@pytest.mark.parametrize("seed", [FIRST_DEVELOPMENT_SEED, FIRST_TRAINING_SEED - 1])
def test_a_seed_of_development_has_its_duration(files: Files, seed: int) -> None:
    assert files.duration_s([SCENARIO], seed) == DEVELOPMENT_S


@pytest.mark.parametrize("seed", [FIRST_TRAINING_SEED, OWN_TESTS - 1])
def test_a_seed_of_training_has_the_duration_of_the_longest_set_of_its_scenario(files: Files, seed: int) -> None:
    lasting: list[float] = []
    for name, row in files.settings.training_sets.items():
        if row.scenario == SCENARIO:
            lasting.append(files.training_size(name).shard_s)
    longest = max(lasting)
    assert longest not in (TEST_S, DEVELOPMENT_S)
    assert files.duration_s([SCENARIO], seed) == longest


def test_of_several_scenarios_the_longest_test_counts(files: Files) -> None:
    others = ["forward_walk", SCENARIO]
    assert files.duration_s(others, 1) == max(files.settings.test_s(name) for name in others) > TEST_S
