"""The page of all runs: what it says, and what a browser makes of it when somebody clicks and types."""

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import astuple
from html.parser import HTMLParser
from pathlib import Path

import pytest
from browser import Browser, with_browser

from experiments.evaluation.report.runs_page import COLUMNS, runs_page
from experiments.plan.products import TEMPLATES
from experiments.records.scores import SCORES, Score
from mobnet.core.files import TIME, write_json, write_text
from mobnet.core.rows import csv_text

REPO = Path(__file__).parents[3]
RUNS = {  # name -> cell, best validation loss, RMSE [N m]; the first one diverged before its first epoch ended
    "FTS-e2e-LL-s0": ("GRU", None, None),
    "GRU-LL-s0": ("GRU", -5.0, 1.5),
    "GRU-LL-s1": ("GRU", -4.0, 11.5),
    "LSTM-LL-s0": ("LSTM", -4.5, 2.5),
}
LOST = "FTS-e2e-LL-s0"  # what its training took
SHOWN = "[...document.querySelectorAll('#runs > tbody:not([hidden])')].map((run) => run.dataset.name)"
OPEN = "[...document.querySelectorAll('.more')].filter((row) => row.getClientRects().length).map((row) => row.id)"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory, write_run: Callable[..., Path]) -> Path:
    """The page of a few made-up trainings; the second of three epochs is the best."""
    networks = tmp_path_factory.mktemp("results") / "networks"
    for name, (cell, loss, rmse) in RUNS.items():
        rows = [(loss + x, rmse + x) for x in (1, 0, 0.5)] if loss and rmse else []
        lines = [f"{i},{a - 0.25},{a},{b},{0.005 / i},9" for i, (a, b) in enumerate(rows, start=1)]
        write_run(networks, name, lines, diverged=not rows, settings={"network": {"cell": cell}})
        if name != LOST:
            write_json(networks.with_name("state") / name / TIME, {"seconds": 360.0})
    return make_page(networks)


def make_page(networks: Path) -> Path:
    """Write the page of all trainings in a folder, and of the errors of one in two tests, beside that folder."""
    page, scores = networks.with_name("runs.html"), []
    for test, values in {"walk": (2.0, 3.0), "motion": (9.0,)}.items():
        rows = [
            Score(test, "robots", "GRU", 1, walk, "LL", "avg", "rmse", value, "N m")
            for walk, value in enumerate(values)
        ]
        scores.append(networks.with_name(test) / "robots.csv")
        write_text(scores[-1], csv_text(SCORES, [astuple(row) for row in rows]))
    runs_page("default", sorted(networks.iterdir()), scores, [REPO / TEMPLATES / "runs.html"], page)
    return page


class Reader(HTMLParser):
    """Collects rows of text, attributes, and tags that are not closed in their order."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.found: list[tuple[str, str | None]] = []
        self.open: list[str] = []
        self.feed(page.read_text())
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += attrs
        if tag not in ("meta", "input"):
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += attrs

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data.strip()

    def values(self, name: str) -> list[str | None]:
        """Return the values of an attribute."""
        return [value for key, value in self.found if key == name]


def test_every_run_has_a_row_with_its_numbers(page: Path) -> None:
    """The page is complete without scripts; a dash stands for a number that does not exist."""
    rows = {row[0]: row for row in Reader(page).rows}
    assert rows["GRU-LL-s1"][3:] == [
        "GRU", "LL", "1", "GRU", "83,712", "1,800,000", "3", "2", "-4.000", "11.50", "2.50", "360.0", "done",
    ]  # fmt: skip
    assert rows["FTS-e2e-LL-s0"][9:14] == ["0", "–", "–", "–", "–"]
    assert rows[LOST][14] == "–"
    assert rows["FTS-e2e-LL-s0"][-1] == "diverged"
    assert len(rows["name"]) == len(COLUMNS) + 1


def test_page_is_well_formed_and_needs_nothing_else(page: Path) -> None:
    read = Reader(page)
    assert read.open == []
    assert not read.values("src")
    assert max(Counter(read.values("id")).values()) == 1
    assert not re.search(r"https?:|@import|url\(", page.read_text())


def test_links_lead_to_the_metrics(page: Path) -> None:
    links = [value for value in Reader(page).values("href") if value and not value.startswith("#")]
    assert [page.parent / link for link in links] == [page.parent / f"networks/{name}/metrics.csv" for name in RUNS]
    assert all((page.parent / link).is_file() for link in links)


def test_what_a_run_says_is_text_never_markup(page: Path) -> None:
    assert "<script>alert" not in page.read_text()
    assert "&lt;script&gt;alert(1)" in page.read_text()


def test_equal_runs_give_equal_bytes(page: Path) -> None:
    once = page.read_bytes()
    assert make_page(page.parent / "networks").read_bytes() == once


def test_a_hundred_long_runs_stay_small(tmp_path: Path, write_run: Callable[..., Path]) -> None:
    """Two hundred epochs a run, as at the paper's scale: below 2 MB."""
    lines = [f"{i},{-i / 37:.6f},{-i / 41:.6f},{400 / i:.6f},{0.005 / i:.6f},9" for i in range(1, 201)]
    for seed in range(10):
        write_run(tmp_path / "networks", f"MOB-Net-LL-s{seed}", lines)
    assert make_page(tmp_path / "networks").stat().st_size < 200_000


