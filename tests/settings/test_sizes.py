"""Sizes by which an outcome can be judged: enough walks and trainings, and nothing but what is compared differs."""

from pathlib import Path

import pytest
from csv_files import read_table

from mobnet.evaluation.measure.detection.results import rate_of, share_of
from mobnet.plan.files import Files
from mobnet.plan.reactions import sizes_of
from mobnet.settings.catalogue import Catalogue
from mobnet.settings.load import load_settings
from mobnet.settings.settings import Settings

ROOT = Path(__file__).parents[2]
JUDGED = ("foot", "knee", "cart", "door")  # cases of which the paper tells that robots do not fall
FALLS_SHARE, FALLS_PER_H, DIVERGED_SHARE = 0.1, 4.0, 0.5  # at most, of walks, in an hour, and of trainings
HOUR_S = 3600.0


@pytest.fixture(scope="module", params=["default", "paper"])
def sized(request: pytest.FixtureRequest) -> Settings:
    """The configuration at a scale whose results are judged."""
    return load_settings(overrides={"scale": request.param})


def test_robots_that_never_fall_can_show_a_small_share_of_falls(sized: Settings) -> None:
    files = Files(Catalogue(sized), Path("results"))
    for case in JUDGED:
        walks = len(files.robots) * sizes_of(files, case).runs
        high = share_of([False] * walks, sized.evaluation.statistics).high
        assert high is not None
        assert high < FALLS_SHARE, f"{case}: {walks} walks"


def test_free_walks_can_show_a_small_rate_of_falls_at_the_scale_of_the_paper() -> None:
    """The scale `default` has a quarter of the hour, and says so in scales.yaml."""
    settings = load_settings(overrides={"scale": "paper"})
    files = Files(Catalogue(settings), Path("results"))
    sizes = sizes_of(files, "free")
    hours = len(files.robots) * sizes.runs * sizes.longest_s / HOUR_S
    high = rate_of(0, hours, settings.evaluation.statistics).high
    assert high is not None
    assert high < FALLS_PER_H


def test_trainings_that_never_diverge_can_show_that_most_do_not(sized: Settings) -> None:
    files = Files(Catalogue(sized), Path("results"))
    kinds, figure = sized.evaluation.kinds, sized.evaluation.figure_17
    trained = files.network_folders(["GRU-printed-rate"], figure.limb, kinds.level)
    high = share_of([False] * len(trained), sized.evaluation.statistics).high
    assert high is not None
    assert high < DIVERGED_SHARE


@pytest.mark.parametrize("scale", ["smoke", "quick", "default", "paper"])
def test_networks_of_the_whole_body_learn_from_as_many_samples_whatever_their_size(scale: str) -> None:
    experiments = load_settings(overrides={"scale": scale}).sizes.experiments
    assert experiments["single"] == experiments["double"]


def test_kinds_learn_by_one_recipe_at_the_rates_with_the_lowest_loss_of_it_in_the_trials() -> None:
    catalogue = Catalogue(settings := load_settings())
    figure, tried = settings.evaluation.figure_17, read_table(ROOT / "docs/trials/tuning.csv")
    recipes = [catalogue.learned(method) for method in figure.methods]
    assert [recipe.model_copy(update={"rate_first": 1.0}) for recipe in recipes] == [
        recipes[0].model_copy(update={"rate_first": 1.0})
    ] * len(recipes)
    assert (recipes[0].optimizer, recipes[0].loss, recipes[0].coarse) == ("adam", "likelihood", ())
    for recipe, best in zip(recipes, figure.best, strict=True):
        name = "MOB-Net" if best == "GRU" else best  # the GRU of the left leg was tried under that name
        losses = {
            float(row.tried.rsplit(" ", 1)[1]): row.validation_loss
            for row in tried if row.method == name and row.tried.startswith("loss likelihood")
        }  # fmt: skip
        assert recipe.rate_first == min(losses, key=lambda rate: losses[rate]), best
