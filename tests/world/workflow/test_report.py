"""Snakemake's report: every table and figure has its caption, and a browser can click through it offline.

The files shown are made up here; the workflow itself marks them for the report.
"""

import re
import shutil
from html import unescape
from pathlib import Path

import pytest
from browser import with_browser

from experiments.evaluation.report.pages import table_page, titled
from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.products import CATEGORIES, KEPT_TABLE, TEMPLATES
from experiments.settings.load import load_settings
from mobnet.core.files import write_text

from .clicks import MENU, ROWS, choose, explain, show, text_of_frame
from .conftest import ROOT

CAPTIONS = ROOT / "workflow" / "report"
TABLE_HTML = ROOT / TEMPLATES / "table.html"
FIELD = re.compile(r"\{\{.*?\}\}", re.DOTALL)  # of a caption
COUNTERPARTS = ["table_07", "table_08", "table_10", "table_11", "figure_08", "figure_09", "figure_10", "figure_12"]


def in_report(made):
    """Return category -> names of what the report must show, of all files that the workflow makes."""
    endings = {
        "figures": r"figures/.*\.png",
        "tables": r"(?:tables/.*|results/\w+/compute)\.md",
        "paper": r".*main\.pdf",
        "trainings": r".*/runs\.html",
        "explore": r".*/explore\.html",
        "start": r".*/pages/index\.html",
    }
    return {kind: sorted(Path(name).stem for name in made if re.fullmatch(end, name)) for kind, end in endings.items()}


def test_everything_shown_has_a_caption_and_every_caption_is_shown(outputs):
    evaluation = load_settings().evaluation
    shown = ("learning_curve", "why_share", "hit_path")  # tables of trials, which their own commands make
    waiting = {name for name in shown if not Path(getattr(evaluation, name).data).exists()}
    for kind, names in in_report(outputs("smoke")).items():
        captions = sorted(path.stem for path in (CAPTIONS / kind).iterdir() if path.stem not in waiting)
        if kind == "tables":
            names = sorted([*names, KEPT_TABLE.stem])  # that of a trial stands in the paper alone
        assert captions == names or (kind, names) == ("paper", [])  # without TeX there is none


@pytest.mark.parametrize("path", sorted(CAPTIONS.glob("*/*.rst")), ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_caption_has_a_title_of_its_own_and_is_sound(path):
    title, gap, *text = path.read_text().splitlines()
    assert 10 < len(title) < 60  # the menu is as wide as its longest line
    assert gap == ""
    assert len(text) >= 1
    page = table_page(TABLE_HTML, markdown_table(["a"], [["b"]]), *titled(path.read_text()))  # docutils finds no fault
    assert title in unescape(page)
    number = re.fullmatch(r"(table|figure)_(\d\d)", path.stem)
    if number:
        assert title.startswith(f"{number[1].capitalize()} {int(number[2])}: ")
        assert re.search(r"\(section\s\d", path.read_text())


@pytest.mark.parametrize("name", COUNTERPARTS)
def test_what_the_paper_took_from_the_robot_is_called_one_of_surrogate_robots(name):
    (path,) = CAPTIONS.glob(f"*/{name}.rst")
    assert "surrogate robot" in path.read_text().splitlines()[0]


@pytest.fixture(scope="module")
def report(make_project, snakemake, outputs):
    """The report of made-up files: each table has one cell that names it, each figure is the same picture."""
    folder = make_project("report")
    made = outputs("smoke")
    for path in (folder / name for name in made):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            path.write_text(markdown_table(["name", "number"], [[path.stem, "1.25"]]))
        elif path.suffix == ".png":
            shutil.copy(ROOT / "docs" / "results" / "figure_05.png", path)
        elif path.name in ("runs.html", "explore.html", "main.pdf", "index.html"):
            path.write_text(f'<h1 title="&amp;">made up: {path.stem}</h1>\n')
    for table in (folder / name for name in made if name.endswith(".md")):
        caption = titled((CAPTIONS / "tables" / f"{table.stem}.rst").read_text())
        page = table_page(TABLE_HTML, table.read_text(), *caption)
        write_text(folder / "results" / "smoke" / "pages" / f"{table.stem}.html", page)
    for kind in ("tables", "figures"):
        for caption in (CAPTIONS / kind).iterdir():
            filled = FIELD.sub("1.25", caption.read_text())
            write_text(folder / "results" / "smoke" / "captions" / kind / caption.name, filled)
    done = snakemake("--config", "scale=smoke", "--report", "report.html", folder=folder)
    assert (folder / "report.html").is_file(), done.stdout + done.stderr
    return folder / "report.html"


@with_browser
def test_the_first_page_says_what_it_is_and_lists_all_categories(report, open_page, outputs):
    browser = open_page(report)
    browser.until("document.querySelector('#app .prose h1')?.textContent", "MOB-Net reproduced in simulation")
    assert "Scale smoke" in browser.value("document.body.innerText")
    first = "document.querySelector('#app .prose iframe')"
    browser.until(f"{first}?.contentDocument?.body?.innerText.trim()", "made up: index")
    assert browser.value(f"{first}.contentDocument.querySelector('h1').title") == "&"
    assert browser.value(f"{first}.getBoundingClientRect().width > innerWidth / 2")
    shown = [CATEGORIES.get(kind, kind.capitalize()) for kind, names in in_report(outputs("smoke")).items() if names]
    assert browser.value(MENU)[-len(shown) :] == sorted(shown)
    assert sorted(shown)[0] == "0 Read me first"


@with_browser
@pytest.mark.parametrize("kind", ["figures", "tables"])
def test_a_category_lists_all_its_results(kind, report, open_page, outputs):
    browser = open_page(report)
    choose(browser, kind.capitalize())
    browser.until(ROWS, in_report(outputs("smoke"))[kind])


@with_browser
def test_a_table_is_shown_and_says_where_it_comes_from(report, open_page):
    browser = open_page(report)
    choose(browser, "Tables")
    show(browser, "table_07", "iframe.w-full")
    text = text_of_frame(browser)
    assert "1.25" in text
    for told in (text, explain(browser, "table_07")):
        assert "The original measured its Table 7 (section 5.2) on its robot" in " ".join(told.split())


@with_browser
def test_a_figure_fits_beside_the_menu_and_says_which_rule_made_it(report, open_page):
    browser = open_page(report)
    choose(browser, "Figures")
    show(browser, "figure_05", ".p-3 > img")
    browser.until("document.querySelector('#app .p-3 > img').naturalWidth > 100", True)
    box = browser.value("document.querySelector('#app .p-3 > img').getBoundingClientRect().toJSON()")
    assert box["top"] >= 0
    assert box["right"] <= browser.value("innerWidth")
    told = explain(browser, "figure_05")
    assert "After Figure 5 of the original (section 5.1" in told
    assert "SNAKEMAKE RULE figure" in told
