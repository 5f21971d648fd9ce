"""The documentation's pages: every link leads somewhere, nothing comes from elsewhere, search works from a folder."""

import json
import re
from importlib.resources import files
from pathlib import Path

import pytest
from browser import with_browser
from links import broken, outside

from experiments.site.docs import SEARCHED, accessible, build, modules_of, relinked, with_words
from mobnet.core.errors import DataError
from mobnet.formats.reading import read_yaml

ROOT = Path(__file__).parents[3]


def test_links_to_folders_and_to_the_readme_lead_to_pages(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sources = tmp_path / "sources"
    (sources / "docs" / "results").mkdir(parents=True)
    (tmp_path / "configs").mkdir()
    (tmp_path / "configs" / "one.yaml").write_text("a: 1\n")
    text = "[a](results) [b](../README.md#limits) [c](../configs/one.yaml) [d](b.md) [e](https://x.org/README.md)"
    found = relinked(text, Path("docs/page.md"), sources)
    assert found == (
        "[a](results/README.md) [b](../index.md#limits) [c](../configs/one.yaml) [d](b.md) [e](https://x.org/README.md)"
    )
    assert (sources / "configs" / "one.yaml").read_text() == "a: 1\n"


def test_words_for_the_search_are_behind_the_title_or_a_heading():
    text = "Before\n# A page: one\n\n## Run it\ntext\n"
    title = with_words(text, "", ["docker"], "x")
    assert title == "Before\n# A page: one\n\n```{index} ! docker\n```\n\n## Run it\ntext\n"
    heading = with_words(text, "run-it", ["resume", "ctrl-c"], "x")
    assert heading == "Before\n# A page: one\n\n## Run it\n\n```{index} ! resume, ! ctrl-c\n```\ntext\n"
    with pytest.raises(DataError, match=r"search\.yaml: a\.md#run: the page has no such heading"):
        with_words(text, "run", ["resume"], "search.yaml: a.md#run")


def test_every_page_of_the_search_has_its_heading_and_each_word_once():
    for place, words in read_yaml(ROOT / SEARCHED).items():
        name, _, heading = place.partition("#")
        with_words((ROOT / name).read_text(), heading, words, place)
        assert len(set(words)) == len(words)
        assert [word for word in words if word != word.lower() or "," in word] == []


def test_modules_that_are_run_and_packages_that_are_not_public_have_no_page():
    names = ("core/rows.py", "core/__init__.py", "settings/base.py", "simulation/__main__.py", "kernel/low_pass.py")
    found = modules_of([Path("src/mobnet") / name for name in names])
    assert {name: modules for name, modules in found.items() if modules} == {
        "core": ["mobnet.core.rows"],
        "kernel": ["mobnet.kernel.low_pass"],
    }


def test_a_link_that_leads_nowhere_stops_the_build_with_its_line(tmp_path):
    (tmp_path / "sources" / "docs").mkdir(parents=True)
    conf = (ROOT / "docs" / "conf.py").read_text()
    (tmp_path / "sources" / "conf.py").write_text(conf)
    (tmp_path / "sources" / "docs" / "site.css").touch()
    (tmp_path / "sources" / "index.md").write_text("# Title\n\nText with a [link](nowhere.md).\n")
    with pytest.raises(DataError, match=r"index\.md:3: WARNING: .*nowhere\.md"):
        build(tmp_path / "sources", tmp_path / "pages")


def test_a_page_that_is_not_of_the_theme_stays_as_it_is():
    assert accessible("<pre>") == "<pre>"
    assert accessible('<aside class="sidebar-drawer"><pre>').endswith('<pre tabindex="0">')


@pytest.mark.slow
def test_every_link_of_every_page_leads_to_a_file_and_a_place_in_it(site):
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > 100
    assert list(broken(pages)) == []


@pytest.mark.slow
def test_every_field_of_a_text_is_filled(site):
    """Code shows how fields are written; scripts and styles have braces of their own."""
    others = re.compile(r"<(code|pre|script|style)\b.*?</\1>", re.DOTALL)
    found = {}
    for page in site.rglob("*.html"):
        if fields := re.findall(r"\{\{.*", others.sub("", page.read_text())):
            found[str(page.relative_to(site))] = fields
    assert found == {}
    text = (site / "docs" / "results" / "all_claims.html").read_text()
    (statements,) = re.findall(r"Of (\d+) statements of the original", text)
    readme = (ROOT / "README.md").read_text()
    assert f"judged {statements} of their statements" in " ".join(readme.split())


@pytest.mark.slow
def test_nothing_is_loaded_from_elsewhere(site):
    assert outside([*site.rglob("*.html"), *site.rglob("*.css")]) == set()


@pytest.mark.slow
def test_every_document_is_a_page_and_every_published_figure_is_shown(site):
    documents = [*(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "notes").glob("*.md")]
    pages = [site / path.relative_to(ROOT).with_suffix(".html") for path in documents]
    assert [page for page in pages if not page.is_file()] == []
    gallery = (site / "docs" / "results" / "README.html").read_text()
    drawn = [path.stem for path in (ROOT / "docs" / "results").glob("*.png")]
    assert [name for name in drawn if f"{name}.png" not in gallery] == []


@pytest.mark.slow
@with_browser
@pytest.mark.parametrize("page", [
    "index", "docs/map", "docs/robots", "docs/logs", "docs/interface", "docs/results/README", "docs/results/claims",
    "docs/results/all_claims", "docs/results/table_05", "reference/configuration/plant", "reference/commands",
    "reference/internals", "reference/export", "docs/notes/observer", "search",
])  # fmt: skip
def test_axe_finds_no_fault_of_access_on_a_page_of_each_kind(site, running, page):
    with running.sized(1280):
        running.go((site / f"{page}.html").as_uri())
        running.value((files("axe_core_python") / "axe.min.js").read_text())
        running.value("axe.run().then((found) => { window.axeFound = found.violations; })")
        running.until("Boolean(window.axeFound)", True)
        nodes = "one.nodes.map((node) => node.html.slice(0, 100))"
        found = json.loads(running.value(f"JSON.stringify(axeFound.map((one) => [one.id, {nodes}]))"))
    assert found == []


@pytest.mark.slow
@with_browser
def test_tables_of_the_map_fit_the_page_of_a_laptop(site, running):
    with running.sized(1280):
        running.go((site / "docs/map.html").as_uri())
        wide = "[...document.querySelectorAll('.table-wrapper')].filter((one) => one.scrollWidth > one.clientWidth + 1)"
        assert running.value(f"[document.querySelectorAll('.table-wrapper').length, {wide}.length]") == [3, 0]


@pytest.mark.slow
@with_browser
def test_modules_are_below_the_page_of_the_names_for_programs(site, running):
    """No module and no package is in the first level of the menu."""
    running.go((site / "index.html").as_uri())
    first = running.value("[...document.querySelectorAll('.sidebar-tree li.toctree-l1 > a')].map((a) => a.href)")
    assert any(link.endswith("docs/interface.html") for link in first)
    made = [link.rpartition("/reference/")[2] for link in first if "/reference/" in link]
    assert made == ["commands.html", "configuration.html"]


@pytest.mark.slow
@with_browser
def test_search_finds_a_page_without_a_server(site, running):
    running.events.clear()
    running.go(f"{(site / 'search.html').as_uri()}?q=momentum+observer")
    running.until("document.querySelectorAll('#search-results li a').length > 5", True)
    links = running.value("[...document.querySelectorAll('#search-results li a')].map(a => a.href)")
    assert any("observer.html" in link for link in links)
    assert [event for event in running.events if event["method"] == "Runtime.exceptionThrown"] == []
    asked = [event["params"]["request"]["url"] for event in running.events if event["method"].endswith("WillBeSent")]
    assert [url for url in asked if not url.startswith(("file:", "data:", "about:"))] == []


@pytest.mark.slow
@with_browser
@pytest.mark.parametrize(("word", "page"), [
    ("resume", "docs/guide.html"),
    ("docker", "docs/guide.html"),
    ("apptainer", "docs/cluster.html"),
    ("tolerance", "docs/guide.html"),
    ("ROS", "docs/log_formats.html"),
    ("threshold", "docs/detection.html"),
    ("urdf", "docs/robots.html"),
])  # fmt: skip
def test_a_search_finds_the_guide_first_and_pages_of_modules_behind_all_texts(site, running, word, page):
    running.go(f"{(site / 'search.html').as_uri()}?q={word}")
    running.until("/finished/.test(document.querySelector('.search-summary')?.innerText)", True)
    links = running.value("[...document.querySelectorAll('#search-results li > a')].map(a => a.href)")
    names = [re.split("[?#]", link.removeprefix(f"{site.as_uri()}/"))[0] for link in links]
    assert names[0] == page
    texts = [name for name in names if not re.match(r"CHANGELOG\.|reference/(?!commands\.)", name)]
    assert names[: len(texts)] == texts
