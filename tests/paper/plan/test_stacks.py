"""Which networks learn side by side, and that it is decided once for the results of a scale."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest

from experiments.plan.dry_run import PlannedJob
from experiments.plan.plan import STACKS, Plan, make_plan, record_stacks, with_stacks
from experiments.plan.stacks import Stacked, is_stacked
from experiments.plan.work import on_gpu, work_of
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError, DataError
from mobnet.settings.networks import IN_A_STACK, Training

SCALES = ("smoke", "paper")
MOST = 8


@cache
def planned(scale: str, **stacks: object) -> Plan:
    """Return the plan of a scale whose networks learn side by side."""
    settings = load_settings(overrides={"scale": scale, "stacks": {"side_by_side": True, **stacks}})
    return make_plan(settings, with_pdf=False)


@pytest.fixture(scope="module")
def plans() -> Mapping[str, Plan]:
    """The plan of some scales, with small stacks."""
    return {scale: planned(scale, most=MOST) for scale in SCALES}


@cache
def training_of(scale: str, robot: str, method: str, limb: str) -> Training:
    return planned(scale).jobs.files_of(robot).catalogue.training(method, limb)


@pytest.mark.parametrize("scale", SCALES)
def test_the_networks_of_a_stack_are_alike_and_few(plans: Mapping[str, Plan], scale: str) -> None:
    plan = plans[scale]
    for name, members in plan.jobs.stacks.members.items():
        assert 1 <= len(members) <= MOST
        shapes: set[object] = set()
        for own in members:
            training = training_of(scale, own.robot, own.network.method, own.network.limb)
            files = plan.jobs.files_of(own.robot)
            cell = training.network.model_dump(exclude={"data", "experiment", "joints", "Q", "T"})
            # A leg and its mirror image, and a limb of another robot, have ports of other names and the same sizes.
            ports = [len(files.settings.layout.limbs(getattr(training.network, key))) for key in ("joints", "Q", "T")]
            learning = training.learning.model_dump_json(include={*IN_A_STACK})
            starts = bool(files.start(*own.network))
            shapes.add((str(cell), sum(ports), ports[0], learning, training.epochs, starts))
        assert len(shapes) == 1, name


@pytest.mark.parametrize("scale", SCALES)
def test_every_network_with_inputs_and_without_norm_is_in_one_stack(plans: Mapping[str, Plan], scale: str) -> None:
    plan = plans[scale]
    found: list[Stacked] = []
    for members in plan.jobs.stacks.members.values():
        found += members
    wanted: set[Stacked] = set()
    for files in plan.files.owners:
        for network in files.own_networks:
            cell = training_of(scale, files.results.name, network.method, network.limb).network
            if cell.cell != "constant" and not cell.spectral:
                wanted.add(Stacked(files.results.name, network))
    assert len(found) == len(set(found))
    assert set(found) == wanted == set(plan.jobs.stacks.names)
    for name, members in plan.jobs.stacks.members.items():
        assert {plan.jobs.stacks.names[own] for own in members} == {name}


def test_a_gru_with_a_norm_and_a_constant_learn_alone(plans: Mapping[str, Plan]) -> None:
    catalogue = plans["paper"].files.robots["robot_1"].catalogue
    assert not is_stacked(catalogue.training("GRU-spectral", "LL"))
    for method in ("GRU", "GRU-windows", "LSTM", "RNN-adam", "MLP", "TCN"):
        assert is_stacked(catalogue.training(method, "LL"))
    assert not is_stacked(planned("paper").files.catalogue.training("MOB-Net", "N"))


@pytest.mark.parametrize("scale", SCALES)
def test_no_stack_waits_for_itself(plans: Mapping[str, Plan], scale: str) -> None:
    """One that is fine-tuned reads the weights of a network of another stack, which reads none of it."""
    plan = plans[scale]
    folders = {plan.jobs.files_of(own.robot).network(*own.network): own for own in plan.jobs.stacks.names}
    started = 0
    for name in plan.jobs.stacks.members:
        for read in plan.jobs.read_by_stack(SimpleNamespace(stack=name)):
            if (first := folders.get(read.parent)) is None:
                continue
            started += 1
            earlier = plan.jobs.stacks.names[first]
            assert earlier != name
            others = plan.jobs.read_by_stack(SimpleNamespace(stack=earlier))
            assert not [path for path in others if path.parent in folders]
    assert started > 0


def test_a_plan_works_out_its_stacks_once(plans: Mapping[str, Plan]) -> None:
    """Each look at them would take as long as the whole price of a scale."""
    assert plans["paper"].jobs.stacks.members is plans["paper"].jobs.stacks.members


def test_names_of_stacks_are_stable(plans: Mapping[str, Plan]) -> None:
    """A job is named by them: the same configuration gives the same ones, and more networks keep the first."""
    first = plans["paper"].jobs.stacks.members
    again = planned.__wrapped__("paper", most=MOST).jobs.stacks.members
    assert dict(first) == dict(again)
    assert "plant-MOB-Net-LL-s0" in first
    wider = planned("paper", most=1024).jobs.stacks.members
    assert set(wider) <= set(first)


def test_a_network_of_a_stack_takes_its_weights_from_there(plans: Mapping[str, Plan]) -> None:
    leg = {"robot": "plant", "method": "MOB-Net", "limb": "LL", "seed": "0"}
    plan = plans["smoke"]
    path, name = plan.jobs.train(SimpleNamespace(**leg))["lesson"]
    assert path == Path("results/smoke/stacks/plant-MOB-Net-LL-s0.safetensors")
    assert name == "plant/MOB-Net-LL-s0"
    alone = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)
    assert "lesson" not in alone.jobs.train(SimpleNamespace(**leg))
    given = plan.jobs.train_stack(SimpleNamespace(stack="plant-MOB-Net-LL-s0"))
    assert "lesson" not in given["members"][name]
    assert len({str(own["state"]) for own in given["members"].values()}) == len(given["members"])


def test_steps_are_work_of_the_stack_alone(plans: Mapping[str, Plan]) -> None:
    plan = plans["paper"]
    leg = {"robot": "plant", "method": "MOB-Net", "limb": "LL", "seed": "0"}
    spectral = {"robot": "robot_1", "method": "GRU-spectral", "limb": "LL", "seed": "101"}
    stack = PlannedJob("train_stack", "train_stack/x", {"stack": "plant-MOB-Net-LL-s0"}, ("stack",), {})
    taught = PlannedJob("train", "train/x", leg, ("weights",), {})
    alone = PlannedJob("train", "train/y", spectral, ("weights",), {})
    members = plan.jobs.stacks.members["plant-MOB-Net-LL-s0"]
    assert set(work_of(plan, taught).amounts) == {"s"}
    assert work_of(plan, stack).amounts == {"s": len(members) * work_of(plan, taught).amounts["s"]}
    assert work_of(plan, alone).amounts["GRU spectral step"] > 0
    there = on_gpu(plan, stack)
    assert there is not None
    assert (there.networks, there.units, there.horizon) == (len(members), 150, 50)
    assert there.steps == plan.files.learned_steps("MOB-Net", "LL")
    assert there.all_steps == len(members) * there.steps
    assert on_gpu(plan, taught) is None
    other = PlannedJob("train_stack", "train_stack/z", {"stack": "robot_1-TCN-LL-s101"}, ("stack",), {})
    for job in (alone, other):  # no rate was measured of these
        there = on_gpu(plan, job)
        assert there is not None
        assert there.networks == 0


@pytest.fixture
def auto() -> Settings:
    """The configuration, which leaves it to the machine."""
    return load_settings(overrides={"scale": "smoke", "stacks": {"side_by_side": "auto"}})


def test_what_the_first_machine_decided_is_kept(auto: Settings, tmp_path: Path) -> None:
    with_gpu = with_stacks(auto, tmp_path, gpus=1)
    assert with_gpu.stacks.side_by_side is True
    assert with_stacks(auto, tmp_path, gpus=0).stacks.side_by_side is False
    record_stacks(with_gpu, tmp_path)
    assert with_stacks(auto, tmp_path, gpus=0).stacks.side_by_side is True
    assert with_stacks(auto, tmp_path / "other", gpus=0).stacks.side_by_side is False
    before = (tmp_path / STACKS).read_bytes()
    record_stacks(with_stacks(auto, tmp_path / "other", gpus=0), tmp_path)
    assert (tmp_path / STACKS).read_bytes() == before


@pytest.mark.parametrize("given", [True, False])
def test_a_yes_or_no_stays_whatever_the_machine_has(given: bool, tmp_path: Path) -> None:
    settings = load_settings(overrides={"scale": "smoke", "stacks": {"side_by_side": given}})
    record_stacks(settings, tmp_path)
    for gpus in (0, 2):
        assert with_stacks(settings, tmp_path, gpus).stacks.side_by_side is given
    assert with_stacks(settings, tmp_path, 1).stacks.most == settings.stacks.most


def test_a_damaged_record_is_named(auto: Settings, tmp_path: Path) -> None:
    (tmp_path / STACKS).parent.mkdir()
    (tmp_path / STACKS).write_text('{"side_by_side": "perhaps"}')
    with pytest.raises(DataError, match=r"stacks.json: side_by_side: 'perhaps' is not accepted"):
        with_stacks(auto, tmp_path, 0)


@pytest.mark.parametrize("value", ["yes", "auto ", 1, {}])
def test_another_word_is_refused(value: object) -> None:
    with pytest.raises(ConfigError, match="side_by_side"):
        load_settings(overrides={"stacks": {"side_by_side": value}})


@pytest.mark.parametrize("scale", SCALES)
def test_a_stack_holds_the_data_of_its_largest_member(plans: Mapping[str, Plan], scale: str) -> None:
    """Its members learn from one set after another; a plan that forgot them would start two such stacks at once."""
    plan = plans[scale]
    for name, members in plan.jobs.stacks.members.items():
        largest = 0.0
        for own in members:
            method, limb, seed = own.network
            w = {"robot": own.robot, "method": method, "limb": limb, "seed": str(seed)}
            largest = max(largest, work_of(plan, PlannedJob("train", "train/x", w, ("weights",), {})).held)
        stack = PlannedJob("train_stack", "train_stack/x", {"stack": name}, ("stack",), {})
        assert work_of(plan, stack).held == largest > 0.0
