"""What gives verdicts a scale: methods that know nothing, judged as if they were the network of a claim.

A bound may be so wide, or a test so easy, that any method passes. So each claim about a network is judged a second time
with methods in the network's place that know nothing of it: no estimate at all, the observer alone, and MOB-Net's own
estimate half a walk late, which has its size and the wrong time. Where one of them would be reproduced, the claim says
nothing for the network: it is a description and not counted as reproduced. Nor is a claim of the original counted that
is judged on a method of ours, or that rests on fewer than `LEAST_TRAININGS` trainings of its network.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import get_args

from experiments.evaluation.measure.claims.cells import Evidence, listed
from experiments.evaluation.measure.claims.verdicts import ClaimNumbers, made_number, verdicts_of
from experiments.evaluation.number.number import Number
from experiments.settings.claim_ranges import ranges_of
from experiments.settings.claims import Cell, Claim, MadeNumber, TrainingMetric
from experiments.settings.runs import Statistics
from experiments.settings.verdicts import MOB_NET, NOT_MEASURED, OURS, REPRODUCED, STAND_INS
from mobnet.settings.detection import DetectorSettings
from mobnet.settings.methods import Method

# [own] Of two trainings no interval over trainings is of any use (docs/notes/measures.md).
LEAST_TRAININGS = 3
NAMES = ("detector", "method")  # columns of tables that name a method
VALUE = re.compile(r"-\d+$")  # of a sweep, at the end of the name of a method
COUNTS = {1: "one training", 2: "two trainings"}


@dataclass(frozen=True)
class KnownMethods:
    """The methods and detectors that claims name; `original` are those of the paper, with their places in it."""

    methods: Mapping[str, Method]
    detectors: Mapping[str, DetectorSettings]
    original: Mapping[str, str]

    def method_of(self, cell: Cell) -> str:
        """Return the method of a cell, of a detector the one that it runs on; empty where it has none."""
        name = name_of(cell)
        if "detector" in cell.where and name in self.detectors:
            return self.detectors[name].method
        return name

    def is_network(self, cell: Cell) -> bool:
        """Return whether a cell is of a method with networks."""
        method = self.methods.get(self.method_of(cell))
        return is_training(cell) or (method is not None and bool(method.limbs))

    def network_of(self, claim: Claim) -> str:
        """Return the network or detector that a claim speaks for; empty where it names none."""
        if claim.about:
            return claim.about
        names = [name_of(cell) for cell in claim.cells if self.is_network(cell)]
        return MOB_NET if MOB_NET in names else next(iter(names), "")

    def not_original(self, claim: Claim) -> list[str]:
        """Return the methods and detectors of a claim that the paper does not have, and methods that these run on."""
        others: dict[str, None] = {}
        for cell in claim.cells:
            for name in (name_of(cell), self.method_of(cell)):
                if name and VALUE.sub("", name) not in self.original:
                    others[name] = None
        return list(others)


def name_of(cell: Cell) -> str:
    """Return the method or the detector that a cell names; empty where it names none."""
    if cell.method:
        return cell.method
    return next((cell.where[name] for name in NAMES if name in cell.where), "")


def is_training(cell: Cell) -> bool:
    """Return whether a cell is about trainings, for which nothing can stand in."""
    return listed(cell.metric or "")[0] in get_args(TrainingMetric)


def in_place(claim: Claim, network: str, stand_in: str) -> Claim | None:
    """Return a claim with another method in the place of a network.

    It is None where the claim is about trainings, where the other method would be compared with itself, and where no
    cell names the network, as of a pair of detectors of which the table names the other one.
    """
    if network not in {name_of(cell) for cell in claim.cells}:
        return None
    made = _with(claim, network, stand_in)
    signed = _with(claim.sign_of, network, stand_in) if claim.sign_of else None
    if made is None or (claim.sign_of and signed is None):
        return None
    return claim.model_copy(update={"cells": made, "cause": None, "sign_of": _of(claim.sign_of, signed)})


def _of(made: MadeNumber | None, cells: tuple[Cell, ...] | None) -> MadeNumber | None:
    """Return a number, if there is one, made of other cells."""
    return None if made is None or cells is None else made.model_copy(update={"cells": cells})


def _with(made: MadeNumber, network: str, stand_in: str) -> tuple[Cell, ...] | None:
    """Return the cells of a number with another method in the place of a network, None where it cannot stand there."""
    others = [cell for cell in made.cells if name_of(cell) != network]
    cells: list[Cell] = []
    for cell in made.cells:
        if is_training(cell):
            return None
        if name_of(cell) != network:
            cells.append(cell)
            continue
        replaced = _replaced(cell, stand_in)
        if replaced in others:
            return None
        cells.append(replaced)
    return tuple(cells)


def _replaced(cell: Cell, name: str) -> Cell:
    """Return a cell of another method or detector."""
    if cell.method:
        return cell.model_copy(update={"method": name})
    key = next(each for each in NAMES if each in cell.where)
    return cell.model_copy(update={"where": {**cell.where, key: name}})


def stand_ins_of(claim: Claim, known: KnownMethods) -> dict[str, Claim]:
    """Return the claim with each method of `STAND_INS` in its network's place, of those that can stand there."""
    network = known.network_of(claim)
    claims: dict[str, Claim] = {}
    for name in STAND_INS if network else ():
        other = in_place(claim, network, name)
        if other is not None:
            claims[name] = other
    return claims


def control_of(claim: Claim, results: Evidence, statistics: Statistics, known: KnownMethods) -> dict[str, str]:
    """Return the verdict that a claim would have with each method of `STAND_INS`, of those that were measured."""
    verdicts: dict[str, str] = {}
    for name, other in stand_ins_of(claim, known).items():
        numbers = [other, *([other.sign_of] if other.sign_of else [])]
        if not all(results.holds(cell) for number in numbers for cell in number.cells):
            continue
        ours, *signed = (made_number(number, results, statistics, claim.unit) for number in numbers)
        _, _, verdict = verdicts_of(ClaimNumbers(ours, signed[0] if signed else ours), ranges_of(other))
        if verdict != NOT_MEASURED:
            verdicts[name] = verdict
    return verdicts


def weaknesses_of(claim: Claim, score: str, ours: Number, control: Mapping[str, str], known: KnownMethods) -> list[str]:
    """Return why a claim with a number of ours would not be counted as reproduced: it tells too little."""
    weaknesses: list[str] = []
    other = known.not_original(claim)
    if score != OURS and other:
        weaknesses.append(f"the original has no {' or '.join(other)}, so it is not measured like for like")
    passing = [name for name, verdict in control.items() if verdict == REPRODUCED]
    if passing:
        network = known.network_of(claim)
        weaknesses.append(f"with {' or '.join(passing)} in the place of {network} it would be, too")
    trainings = trainings_of(claim, ours)
    if known.network_of(claim) and 0 < trainings < LEAST_TRAININGS:
        weaknesses.append(f"it rests on {COUNTS[trainings]}")
    return weaknesses


def trainings_of(claim: Claim, number: Number) -> int:
    """Return how many trainings of a network a number rests on; 0 where it does not say.

    A trend has an interval over all sizes, which have a training each.
    """
    if claim.quantity == "trend":
        return sum(number.networks)
    return max(number.networks, default=0)
