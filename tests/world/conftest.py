"""The whole configuration at its smoke scale, and the documentation of this checkout."""

import pytest
from once import once
from paper_settings import recipe_of, settings, settings_at
from planned_jobs import ROOT

from experiments.plan.plan import make_plan
from experiments.site.docs import docs

__all__ = ["recipe_of", "settings"]


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The documentation of this checkout as the rule makes it, which takes some minutes: once for all tests."""

    def build(folder):
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(ROOT)
            (product,) = make_plan(settings_at("smoke"), with_pdf=False).docs
            docs(**{**product.call.arguments, "out": folder})

    return once(tmp_path_factory, "site", build)
