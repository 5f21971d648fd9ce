"""Pages are made of templates that their rules know."""

from pathlib import Path

import pytest
from jinja2 import Environment, UndefinedError
from jinja2.meta import find_referenced_templates

from experiments.evaluation.report.html import rendered
from experiments.plan.plan import make_plan
from experiments.plan.products import TEMPLATES
from experiments.settings.settings import Settings

REPO = Path(__file__).parents[4]
PAGES = {"runs_page": ["runs"], "explore": ["explore"], "pages": ["table", "claims", "index"]}  # product -> pages


def files_behind(name: str) -> set[str]:
    """Return a template and all that it extends or includes, directly or not."""
    tree = Environment().parse((REPO / TEMPLATES / name).read_text())
    found = [other for other in find_referenced_templates(tree) if other is not None]
    return {name}.union(*map(files_behind, found))


@pytest.fixture(scope="module")
def inputs(settings: Settings) -> dict[str, set[str]]:
    """Page -> the templates that are inputs of its rule."""
    products = {product.name: product for product in make_plan(settings, with_pdf=False).products}
    return {
        page: {path.name for path in map(Path, products[name].inputs) if path.parent == TEMPLATES}
        for name, pages in PAGES.items()
        for page in pages
    }


def test_the_rule_of_a_page_reruns_when_any_of_its_templates_changes(inputs: dict[str, set[str]]) -> None:
    for page, known in inputs.items():
        assert files_behind(f"{page}.html") <= known


def test_every_template_belongs_to_a_page(inputs: dict[str, set[str]]) -> None:
    used = set[str]().union(*(files_behind(f"{page}.html") for page in inputs))
    assert {path.name for path in (REPO / TEMPLATES).iterdir()} == used
    assert set[str]().union(*inputs.values()) == used


def test_text_is_escaped_and_a_missing_value_is_an_error(tmp_path: Path) -> None:
    template = tmp_path / "one.html"
    template.write_text("<p>{{ text }}</p>\n")
    assert rendered(template, text="a < b") == "<p>a &lt; b</p>\n"
    with pytest.raises(UndefinedError, match="text"):
        rendered(template)
