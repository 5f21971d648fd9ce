"""The jobs that are made once for each recording, network or run: which function, what it gets, what it reads."""

from dataclasses import dataclass
from pathlib import Path

from mobnet.core.files import WEIGHTS
from mobnet.plan.call import Call, Job
from mobnet.plan.detection import numbers_of, walks_of
from mobnet.plan.runs import Files, files_in
from mobnet.settings.data import Terrain
from mobnet.settings.evaluation import Scoring
from mobnet.settings.names import shown_in
from mobnet.settings.settings import Settings, WalkSettings

KINDS = "mobnet.estimation.kinds"  # modules that a method names as its kind


@dataclass(frozen=True)
class Jobs:
    """Jobs by the wildcards of their rules."""

    settings: Settings
    files: Files

    def motion(self, motion: str, seed: int) -> Job:
        """Return the making of a random motion of the upper body."""
        arguments = {
            "root_seed": self.settings.seed,
            "robot": self.settings.robot,
            "motion": self.settings.motions[motion],
            "name": motion,
            "seed": seed,
            "duration_s": self.files.motion_s(motion, seed),
            "out": self.files.results / "motions" / motion / f"s{seed}",
        }
        return Job(Call("mobnet.simulation.motion:make_motion", arguments), ())

    def collect(self, scenario: str, level: str, seed: int) -> Job:
        """Return the recording of a walk."""
        motion = self.files.motion(scenario, seed)
        arguments = {
            "settings": walk_settings(self.settings, scenario, level),
            "seed": seed,
            "duration_s": self.files.duration_s([scenario], seed),
            "out": self.files.array("recordings", scenario, level, seed),
            "motion": next(iter(motion), None),
        }
        return Job(Call("mobnet.simulation.record:collect", arguments), _read(motion))

    def collect_tests(self, scenario: str, level: str) -> Job:
        """Return the recordings of a test, all of them."""
        seeds = self.files.test_seeds
        motions = [self.files.motion(scenario, seed) for seed in seeds]
        outs = self.files.tests(scenario, level)
        arguments = {
            "settings": walk_settings(self.settings, scenario, level),
            "duration_s": self.files.duration_s([scenario], seeds[0]),
            "walks": tuple((*walk[:2], next(iter(walk[2]), None)) for walk in zip(seeds, outs, motions, strict=True)),
        }
        return Job(Call("mobnet.simulation.record:collect_tests", arguments), _read(motions))

    def observe(self, scenario: str, level: str, seed: int) -> Job:
        """Return the observer's residual of a recording."""
        recording = self.files.array("recordings", scenario, level, seed)
        out = self.files.array("residuals", scenario, level, seed)
        arguments = {**self._observer(level), "recording": recording, "out": out}
        return Job(Call("mobnet.estimation.observe:observe", arguments), _read(recording))

    def observe_tests(self, scenario: str, level: str) -> Job:
        """Return the observer's residuals of all recordings of a test."""
        recordings, outs = (self.files.tests(scenario, level, kind) for kind in ("recordings", "residuals"))
        arguments = {**self._observer(level), "pairs": tuple(zip(recordings, outs, strict=True))}
        return Job(Call("mobnet.estimation.observe:observe_tests", arguments), _read(recordings))

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

    def train(self, method: str, limb: str, seed: int) -> Job:
        """Return the training of a network; one with `of` learns what is left of the uncertainty by a fit.

        One with `start` begins with the weights of that method's network.
        """
        training, fitted = self.settings.training(method, limb), self.files.fit(method)
        recordings, residuals = self._training(training.network.data)
        name = f"{method}-{limb}-s{seed}"
        arguments = {
            "root_seed": self.settings.seed,
            "layout": self.settings.layout,
            "rate_hz": self.settings.rates.data_hz,
            "training": training,
            "seed": seed,
            "recordings": recordings,
            "residuals": residuals,
            "out": self.files.results / "networks" / name,
            "state": self.files.results / "state" / name,
        }
        if start := self.files.start(method, limb, seed):
            arguments |= {"start": start}
        if training.learning.labels == "swing":
            swings = self.settings.evaluation.changed
            arguments |= {"margins": (swings.lift_off_s, swings.landing_s)}
        if not fitted:
            return Job(Call("mobnet.learning.train:train", arguments), _read([recordings, residuals, start]))
        arguments |= {"observer": self.settings.observer, "fitted": fitted[0]}
        return Job(Call("mobnet.estimation.train_gray:train_gray", arguments), _read([recordings, residuals, fitted]))

    def estimate(self, method: str, network_seed: int, scenario: str, level: str) -> Job:
        """Return a method's external torque for all recordings of a test, which run side by side."""
        networks = self.files.networks(method, network_seed, scenario, level)
        kinds = "recordings", "residuals", f"estimates/{method}/n{network_seed}"
        recordings, residuals, outs = (self.files.tests(scenario, level, kind) for kind in kinds)
        fitted = self.files.fit(method)
        arguments = {
            **self._observer(level),
            "method": method,
            "methods": {name: self.settings.method(name) for name in self._with_source(method)},
            "networks": networks,
            "fitted": next(iter(fitted), None),
            "joints": self.settings.estimated(method, scenario, level),
            "recordings": recordings,
            "residuals": residuals,
            "outs": outs,
        }
        inputs = _read([recordings, residuals, fitted, [folder / WEIGHTS for folder in networks.values()]])
        return Job(Call("mobnet.estimation.estimate:estimate", arguments), inputs, self._kinds(method))

    def score(self, scenario: str, level: str) -> Job:
        """Return the errors of every run of a test at a level, and what else products ask for."""
        runs, (out,) = self.files.runs_of(scenario, level), self.files.scores([(scenario, level)])
        asked = scoring(self.settings, scenario, level)
        arguments = {"layout": self.settings.layout, "runs": runs, "asked": asked, "out": out}
        read = [[run.residual, run.estimate, run.recording] for run in runs]
        return Job(Call("mobnet.evaluation.measure.scores:score", arguments), _read(read))

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
        return Job(Call("mobnet.evaluation.measure.detections:detect", arguments), _read(walks))

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
    sections = {
        name: getattr(evaluation, name)
        for name in ("peaks", "bode", "drift", "phases", "sigma", "changed")
        if (scenario, level) in shown_in(getattr(evaluation, name))
    }
    pushes = [settings.pushes[name] for name in settings.scenarios[scenario].pushes]
    shared = {
        "window": evaluation.windows.get(scenario),
        "touch_down_s": evaluation.phases.touch_down_s,
        "stuck_rad_s": settings.plant.friction_smoothing_rad_s,
        "cover_share": settings.learning.calibration_share,
        "lines": {push.joint: push.sines.frequency_hz for push in pushes if push.joint and push.sines},
    }
    return Scoring.model_validate({**sections, **shared})


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
