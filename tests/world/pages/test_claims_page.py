"""The page of the claims: what it says, and what a browser makes of it when somebody clicks, types and narrows it."""

from base64 import b64encode
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from browser import Browser, wait, with_browser

from experiments.evaluation.measure.claims.verdicts import worst
from experiments.evaluation.report.claims_page import (
    BAND,
    WIDTH,
    ClaimRow,
    claims_page,
    places_of,
    plot_of,
    read_statements,
    verdict_counts,
)
from experiments.plan.products import TEMPLATES
from experiments.settings.load import load_settings
from experiments.settings.verdicts import VERDICTS
from mobnet.core.rows import read_texts

REPO = Path(__file__).parents[3]
GOLDEN = REPO / "tests" / "golden" / "claims.csv"
SHOWN = "[...document.querySelectorAll('#statements > tbody:not([hidden])')].map((body) => body.dataset.name)"
OPEN = "[...document.querySelectorAll('details[open]')].map((one) => one.closest('tbody[data-name]').dataset.name)"
CLAIM = ClaimRow(
    "a", "A.", "Table 5", "reproduced", "", 1.0, 1.5, 1.25, 1.75, "N m", "inside", "same", (0.5, 2.0), (0.2, 5.0)
)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the claims of the golden table."""
    page = tmp_path_factory.mktemp("claims") / "claims.html"
    page.write_text(claims_page(GOLDEN, 0.95, "Claims", "<p>text</p>", REPO / TEMPLATES / "claims.html"))
    return page


def test_a_statement_has_all_its_claims_and_the_worst_of_their_verdicts() -> None:
    rows, statements = read_texts(GOLDEN), read_statements(GOLDEN)
    assert [statement.name for statement in statements] == list(dict.fromkeys(row["statement"] for row in rows))
    for statement in statements:
        own = [row for row in rows if row["statement"] == statement.name]
        assert [claim.name for claim in statement.claims] == [row["claim"] for row in own]
        assert statement.verdict == worst([row["verdict"] for row in own])
    assert sum(verdict_counts(statements).values()) == len(statements)
    assert list(verdict_counts(statements)) == list(VERDICTS)


def test_a_joint_is_told_from_a_claim() -> None:
    assert CLAIM.joint == ""
    assert replace(CLAIM, name="noise-floor-LL1").joint == "LL1"


@pytest.mark.parametrize(("printed", "places"), [
    ("Table 6, section 5.1", ["Table 6", "section 5.1"]), ('5.1, "6.7 %"', ["section 5.1"]), ("6.3, Figure 20 (a)",
    ["section 6.3", "Figure 20"]), ("abstract, Table 5", ["abstract", "Table 5"]),
    ("not in the paper", ["not in the paper"]),
])  # fmt: skip
def test_where_a_claim_is_printed(printed: str, places: list[str]) -> None:
    assert places_of(printed) == places


def test_every_claim_of_the_configuration_is_printed_somewhere() -> None:
    assert all(places_of(claim.printed) for claim in load_settings().claims.values())


def test_the_range_has_the_same_place_in_every_picture_and_numbers_lie_as_they_compare() -> None:
    for factor in (1.0, 1000.0):
        names = ("published", "value", "low", "high")
        numbers = {name: factor * getattr(CLAIM, name) for name in names}
        ranges = {"claimed": (0.5 * factor, 2.0 * factor), "side": (0.2, None)}
        plot = plot_of(replace(CLAIM, **numbers, **ranges))
        assert plot.band == pytest.approx([share * WIDTH for share in BAND])
        assert plot.interval is not None
        assert plot.published is not None
        assert plot.side is not None
        places = [plot.side[0], plot.band[0], plot.published, plot.interval[0], plot.value, plot.interval[1]]
        assert places == sorted(places)
        assert plot.side[1] == WIDTH


def test_what_lies_far_out_stands_at_the_edge() -> None:
    for value, place in ((100.0, WIDTH), (-100.0, 0.0)):
        assert plot_of(replace(CLAIM, value=value, low=value, high=value)).value == place


@pytest.mark.parametrize("bounds", [(1.0, None), (None, 1.0)])
def test_a_range_that_is_open_on_one_side_ends_in_the_middle(bounds: tuple[float | None, float | None]) -> None:
    plot = plot_of(replace(CLAIM, claimed=bounds, side=None, published=None))
    assert plot.band == ((WIDTH / 2, WIDTH) if bounds[0] else (0.0, WIDTH / 2))
    assert WIDTH / 2 < plot.value < WIDTH


def test_a_claim_without_a_number_has_no_picture() -> None:
    assert replace(CLAIM, value=None, low=None, high=None).plot is None


@pytest.fixture
def browse(open_page: Callable[[Path, str], Browser], page: Path) -> Callable[[str], Browser]:
    """A function that loads the page with a fragment."""
    return lambda fragment: open_page(page, fragment)


def test_the_papers_statements_and_ours_have_a_bar_each(page: Path) -> None:
    """And those of the paper are also counted by their first claims."""
    text = " ".join(page.read_text().split())
    paper, ours = text.split("<h2>Statements of the original</h2>")[1].split(
        "<h2>Our own statements, not in the original</h2>"
    )
    statements = read_statements(GOLDEN)
    for part, kinds in ((paper, {one.kind for one in statements} - {"ours"}), (ours, {"ours"})):
        own = [one for one in statements if one.kind in kinds]
        for verdict, count in verdict_counts(own).items():
            assert (f">{count} {verdict}</span>" in part) == (count > 0)
    first = Counter(one.first.verdict for one in statements if one.kind != "ours")
    told = ", ".join(f"{first[verdict]} {verdict}" for verdict in VERDICTS if first[verdict])
    assert f"By their first claim alone: {told}." in paper
    assert "By their first claim alone" not in ours


@with_browser
def test_every_verdict_is_a_word_with_a_mark(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    words = browser.value("[...document.querySelectorAll('#statements .verdict')].map((one) => one.textContent)")
    rows = Counter(claim.verdict for one in read_statements(GOLDEN) if one.others for claim in one.claims)
    assert Counter(words) == rows + Counter(one.verdict for one in read_statements(GOLDEN))
    marks = browser.value(
        "[...document.querySelectorAll('#statements .verdict')].map((one) => getComputedStyle(one, '::before').content)"
    )
    assert len(set(zip(words, marks, strict=True))) == len(set(words)) == len(set(marks))


@with_browser
def test_the_address_says_what_is_shown(browse: Callable[[str], Browser]) -> None:
    statements = read_statements(GOLDEN)
    browser = browse("#verdict=open&kind=networks&sort=-ours")
    wanted = [one for one in statements if (one.verdict, one.kind) == ("open", "networks")]
    assert browser.value(SHOWN) == [one.name for one in sorted(wanted, key=lambda one: -(one.first.value or 0.0))]
    assert browser.value("document.querySelector('[aria-sort=descending]').dataset.key") == "ours"
    assert browser.value("document.forms[0].elements.verdict.value") == "open"
    said = browser.value("document.querySelector('#shown').value")
    assert said == f"{len(wanted)} of {len(statements)} statements"
    browser = browse("#place=Table+6")
    assert browser.value(SHOWN) == [one.name for one in statements if "Table 6" in one.places]


@with_browser
def test_a_menu_and_typing_filter_and_the_address_keeps_up(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    browser.value(
        "(() => {const menu = document.forms[0].elements.verdict; menu.value = 'reproduced';"
        "menu.dispatchEvent(new Event('input', {bubbles: true}))})()"
    )
    kept = [one.name for one in read_statements(GOLDEN) if one.verdict == "reproduced"]
    browser.until(SHOWN, kept)
    browser.click("input[type=search]")
    browser.tell("Input.insertText", text="5, Ideal")
    browser.until("location.hash", "#verdict=reproduced&filter=5%2C+Ideal")
    assert browser.value(SHOWN) == ["mob-exact"]


@with_browser
def test_a_click_on_a_head_sorts_and_a_second_one_turns_it_round(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    orders = [[VERDICTS.index(one.verdict) for one in read_statements(GOLDEN)]]
    with browser.sized(1280):
        for sign in (1, -1):
            browser.click("[data-key=verdict] a")
            browser.until("location.hash", f"#sort={'-' * (sign < 0)}verdict")
            browser.until("document.querySelector('[aria-sort]').ariaSort", "ascending" if sign > 0 else "descending")
            names = {one.name: VERDICTS.index(one.verdict) for one in read_statements(GOLDEN)}
            orders.append([sign * names[name] for name in browser.value(SHOWN)])
    assert orders[0] != sorted(orders[0])
    assert all(order == sorted(order) for order in orders[1:])


@with_browser
def test_a_line_opens_its_claims_and_the_address_keeps_them_open(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    first, second = [one.name for one in read_statements(GOLDEN) if one.others][:2]
    for name in (first, second):
        browser.click(f"[data-name={name}] summary")
    browser.until(OPEN, [first, second])
    assert browser.value("location.hash") == f"#open={first}&open={second}"
    browser.click(f"[data-name={first}] summary")
    browser.until(OPEN, [second])
    browser.click("#all")
    browser.until(f"{OPEN}.length", sum(bool(one.others) for one in read_statements(GOLDEN)))
    assert browser.value("location.hash") == "#open=all"


@with_browser
def test_it_filters_within_the_report_too(page: Path, open_page: Callable[..., Browser], tmp_path: Path) -> None:
    """There it stands in a frame whose address is the page itself."""
    data = b64encode(page.read_bytes()).decode()
    (tmp_path / "frame.html").write_text(f'<iframe src="data:text/html;base64,{data}"></iframe>')
    browser = open_page(tmp_path / "frame.html")
    (tree,) = browser.tell("Page.getFrameTree")["frameTree"]["childFrames"]
    world = browser.tell("Page.createIsolatedWorld", frameId=tree["frame"]["id"])["executionContextId"]

    def shown(script: str) -> Any:
        asked = {"expression": script, "contextId": world, "returnByValue": True}
        return browser.tell("Runtime.evaluate", **asked)["result"]["value"]

    shown(
        "(() => {const box = document.forms[0].elements.filter; box.value = '5, Ideal';"
        "box.dispatchEvent(new Event('input', {bubbles: true}))})() ?? 0"
    )
    assert wait(lambda: shown(SHOWN) == ["mob-exact"])


@with_browser
@pytest.mark.parametrize("width", [400, 1280])
def test_nothing_is_wider_than_the_screen(browse: Callable[[str], Browser], width: int) -> None:
    with browse("").sized(width, mobile=True):
        browser = browse("#open=all")
        assert browser.value("document.documentElement.scrollWidth") == width
        assert browser.value("document.querySelector('svg[viewBox]').getBoundingClientRect().width") == 160


@with_browser
def test_without_scripts_it_is_a_plain_table_whose_lines_open(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    with browser.without_scripts():
        browser.until(f"{SHOWN}.length", len(read_statements(GOLDEN)))
        assert browser.value("document.querySelector('form').getClientRects().length") == 0
        browser.click("summary")
        browser.until(f"{OPEN}.length", 1)
