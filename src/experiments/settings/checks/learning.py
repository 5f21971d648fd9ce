"""What must hold for networks, methods and sweeps."""

from collections.abc import Iterator
from itertools import product

from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from experiments.settings.trials import Factors, factors_of
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.faults import at_most
from mobnet.formats.network import NetworkCell
from mobnet.formats.reading import Place, Problem
from mobnet.settings.methods import Method, swept_names
from mobnet.settings.networks import Learning, Network


def learning_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what does not fit in networks, methods and sweeps."""
    settings = catalogue.settings
    learning = settings.learning
    if learning.calibration_share not in learning.calibration_levels:
        text = misfit(learning.calibration_share, f"one of calibration_levels, {list(learning.calibration_levels)}")
        yield ("learning", "calibration_share"), text
    for name, method in settings.methods.items():
        for place, text in _method_problems(catalogue, name, method):
            yield ("methods", name, *place), text
    for limb in settings.networks:
        yield from _window_problems(catalogue, limb)
    yield from _trial_problems(catalogue)
    yield from _name_problems(settings)
    yield from _sweep_problems(settings)


def _trial_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield trials of how a method learns that does not, and development walks that are tests."""
    settings = catalogue.settings
    grids = settings.trials.tuning.grids
    place = ("trials", "tuning", "grids")
    for name, grid in grids.items():
        if grid.learning and name in settings.methods and not settings.methods[name].limbs:
            accepted = "`options` of a method without networks"
            yield (*place, name, "learning"), misfit("`learning`", accepted)
    plain = [name for name, method in catalogue.all_methods.items() if not method.limbs]
    for index, name in enumerate(settings.trials.tuning.references):
        if name not in plain:
            yield ("trials", "tuning", "references", index), not_accepted("method without networks", name, plain)
    taken = {*catalogue.tests, *(row.scenario for row in settings.training_sets.values())}
    accepted = [name for name in settings.scenarios if name not in taken]
    developed: dict[Place, str] = {("development", t, "scenario"): w.scenario for t, w in settings.development.items()}
    trial = settings.trials.factorial
    developed |= {("trials", "factorial", "walk"): trial.walk, ("trials", "factorial", "hits"): trial.hits}
    why = settings.trials.why
    for key in ("walk", "hits", "twin"):
        developed["trials", "why", key] = getattr(why, key)
    for place, scenario in developed.items():
        if scenario in taken:
            yield place, not_accepted("scenario apart from tests and training", scenario, accepted)
    yield from _factorial_problems(catalogue)
    yield from _why_problems(settings)


def _why_problems(settings: Settings) -> Iterator[Problem]:
    """Yield names of the trial `why` that do not belong there."""
    trial = settings.trials.why
    place = ("trials", "why")
    joints = settings.layout.limbs(settings.robot.networks[trial.limb].joints)
    if trial.joint not in joints:
        yield (*place, "joint"), not_accepted("joint of the network", trial.joint, joints)
    recorded = settings.fleet.sets
    if trial.path_set not in recorded:
        yield (*place, "path_set"), not_accepted("set of `fleet.sets`", trial.path_set, recorded)
    for k, row in enumerate(trial.rows):
        for index, name in enumerate(row.sets):
            if name not in recorded:
                yield (*place, "rows", k, "sets", index), not_accepted("set of `fleet.sets`", name, recorded)
        for index, name in enumerate(row.ways):
            if name not in trial.ways:
                yield (*place, "rows", k, "ways", index), not_accepted("way", name, trial.ways)
        for index, name in enumerate(row.methods):
            if name in settings.methods and trial.limb not in settings.methods[name].limbs:
                yield (*place, "rows", k, "methods", index), misfit(name, f"a method with {trial.limb} in its `limbs`")


