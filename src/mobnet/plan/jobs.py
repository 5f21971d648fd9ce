"""The jobs behind recordings, networks, estimates and scores: which function, what it gets, what it reads."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.files import WEIGHTS
from mobnet.core.stage import Stage
from mobnet.plan.call import Call, Job
from mobnet.plan.detection import numbers_of, walks_of
from mobnet.plan.parts import MethodRun, Repetition, Shard
from mobnet.plan.runs import Files, NetworkName, files_in
from mobnet.settings.data import Terrain
from mobnet.settings.evaluation import Scoring, measured_in
from mobnet.settings.names import shown_in
from mobnet.settings.settings import Settings, WalkSettings

KINDS = "mobnet.estimation.kinds"  # modules that a method names as its kind
MEASURES = "mobnet.evaluation.measure.estimates"  # modules that sections of the evaluation name


@dataclass(frozen=True)
class Jobs:
    """The jobs of the plant of section 5.1 or of a robot of the fleet, behind the steps of the plan.

    The name of a job is that of its log.
    """

    settings: Settings
    files: Files

    def motions(self, name: str, motion: str, seeds: Sequence[int]) -> Job:
        """Return the making of random motions of the upper body."""
        arguments = {
            "root_seed": self.settings.seed,
            "robot": self.settings.robot,
            "motion": self.settings.motions[motion],
            "name": motion,
            "motions": tuple(
                (seed, self.files.motion_s(motion, seed), self.files.motion_place(motion, seed)) for seed in seeds
            ),
        }
        return self._staged("mobnet.simulation.motion:make_motions", arguments, name, ())

    def collect(self, name: str, scenario: str, level: str, seeds: Sequence[int]) -> Job:
        """Return recordings of a scenario at a level, and the observer's residuals of them."""
        shards = tuple(self._shard(scenario, level, seed) for seed in seeds)
        arguments = {
            "settings": walk_settings(self.settings, scenario, level),
            "observer": self.settings.observer,
            "duration_s": self.files.duration_s([scenario], seeds[0]),
            "shards": shards,
        }
        motions = [shard.motion for shard in shards]
        return self._staged("mobnet.estimation.walks:collect_walks", arguments, name, _read(motions))

    def _shard(self, scenario: str, level: str, seed: int) -> Shard:
        """Return one recording of a scenario."""
        recording, residual = (self.files.array(kind, scenario, level, seed) for kind in ("recordings", "residuals"))
        return Shard(seed, recording, residual, next(iter(self.files.motion(scenario, seed)), None))

    def fit(self, method: str) -> Job:
        """Return the fit of a method without networks to the training sets of its limbs."""
        row = self.settings.method(method)
        networks = {limb: self.settings.network(method, limb) for limb in row.fitted}
        training = {limb: tuple(zip(*self._training(network.data), strict=True)) for limb, network in networks.items()}
        arguments = {
            "layout": self.settings.layout,
            "observer": self.settings.observer,
            "method": row,
            "networks": networks,
            "training": training,
            "out": self.files.results / "fits" / f"{method}.json",
        }
        return Job(Call("mobnet.estimation.fitting:write_fit", arguments), _read(training), self._kinds(method))

    def train(self, name: str, networks: Sequence[NetworkName]) -> Job:
        """Return the trainings of networks that learn from one set of recordings.

        Those with `of` learn what is left of the uncertainty by a fit; those with `start` begin with the weights of
        that method's network. Networks of one job are alike in both.
        """
        first = networks[0]
        learning = self.settings.training(first.method, first.limb)
        recordings, residuals = self._training(learning.network.data)
        repetitions, fitted = tuple(map(self._repetition, networks)), self.files.fit(first.method)
        arguments = {
            "root_seed": self.settings.seed,
            "layout": self.settings.layout,
            "rate_hz": self.settings.rates.data_hz,
            "networks": repetitions,
            "recordings": recordings,
            "residuals": residuals,
        }
        starts = [repetition.start for repetition in repetitions]
        inputs = _read([recordings, residuals, fitted, starts])
        if fitted:
            arguments |= {"observer": self.settings.observer, "fitted": fitted[0]}
            return self._staged("mobnet.estimation.train_gray:train_gray", arguments, name, inputs)
        if learning.learning.labels == "swing":
            swings = self.settings.evaluation.changed
            arguments |= {"margins": (swings.lift_off_s, swings.landing_s)}
        return self._staged("mobnet.learning.train:train_all", arguments, name, inputs)

    def _repetition(self, network: NetworkName) -> Repetition:
        """Return the training of a network."""
        folder = self.files.network(*network)
        return Repetition(
            training=self.settings.training(network.method, network.limb),
            seed=network.seed,
            out=folder,
            state=self.files.results / "state" / folder.name,
            start=self.files.start(*network),
        )

    def estimate(self, name: str, scenario: str, level: str) -> Job:
        """Return the external torque of all methods of a test, whose recordings run side by side."""
        methods = self.settings.tests[scenario][level]
        runs = tuple(
            self._run(method, seed, scenario, level)
            for method in methods
            for seed in self.files.run_seeds(method, scenario, level)
        )
        recordings, residuals = (self.files.tests(scenario, level, kind) for kind in ("recordings", "residuals"))
        arguments = {**self._observer(level), "runs": runs, "recordings": recordings, "residuals": residuals}
        weights = [folder / WEIGHTS for run in runs for folder in run.networks.values()]
        inputs = _read([recordings, residuals, [run.fitted for run in runs], weights])
        kinds = tuple(dict.fromkeys(kind for method in methods for kind in self._kinds(method)))
        return self._staged("mobnet.estimation.estimate:estimate", arguments, name, inputs, kinds)

    def _run(self, method: str, network_seed: int, scenario: str, level: str) -> MethodRun:
        """Return the run of a method with its networks of a seed on all recordings of a test."""
        return MethodRun(
            method=method,
            methods={name: self.settings.method(name) for name in self._with_source(method)},
            networks=self.files.networks(method, network_seed, scenario, level),
            fitted=next(iter(self.files.fit(method)), None),
            outs=self.files.tests(scenario, level, f"estimates/{method}/n{network_seed}"),
            joints=self.settings.estimated(method, scenario, level),
        )

    def score(self, scenario: str, level: str) -> Job:
        """Return the errors of every run of a test at a level, and what else products ask for."""
        runs, (out,) = self.files.runs_of(scenario, level), self.files.scores([(scenario, level)])
        asked = scoring(self.settings, scenario, level)
        arguments = {"layout": self.settings.layout, "runs": runs, "asked": asked, "out": out}
        read = [[run.residual, run.estimate, run.recording] for run in runs]
        modules = tuple(f"{MEASURES}.{name}" for name in asked.sections)
        return Job(Call(f"{MEASURES}.scores:score", arguments), _read(read), modules)

    def detect(self) -> Job:
        """Return the calibration and the trial of the detectors of a robot, or of the plant of section 5.1."""
        walks = walks_of(self.files)
        arguments = {
            "detection": numbers_of(self.files),
            "robot": self.settings.robot,
            "rate_hz": self.settings.rates.data_hz,
            "walks": walks,
            "out": self.files.results / "detection",
        }
        return Job(Call("mobnet.evaluation.measure.detection.trial:detect", arguments), _read(walks))

    def _staged(
        self,
        function: str,
        arguments: Mapping[str, object],
        name: str,
        inputs: tuple[str, ...],
        modules: tuple[str, ...] = (),
    ) -> Job:
        """Return a job that keeps its finished parts below `state` until all of them are there."""
        job = Job(Call(function, arguments), inputs, modules)
        stage = Stage(self.files.results / "state" / name, job.given, inputs)
        return Job(Call(function, {**arguments, "stage": stage}), inputs, modules)

    def _kinds(self, method: str) -> tuple[str, ...]:
        """Return the modules that a method imports by name: its kind and that of the method it runs on."""
        return tuple(dict.fromkeys(f"{KINDS}.{self.settings.method(name).kind}" for name in self._with_source(method)))

    def _with_source(self, method: str) -> tuple[str, ...]:
        """Return a method and, if it runs on another one, that one too."""
        return tuple(dict.fromkeys([method, self.settings.source_of(method)]))

    def _observer(self, level: str) -> dict[str, object]:
        """Return what the observer takes."""
        return {
            "rate_hz": self.settings.rates.data_hz,
            "robot": self.settings.robot,
            "gravity_m_s2": self.settings.plant.gravity_m_s2,
            "observer": self.settings.observer,
            "level": self.settings.levels[level],
        }

    def _training(self, name: str) -> tuple[tuple[Path, ...], tuple[Path, ...]]:
        """Return recordings and residuals of a training set."""
        return self.files.training("recordings", name), self.files.training("residuals", name)


def scoring(settings: Settings, scenario: str, level: str) -> Scoring:
    """Return what is measured on the runs of a test at a level: the sections of the products that show it."""
    evaluation = settings.evaluation
    sections = {name: own for name, own in measured_in(evaluation).items() if (scenario, level) in shown_in(own)}
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
    """Return what a walk takes: of terrains and pushes, those that the scenario names."""
    row = settings.scenarios[scenario]
    sections = {
        name: getattr(settings, name) for name in WalkSettings.model_fields if name in type(settings).model_fields
    }
    picked = {
        "scenario_name": scenario,
        "scenario": row,
        "random_torque": settings.random_torque_of(scenario),
        "level_name": level,
        "level": settings.levels[level],
        "surrogate": settings.surrogate if settings.levels[level].surrogate else None,
        "terrain": Terrain(**{name: getattr(settings.terrain, name) for name in row.terrain}),
        "pushes": {name: settings.pushes[name] for name in row.pushes},
    }
    return WalkSettings.model_validate({**sections, **picked})


def _read(needs: object) -> tuple[str, ...]:
    """Return the files behind some arguments, each once."""
    return tuple(dict.fromkeys(map(str, files_in(needs))))
