"""What the job of each rule gets beside its files, by the rule's wildcards: sections of the configuration and seeds.

Nothing is worked out before Snakemake asks for it. The files that a job reads are inputs of its rule, which looks them
up in `experiments.plan.sheets`. Where a function gets many files, by methods or limbs, arguments name them as the plan
does: a network by its folder, an array without its endings. Scripts put in their place what `input` of the rule has
(`experiments.jobs.inputs`).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from experiments.plan.detection import level_of_detectors, numbers_of, walks_of
from experiments.plan.files import PLANT, Files, NetworkName, files_in
from experiments.plan.parts import CaseWalks, MethodRun
from experiments.plan.reactions import is_pushed, methods_of, sizes_of
from experiments.plan.stacks import Stacked, Stacks
from experiments.settings.asked import tests_in
from experiments.settings.evaluation import measured_in
from experiments.settings.measures import Scoring
from experiments.settings.settings import Settings
from mobnet.settings.data import Terrain
from mobnet.settings.methods import Method
from mobnet.settings.walking import Walking, WalkSettings

KINDS = "mobnet.estimation.kinds"  # modules that a method names as its kind
MEASURES = "experiments.evaluation.measure.estimates"  # modules that sections of the evaluation name
KNOWN = "experiments.jobs.fitting"  # what a training builds upon
Arguments = dict[str, Any]


@dataclass(frozen=True)
class Jobs:
    """The jobs of a scale; `w` are the wildcards of a rule, of which `robot` is the folder of the plant or a robot."""

    plant: Files

    @property
    def settings(self) -> Settings:
        """The configuration."""
        return self.plant.settings

    @cached_property
    def stacks(self) -> Stacks:
        """The networks that learn side by side where the configuration says so."""
        return Stacks(self.plant)

    def files(self, w: Any) -> Files:
        """Return the files of the robot of some wildcards."""
        return self.files_of(w.robot)

    def files_of(self, robot: str) -> Files:
        """Return the files of a robot, or of the plant of section 5.1, by the name of its folder."""
        return self.plant if robot == PLANT else self.plant.robots[robot]

    def motion(self, w: Any) -> Arguments:
        """Return the making of a random motion of the upper body."""
        return {
            "root_seed": self.settings.seed,
            "robot": self.settings.robot,
            "motion": self.settings.motions[w.motion],
            "name": w.motion,
            "seed": int(w.seed),
            "duration_s": self.plant.motion_s(w.motion, int(w.seed)),
        }

    def collect(self, w: Any) -> Arguments:
        """Return the recordings of a scenario at a level: of a test, for training, or for a trial."""
        files = self.files(w)
        seeds = files.seeds_of(w.scenario, w.level)
        return {
            "settings": walk_settings(files.settings, w.scenario, w.level),
            "duration_s": files.duration_s([w.scenario], seeds[0], w.level),
            "seeds": seeds,
        }

    def motions(self, w: Any) -> list[Path]:
        """Return the motion of the upper body in each of these recordings; none where it stays as it is."""
        files = self.files(w)
        paths: list[Path] = []
        for seed in files.seeds_of(w.scenario, w.level):
            paths += files.motion(w.scenario, seed)
        return paths

    def observe(self, w: Any) -> Arguments:
        """Return the observer's residuals of these recordings."""
        return self._observer(self.files(w), w.level)

    def fit(self, w: Any) -> Arguments:
        """Return the fit of a method without networks to the training sets of its limbs."""
        files = self.files(w)
        row = files.catalogue.method(w.method)
        networks = {limb: files.catalogue.network(w.method, limb) for limb in row.fitted}
        training: dict[str, list[tuple[Path, Path]]] = {}
        for limb, network in networks.items():
            sets = files.training("recordings", network.data), files.training("residuals", network.data)
            training[limb] = list(zip(*sets, strict=True))
        return {
            "layout": files.settings.layout,
            "observer": files.settings.observer,
            "method": row,
            "networks": networks,
            "training": training,
        }

    def train(self, w: Any) -> Arguments:
        """Return the training of a network, with what it learned in a stack where it is in one."""
        files = self.files(w)
        training = files.catalogue.training(w.method, w.limb)
        arguments: Arguments = {
            "root_seed": self.settings.seed,
            "layout": self.settings.layout,
            "training": training,
            "seed": int(w.seed),
            "state": files.results / "state" / files.network(w.method, w.limb, int(w.seed)).name,
            "rate_hz": self.settings.rates.data_hz,
        }
        if training.learning.labels == "swing":
            # Without a sensor a leg knows its external torque only where it surely touches nothing
            # (docs/notes/fine_tuning.md).
            swings = self.settings.evaluation.changed
            arguments["margins"] = (swings.lift_off_s, swings.landing_s)
        if files.fit(w.method):
            arguments["observer"] = self.settings.observer
        in_stack = Stacked(w.robot, NetworkName(w.method, w.limb, int(w.seed)))
        if self.settings.stacks.side_by_side is True and in_stack in self.stacks.names:
            arguments["lesson"] = (self.stacks.file(self.stacks.names[in_stack]), in_stack.name)
        return arguments

    def learned_from(self, w: Any) -> dict[str, Any]:
        """Return the files that a network learns from.

        One with a `start` begins with the weights of that method's network; one that builds upon a fit learns what it
        leaves of the uncertainty.
        """
        files = self.files(w)
        data = files.catalogue.training(w.method, w.limb).network.data
        read: dict[str, Any] = {
            "recordings": files.training("recordings", data),
            "residuals": files.training("residuals", data),
        }
        if start := files.start(w.method, w.limb, int(w.seed)):
            read["start"] = start
        if fitted := files.fit(w.method):
            read["fitted"] = fitted[0]
        return read

    def train_stack(self, w: Any) -> Arguments:
        """Return the training of networks side by side: what that of each of them would get, and its files."""
        members: dict[str, Arguments] = {}
        for robot, (method, limb, seed) in self.stacks.members[w.stack]:
            wildcards = SimpleNamespace(robot=robot, method=method, limb=limb, seed=seed)
            given = {**self.train(wildcards), **self.learned_from(wildcards)}
            given.pop("lesson", None)
            members[Stacked(robot, NetworkName(method, limb, seed)).name] = given
        return {"members": members, "state": self.plant.results / "state" / w.stack}

    def read_by_stack(self, w: Any) -> list[Path]:
        """Return the files that the networks of a stack learn from."""
        paths: dict[Path, None] = {}
        for given in self.train_stack(w)["members"].values():
            for name in ("recordings", "residuals", "start", "fitted"):
                paths |= dict.fromkeys(files_in(given.get(name)))
        return list(paths)

    def estimate(self, w: Any) -> Arguments:
        """Return the external torque of a test by all of its methods, whose recordings run side by side."""
        files = self.files(w)
        runs: list[MethodRun] = []
        for method in files.catalogue.tests[w.scenario][w.level]:
            for seed in files.run_seeds(method, w.scenario, w.level):
                runs.append(self._run(files, method, seed, w.scenario, w.level))
        return {**self._observer(files, w.level), "runs": runs}

    def score(self, w: Any) -> Arguments:
        """Return the errors of every run of a test at a level, and what else products ask for."""
        return {
            "layout": self.settings.layout,
            "runs": self.plant.scored_runs(w.scenario, w.level),
            "asked": scoring(self.settings, w.scenario, w.level),
        }

    def detect(self, w: Any) -> Arguments:
        """Return the calibration and the trial of the detectors of a robot, or of the plant of section 5.1."""
        files = self.files(w)
        return {
            "detection": numbers_of(files),
            "robot": files.settings.robot,
            "rate_hz": files.settings.rates.data_hz,
            "walks": walks_of(files),
        }

    def watch(self, w: Any) -> Arguments:
        """Return the thresholds of a robot's limbs that are watched all the time, and of its feet's sensors."""
        files = self.files(w)
        random = files.settings.detection.random
        level = level_of_detectors(files)
        return {
            **self._in_the_loop(files, [files.settings.reaction.estimator]),
            "settings": walk_settings(files.settings, random, level),
        }

    def quiet(self, w: Any) -> tuple[Path, ...]:
        """Return the recordings from which these thresholds follow."""
        files = self.files(w)
        return files.tests(files.settings.detection.random, level_of_detectors(files))

    def react(self, w: Any) -> Arguments:
        """Return the walks of a robot in a case, with all that is compared there."""
        files = self.files(w)
        settings = files.settings
        sizes = sizes_of(files, w.case)
        # These walks are tests, too, and sealed as all tests are: methods never change by what they show.
        first = settings.sizes.test.first_seed
        walks = CaseWalks(
            case=w.case,
            settings=walk_settings(settings, settings.reaction.cases[w.case].scenario, level_of_detectors(files)),
            seeds=tuple(range(first, first + sizes.runs)),
            sizes=sizes,
            is_pushed=is_pushed(files, w.case),
        )
        return {
            **self._in_the_loop(files, methods_of(files, [w.case]), settings.reaction.cases[w.case].limbs),
            "walks": walks,
        }

    def falls(self, w: Any) -> Arguments:
        """Return the count of a robot's falls with each random torque of the trial."""
        files = self.files(w)
        trial = self.settings.trials.random_torque
        return {
            "settings": walk_settings(files.settings, trial.scenario, w.robot),
            "seed": trial.first_seed + list(self.plant.robots).index(w.robot),
            "amplitudes_nm": trial.amplitudes_nm,
            "walked_s": trial.walked_s,
        }

    def modules_of(self, w: Any, methods: Iterable[str]) -> list[str]:
        """Return the modules that methods import by name: their kinds and those of the methods they run on."""
        catalogue = self.files(w).catalogue
        modules: dict[str, None] = {}
        for method in methods:
            for name in (method, catalogue.source_of(method)):
                modules[f"{KINDS}.{catalogue.method(name).kind}"] = None
        return list(modules)

    def trained_by(self, w: Any) -> list[str]:
        """Return the module by which a training knows a fit, if it builds upon one: others do not rerun with it."""
        return [KNOWN] if self.files(w).fit(w.method) else []

    def estimated_by(self, w: Any) -> list[str]:
        """Return the modules of the methods of a test."""
        return self.modules_of(w, self.files(w).catalogue.tests[w.scenario][w.level])

    def watched_by(self, w: Any) -> list[str]:
        """Return the modules of the methods that run in a case, or in the loop of every case."""
        cases = [w.case] if hasattr(w, "case") else []
        return self.modules_of(w, methods_of(self.files(w), cases))

    def measured_by(self, w: Any) -> list[str]:
        """Return the modules that measure what products show of a test."""
        return [f"{MEASURES}.{name}" for name in scoring(self.settings, w.scenario, w.level).sections]

    def _run(self, files: Files, method: str, network_seed: int, scenario: str, level: str) -> MethodRun:
        """Return the run of a method with its networks of a seed on all recordings of a test."""
        return MethodRun(
            method=method,
            methods=_with_source(files, method),
            networks=files.networks(method, network_seed, scenario, level),
            fitted=next(iter(files.fit(method)), None),
            network_seed=network_seed,
            joints=files.catalogue.estimated(method, scenario, level),
        )

    def _in_the_loop(self, files: Files, methods: Iterable[str], limbs: Sequence[str] = ()) -> Arguments:
        """Return what runs in a loop with a robot: methods with their trained networks, the first of a limb.

        They are those of some limbs, or of all if none are named.
        """
        runs: dict[str, MethodRun] = {}
        for method in methods:
            source = files.catalogue.network_source_of(method)
            networks: dict[str, Path] = {}
            for limb in files.catalogue.method(source).limbs:
                # A walk on some limbs waits for their networks alone.
                is_asked = not limbs or limb in limbs
                if is_asked and (files.catalogue.owner_of(source, limb), limb) in files.learned:
                    networks[limb] = files.network(source, limb, files.network_seeds(source, limb)[0])
            fitted = next(iter(files.fit(method)), None)
            runs[method] = MethodRun(method, _with_source(files, method), networks, fitted, 0)
        return {
            "reaction": files.settings.reaction,
            "detection": numbers_of(files),
            "observer": files.settings.observer,
            "runs": runs,
        }

    def _observer(self, files: Files, level: str) -> Arguments:
        """Return what the observer takes at a level."""
        return {
            "robot": files.settings.robot,
            "level": files.settings.levels[level],
            "gravity_m_s2": files.settings.plant.gravity_m_s2,
            "observer": files.settings.observer,
            "rate_hz": files.settings.rates.data_hz,
        }