def _factorial_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield cells that are not every combination of their factors, once, and names that do not belong there."""
    settings = catalogue.settings
    trial = settings.trials.factorial
    place = ("trials", "factorial")
    recorded = settings.fleet.sets
    for index, name in enumerate(trial.cells):
        if name not in recorded:
            yield (*place, "cells", index), not_accepted("set of `fleet.sets`", name, recorded)
    if trial.another_day not in recorded:
        yield (*place, "another_day"), not_accepted("set of `fleet.sets`", trial.another_day, recorded)
    if trial.same_day not in trial.cells:
        yield (*place, "same_day"), not_accepted("cell", trial.same_day, trial.cells)
    factors = [factors_of(settings.training_sets, settings.scenarios, name) for name in trial.cells]
    every = set(map(Factors._make, product((False, True), (False, True), ("random", "joystick"))))
    if set(factors) != every or len(factors) != len(every):
        accepted = "each combination of random torque, pushes and commands `random` or `joystick`, once"
        yield (*place, "cells"), misfit(list(trial.cells), accepted)
    joints = settings.layout.limbs(settings.robot.networks[trial.limb].joints)
    if trial.joint not in joints:
        yield (*place, "joint"), not_accepted("joint of the network", trial.joint, joints)
    for key, method, wanted in (("method", trial.method, "limbs"), ("fitted", trial.fitted, "fitted")):
        if trial.limb not in getattr(settings.methods.get(method), wanted, ()):
            yield (*place, key), misfit(method, f"a method with {trial.limb} in its `{wanted}`")


def _method_problems(catalogue: Catalogue, name: str, method: Method) -> Iterator[Problem]:
    """Yield keys of a method that do not go together."""
    settings = catalogue.settings
    if bool(method.limbs) != (method.target is not None):
        yield (), misfit("`target` or `limbs` alone", "both together, or none of them")
    for key in ("network", "learning"):
        if getattr(method, key) and not method.limbs:
            yield (key,), misfit(f"`{key}`", f"`{key}` of a method with `limbs`")
    if method.of is not None and (method.fitted or method.of == name):
        yield ("of",), misfit(method.of, "another method, without `fitted` of its own")
    if method.of in settings.methods and method.limbs and not settings.methods[method.of].fitted:
        yield ("of",), misfit(method.of, "a method with `fitted`, for one with `limbs` of its own")
    yield from _tuning_problems(catalogue, name, method)
    for limb, owner in method.networks_of.items():
        row = settings.methods.get(owner)
        # An unknown method is told elsewhere.
        if row and (limb not in method.limbs or limb not in row.limbs or limb in row.networks_of):
            yield ("networks_of", limb), misfit(owner, f"a method with a network of its own for {limb}, one of `limbs`")
        elif row and row.target != method.target:
            yield ("networks_of", limb), misfit(owner, f"a method whose networks learn the {method.target} torque")
    robot = settings.robot
    for index, limb in enumerate(method.fitted):
        if not set(robot.order.actuated).intersection(settings.layout.limbs(robot.networks[limb].joints)):
            yield ("fitted", index), misfit(limb, "a network of joints that have motors and friction")
    seen = dict[str, str]()
    for index, limb in enumerate((*method.limbs, *method.fitted)):
        key = "limbs" if index < len(method.limbs) else "fitted"
        for joint in settings.layout.limbs(robot.networks[limb].joints):
            first = seen.setdefault(f"{key} {joint}", limb)
            if first != limb:
                yield (key, index), misfit(limb, f"networks without joints of {first}")
                break


def _tuning_problems(catalogue: Catalogue, name: str, method: Method) -> Iterator[Problem]:
    """Yield methods that are fine-tuned from other networks, or learn from swings with nothing to start from."""
    settings = catalogue.settings
    first = settings.methods.get(method.start or "")
    swings = method.learning.get("labels") == "swing"
    if swings and (first is None or method.target != "uncertainty"):
        yield ("learning", "labels"), misfit("swing", "`labels: swing` of a method with `start` and target uncertainty")
    if first is None:
        return
    if method.limbs and catalogue.learned(name).coarse:
        yield (
            ("learning", "coarse"),
            misfit("coarse time", "[] of a method with `start`, whose state is kept as long as it is"),
        )
    if first.start or first.of or method.of or first.target != method.target:
        yield ("start",), misfit(method.start, "a method with the same target, without `start`; neither with `of`")
    for limb in method.limbs:
        if limb not in first.limbs:
            yield ("start",), misfit(method.start, f"a method that trains {limb}")
            continue
        tuned, other = (catalogue.network(row, limb) for row in (name, str(method.start)))
        differs = any(getattr(tuned, key) != getattr(other, key) for key in NetworkCell.model_fields)
        if tuned.cell != "GRU" or tuned.spectral or differs:
            yield ("start",), misfit(method.start, f"a method with the same GRU for {limb}, without `spectral`")
        legs = [settings.layout.limb(foot.limb) for foot in settings.robot.feet.values()]
        joints = set(settings.layout.limbs(tuned.joints))
        if swings and not any(joints <= set(leg) for leg in legs):
            yield ("learning", "labels"), misfit("swing", "`labels: swing` of networks of one leg")


def _window_problems(catalogue: Catalogue, limb: str) -> Iterator[Problem]:
    """Yield windows that are longer than what a network is trained on at once, by the methods that train it."""
    settings = catalogue.settings
    rows = {("networks", limb): settings.networks[limb]} | {
        ("methods", name, "network"): catalogue.network(name, limb)
        for name, method in settings.methods.items()
        if limb in method.limbs
    }
    for place, row in rows.items():
        yield from at_most((*place, "window_steps"), row.window_steps or 0, row.horizon_steps, "horizon_steps")


def _name_problems(settings: Settings) -> Iterator[Problem]:
    """Yield names of methods that a disk may take for the same, or that a sweep gives too."""
    seen = dict[str, str]()
    for name in settings.methods:
        first = seen.setdefault(name.casefold(), name)
        if first != name:
            yield ("methods", name), misfit(name, f"names that differ from {first} in more than capitals")
    for key, sweep in settings.sweeps.items():
        for made in swept_names(key, sweep):
            if made.casefold() in seen:
                yield ("methods", seen[made.casefold()]), misfit(made, f"names that sweep {key} does not give")


def _sweep_problems(settings: Settings) -> Iterator[Problem]:
    """Yield sweeps of what is no number, or of methods that do not train the limb."""
    for key, sweep in settings.sweeps.items():
        section = Network if sweep.section == "network" else Learning
        if key not in section.model_fields:
            yield ("sweeps", key), not_accepted(f"key of section {sweep.section}", key, section.model_fields)
        for index, base in enumerate(sweep.of):
            if base not in settings.methods or sweep.limb not in settings.methods[base].limbs:
                accepted = [name for name, method in settings.methods.items() if sweep.limb in method.limbs]
                yield ("sweeps", key, "of", index), not_accepted(f"method that trains {sweep.limb}", base, accepted)
