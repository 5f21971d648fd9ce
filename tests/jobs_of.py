"""What the job of a rule gets and reads."""

from types import SimpleNamespace
from typing import Any

from experiments.plan.files import PLANT, made_by_jobs
from experiments.plan.plan import Plan


def arguments(plan: Plan, rule: str, robot: str = PLANT, **wildcards: str) -> Any:
    """Return the arguments of a rule's job by its wildcards."""
    return getattr(plan.jobs, rule)(SimpleNamespace(robot=robot, **wildcards))


def reads(plan: Plan, rule: str, robot: str = PLANT, **wildcards: str) -> list[str]:
    """Return what the job reads of what other jobs make."""
    w = SimpleNamespace(robot=robot, **wildcards)
    needs = [arguments(plan, rule, robot, **wildcards)]
    if rule == "train":
        needs.append(plan.jobs.learned_from(w))
    if rule == "estimate":
        files = plan.jobs.files(w)
        needs += [files.tests(w.scenario, w.level, kind) for kind in ("recordings", "residuals")]
    return made_by_jobs(needs)


def network(name: str) -> dict[str, str]:
    """Return the wildcards of a network's folder, METHOD-LIMB-sSEED."""
    method, limb, seed = name.rsplit("-", 2)
    return {"method": method, "limb": limb, "seed": seed.removeprefix("s")}
