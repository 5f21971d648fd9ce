"""Made-up scores, whose means are known."""

import itertools
from collections.abc import Iterable, Mapping
from typing import Any

from experiments.evaluation.measure.claims.cells import listed
from experiments.records.scores import Score
from experiments.settings.claims import Cell, Claim, numbers_of
from experiments.settings.metrics import unit_of_metric
from experiments.settings.tables import ErrorRow
from mobnet.core.joints import JointLayout

JOINTS = [f"LL{i}" for i in range(1, 7)]
FURTHER = ["zero", "MOB-fric-load", "MOB-Kalman", "MOB-Net-gray"]  # baselines, below the paper's methods
LEVELS = {"ideal": ["MOB"], "sensor_noise": ["MOB"], "all_uncertainty": ["MOB", "MOB-Net", "FTS-e2e", *FURTHER]}
MEANS = {"ideal": 0.01, "sensor_noise": 1.2, "MOB": 19.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "zero": 40.0,
         "MOB-fric-load": 2.5, "MOB-Kalman": 3.0, "MOB-Net-gray": 1.4}  # avg [N m]  # fmt: skip
ALONE = ("MOB", "MOB-fric", "zero", "MOB-fric-load", "MOB-fric-dahl", "MOB-Kalman")  # methods without networks


def made_up_scores(networks: int = 2, tests: int = 3) -> list[Score]:
    """Return scores of every level and method whose means over runs are MEANS, joint by joint up to a factor."""
    rows = []
    for level, method in ((level, method) for level, methods in LEVELS.items() for method in methods):
        mean = MEANS.get(level, MEANS[method])
        seeds = range(1 if method in ALONE else networks)
        for network, test in itertools.product(seeds, range(1, tests + 1)):
            off = 1 + 0.1 * (test - (tests + 1) / 2) + 0.04 * (network - (len(seeds) - 1) / 2)
            for i, joint in enumerate([*JOINTS, "avg"]):
                factor = 1.0 if joint == "avg" else (i + 1) / 3.5
                run = ("forward_walk", level, method, network, test, "LL", joint)
                rows.append(Score(*run, "rmse", mean * factor * off, "N m"))
                rows.append(Score(*run, "rmse_raw", (mean + 5.0) * factor * off, "N m"))
                rows.append(Score(*run, "roughness", 50.0 * mean**0.1 * off, "N m/s"))
    return rows


def limb_scores(layout: JointLayout, scenario: str, means: dict[str, float], networks: int = 2) -> list[Score]:
    """Return scores of LL, W and RA on two tests: `means` of every joint and average [N m], up to a factor per run."""
    rows = []
    for method, mean in means.items():
        seeds = range(1 if method in ALONE else networks)
        for network, test in itertools.product(seeds, (1, 2)):
            value = mean * (1 + 0.1 * (test - 1.5) + 0.04 * (network - (len(seeds) - 1) / 2))
            for limb in ("LL", "W", "RA"):
                for joint in (*layout.limb(limb), "avg"):
                    run = (scenario, "all_uncertainty", method, network, test, limb, joint)
                    rows += [Score(*run, "rmse", value, "N m"), Score(*run, "rmse_raw", value + 1.0, "N m")]
    return rows


def table_scores(layout: JointLayout, rows: list[ErrorRow], metrics: tuple[str, ...]) -> list[Score]:
    """Return scores of every joint that rows of a table ask for: 2 networks where there are any, 3 tests.

    That of the k-th joint is 0.1 k times 4 of MOB, 3 of MOB-fric, 1 of MOB-Net, 2 of others, up to a factor per run.
    """
    sizes = {"MOB": 4.0, "MOB-fric": 3.0, "MOB-Net": 1.0}
    scores: list[Score] = []
    for row, method in ((each, name) for each in rows for name in (*each.methods, *each.further)):
        networks = 1 if method in ALONE else 2
        for network, test in itertools.product(range(networks), (1, 2, 3)):
            off = 1 + 0.1 * (test - 2) + 0.04 * (network - (networks - 1) / 2)
            for limb, joints in layout.groups.items():
                for joint in joints:
                    run = (row.scenario, row.level, method, network, test, limb, joint)
                    value = 0.1 * sizes.get(method, 2.0) * (layout.names.index(joint) + 1) * off
                    scores += [
                        Score(*run, metric, value * (k + 1), "%" if metric == "r_rmse" else layout.unit(joint))
                        for k, metric in enumerate(metrics)
                    ]
    return list(dict.fromkeys(scores))