@pytest.fixture
def browse(open_page: Callable[[Path, str], Browser], page: Path) -> Callable[[str], Browser]:
    """A function that loads the page with a fragment."""
    return lambda fragment: open_page(page, fragment)


@with_browser
def test_the_address_says_what_is_shown(browse: Callable[[str], Browser]) -> None:
    browser = browse("#sort=-rmse&filter=gru+LL&open=GRU-LL-s0")
    assert browser.value(SHOWN) == ["GRU-LL-s1", "GRU-LL-s0", "FTS-e2e-LL-s0"]
    assert browser.value(OPEN) == ["more-GRU-LL-s0"]
    assert browser.value("document.querySelector('#filter').value") == "gru LL"
    assert browser.value("document.querySelector('#shown').value") == "3 of 4 runs, 0.20 h of training"


@with_browser
def test_a_click_on_a_head_sorts_and_a_second_one_turns_it_round(browse: Callable[[str], Browser]) -> None:
    """Numbers by size, not by digits; a run without a number is last both ways."""
    browser = browse("")
    browser.click("[data-key=rmse] a")
    browser.until(SHOWN, ["GRU-LL-s0", "LSTM-LL-s0", "GRU-LL-s1", "FTS-e2e-LL-s0"])
    assert browser.value("document.querySelector('[aria-sort]').dataset.key") == "rmse"
    browser.click("[data-key=rmse] a")
    browser.until(SHOWN, ["GRU-LL-s1", "LSTM-LL-s0", "GRU-LL-s0", "FTS-e2e-LL-s0"])
    browser.click("[data-key=name] a")
    browser.until(SHOWN, sorted(RUNS))


