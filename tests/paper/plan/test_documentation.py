"""The documentation is made apart from all other products, from files that are in the project."""

from pathlib import Path

import pytest

from experiments.plan.plan import Plan, make_plan
from experiments.plan.product import Product
from experiments.settings.load import load_settings

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def plan() -> Plan:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        return make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)


@pytest.fixture
def product(plan: Plan) -> Product:
    (product,) = plan.docs
    return product


def test_no_product_needs_it_and_it_needs_none(plan: Plan, product: Product) -> None:
    assert product.outputs == ("results/smoke/docs",)
    made = {name for one in plan.products for name in one.outputs}
    assert not made & set(product.inputs)
    assert not [one.name for one in plan.products if set(one.inputs) & set(product.outputs)]


def test_it_is_made_again_when_a_document_a_caption_a_result_or_a_docstring_changes(product: Product) -> None:
    wanted = (
        "README.md", "docs/README.md", "docs/conf.py", "docs/notes/observer.md", "docs/results/figure_06.png",
        "docs/results/claims.csv", "workflow/report/tables/table_05.rst", "src/mobnet/formats/base.py",
    )  # fmt: skip
    assert [name for name in wanted if name not in product.inputs] == []
    assert [name for name in product.inputs if not (ROOT / name).is_file()] == []