def measured_scores(layout: JointLayout, tests: Iterable[Any], metrics: Mapping[str, tuple[float, str]]) -> list[Score]:
    """Return scores of the methods of tests, limb by limb: each metric's value, a tenth more of each later method.

    There are two walks; MOB has one network, others have two.
    """
    rows: list[Score] = []
    for test in tests:
        for k, method in enumerate(test.methods):
            for network, walk in itertools.product(range(1 if method == "MOB" else 2), (1, 2)):
                off = (1 + 0.1 * k) * (1 + 0.1 * (walk - 1.5) + 0.04 * (network - 0.5) * (method != "MOB"))
                for limb, (metric, (value, unit)) in itertools.product(test.limbs, metrics.items()):
                    for joint in (*layout.limb(limb), "avg"):
                        run = (test.scenario, test.level, method, network, walk, limb, joint, metric)
                        rows.append(Score(*run, value * off, unit))
    return rows


def cells_of(claims: list[Claim]) -> list[Cell]:
    """Return all cells of claims and of their causes."""
    return [cell for claim in claims for made in numbers_of(claim) for cell in made.cells]


def claimed_scores(layout: JointLayout, claims: list[Claim], means: dict[str, float], pushes: bool) -> list[Score]:
    """Return the scores that claims name, and the plain error: 0.01 where all is ideal, else a method's mean [N m]."""
    networks = {"MOB": 1, "MOB-fric": 1, "MOB-fric-load": 1, "MOB-Net-Single": 2, "zero": 1}
    rows = {}
    for cell in (cell for cell in cells_of(claims) if cell.joint):
        metrics = {"rmse", *listed(cell.metric or "rmse")}
        kept = [name for name in sorted(metrics) if pushes or "push" not in name]
        mean = 0.01 if cell.level == "ideal" else means[str(cell.method)]
        joints = [joint for name in listed(cell.joint or ()) for joint in layout.groups.get(name, (name,))]
        limbs = [next(limb for limb, own in layout.groups.items() if joint in own) for joint in joints]
        seeds = range(networks.get(str(cell.method), 3))
        for (limb, joint), name, network, test in itertools.product(
            zip(limbs, joints, strict=True), kept, seeds, (1, 2)
        ):
            run = (str(cell.scenario), str(cell.level), str(cell.method), network, test, limb, joint, name)
            rows[run] = Score(*run, mean * (1 + 0.01 * (test - 1.5)), unit_of_metric(name, "N m"))
    return list(rows.values())


def push_scores(scenario: str, means: dict[str, float], pushes: int) -> list[Score]:
    """Return scores of LL3 around pushes: `means` of all [N m], a tenth more of each later one, one less of no push."""
    rows, level = [], "all_uncertainty" if scenario == "hip_pitch_step" else "robots"
    for method, mean in means.items():
        for network, test in itertools.product(range(1 if method == "MOB" else 2), (1, 2)):
            run = (scenario, level, method, network, test, "LL", "LL3")
            value = mean * (1 + 0.1 * (test - 1.5) + 0.04 * (network - 0.5) * (method != "MOB"))
            each = {f"rmse_push_{k}": value * (1 + 0.1 * (k - 1)) for k in range(1, pushes + 1)}
            measured = {"rmse": value - 1.0} | each | ({"rmse_pushed": value} if pushes else {})
            rows += [Score(*run, metric, number, "N m") for metric, number in measured.items()]
    return rows
