"""Which step of a plan makes a file."""

from pathlib import Path
from typing import Any

from experiments.plan.plan import Plan
from experiments.plan.steps import Step


def maker(plan: Plan, *place: str) -> Step:
    """Return the step, one of the trials too, that makes a file below the results of the plan's scale."""
    file = str(plan.folders.results.joinpath(*place))
    (found,) = [step for step in (*plan.steps, *plan.trial_steps) if file in step.outputs]
    return found


def arguments(plan: Plan, *place: str) -> Any:
    return maker(plan, *place).job.call.arguments


def recording(scenario: str, level: str, seed: int | str, robot: str = "") -> str:
    return str(Path(robot) / "recordings" / scenario / level / f"s{seed}.parquet")