@with_browser
def test_typing_filters_and_the_address_keeps_up(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    browser.click("#filter")
    browser.tell("Input.insertText", text="lstm")
    browser.until(SHOWN, ["LSTM-LL-s0"])
    assert browser.value("location.hash") == "#sort=name&filter=lstm"
    browser.tell("Input.insertText", text=" diverged")
    browser.until(SHOWN, [])


@with_browser
def test_a_name_opens_and_closes_its_run_and_back_undoes_it(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    assert browser.value(OPEN) == []
    browser.click("[data-name=GRU-LL-s1] th a")
    browser.until(OPEN, ["more-GRU-LL-s1"])
    assert browser.value("document.querySelectorAll('#more-GRU-LL-s1 .charts > svg').length") == 3
    assert browser.value("document.querySelector('[aria-expanded=true]').textContent") == "GRU-LL-s1"
    browser.click("[data-name=LSTM-LL-s0] a")
    browser.until(OPEN, ["more-GRU-LL-s1", "more-LSTM-LL-s0"])
    browser.click("[data-name=GRU-LL-s1] th a")
    browser.until(OPEN, ["more-LSTM-LL-s0"])
    browser.value("history.back()")
    browser.until(OPEN, ["more-GRU-LL-s1", "more-LSTM-LL-s0"])


@with_browser
def test_the_keyboard_alone_sorts_and_opens(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    browser.value("document.querySelector('[data-key=loss] a').focus()")
    browser.press("Enter", 13, "\r")
    browser.until(SHOWN, ["GRU-LL-s0", "LSTM-LL-s0", "GRU-LL-s1", "FTS-e2e-LL-s0"])
    for _ in range(len(COLUMNS) - [column.key for column in COLUMNS].index("loss") + 1):  # the last one passes a box
        browser.press("Tab", 9)
    browser.press("Enter", 13, "\r")
    browser.until(OPEN, ["more-GRU-LL-s0"])


@with_browser
def test_curves_are_drawn_large_where_a_run_is_opened(browse: Callable[[str], Browser]) -> None:
    """The large curve is the small one, scaled to fill its axes."""
    browser = browse("#open=GRU-LL-s0")
    small, large = (
        browser.value(f"(() => {{const b = document.querySelector('{place}').getBoundingClientRect();"
                      "return [b.width, b.height]})()")
        for place in ("#loss-GRU-LL-s0", "#more-GRU-LL-s0 use")
    )  # fmt: skip
    assert large[0] > 4 * small[0] > 0
    assert large[1] > 4 * small[1] > 0


@with_browser
def test_a_link_to_an_opened_run_shows_it_without_scrolling(browse: Callable[[str], Browser]) -> None:
    with browse("").sized(1000, 300):
        browser = browse("#open=LSTM-LL-s0")
        browser.until("document.querySelector('.open').getBoundingClientRect().top < innerHeight", True)


@with_browser
def test_without_scripts_every_run_is_open(browse: Callable[[str], Browser]) -> None:
    browser = browse("")
    with browser.without_scripts():
        browser.until(f"{OPEN}.length", len(RUNS))


CHOSEN = "[...document.querySelectorAll('#runs input:checked')].map((box) => box.closest('tbody').dataset.name)"
LEGEND = "[...document.querySelectorAll('#legend li')].map((entry) => entry.textContent)"
ROW = "(row) => [...row.cells].map((cell) => cell.textContent)"
DIFFERENT = f"[...document.querySelectorAll('#difference tbody tr')].map({ROW})"


def heights(browser: Browser) -> list[list[float]]:
    """Return how high the curves of the chart of chosen runs are at each epoch."""
    lines = browser.value(
        "[...document.querySelectorAll('#overlay polyline')].map((line) => line.getAttribute('points'))"
    )
    return [[-float(point.split(",")[1]) for point in line.split(" ")] for line in lines]


@with_browser
def test_chosen_runs_stand_in_one_chart_and_in_the_address(browse: Callable[[str], Browser]) -> None:
    """Curves that the page has on grids of their own are on one axis here: a run with twice the error lies higher."""
    browser = browse("#curve=rmse")
    assert browser.value("document.querySelector('#compare').getClientRects().length") == 0
    for name in ("GRU-LL-s1", "GRU-LL-s0"):
        browser.click(f"[data-name={name}] input")
    browser.until(CHOSEN, ["GRU-LL-s0", "GRU-LL-s1"])
    assert browser.value(LEGEND) == ["GRU-LL-s1", "GRU-LL-s0"]
    assert browser.value("location.hash") == "#curve=rmse&sort=name&pick=GRU-LL-s1&pick=GRU-LL-s0"
    upper, lower = heights(browser)
    assert min(upper) > max(lower)
    step = upper[0] - upper[1]  # 1 N m, ten of which lie between the two runs
    assert [a - b for a, b in zip(upper, lower, strict=True)] == pytest.approx([10 * step] * 3, rel=0.02)
    browser.click("#none")
    browser.until(CHOSEN, [])


@with_browser
def test_a_mean_over_seeds_lies_between_them_in_a_band(browse: Callable[[str], Browser]) -> None:
    (upper, lower), (mean,) = (
        heights(browse(f"#curve=rmse&{rest}")) for rest in ("pick=GRU-LL-s1&pick=GRU-LL-s0", "pick=GRU-LL-s0&mean=1")
    )
    assert mean == pytest.approx([(a + b) / 2 for a, b in zip(upper, lower, strict=True)], abs=1.0)
    browser = browse("#curve=rmse&pick=GRU-LL-s0&mean=1")
    assert browser.value(LEGEND) == ["GRU LL, 2 seeds"]
    band = browser.value("document.querySelector('#overlay polygon').getAttribute('points')").split(" ")
    edges = [-float(point.split(",")[1]) for point in band]
    assert edges == pytest.approx([*lower, *reversed(upper)], abs=1.0)


@with_browser
def test_settings_of_two_chosen_runs_are_compared(browse: Callable[[str], Browser]) -> None:
    assert browse("#pick=GRU-LL-s0&pick=LSTM-LL-s0").value(DIFFERENT) == [["settings.network.cell", "GRU", "LSTM"]]
    browser = browse("#pick=GRU-LL-s0&pick=LSTM-LL-s0&pick=GRU-LL-s1")
    assert browser.value("document.querySelector('#difference').hidden")


@with_browser
def test_a_run_without_epochs_and_a_name_of_none_do_no_harm(browse: Callable[[str], Browser]) -> None:
    browser = browse("#pick=FTS-e2e-LL-s0&pick=nobody&curve=nothing&sort=nothing")
    assert browser.value(LEGEND) == ["FTS-e2e-LL-s0: no epoch was finished"]
    assert browser.value("document.querySelectorAll('#overlay polyline').length") == 0


@with_browser
@pytest.mark.parametrize("width", [400, 1280])
def test_the_page_is_not_wider_than_the_screen_and_names_stay(browse: Callable[[str], Browser], width: int) -> None:
    with browse("").sized(width, mobile=True):
        browser = browse("#pick=GRU-LL-s0&pick=LSTM-LL-s0&open=GRU-LL-s0")
        assert browser.value("document.documentElement.scrollWidth") == width
        browser.value("document.querySelector('#table').scrollLeft = 500")
        lefts = [
            browser.value(f"document.querySelector('{place}').getBoundingClientRect().left")
            for place in ("#runs > tbody:not([hidden]) th", "#table")
        ]
        assert lefts[0] == pytest.approx(lefts[1], abs=2)


def test_what_all_runs_share_is_shown_once(page: Path) -> None:
    text = page.read_text()
    assert text.count("<dt>provenance.commit</dt>") == 1
    assert text.count("<dt>settings.network.cell</dt>") == len(RUNS)
