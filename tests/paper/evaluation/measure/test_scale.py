"""A verdict has a scale: what methods that know nothing reach does not count, nor what the paper does not have."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from paper_settings import STATISTICS

from experiments.evaluation.measure.claims.cells import Evidence
from experiments.evaluation.measure.claims.scale import KnownMethods, control_of, in_place, stand_ins_of, weaknesses_of
from experiments.evaluation.measure.claims.verdicts import ClaimNumbers, Row, judged, rows_of, score_of
from experiments.evaluation.number.number import Number
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.settings.verdicts import NETWORKS, OURS, REPRODUCED, STAND_INS
from mobnet.core.rows import read_texts

ROOT = Path(__file__).parents[4]
PUBLISHED = read_texts(ROOT / "docs" / "results" / "claims.csv")
# Statements of the paper that are judged on a method of ours, none of which counts. The first two kinds may go as soon
# as detectors run on the networks that the original has.
OF_OURS = ("found-", "delay-", "impact-", "reacts-")


@pytest.fixture(scope="module")
def configured() -> Settings:
    return load_settings(ROOT / "configs")


@pytest.fixture(scope="module")
def known(configured: Settings) -> KnownMethods:
    return KnownMethods(configured.methods, configured.detection.detectors, configured.published.original_methods)


def on(known: KnownMethods, row: Row, ours: Number, control: dict[str, str]) -> dict[str, Any]:
    """Return a claim judged on a number, with its control."""
    score = score_of(row.claim, known.methods)
    weaknesses = weaknesses_of(row.claim, score, ours, control, known)
    return judged(row, ClaimNumbers(ours, ours), score, STATISTICS, control, weaknesses)


def row_of(settings: Settings, name: str) -> Row:
    return next(row for row in rows_of(settings.claims) if row.name == name)


def test_a_claim_is_judged_with_methods_in_the_place_of_its_network(configured: Settings, known: KnownMethods) -> None:
    claim = configured.claims["fts-e2e-average"]  # FTS-e2e over MOB-Net: MOB-Net's place is taken, not that of FTS-e2e
    found = stand_ins_of(claim, known)
    assert {name: [cell.method for cell in other.cells] for name, other in found.items()} == {
        name: ["FTS-e2e", name] for name in STAND_INS
    }
    alone = stand_ins_of(configured.claims["fts-e2e-error"], known)
    assert [cell.method for cell in alone["zero"].cells] == ["zero"]
    spoken_for = stand_ins_of(configured.claims["gray-walk-net"], known)  # it says that another one beats MOB-Net
    assert [cell.method for cell in spoken_for["MOB"].cells] == ["MOB", "MOB-Net"]


def test_no_method_is_compared_with_itself_and_nothing_stands_in_for_a_training(
    configured: Settings, known: KnownMethods
) -> None:
    assert list(stand_ins_of(configured.claims["mob-net-cut"], known)) == ["zero", "MOB-Net-shuffled"]
    assert "zero" not in stand_ins_of(configured.claims["zero-walk"], known)
    assert stand_ins_of(configured.claims["gru-validation"], known) == {}
    assert stand_ins_of(configured.claims["noise-floor"], known) == {}


def test_a_detector_is_replaced_in_the_claim_and_in_its_sign(configured: Settings) -> None:
    claim = configured.claims["delay-fts-knee"]
    other = in_place(claim, "FTS-e2e-mean", "MOB")
    assert other is not None
    assert other.sign_of is not None
    assert [cell.where["detector"] for cell in (*other.cells, *other.sign_of.cells)] == ["MOB", "MOB", "MOB-Net-OR"]


def test_what_a_method_that_knows_nothing_passes_is_a_description(
    configured: Settings, known: KnownMethods, make_scores: Callable[..., Any]
) -> None:
    """MOB has about the error that the claim wants of MOB-Net: the test is too easy."""
    row = row_of(configured, "mob-net-error")
    ours = Number(1.3, 1.2, 1.4, networks=(3,))
    assert on(known, row, ours, {"zero": "not reproduced"})["verdict"] == "reproduced"
    weak = on(known, row, ours, {"MOB": "reproduced"})
    assert weak["verdict"] == "description"
    assert weak["remark"] == "Not counted as reproduced: with MOB in the place of MOB-Net it would be, too."
    # A failure stays one.
    assert on(known, row, Number(9.0, 8.0, 10.0, networks=(3,)), {"MOB": "reproduced"})["verdict"] == "not reproduced"


@pytest.mark.parametrize(("low", "high"), [(150.0, 250.0), (500.0, 900.0), (150.0, 900.0)])
def test_what_follows_from_our_own_choices_is_never_judged(
    low: float, high: float, configured: Settings, known: KnownMethods
) -> None:
    row = row_of(configured, "impact-foot")
    found = on(known, row, Number(200.0, low, high, unit="N", networks=(3,)), {})
    assert found["verdict"] == "description"
    assert found["remark"] == f"Described, not judged: {row.claim.described}"
    assert on(known, row, Number(None), {})["verdict"] == "not measured"


def test_the_control_has_the_verdicts_of_other_methods(configured: Settings, known: KnownMethods) -> None:
    """Made-up: MOB finds as many as a detector must, and the table has no row of `zero`."""
    columns = {"level": "robots", "leg": "LL", "kind": "walking", "cell": "all", "quantity": "found"}
    rows = [{**columns, "detector": name, "value": "0.95", "low": low, "high": "1.0"}
            for name, low in (("MOB", "0.9"), ("MOB-Net-OR", "0.99"))]  # fmt: skip
    claim = configured.claims["found-or"]
    results = Evidence(configured.layout, {}, {}, pd.DataFrame(), {str(claim.cells[0].table): rows})
    assert control_of(claim, results, STATISTICS, known) == {"MOB": "reproduced"}
    rows[0]["low"] = "0.7"
    assert control_of(claim, results, STATISTICS, known) == {"MOB": "open"}


@pytest.mark.parametrize(
    ("networks", "verdict"), [((1,), "description"), ((1, 2), "description"), ((3, 1), "reproduced")]
)
def test_fewer_than_three_trainings_are_not_counted(
    networks: tuple[int, ...], verdict: str, configured: Settings, known: KnownMethods
) -> None:
    row = row_of(configured, "load-upper")
    found = on(known, row, Number(1.0, 0.95, 1.05, networks=networks), {})
    assert found["verdict"] == verdict
    observer = row_of(configured, "mob-exact")
    assert on(known, observer, Number(0.01, 0.009, 0.011, networks=(1,)), {})["verdict"] == "reproduced"


def test_a_trend_rests_on_the_trainings_of_all_sizes(configured: Settings, known: KnownMethods) -> None:
    row = row_of(configured, "data-mob-net")
    assert on(known, row, Number(-1.0, -2.0, -0.5, networks=(1, 1, 1, 1, 1)), {})["verdict"] == "reproduced"


def test_methods_of_the_paper_are_named_and_claims_on_others_are_known(
    configured: Settings, known: KnownMethods
) -> None:
    odd: list[str] = []
    for row in rows_of(configured.claims):
        if score_of(row.claim, known.methods) != OURS and known.not_original(row.claim):
            odd.append(row.statement)
    assert [name for name in odd if not name.startswith(OF_OURS)] == []
    assert set(known.original) <= {*configured.methods, *configured.detection.detectors, *swept(configured)}


def swept(settings: Settings) -> set[str]:
    """Return the methods of sweeps, without the value."""
    names: set[str] = set()
    for key, sweep in settings.sweeps.items():
        names.update(f"{method}-{key.replace('_', '-')}" for method in sweep.of)
    return names


@pytest.mark.parametrize(
    "row", [row for row in PUBLISHED if row["verdict"] == REPRODUCED], ids=lambda row: row["claim"]
)
def test_nothing_that_tells_too_little_is_published_as_reproduced(
    row: dict[str, str], configured: Settings, known: KnownMethods
) -> None:
    claim = row_of(configured, row["claim"]).claim
    assert REPRODUCED not in [row[column] for column in STAND_INS.values()]
    assert row["score"] == OURS or known.not_original(claim) == []
    if row["score"] == NETWORKS and row["networks"]:
        assert max(map(int, row["networks"].split("+"))) >= 3
