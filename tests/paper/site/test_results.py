"""Pages of results: a table and a figure with caption, command, numbers and the claims about them."""

import shutil
from pathlib import Path

import pytest

from experiments.settings.claims import Claim
from experiments.site.results import result_pages

PUBLISHED = Path(__file__).parents[3] / "docs/results"


@pytest.fixture
def pages(tmp_path: Path, settings) -> dict[str, str]:
    """Pages of a table and a figure of one name, a figure of the paper, and a caption of what is not published."""
    results, captions = tmp_path / "results", []
    (results / "figures").mkdir(parents=True)
    for kind, names in (("figures", ("sigma", "figure_06")), ("tables", ("sigma", "table_05", "waiting"))):
        for name in names:
            captions.append(tmp_path / kind / f"{name}.rst")
            captions[-1].parent.mkdir(exist_ok=True)
            field = '{{ found("mob-exact") }}'
            captions[-1].write_text(f"Title of {kind} {name}\n\nText of ``{name}`` and {field} N m.\n")
    for name in ("sigma.png", "figure_06.png", "figures/figure_06.csv.gz", "figures/figure_06_bars.csv.gz"):
        (results / name).touch()
    for name in ("sigma", "table_05"):
        (results / f"{name}.md").write_text("| a |\n| --- |\n| 1.25 |\n")
        (results / f"{name}.csv").touch()
    shutil.copy(PUBLISHED / "claims_summary.csv", results)
    head, *rows = (PUBLISHED / "claims.csv").read_text().splitlines()
    named = next(row for row in rows if row.startswith("mob-exact,"))
    (results / "claims.csv").write_text(f"{head}\n{named}\n")
    claims: dict[str, Claim] = settings.claims
    return dict(result_pages(results, captions, claims))


def test_a_table_has_caption_text_numbers_command_and_claims(pages) -> None:
    page = pages["docs/results/table_05.md"]
    assert page.startswith("# Title of tables table_05\n")
    for text in (
        "Text of ``table_05`` and 0.010 N m.",
        "| 1.25 |",
        "[table_05.csv](table_05.csv)",
        "`./reproduce tables/table_05.md`",
    ):
        assert text in page
    claims = page.split("## Claims about it")[1]
    assert "(Table 5, Ideal): reproduced." in claims
    assert "(Table 5): not measured." in claims
    assert "Figure 6" not in claims


def test_a_figure_has_its_picture_and_all_its_numbers(pages) -> None:
    page = pages["docs/results/figure_06.md"]
    assert "](figure_06.png)](figure_06.png)" in page
    assert "[figures/figure_06.csv.gz](figures/figure_06.csv.gz), [figures/figure_06_bars.csv.gz]" in page
    assert "`./reproduce figures/figure_06.pdf`" in page


def test_a_table_keeps_the_name_that_a_figure_has_too(pages) -> None:
    assert "| 1.25 |" in pages["docs/results/sigma.md"]
    assert "sigma.png" in pages["docs/results/sigma_figure.md"]


def test_the_gallery_shows_what_is_published_those_of_the_paper_first(pages) -> None:
    page = pages["docs/results/README.md"]
    places = [page.index(f"Title of {name}") for name in ("figures figure_06", "figures sigma", "tables table_05")]
    assert places == sorted(places)
    assert "waiting" not in page
    assert "docs/results/waiting.md" not in pages
