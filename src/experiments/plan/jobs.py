"""The jobs behind recordings, networks, estimates and scores: which function, what it gets, what it reads."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.plan.call import STAGE, Call, Job
from experiments.plan.detection import detection_files, level_of_detectors, numbers_of, walks_of
from experiments.plan.files import NOTE, Files, NetworkName, files_in
from experiments.plan.parts import CaseWalks, MethodRun, Repetition, Shard
from experiments.plan.reactions import course_file, is_pushed, methods_of, reaction_file, sizes_of, watch_file
from experiments.running.stage import Stage
from experiments.settings.asked import tests_in
from experiments.settings.catalogue import Catalogue
from experiments.settings.evaluation import measured_in
from experiments.settings.measures import Scoring
from experiments.settings.settings import Settings
from mobnet.core.code import code_hash
from mobnet.core.files import RUN, WEIGHTS
from mobnet.settings.data import Terrain
from mobnet.settings.walking import Walking, WalkSettings

KINDS = "mobnet.estimation.kinds"  # modules that a method names as its kind
MEASURES = "experiments.evaluation.measure.estimates"  # modules that sections of the evaluation name


@dataclass(frozen=True)
class Jobs:
    """The jobs of the plant of section 5.1 or of a robot of the fleet, behind the steps of the plan.

    The name of a job is that of its log.
    """

    files: Files

    @property
    def settings(self) -> Settings:
        """The configuration, of a robot as it has it."""
        return self.files.settings

    @property
    def catalogue(self) -> Catalogue:
        """What follows from it."""
        return self.files.catalogue

    def motions(self, name: str, motion: str, seeds: Sequence[int]) -> Job:
        """Return the making of random motions of the upper body."""
        motions = tuple(
            (seed, self.files.motion_s(motion, seed), self.files.motion_place(motion, seed)) for seed in seeds
        )
        arguments = {
            "root_seed": self.settings.seed,
            "robot": self.settings.robot,
            "motion": self.settings.motions[motion],
            "name": motion,
            "motions": motions,
        }
        own = {f"{out}{NOTE}": (seed, duration_s) for seed, duration_s, out in motions}
        call = Call("experiments.jobs.motions:make_motions", arguments)
        return self._staged(name, Job(call, (), (), own, ("motions",)))

    def collect(self, name: str, scenario: str, level: str, seeds: Sequence[int]) -> Job:
        """Return recordings of a scenario at a level, and the observer's residuals of them."""
        shards = tuple(self._shard(scenario, level, seed) for seed in seeds)
        arguments = {
            "settings": walk_settings(self.settings, scenario, level),
            "observer": self.settings.observer,
            "duration_s": self.files.duration_s([scenario], seeds[0]),
            "shards": shards,
        }
        inputs = _read([shard.motion for shard in shards])
        own: dict[str, Shard] = {}
        for shard in shards:
            own |= {f"{shard.recording}{NOTE}": shard, f"{shard.residual}{NOTE}": shard}
        call = Call("experiments.jobs.walks:collect_walks", arguments)
        return self._staged(name, Job(call, inputs, (), own, ("shards",)))

    def _shard(self, scenario: str, level: str, seed: int) -> Shard:
        """Return one recording of a scenario."""
        recording, residual = (self.files.array(kind, scenario, level, seed) for kind in ("recordings", "residuals"))
        return Shard(seed, recording, residual, next(iter(self.files.motion(scenario, seed)), None))

    def falls(self, seed: int) -> Job:
        """Return the count of a robot's falls with each random torque of the trial."""
        trial = self.settings.trials.random_torque
        arguments = {
            "settings": walk_settings(self.settings, trial.scenario, self.files.robot),
            "seed": seed,
            "amplitudes_nm": trial.amplitudes_nm,
            "walked_s": trial.walked_s,
            "out": (out := self.files.falls),
        }
        call = Call("experiments.evaluation.measure.data.random_torque:count_falls", arguments)
        return Job(call, (), (), {str(out): ()})

    def fit(self, method: str) -> Job:
        """Return the fit of a method without networks to the training sets of its limbs."""
        row = self.catalogue.method(method)
        networks = {limb: self.catalogue.network(method, limb) for limb in row.fitted}
        training = {limb: tuple(zip(*self._training(network.data), strict=True)) for limb, network in networks.items()}
        arguments = {
            "layout": self.settings.layout,
            "observer": self.settings.observer,
            "method": row,
            "networks": networks,
            "training": training,
            "out": (out := self.files.results / "fits" / f"{method}.json"),
        }
        call = Call("experiments.jobs.fitting:write_fit", arguments)
        kinds = self._kinds(method)
        return Job(call, _read(training), kinds, {str(out): code_hash(*kinds)})

    def train(self, name: str, networks: Sequence[NetworkName]) -> Job:
        """Return the trainings of networks that learn from one set of recordings.

        Those with `of` learn what is left of the uncertainty by a fit; those with `start` begin with the weights of
        that method's network. Networks of one job are alike in both.
        """
        first = networks[0]
        learning = self.catalogue.training(first.method, first.limb)
        recordings, residuals = self._training(learning.network.data)
        repetitions = tuple(map(self._repetition, networks))
        fitted = self.files.fit(first.method)
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
        elif learning.learning.labels == "swing":
            # Without a sensor a leg knows its external torque only where it surely touches nothing (note 0029).
            swings = self.settings.evaluation.changed
            arguments |= {"margins": (swings.lift_off_s, swings.landing_s)}
        function = "experiments.jobs.train_gray:train_gray" if fitted else "experiments.jobs.trainings:train_all"
        own = {f"{repetition.out}/{RUN}": repetition for repetition in repetitions}
        return self._staged(name, Job(Call(function, arguments), inputs, (), own, ("networks",)))

    def _repetition(self, network: NetworkName) -> Repetition:
        """Return the training of a network."""
        folder = self.files.network(*network)
        return Repetition(
            training=self.catalogue.training(network.method, network.limb),
            seed=network.seed,
            out=folder,
            state=self.files.results / "state" / folder.name,
            start=self.files.start(*network),
        )

    def estimate(self, name: str, scenario: str, level: str) -> Job:
        """Return the external torque of all methods of a test, whose recordings run side by side."""
        methods = self.catalogue.tests[scenario][level]
        runs: list[MethodRun] = []
        for method in methods:
            seeds = self.files.run_seeds(method, scenario, level)
            runs += [self._run(method, seed, scenario, level) for seed in seeds]
        recordings, residuals = (self.files.tests(scenario, level, kind) for kind in ("recordings", "residuals"))
        arguments = {**self._observer(level), "runs": tuple(runs), "recordings": recordings, "residuals": residuals}
        inputs = _read([recordings, residuals, [run.fitted for run in runs], _weights(runs)])
        own: dict[str, object] = {}
        for run in runs:
            # The stamp of an estimate tells its method, but not which other recordings the same job runs it on.
            method = repr(replace(run, outs=()))
            code = code_hash(*self._kinds(run.method))
            for out, recording, residual in zip(run.outs, recordings, residuals, strict=True):
                own[f"{out}{NOTE}"] = (method, code, recording, residual)
        call = Call("experiments.jobs.estimates:estimate", arguments)
        parts = ("runs", "recordings", "residuals")
        return self._staged(name, Job(call, inputs, self._kinds(*methods), own, parts))

    def _run(self, method: str, network_seed: int, scenario: str, level: str) -> MethodRun:
        """Return the run of a method with its networks of a seed on all recordings of a test."""
        return MethodRun(
            method=method,
            methods={name: self.catalogue.method(name) for name in self._with_source(method)},
            networks=self.files.networks(method, network_seed, scenario, level),
            fitted=next(iter(self.files.fit(method)), None),
            outs=self.files.tests(scenario, level, f"estimates/{method}/n{network_seed}"),
            joints=self.catalogue.estimated(method, scenario, level),
        )

    def score(self, scenario: str, level: str) -> Job:
        """Return the errors of every run of a test at a level, and what else products ask for."""
        runs = self.files.scored_runs(scenario, level)
        (out,) = self.files.scores([(scenario, level)])
        asked = scoring(self.settings, scenario, level)
        arguments = {"layout": self.settings.layout, "runs": runs, "asked": asked, "out": out}
        read = [[run.residual, run.estimate, run.recording] for run in runs]
        modules = tuple(f"{MEASURES}.{name}" for name in asked.sections)
        return Job(Call(f"{MEASURES}.scores:score", arguments), _read(read), modules, {str(out): code_hash(*modules)})

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
        own = dict.fromkeys(map(str, detection_files(self.files).values()), ())
        return Job(Call("experiments.jobs.detect:detect", arguments), _read(walks), (), own)

    def watch(self) -> Job:
        """Return the thresholds of a robot's limbs that are watched all the time, and of its feet's sensors."""
        settings = self.settings
        files = self.files
        level = level_of_detectors(self.files)
        random = settings.detection.random
        method = settings.reaction.estimator
        run = self._loaded(method)
        quiet = files.tests(random, level)
        arguments = {
            "settings": walk_settings(settings, random, level),
            "reaction": settings.reaction,
            "detection": numbers_of(files),
            "observer": settings.observer,
            "runs": {method: run},
            "quiet": quiet,
            "out": (out := watch_file(files)),
        }
        inputs = _read([*quiet, run.fitted, _weights([run])])
        kinds = self._kinds(method)
        return Job(Call("experiments.jobs.calm:watch", arguments), inputs, kinds, {str(out): code_hash(*kinds)})

    def react(self, cases: Sequence[str]) -> Job:
        """Return the walks of a robot in some cases, with all that is compared there."""
        settings = self.settings
        files = self.files
        level = level_of_detectors(self.files)
        methods = methods_of(files, cases)
        # These walks are tests, too, and sealed as all tests are: methods never change by what they show.
        first = settings.sizes.test.first_seed
        walks = tuple(
            CaseWalks(
                case=case,
                settings=walk_settings(settings, settings.reaction.cases[case].scenario, level),
                seeds=tuple(range(first, first + sizes_of(files, case).runs)),
                sizes=sizes_of(files, case),
                out=reaction_file(files, case),
                course=course_file(files, case) if is_pushed(files, case) else None,
            )
            for case in cases
        )
        runs = {method: self._loaded(method) for method in methods}
        arguments = {
            "reaction": settings.reaction,
            "detection": numbers_of(files),
            "observer": settings.observer,
            "runs": runs,
            "thresholds": (thresholds := (detection_files(files)["thresholds"], watch_file(files))),
            "walks": walks,
        }
        fits = [run.fitted for run in runs.values()]
        inputs = (*_read([fits, _weights(runs.values())]), *map(str, thresholds))
        kinds = self._kinds(*methods)
        stamps = {str(one.out): code_hash(*kinds) for one in walks}
        noted = {f"{one.course}{NOTE}": () for one in walks if one.course}
        return Job(Call("experiments.jobs.react:react", arguments), inputs, kinds, {**stamps, **noted})

    def _loaded(self, method: str) -> MethodRun:
        """Return a method with all of its networks that are trained, the first of each limb, to run in a loop."""
        source = self.catalogue.network_source_of(method)
        files = self.files
        limbs = [limb for limb in self.catalogue.method(source).limbs if (source, limb) in files.learned]
        return MethodRun(
            method=method,
            methods={name: self.catalogue.method(name) for name in self._with_source(method)},
            networks={limb: files.network(source, limb, files.network_seeds(source, limb)[0]) for limb in limbs},
            fitted=next(iter(files.fit(method)), None),
            outs=(),
        )

    def _staged(self, name: str, job: Job) -> Job:
        """Return a job that keeps its finished parts below `state` until all of them are there."""
        stage = Stage(self.files.results / "state" / name, job.given, job.inputs)
        return replace(job, call=Call(job.call.function, {**job.call.arguments, STAGE: stage}))

    def _kinds(self, *methods: str) -> tuple[str, ...]:
        """Return the modules that methods import by name: their kinds and those of the methods they run on."""
        found: list[str] = []
        for method in methods:
            found += [f"{KINDS}.{self.catalogue.method(name).kind}" for name in self._with_source(method)]
        return tuple(dict.fromkeys(found))

    def _with_source(self, method: str) -> tuple[str, ...]:
        """Return a method and, if it runs on another one, that one too."""
        return tuple(dict.fromkeys([method, self.catalogue.source_of(method)]))

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
    measured = measured_in(evaluation).items()
    sections = {name: own for name, own in measured if (scenario, level) in tests_in(settings, own)}
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
        "surrogate": settings.surrogate if chosen else None,
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


def _weights(runs: Iterable[MethodRun]) -> list[Path]:
    """Return the weights of all networks of some runs."""
    found: list[Path] = []
    for run in runs:
        found += [folder / WEIGHTS for folder in run.networks.values()]
    return found


def _read(needs: object) -> tuple[str, ...]:
    """Return the files behind some arguments, each once."""
    return tuple(dict.fromkeys(map(str, files_in(needs))))
