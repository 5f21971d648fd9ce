"""Files of results that are not those of the plan."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.plan.plan import Plan
from experiments.plan.steps import Step
from experiments.running.logs import LOGS

FOREIGN = "made by another configuration or code, which is not accepted; accepted:"


@dataclass(frozen=True)
class Stamped:
    """The files of a plan that have stamps, below the folder of the project."""

    plan: Plan
    root: Path = Path()

    @cached_property
    def steps(self) -> Mapping[str, Step]:
        """File -> the step that makes it."""
        found: dict[str, Step] = {}
        for step in (*self.plan.trial_steps, *self.plan.steps):
            found |= dict.fromkeys(step.outputs, step)
        return found

    @cached_property
    def folders(self) -> frozenset[str]:
        """Folders of results in which every file has a step."""
        return frozenset(map(self._folder, self.steps))

    def foreign(self, names: Iterable[str]) -> Iterator[str]:
        """Yield a line for each file, by its name below the project, that is not what its step makes.

        Tables, figures and what else products make have no stamps, and are left out.
        """
        for name in names:
            step = self.steps.get(name)
            if step is None and self._folder(name) in self.folders:
                yield f"{name}: {FOREIGN} a file that a job of this configuration makes"
            elif step and not step.job.stamps.fit(self.root, self._account(step), name):
                yield f"{name}: {FOREIGN} what `./reproduce {name} --force` makes"

    def _folder(self, name: str) -> str:
        return self.plan.files.owner_of(Path(name))[1][0]

    def _account(self, step: Step) -> str:
        return f"{self.plan.folders.results}/{LOGS}/{step.work.job}.json"
