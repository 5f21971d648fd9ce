"""Sizes by which an outcome can be judged: enough walks and trainings, and nothing but what is compared differs."""

from pathlib import Path

import pytest
from csv_files import read_table

from experiments.intervals.clusters import ClusterKey, rate_in, share_in
from experiments.intervals.independent import wilson
from experiments.plan.files import Files
from experiments.plan.reactions import sizes_of
from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.outcomes import best_share, is_met_by_a_rate, is_met_by_a_share
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings

ROOT = Path(__file__).parents[3]
JUDGED = ("foot", "knee", "cart", "door")  # cases of which the paper tells that robots do not fall
FALLS_SHARE, FALLS_PER_H, DIVERGED_SHARE = 0.1, 4.0, 0.5  # at most, of walks, in an hour, and of trainings
HOUR_S = 3600.0


@pytest.fixture(scope="module")
def paper() -> Settings:
    """The configuration at the scale whose walks decide the claims about falls."""
    return load_settings(overrides={"scale": "paper"})


def places_of(robots: int, walks: int) -> list[ClusterKey]:
    """Return the places of walks of several robots, which share the seeds."""
    return [ClusterKey(f"robot_{robot}", seed) for robot in range(robots) for seed in range(walks)]


def test_robots_that_never_fall_can_show_a_small_share_of_falls(paper: Settings) -> None:
    files = Files(Catalogue(paper), Path("results"))
    for case in JUDGED:
        places = places_of(len(files.robots), sizes_of(files, case).runs)
        high = share_in([False] * len(places), places, paper.evaluation.statistics).high
        assert high is not None
        assert high < FALLS_SHARE, f"{case}: {len(places)} walks"


@pytest.mark.parametrize("falls", [0, 2])
def test_free_walks_can_show_a_small_rate_of_falls(paper: Settings, falls: int) -> None:
    """Also where there are two, one robot's both."""
    files = Files(Catalogue(paper), Path("results"))
    sizes = sizes_of(files, "free")
    places = places_of(len(files.whole_robots), sizes.runs)
    hours = [sizes.longest_s / HOUR_S] * len(places)
    counts = [1] * falls + [0] * (len(places) - falls)
    high = rate_in(counts, hours, places, paper.evaluation.statistics).high
    assert high is not None
    assert high < FALLS_PER_H


@pytest.mark.parametrize(("robots", "walks"), [(3, 6), (3, 57), (5, 12), (8, 7)])
def test_what_no_outcome_can_reach_is_told_by_the_interval_that_the_tables_have(robots: int, walks: int) -> None:
    """`settings` computes the best outcome without the code of results: of robots that are alike."""
    statistics = load_settings().evaluation.statistics
    trials = robots * walks
    places = places_of(robots, walks)
    found = share_in([False] * trials, places, statistics)
    assert best_share(0, trials, robots, statistics) == (found.low, found.high)
    rate = rate_in([0] * trials, [0.1] * trials, places, statistics)
    assert rate.high is not None
    for factor, is_met in ((1.001, True), (0.999, False)):
        bounds = (None, factor * rate.high)
        assert is_met_by_a_rate(bounds, 0.1 * trials, robots, statistics) == is_met


@pytest.mark.parametrize(
    ("bounds", "is_met"), [((None, 0.29), True), ((None, 0.28), False), ((0.2, 0.8), True), ((0.4, 0.6), False)]
)
def test_some_share_of_eighteen_walks_of_three_robots_lies_within_bounds(
    bounds: tuple[float | None, float], is_met: bool
) -> None:
    assert is_met_by_a_share(bounds, 18, 3, load_settings().evaluation.statistics) == is_met


@pytest.mark.parametrize("scale", ["default", "paper"])
def test_trainings_that_never_diverge_can_show_that_most_do_not(scale: str) -> None:
    sized = load_settings(overrides={"scale": scale})
    files = Files(Catalogue(sized), Path("results"))
    kinds, figure = sized.evaluation.kinds, sized.evaluation.figure_17
    trained = files.network_folders(["GRU-printed-rate"], figure.limb, kinds.level)
    _, high = wilson(0.0, len(trained), sized.evaluation.statistics.confidence)
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
