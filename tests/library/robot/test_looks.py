"""Looks are for pictures alone: physics, contacts and what a recording depends on are the same with and without."""

import numpy as np
from library_settings import LibrarySettings

from mobnet.robot.description import WalkingRobot, describe, dressed
from mobnet.robot.plant import robot_spec

PHYSICS = (
    "nq", "nv", "nu", "nbody", "nsite", "nsensor", "body_mass", "body_inertia", "body_ipos", "body_iquat", "body_pos",
    "body_parentid", "dof_armature", "jnt_axis", "jnt_range", "actuator_gear", "sensor_type", "site_pos",
)  # fmt: skip


def test_a_robot_with_looks_has_the_same_physics_and_the_same_contacts(
    settings: LibrarySettings, robot: WalkingRobot
) -> None:
    plain, shown = (robot_spec(one).compile() for one in (robot, dressed(robot, settings.robot.looks)))
    for name in PHYSICS:
        np.testing.assert_array_equal(getattr(plain, name), getattr(shown, name), err_msg=name)
    assert shown.ngeom > plain.ngeom
    for one in (plain, shown):
        touching = (one.geom_contype != 0) | (one.geom_conaffinity != 0)
        assert [one.geom(k).name for k in np.flatnonzero(touching)] == ["left_sole", "right_sole"]
    for name in ("pos", "size", "friction"):
        for sole in ("left_sole", "right_sole"):
            np.testing.assert_array_equal(getattr(plain.geom(sole), name), getattr(shown.geom(sole), name))


def test_no_job_depends_on_looks_by_the_table(settings: LibrarySettings) -> None:
    table = settings.robot
    without = table.model_copy(update={"looks": None})
    assert repr(without) == repr(table)
    assert (describe(without).shapes, describe(without).tones) == (describe(table).shapes, describe(table).tones)
    other = table.model_copy(update={"shapes": table.shapes[1:]})
    assert repr(other) != repr(table)  # these do touch


def test_a_robot_without_looks_is_shown_as_it_is(robot: WalkingRobot) -> None:
    assert dressed(robot, None) is robot


def test_every_solid_of_a_side_has_its_mirror_image(settings: LibrarySettings, robot: WalkingRobot) -> None:
    names = [shape.name for shape in dressed(robot, settings.robot.looks).shapes]
    left = [name for name in names if name.startswith("left_")]
    assert len(left) > 30
    assert {name.replace("left_", "right_", 1) for name in left} <= set(names)
