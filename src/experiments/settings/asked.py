"""What is run: every run that a table, a figure, a claim or a detector asks for, with the joints that it shows.

A section asks for the runs that stand in it: a test, a level, methods; what it shows of them are the limbs, columns or
joints that it names, or that a section around it does. A test is a scenario that is asked for.
"""

from collections.abc import Iterator
from typing import NamedTuple, cast

from pydantic import BaseModel

from experiments.settings.claims import Cell
from experiments.settings.figures import Figure05, Figure18, FineTuning
from experiments.settings.measures import CalibrationTest
from experiments.settings.products import items_of
from experiments.settings.runs import Mean, Runs
from experiments.settings.settings import Settings
from experiments.settings.tables import ErrorRow
from mobnet.formats.reading import Place
from mobnet.settings.detection import Detection
from mobnet.settings.methods import swept_name

SHOWN = ("limbs", "limb", "columns", "joints", "joint")  # keys that say what is shown, the first one that is there


class RunRequest(NamedTuple):
    """A run of a method on a test at a level, asked for at a place, and the limbs or joints that are shown of it.

    With `partly`, it is enough that the method estimates some of them.
    """

    place: Place
    scenario: str
    level: str
    method: str
    shown: tuple[str, ...]
    partly: bool = False


def asked_by(settings: Settings) -> Iterator[RunRequest]:
    """Yield every run that the configuration asks for."""
    yield from asked_in(settings, settings.evaluation, ("evaluation",))
    yield from _of_detection(settings)
    yield from asked_in(settings, settings.claims, ("claims",))


def tests_in(settings: Settings, section: object) -> tuple[tuple[str, str], ...]:
    """Return test and level of the runs that a section, or several of them, asks for; each once."""
    return tuple(dict.fromkeys((request.scenario, request.level) for request in asked_in(settings, section, ())))


def asked_in(settings: Settings, section: object, place: Place, shown: tuple[str, ...] = ()) -> Iterator[RunRequest]:
    """Yield the runs that a section asks for, and those of the sections in it."""
    if isinstance(section, BaseModel):
        shown = _shown_by(section) or shown
        for key, scenario, level, method in _own(settings, section):
            partly = isinstance(section, CalibrationTest)
            yield RunRequest((*place, *key), scenario, level, method, shown, partly)
    for key, item in items_of(section).items():
        yield from asked_in(settings, item, (*place, key), shown)


def _own(settings: Settings, section: BaseModel) -> Iterator[tuple[Place, str, str, str]]:
    """Yield place in the section, scenario, level and method of the runs that stand in it, not in a section in it."""
    match section:
        case Cell(scenario=str(scenario), level=str(level), method=str(method)):
            yield ("method",), scenario, level, method
        case Figure05():
            for level, methods in section.panels.items():
                yield from ((("panels", level, k), section.scenario, level, name) for k, name in enumerate(methods))
        case Figure18():
            for scenario in section.panels:
                yield from ((("methods", k), scenario, section.level, name) for k, name in enumerate(section.methods))
        case FineTuning():
            yield from _of_fine_tuning(settings, section)
        case Runs() | CalibrationTest():
            further = section.further if isinstance(section, ErrorRow) else ()
            for key, methods in (("methods", section.methods), ("further", further)):
                yield from (((key, k), section.scenario, section.level, name) for k, name in enumerate(methods))
        case _:
            return


def _of_fine_tuning(settings: Settings, section: FineTuning) -> Iterator[tuple[Place, str, str, str]]:
    """Yield the runs of the fine-tuned methods, one for each value of the sweep, and that at the known level."""
    values = settings.sweeps[section.sweep].values if section.sweep in settings.sweeps else ()
    for title, test in section.tests.items():
        for label, base in test.tuned.items():
            names = (swept_name(base, section.sweep, value) for value in values)
            yield from ((("tests", title, "tuned", label), test.scenario, test.level, name) for name in names)
        yield from ((("tests", title, "known"), test.scenario, test.known, name) for name in test.methods)


def _of_detection(settings: Settings) -> Iterator[RunRequest]:
    """Yield the runs of the gate's and the detectors' methods on the walks, of the legs that are hit, or all."""
    detection: Detection = settings.detection
    methods: dict[Place, str] = {("gate", "method"): detection.gate.method}
    methods |= {("detectors", name, "method"): row.method for name, row in detection.detectors.items()}
    feet = settings.robot.feet
    for scenario in settings.detection_walks:
        pushes = settings.scenarios[scenario].pushes if scenario in settings.scenarios else ()
        points = [settings.pushes[name].point or "" for name in pushes if name in settings.pushes]
        hit: set[str] = set()
        for side, foot in feet.items():
            # Of the points of a robot, those on the left or the right have names such as `left_knee_front`.
            if any(point.startswith(f"{side}_") for point in points):
                hit.add(foot.limb)
        shown = tuple(leg for leg in detection.legs if leg in hit or not pushes)
        for level in detection.levels:
            for place, method in methods.items():
                yield RunRequest(("detection", *place), scenario, level, method, shown, partly=True)


def _shown_by(section: BaseModel) -> tuple[str, ...]:
    """Return the limbs or joints that a section shows; none where it names none."""
    value = next((value for key in SHOWN if (value := getattr(section, key, None))), ())
    items = cast("tuple[str | Mean, ...]", (value,) if isinstance(value, str) else tuple(value))
    names: list[str] = []
    for item in items:
        names += (item,) if isinstance(item, str) else item.joints
    return tuple(names)
