"""Points on a solid lie on it, their normals point out of it, and their areas add up to its surface."""

import numpy as np
import pytest

from mobnet.detection.solids import depth, patch_of
from mobnet.formats.parts import ShapeRow

SPACING_M = 0.01
ENDS = (0.1, 0.0, 0.0, 0.1, 0.06, 0.08)  # 0.1 m apart, along no axis
CAPSULE = 2.0 * np.pi * 0.05 * 0.1 + 4.0 * np.pi * 0.05**2
SOLIDS = {  # type, what else its row has -> area [m^2]
    "capsule": ({"size": (0.05,), "segment": ENDS}, CAPSULE),
    "standing capsule": ({"size": (0.05, 0.05), "pos": (0.0, 0.1, 0.2)}, CAPSULE),
    "cylinder": ({"size": (0.05,), "segment": ENDS}, 2.0 * np.pi * 0.05 * (0.1 + 0.05)),
    "sphere": ({"size": (0.05,), "pos": (0.1, 0.0, 0.0)}, 4.0 * np.pi * 0.05**2),
    "box": ({"size": (0.05, 0.04, 0.03), "pos": (0.1, 0.0, 0.0)}, 8.0 * (0.05 * 0.04 + 0.04 * 0.03 + 0.03 * 0.05)),
    # of the spheroid with half axes 0.06, 0.06 and 0.03, in closed form
    "ellipsoid": (
        {"size": (0.06, 0.06, 0.03)},
        2.0 * np.pi * 0.06**2 * (1.0 + 0.25 / np.sqrt(0.75) * np.arctanh(np.sqrt(0.75))),
    ),
}


def shape_of(title: str) -> ShapeRow:
    return ShapeRow.model_validate({"name": "solid", "body": "link", "type": title.split()[-1], "tone": "grey",
                                    **SOLIDS[title][0]})  # fmt: skip


@pytest.mark.parametrize("title", SOLIDS)
def test_points_lie_on_the_solid_and_normals_point_out_of_it(title: str) -> None:
    shape = shape_of(title)
    patch = patch_of(shape, SPACING_M)
    np.testing.assert_allclose(depth(shape, patch.points), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(patch.normals, axis=1), 1.0)
    assert (depth(shape, patch.points + 1e-3 * patch.normals) < 0.0).all()
    assert (depth(shape, patch.points - 1e-3 * patch.normals) > 0.0).all()


@pytest.mark.parametrize("title", SOLIDS)
def test_areas_add_up_to_the_surface(title: str) -> None:
    patch = patch_of(shape_of(title), SPACING_M)
    assert patch.area.sum() == pytest.approx(SOLIDS[title][1], rel=0.01)
    # a closed surface has no direction
    np.testing.assert_allclose(patch.area @ patch.normals, 0.0, atol=1e-9)


@pytest.mark.parametrize("title", SOLIDS)
def test_points_are_as_far_apart_as_asked(title: str) -> None:
    points = patch_of(shape_of(title), SPACING_M).points
    distance = np.linalg.norm(points[:, None] - points, axis=-1) + np.eye(len(points))
    nearest = distance.min(axis=1)
    assert 0.5 * SPACING_M < np.median(nearest) < 1.2 * SPACING_M
    assert nearest.max() < 2.0 * SPACING_M


@pytest.mark.parametrize("title", SOLIDS)
def test_a_solid_that_is_smaller_than_the_distance_asked_has_points_on_every_side(title: str) -> None:
    shape = shape_of(title)
    patch = patch_of(shape, 10.0)
    np.testing.assert_allclose(depth(shape, patch.points), 0.0, atol=1e-9)
    assert patch.area.sum() == pytest.approx(SOLIDS[title][1], rel=0.3)  # of a few pieces, each taken as flat


def test_a_needle_has_a_point_on_every_ring() -> None:
    row = {"name": "solid", "body": "link", "type": "cylinder", "tone": "grey", "size": (0.001, 0.5)}
    patch = patch_of(ShapeRow.model_validate(row), 1.0)
    assert patch.area.sum() == pytest.approx(2.0 * np.pi * 0.001 * (1.0 + 0.001), rel=1e-6)
