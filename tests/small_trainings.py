"""A training small enough for a test."""

from dataclasses import dataclass
from pathlib import Path

import pytest
from library_settings import LibrarySettings, training_of

from mobnet.learning.dataset import load_limb_data
from mobnet.learning.job import TrainingJob
from mobnet.learning.train import train_on


@dataclass(frozen=True)
class Small:
    """Trainings of few samples, and their data on disk."""

    settings: LibrarySettings
    recordings: list[Path]
    residuals: list[Path]

    @property
    def layout(self):
        return self.settings.layout

    def training(self, method="MOB-Net", limb="LL", *, epochs=5, **learning):
        """Return a method's training with a small GRU, and with changes of how it learns."""
        training = training_of(self.settings, method, limb)
        hidden = 16 if training.network.cell == "GRU" else training.network.hidden
        changes = {
            "network": training.network.model_copy(update={"hidden": hidden, "horizon_steps": 25}),
            "learning": training.learning.model_copy(update={"stream_s": 0.5, "coarse": (), **learning}),
            "epochs": epochs,
            "epoch_samples": None,
        }
        return training.model_copy(update=changes)

    def data(self, training, **changes):
        files = {"recordings": self.recordings, "residuals": self.residuals}
        return load_limb_data(self.layout, training.network, training.target, **{**files, **changes})

    def arguments(self, training, folder, start=None):
        return {
            "root_seed": 1,
            "layout": self.layout,
            "training": training,
            "seed": 0,
            "recordings": self.recordings,
            "residuals": self.residuals,
            "state": folder / "state",
            "out": folder / "out",
            "start": start,
        }

    def train(self, training, folder, start=None, **changes):
        """Train a network, with `changes` of the arguments of its data, and return its folder."""
        data = self.data(training, held_out=training.held_out, first_s=training.learning.data_s, **changes)
        train_on(data, TrainingJob(training, 0, 1), folder / "out", folder / "state", start, in_place=True)
        return folder / "out"


@pytest.fixture
def small(settings, tmp_path, made_up, write_pair):
    stems = [write_pair(tmp_path / "data", made_up(seed, 4.0, segments=2)) for seed in (0, 1)]
    return Small(settings, *map(list, zip(*stems, strict=True)))


@pytest.fixture
def data(small):
    return small.data(small.training())
