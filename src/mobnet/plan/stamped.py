"""Files of results that are not those of the plan."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from mobnet.plan.plan import Plan
from mobnet.running.logs import LOGS

FOREIGN = "made by another configuration or code, which is not accepted; accepted:"


def foreign(plan: Plan, names: Iterable[str], root: Path = Path()) -> Iterator[str]:
    """Yield a line for each file, by its name below the project, that is not what its job of the plan makes.

    Tables, figures and what else products make have no stamps; other files in the folders of results must have a job.
    """
    steps = {name: step for step in (*plan.trial_steps, *plan.steps) for name in step.outputs}
    kinds = {plan.files.owner_of(Path(name))[1][0] for name in steps}
    for name in names:
        step = steps.get(name)
        if step is None and plan.files.owner_of(Path(name))[1][0] in kinds:
            yield f"{name}: {FOREIGN} a file that a job of this configuration makes"
        elif step and not step.job.stamps.fit(root, f"{plan.folders.results}/{LOGS}/{step.work.job}.json", name):
            yield f"{name}: {FOREIGN} what `./reproduce {name} --force` makes"
