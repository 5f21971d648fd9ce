"""Pictures of the robot on its terrain, drawn off screen through EGL where the machine has it."""

import contextlib
import logging
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DrawingError
from mobnet.core.files import atomic_path
from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import robot_spec
from mobnet.simulation.terrain import DrawnTerrain, add_terrain

Pixels = NDArray[np.uint8]
PACKAGES = "libegl1 libegl-mesa0 libgl1-mesa-dri"  # Debian's names of Mesa's EGL
SIZE = (1000, 750)  # width, height [pixels]
FINER = 2  # drawn pixels a side of a pixel: Mesa takes few samples of each
CAMERA = {"distance": 3.85, "azimuth": 134.0, "elevation": -8.0}  # [m], [deg], [deg]
VIEW_DEG = 30.0  # a long lens: little distortion
EYE_FROM_PELVIS_M = (0.02, 0.0, -0.08)
WIDE_M = 9.0  # half width of the terrain, beyond the end of the fog
EXTENT_M = 2.0  # the scene's size that MuJoCo scales shadow and fog by
FOG = (1.8, 4.4)  # start and end, in extents
SKY_RGB = (0.86, 0.91, 0.96)
HEADLIGHT, HEADLIGHT_SHINE, SUN, SUN_SHINE = 0.36, 0.1, 0.58, 0.25  # brightness, 0..1
SUN_DIRECTION = np.array([-0.48, 0.29, -0.87])
SUN_DISTANCE_M = 5.0
SHADOW_PIXELS, SAMPLES = 8192, 8  # of the shadow's map, of a pixel
SHADOW_CLIP = 2.5  # half width of the shadow's map, in extents; at its edge shadows speckle


def save_picture(robot: RobotDescription, terrain: DrawnTerrain, q: NDArray[Any], path: Path) -> None:
    """Draw the robot at q (nq,) [m, rad] into a PNG, as a whole or not at all; DrawingError where it cannot."""
    (pixels,) = draw_frames(picture_model(robot, terrain), [q])
    with atomic_path(path) as temporary:
        import matplotlib.image  # here: importing it writes a list of fonts into its cache

        matplotlib.image.imsave(temporary, pixels, format="png", pil_kwargs={"optimize": True})


def picture_model(robot: RobotDescription, terrain: DrawnTerrain, size: tuple[int, int] = SIZE) -> mujoco.MjModel:
    """Compile the robot under a sky on a wider part of its terrain, for pictures of a width and height [pixels]."""
    spec = robot_spec(robot)
    add_terrain(spec, _cut(terrain), WIDE_M)
    spec.stat.extent = EXTENT_M
    spec.stat.center = [0.0, 0.0, EXTENT_M / 2]
    _set_view(spec.visual, size)
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        rgb1=SKY_RGB,
        width=SAMPLES,
        height=SAMPLES,
    )
    spec.worldbody.add_light(
        pos=-SUN_DISTANCE_M * SUN_DIRECTION,
        dir=SUN_DIRECTION,
        castshadow=True,
        diffuse=[SUN] * 3,
        specular=[SUN_SHINE] * 3,
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
    )
    return spec.compile()


def _cut(terrain: DrawnTerrain) -> DrawnTerrain:
    """Return a terrain with endless pieces cut into periods: light and fog are computed at corners alone."""
    half = terrain.period / 2
    pieces = [
        piece._replace(bottom=np.minimum(piece.bottom, half), top=np.minimum(piece.top, half))
        for piece in terrain.pieces
    ]
    return DrawnTerrain(terrain.period, tuple(pieces))