def _with_source(files: Files, method: str) -> dict[str, Method]:
    """Return the row of a method and, if it runs on another one, of that one too, by name."""
    return {name: files.catalogue.method(name) for name in (method, files.catalogue.source_of(method))}


def scoring(settings: Settings, scenario: str, level: str) -> Scoring:
    """Return what is measured on the runs of a test at a level: the sections of the products that show it."""
    evaluation = settings.evaluation
    measured = measured_in(evaluation).items()
    sections = {name: section for name, section in measured if (scenario, level) in tests_in(settings, section)}
    pushes = [settings.pushes[name] for name in settings.scenarios[scenario].pushes]
    shared = {
        "window": evaluation.windows.get(scenario),
        "touch_down_s": evaluation.phases.touch_down_s,
        "stuck_rad_s": settings.plant.friction_smoothing_rad_s,
        "cover_share": settings.learning.calibration_share,
        "lines": {push.joint: push.sines.frequency_hz for push in pushes if push.joint and push.sines},
    }
    return Scoring.model_validate({"sections": sections, **shared})


def walk_settings(settings: Settings, scenario: str, level: str) -> WalkSettings:
    """Return what a walk takes: terrains, pushes and obstacles that the scenario names, gait and gains of the level."""
    row = settings.scenarios[scenario]
    walking = settings.walking
    chosen = settings.levels[level].surrogate
    if chosen:
        gait = {name: value for name, value in chosen.gait if value is not None}
        row = row.model_copy(update={"narrowed": row.narrowed.model_copy(update=gait)})
        walking = _with_gains(walking, chosen.gain_ratio)
    sections = {
        name: getattr(settings, name) for name in WalkSettings.model_fields if name in type(settings).model_fields
    }
    picked = {
        "scenario_name": scenario,
        "scenario": row,
        "walking": walking,
        "level_name": level,
        "level": settings.levels[level],
        "surrogate": settings.surrogate.with_numbers(chosen.numbers) if chosen else None,
        "terrain": Terrain(**{name: getattr(settings.terrain, name) for name in row.terrain}),
        "pushes": {name: settings.pushes[name] for name in row.pushes},
        "obstacles": {name: settings.obstacles[name] for name in row.obstacles},
    }
    return WalkSettings.model_validate({**sections, **picked})


def _with_gains(walking: Walking, ratio: float) -> Walking:
    """Return the numbers of the controller with all gains of the legs' joints times a ratio."""
    stiffness = tuple(ratio * gain for gain in walking.leg_stiffness_nm_rad)
    damping = tuple(ratio * gain for gain in walking.leg_damping_nms_rad)
    return walking.model_copy(update={"leg_stiffness_nm_rad": stiffness, "leg_damping_nms_rad": damping})
