"""Pictures of the robot on its terrain, drawn off screen through EGL where the machine has it."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib.image
import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.core.files import atomic_path
from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import robot_spec
from mobnet.simulation.terrain import add_terrain, draw_terrain

log = logging.getLogger(__name__)
Pixels = NDArray[np.uint8]
PACKAGES = "libegl1 libegl-mesa0 libgl1-mesa-dri"  # Debian's names of Mesa's EGL
SIZE = (1000, 750)  # width, height [pixels]
CAMERA = {"distance": 3.85, "azimuth": 134.0, "elevation": -8.0}  # [m], [deg], [deg]
VIEW_DEG = 30.0  # a long lens: little distortion
EYE_FROM_PELVIS_M = (0.02, 0.0, -0.08)
WIDE_M = 9.0  # half width of the terrain: past where the fog ends
EXTENT_M = 2.0  # the scene's size that MuJoCo scales shadow and fog by
FOG = (1.8, 4.4)  # start and end, in extents
SKY_RGB = (0.86, 0.91, 0.96)
HEADLIGHT, HEADLIGHT_SHINE, SUN, SUN_SHINE = 0.36, 0.1, 0.58, 0.25  # brightness, 0..1
SUN_DIRECTION = (-0.48, 0.29, -0.87)
SUN_DISTANCE_M = 5.0
SHADOW_PIXELS, SAMPLES = 8192, 8  # of the shadow's map, of a pixel
SHADOW_CLIP = 2.5  # half width of the shadow's map, in extents; at its edge shadows speckle
logging.getLogger("OpenGL").setLevel(logging.WARNING)  # it tells of every optional part it lacks


def save_picture(config: Mapping[str, Any], robot: RobotDescription, terrain: str, q: NDArray[Any], path: Path) -> bool:
    """Draw the robot at q (nq,) [m, rad] into a PNG, or say in one line what the machine lacks for it.

    Args:
        config: the resolved configuration.
        robot: figures of the robot.
        terrain: key of `terrain` in the configuration.
        q: generalized position (nq,), quaternion w x y z.
        path: the PNG; written as a whole or not at all.

    Returns:
        Whether the picture was drawn.
    """
    try:
        pixels = draw(picture_model(config, robot, terrain), q)
    except (ImportError, AttributeError, OSError, RuntimeError, _gl_error(), mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        log.warning("picture skipped, no drawing off screen (%s); Debian packages for it: %s", reason, PACKAGES)
        return False
    with atomic_path(path) as temporary:
        matplotlib.image.imsave(temporary, pixels, format="png", pil_kwargs={"optimize": True})
    return True


def picture_model(config: Mapping[str, Any], robot: RobotDescription, terrain: str) -> mujoco.MjModel:
    """Compile the robot on a wide terrain under a sky; nothing of it enters a simulation.

    Raises:
        ConfigError: the terrain is unknown.
    """
    spec = robot_spec(robot)
    add_terrain(spec, draw_terrain(terrain, config["terrain"], np.random.default_rng(0)), WIDE_M)
    spec.stat.extent, spec.stat.center = EXTENT_M, [0.0, 0.0, EXTENT_M / 2]
    _set_view(spec.visual)
    spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT, rgb1=SKY_RGB,
        width=SAMPLES, height=SAMPLES,
    )  # fmt: skip
    spec.worldbody.add_light(
        pos=-SUN_DISTANCE_M * np.array(SUN_DIRECTION), dir=SUN_DIRECTION, castshadow=True, diffuse=[SUN] * 3,
        specular=[SUN_SHINE] * 3, type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
    )  # fmt: skip
    return spec.compile()


def _set_view(visual: Any) -> None:
    """Set size, lens, light and quality of pictures."""
    visual.global_.offwidth, visual.global_.offheight = SIZE
    visual.global_.fovy = VIEW_DEG
    visual.headlight.ambient = visual.headlight.diffuse = [HEADLIGHT] * 3
    visual.headlight.specular = [HEADLIGHT_SHINE] * 3
    visual.map.fogstart, visual.map.fogend = FOG
    visual.map.shadowclip = SHADOW_CLIP
    visual.rgba.fog = visual.rgba.haze = [*SKY_RGB, 1.0]
    visual.quality.shadowsize, visual.quality.offsamples = SHADOW_PIXELS, SAMPLES


def draw(model: mujoco.MjModel, q: NDArray[Any]) -> Pixels:
    """Draw a model at q (nq,) [m, rad] with the camera on its base; return pixels (height, width, 3).

    The EGL context is made here: `mujoco.Renderer` takes the kind that was chosen when mujoco was first imported.

    Raises:
        ImportError: the machine has no EGL; PyOpenGL may raise AttributeError or its own errors instead.
    """
    from mujoco.egl import GLContext  # needs EGL, which only pictures need

    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = data.qpos[:3] + EYE_FROM_PELVIS_M
    for name, value in CAMERA.items():
        setattr(camera, name, value)
    scene = mujoco.MjvScene(model, maxgeom=2 * model.ngeom)
    everything = mujoco.mjtCatBit.mjCAT_ALL.value
    mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, camera, everything, scene)
    scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = 1
    context = GLContext(*SIZE)
    try:
        context.make_current()
        return _pixels(model, scene)
    finally:
        context.free()


def _pixels(model: mujoco.MjModel, scene: mujoco.MjvScene) -> Pixels:
    """Draw a scene into the current OpenGL context; return pixels (height, width, 3), the top row first."""
    target = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
    try:
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, target)
        frame = mujoco.MjrRect(0, 0, *SIZE)
        pixels = np.empty((SIZE[1], SIZE[0], 3), dtype=np.uint8)
        mujoco.mjr_render(frame, scene, target)
        mujoco.mjr_readPixels(pixels, None, frame, target)
        return pixels[::-1]
    finally:
        target.free()


def _gl_error() -> type[Exception]:
    """Return what PyOpenGL's errors have in common; importing it needs no OpenGL."""
    from OpenGL.error import Error  # only pictures need it

    return Error
