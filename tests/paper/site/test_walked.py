"""A run whose methods changed walks its tests with seeds that no published run has walked."""

from pathlib import Path

import pytest

from experiments.plan.files import Files
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.site.walked import (
    SEEDS,
    Span,
    WalkedSeeds,
    check_seeds,
    methods_hash,
    read_history,
    walked,
    write_history,
)
from mobnet.core.errors import DataError
from mobnet.core.files import read_json

REPO = Path(__file__).parents[3]
PUBLISHED = read_history(REPO / SEEDS)


@pytest.fixture(scope="module")
def published_scale() -> Settings:
    return load_settings(overrides={"scale": "default"})


def run_of(settings: Settings, commit: str = "head") -> WalkedSeeds:
    return walked(Files(Catalogue(settings), Path("results/default")), commit)


def made(commit: str, methods: str | None, first: int, count: int = 3) -> WalkedSeeds:
    """Return a run with tests alone."""
    return WalkedSeeds(commit=commit, methods=methods, tests={"walk": Span(first=first, count=count)}, reactions={})


def test_the_present_configuration_walks_no_seed_that_another_method_was_published_with(
    published_scale: Settings,
) -> None:
    check_seeds(run_of(published_scale), PUBLISHED)


def test_code_that_was_only_ordered_anew_may_walk_the_same_seeds() -> None:
    published = made("a", "methods", 201).model_copy(update={"same": ["ordered anew"]})
    check_seeds(made("b", "ordered anew", 201), [published])
    with pytest.raises(DataError, match="201 to 203 were published by a"):
        check_seeds(made("b", "another method", 201), [published])


def test_the_newest_published_run_is_that_of_the_published_results_and_of_its_tests() -> None:
    commit = read_json(REPO / "docs/results/provenance.json")["commit"]
    assert PUBLISHED[-1].commit == commit
    assert {"walk_test", "collisions", "forward_walk"} <= PUBLISHED[-1].tests.keys()
    assert {"foot", "knee", "free"} <= PUBLISHED[-1].reactions.keys()
    assert {seed for run in PUBLISHED for seed in run.seeds} >= {*range(201, 216), *range(240, 257)}


def test_every_test_and_every_reaction_of_the_scale_is_listed_with_its_seeds(published_scale: Settings) -> None:
    run, test = run_of(published_scale), published_scale.sizes.test
    files = Files(Catalogue(published_scale), Path("results/default"))
    seeds = {scenario: set(span.seeds) for scenario, span in run.tests.items()}
    for owner in files.owners:
        for scenario, _, seed in owner.recorded():
            assert scenario not in seeds or seed in seeds[scenario] or seed >= 501
    assert set(run.reactions) == set(published_scale.reaction.cases)
    assert run.reactions["foot"] == Span(first=test.first_seed, count=published_scale.sizes.reactions.pushed.runs)
    assert run.tests["forward_walk"] == Span(first=test.first_seed, count=test.shards)


@pytest.mark.parametrize(
    ("methods", "first", "is_accepted"),
    [("same", 10, True), ("other", 10, False), ("other", 12, False), ("other", 13, True)],
)
def test_seeds_of_a_published_run_are_refused_if_its_methods_were_others(
    methods: str, first: int, is_accepted: bool
) -> None:
    published = [made("old12345678", "same", 10)]
    if is_accepted:
        check_seeds(made("new", methods, first), published)
        return
    with pytest.raises(
        DataError, match=rf"^seeds of the tests: {first} is not .* from 13 on, .* by old12345,.*$"
    ) as told:
        check_seeds(made("new", methods, first), published)
    assert len(str(told.value).splitlines()) == 1


def test_a_run_from_before_methods_were_noted_counts_as_another_one() -> None:
    with pytest.raises(DataError, match="10 to 12 were published by"):
        check_seeds(made("new", "same", 10), [made("old", None, 10)])


def test_the_history_is_read_as_it_was_written_and_has_a_commit_once(tmp_path: Path) -> None:
    path = tmp_path / "seeds.json"
    write_history(path, [*PUBLISHED, made("a", None, 1), made("a", "m", 5)])
    assert read_history(path) == [*PUBLISHED, made("a", "m", 5)]
    path.write_text('{"runs": [{"commit": "a"}]}')
    with pytest.raises(DataError, match=r"runs\.0\.methods: key is missing"):
        read_history(path)


def test_what_a_method_is_changes_the_hash_and_what_is_shown_of_it_does_not(published_scale: Settings) -> None:
    before = methods_hash(published_scale)
    learning = published_scale.learning.model_copy(update={"calibrate": not published_scale.learning.calibrate})
    assert methods_hash(published_scale.model_copy(update={"learning": learning})) != before
    assert methods_hash(published_scale.model_copy(update={"claims": {}})) == before
    fewer = published_scale.sizes.model_copy(update={"test": published_scale.scales["quick"].test})
    scales = {**published_scale.scales, "default": fewer}
    assert methods_hash(published_scale.model_copy(update={"scales": scales})) == before
