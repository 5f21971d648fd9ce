"""How much robots walk in a case: no other detector is tried in more walks than ours."""

from pathlib import Path

import pytest
from jobs_of import arguments

from experiments.plan.files import Files
from experiments.plan.plan import make_plan
from experiments.plan.reactions import LEGS_SHARE, sizes_of, walks_in
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.scales import ReactionSizes
from mobnet.settings.reaction import watches_of

CASE = "foot"


@pytest.mark.parametrize(("runs", "compared", "of_others"), [(6, 2, 2), (2, 6, 2), (3, 3, 3)])
def test_other_detectors_walk_as_often_as_asked_and_no_more_often_than_ours(
    runs: int, compared: int, of_others: int
) -> None:
    settings = load_settings()
    usual_s = settings.sizes.reactions.pushed.longest_s
    cases = {CASE: ReactionSizes(runs=runs, compared=compared, longest_s=usual_s)}
    reactions = settings.sizes.reactions.model_copy(update={"cases": cases})
    sizes = settings.sizes.model_copy(update={"reactions": reactions})
    files = Files(Catalogue(settings.model_copy(update={"scales": {settings.scale: sizes}})), Path("results"))
    others = len(watches_of(settings.reaction, CASE)) - 1
    assert sizes_of(files, CASE).runs == runs
    assert others > 1
    assert walks_in(files, CASE) == runs + of_others * others


def test_a_walk_on_some_limbs_reads_their_networks_alone() -> None:
    plan = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)
    limbs = {}
    for case in ("free", "free_all"):
        runs = arguments(plan, "react", "robot_1", case=case)["runs"]
        limbs[case] = set(runs[plan.settings.reaction.estimator].networks)
    assert limbs["free"] == {"LL", "RL"}
    assert {"LL", "RL", "V", "W", "LA", "RA"} <= limbs["free_all"]


def test_a_walk_on_legs_alone_is_priced_below_one_with_all_networks() -> None:
    files = Files(Catalogue(load_settings(overrides={"scale": "quick"})), Path("results"))
    # Both of the size `free`, one compared with two more watches.
    alone = sizes_of(files, "free")
    usual_s = files.settings.sizes.reactions.pushed.longest_s
    assert walks_in(files, "free") == (alone.runs + 2 * alone.compared) * alone.longest_s / usual_s * LEGS_SHARE
    assert walks_in(files, "free_all") == alone.runs * alone.longest_s / usual_s