def _set_view(visual: Any, size: tuple[int, int]) -> None:
    """Set size, lens, light and quality of pictures."""
    visual.global_.offwidth, visual.global_.offheight = (FINER * side for side in size)
    visual.global_.fovy = VIEW_DEG
    visual.headlight.ambient = visual.headlight.diffuse = [HEADLIGHT] * 3
    visual.headlight.specular = [HEADLIGHT_SHINE] * 3
    visual.map.fogstart, visual.map.fogend = FOG
    visual.map.shadowclip = SHADOW_CLIP
    visual.rgba.fog = visual.rgba.haze = [*SKY_RGB, 1.0]
    shrunk = SIZE[0] // size[0]
    visual.quality.shadowsize = SHADOW_PIXELS // max(shrunk, 1)
    visual.quality.offsamples = SAMPLES


def aim(camera: mujoco.MjvCamera, base: NDArray[Any]) -> None:
    """Point a camera at a robot whose base is at (3,) [m]."""
    camera.lookat[:] = base + EYE_FROM_PELVIS_M
    for name, value in CAMERA.items():
        setattr(camera, name, value)


def draw_frames(model: mujoco.MjModel, qs: Iterable[NDArray[Any]]) -> Iterator[Pixels]:
    """Draw a model at each q (nq,) [m, rad], the camera on its base; yield pixels (height, width, 3).

    All frames share one OpenGL context; frames are drawn as they are asked for.

    Raises:
        DrawingError: the machine cannot draw off screen.
    """
    data = mujoco.MjData(model)
    camera = mujoco.MjvCamera()
    option = mujoco.MjvOption()
    option.sitegroup[:] = 0  # sensors and points of pushes are no part of a picture
    scene = mujoco.MjvScene(model, maxgeom=2 * model.ngeom)
    everything = mujoco.mjtCatBit.mjCAT_ALL.value
    with _off_screen(model) as target:
        for q in qs:
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)
            mujoco.mj_camlight(model, data)
            data.light_xpos[0] = data.qpos[:3] - SUN_DISTANCE_M * SUN_DIRECTION  # the shadow's map has an edge
            aim(camera, data.qpos[:3])
            mujoco.mjv_updateScene(model, data, option, None, camera, everything, scene)
            scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = 1
            yield _pixels(model, scene, target)


@contextlib.contextmanager
def _off_screen(model: mujoco.MjModel) -> Iterator[mujoco.MjrContext]:
    """Open an OpenGL context for pictures of a model's size.

    The EGL context is made here: `mujoco.Renderer` takes the kind that was chosen when mujoco was first imported.
    PyOpenGL tells by errors of many kinds that the machine has no EGL.
    """
    logging.getLogger("OpenGL").setLevel(logging.WARNING)  # at its import it names every optional part that is missing
    with contextlib.ExitStack() as stack:
        try:
            from mujoco.egl import GLContext  # needs EGL, which only pictures need

            context = GLContext(model.vis.global_.offwidth, model.vis.global_.offheight)
            stack.callback(context.free)
            context.make_current()
            target = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
            stack.callback(target.free)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, target)
        except (ImportError, AttributeError, OSError, RuntimeError, _gl_error(), mujoco.FatalError) as error:
            reason = " ".join(str(error).split())
            raise DrawingError(f"no drawing off screen ({reason}); Debian packages for it: {PACKAGES}") from error
        yield target


def _pixels(model: mujoco.MjModel, scene: mujoco.MjvScene, target: mujoco.MjrContext) -> Pixels:
    """Draw a scene; return pixels (height, width, 3), the top row first, each the mean of `FINER` times `FINER`."""
    width = model.vis.global_.offwidth
    height = model.vis.global_.offheight
    frame = mujoco.MjrRect(0, 0, width, height)
    pixels = np.empty((height, width, 3), dtype=np.uint8)
    mujoco.mjr_render(frame, scene, target)
    mujoco.mjr_readPixels(pixels, None, frame, target)
    fine = pixels[::-1].reshape(height // FINER, FINER, width // FINER, FINER, 3)
    return fine.mean(axis=(1, 3)).round().astype(np.uint8)


def _gl_error() -> type[Exception]:
    """Return what PyOpenGL's errors have in common; importing it needs no OpenGL."""
    from OpenGL.error import Error  # only pictures need it

    return Error
