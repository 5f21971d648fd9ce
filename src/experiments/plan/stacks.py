"""Which networks learn side by side on a GPU: those of one shape that learn alike, of the plant or of all robots."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from experiments.plan.files import Files, NetworkName
from mobnet.formats.network import SIZES, Inertial
from mobnet.settings.networks import IN_A_STACK, Network, Training

INPUTS_PER_JOINT = 2  # of a network: position and velocity
IMU_INPUTS: dict[Inertial, int] = {"rotation": 6, "angular_velocity": 3, "acceleration": 3}


class Stacked(NamedTuple):
    """A network of a stack: the folder of the plant or of its robot, and its name there."""

    robot: str
    network: NetworkName

    @property
    def name(self) -> str:
        """Its name among the networks of all robots, such as `plant/MOB-Net-LL-s0`."""
        method, limb, seed = self.network
        return f"{self.robot}/{method}-{limb}-s{seed}"


@dataclass(frozen=True)
class Stacks:
    """The stacks of a scale, by name: that of the first network."""

    plant: Files

    @cached_property
    def members(self) -> Mapping[str, tuple[Stacked, ...]]:
        """The networks of each stack, in the order of the plan."""
        alike: dict[str, list[Stacked]] = {}
        for files in self.plant.owners:
            for network in files.own_networks:
                training = files.catalogue.training(network.method, network.limb)
                if is_stacked(training):
                    alike.setdefault(shape_of(files, network, training), []).append(
                        Stacked(files.results.name, network)
                    )
        # A GPU has so much memory: more networks of one shape learn in several stacks, one after the other.
        most = self.plant.settings.stacks.most
        stacks: dict[str, tuple[Stacked, ...]] = {}
        for networks in alike.values():
            for first in range(0, len(networks), most):
                part = tuple(networks[first : first + most])
                stacks[part[0].name.replace("/", "-")] = part
        return stacks

    @cached_property
    def names(self) -> Mapping[Stacked, str]:
        """The stack of each network that is in one."""
        stack_of: dict[Stacked, str] = {}
        for name, members in self.members.items():
            stack_of |= dict.fromkeys(members, name)
        return stack_of

    def file(self, name: str) -> Path:
        """Return the file of what a stack has learned."""
        return self.plant.shared / "stacks" / f"{name}.safetensors"


def is_stacked(training: Training) -> bool:
    """Return whether a network may learn in a stack: one with inputs, whose matrices no norm divides."""
    return training.network.cell != "constant" and not training.network.spectral


def shape_of(files: Files, name: NetworkName, training: Training) -> str:
    """Return what the networks of a stack have in common: their sizes, how they learn and for how many epochs.

    One with fewer samples waits for the others at each epoch's end, which takes less time than a stack of its own.
    """
    layout = files.settings.layout
    network = training.network
    shape = {
        # The tables of the plant wait for no recording of a robot.
        "robot": bool(files.robot),
        **network.model_dump(mode="json", include={"cell", *SIZES[network.cell]}),
        "inputs": inputs_of(files, network),
        "joints": len(layout.limbs(network.joints)),
        "horizon": network.horizon_steps,
        "epochs": training.epochs,
        # One that starts from another's weights waits for them.
        "start": bool(files.start(*name)),
        "fit": bool(files.fit(name.method)),
        **training.learning.model_dump(mode="json", include={*IN_A_STACK}),
    }
    return json.dumps(shape)


def inputs_of(files: Files, network: Network) -> int:
    """Return the number of inputs of a network."""
    limbs = files.settings.layout.limbs
    base = sum(IMU_INPUTS[reading] for reading in network.imu)
    return INPUTS_PER_JOINT * len(limbs(network.Q)) + len(limbs(network.T)) + base
