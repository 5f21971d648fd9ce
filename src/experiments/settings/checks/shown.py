"""What must hold for tables, figures and claims: what they show is run, estimated, trained and pushed.

What must hold for a single table or figure stands with its section (`experiments.settings.products.Checked`).
"""

from collections.abc import Iterator

from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.claims import claim_problems
from experiments.settings.checks.detection import detection_problems, reaction_problems
from experiments.settings.checks.estimates import asked_problems
from experiments.settings.checks.results import Results
from experiments.settings.products import problems_in
from mobnet.settings.reading import Problem


def shown_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what does not fit in tables, figures and claims, and in detectors and reactions that they show."""
    results = Results(catalogue)
    yield from problems_in(catalogue.settings.evaluation, results, ("evaluation",))
    yield from detection_problems(results)
    yield from reaction_problems(results)
    yield from asked_problems(catalogue)
    yield from claim_problems(results)
