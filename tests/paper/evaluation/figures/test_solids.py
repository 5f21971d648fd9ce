"""Solids on a picture: their outlines are exact, hidden faces are not drawn, and left and right are mirror images."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.ground import draw_shadow
from experiments.evaluation.figures.drawing.robot import draw_robot, lowest, projection, solids_of
from experiments.evaluation.figures.drawing.solids import Solid, ellipse_of, lit, outline_of, polygons_of
from experiments.settings.settings import Settings
from mobnet.formats.parts import ShapeRow
from mobnet.robot.description import WalkingRobot, dressed

VIEW = projection(35.0, 20.0)
TURN = projection(-70.0, 50.0)  # any orientation
SEGMENT = (0.0, 0.1, 0.0, 0.3, -0.1, 0.2)
SHAPES = {
    "capsule": {"size": (0.1,), "segment": SEGMENT}, "cylinder": {"size": (0.1,), "segment": SEGMENT},
    "box": {"size": (0.1, 0.2, 0.3)}, "ellipsoid": {"size": (0.1, 0.2, 0.3)}, "sphere": {"size": (0.2,)},
}  # fmt: skip


def solid(kind: str) -> Solid:
    row = ShapeRow.model_validate({"name": "part", "body": "base", "type": kind, "tone": "light", **SHAPES[kind]})
    return Solid(row, TURN, np.array([0.3, -0.2, 0.5]), "0.5")


def surface(kind: str) -> np.ndarray:
    """Return many points of the surface of a solid, sampled by its definition (n, 3) [m]."""
    rng, shape = np.random.default_rng(1), SHAPES[kind]
    ball = rng.normal(size=(200_000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    if kind in ("capsule", "cylinder"):
        start, end = np.reshape(SEGMENT, (2, 3))
        if kind == "cylinder":
            along = (end - start) / np.linalg.norm(end - start)
            ball -= np.outer(ball @ along, along)
            ball /= np.linalg.norm(ball, axis=1, keepdims=True)
        own = np.where(rng.random((len(ball), 1)) < 0.5, start, end) + shape["size"][0] * ball
    elif kind == "box":
        own = np.sign(ball) * shape["size"]
    else:
        own = ball * shape["size"]
    return own @ TURN.T + np.array([0.3, -0.2, 0.5])


@pytest.mark.parametrize("kind", list(SHAPES))
def test_an_outline_reaches_as_far_as_the_solid_in_every_direction(kind: str) -> None:
    outline, points = outline_of(solid(kind), VIEW), surface(kind) @ VIEW[:2].T
    for angle in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
        direction = np.array([np.cos(angle), np.sin(angle)])
        assert (outline @ direction).max() == pytest.approx((points @ direction).max(), abs=0.004)


@pytest.mark.parametrize("kind", list(SHAPES))
def test_the_lowest_point_of_a_solid_is_that_of_its_surface(kind: str) -> None:
    assert solid(kind).lowest == pytest.approx(surface(kind)[:, 2].min(), abs=0.002)


@pytest.mark.parametrize("kind", ["capsule", "cylinder", "ellipsoid", "sphere"])
def test_shade_lies_within_the_outline_and_is_brighter(kind: str) -> None:
    outer, *inner = polygons_of(solid(kind), VIEW)
    for polygon in inner[:4]:
        for angle in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False):
            direction = np.array([np.cos(angle), np.sin(angle)])
            assert (polygon.corners @ direction).max() <= (outer.corners @ direction).max() + 1e-9
    brightness = [polygon.colour.sum() for polygon in (outer, *inner[:4])]
    assert brightness == sorted(brightness)


def test_a_box_shows_three_faces_and_one_from_ahead() -> None:
    assert len(list(polygons_of(solid("box"), VIEW))) == 3
    ahead = Solid(solid("box").shape, np.eye(3), np.zeros(3), "0.5")
    assert len(list(polygons_of(ahead, projection(0.0, 0.0)))) == 1


def test_an_ellipse_seen_from_its_edge_is_a_line_and_no_error() -> None:
    assert np.ptp(ellipse_of(np.array([[1.0, 0.0], [0.0, 0.0]])), axis=0) == pytest.approx([2.0, 0.0], abs=0.01)


def test_bright_colours_go_to_white_and_dark_ones_keep_their_hue() -> None:
    assert lit(np.array(to_rgb("#204060")), 0.5) == pytest.approx(np.array(to_rgb("#204060")) / 2)
    assert lit(np.ones(3), 1.06).max() == 1.0


@pytest.fixture(params=["shapes", "looks"])
def shown(request: pytest.FixtureRequest, settings: Settings, robot: WalkingRobot) -> WalkingRobot:
    return robot if request.param == "shapes" else dressed(robot, settings.robot.looks)


def test_left_and_right_are_mirror_images_on_a_picture(shown: WalkingRobot) -> None:
    q, view = np.eye(1, shown.layout.nq, 3)[0], projection(0.0, 0.0)
    boxes = np.array([_box(outline_of(one, view)) for one in solids_of(shown, q)])
    mirrored = boxes[:, [1, 0, 2, 3]] * [-1, -1, 1, 1]
    assert sorted(map(tuple, np.round(boxes, 3) + 0.0)) == sorted(map(tuple, np.round(mirrored, 3) + 0.0))
    left = next(row for row in solids_of(shown, q) if row.shape.name == "left_forearm")
    assert outline_of(left, view)[:, 0].min() > 0.0  # from ahead, its left is at the right


def _box(outline: np.ndarray) -> list[float]:
    """Return left, right, lower and upper end of an outline."""
    return [outline[:, 0].min(), outline[:, 0].max(), outline[:, 1].min(), outline[:, 1].max()]


def test_a_picture_has_every_solid_and_its_shadow_lies_on_the_ground(shown: WalkingRobot) -> None:
    q = np.eye(1, shown.layout.nq, 3)[0]
    q[2] = -lowest(shown, q)
    axis = Figure().subplots()
    draw_robot(axis, shown, q, VIEW)
    (drawn,) = axis.collections
    assert len(drawn.get_paths()) >= len(shown.shapes)
    draw_shadow(axis, solids_of(shown, q), VIEW)
    reach = np.concatenate([path.vertices for path in axis.collections[-1].get_paths()])
    assert (reach[:, 1] < shown.leg.link_length).all()  # it lies, and does not stand
    assert np.abs(reach).max() < 1.5
