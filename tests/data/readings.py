"""MuJoCo's own reading of a URDF: poses with mass matrix and bias, to which tests compare a robot's table.

    python tests/data/readings.py g1_29dof_rev_1_0.urdf tests/data/g1.npz --floating

The file is read without the code of this project: its shapes are left out because they need meshes, a free joint is
added for a floating base, and what slides stands at zero. MuJoCo then computes everything from the links of the file.
"""

import argparse
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np

POSES, SEED, SPEED, GRAVITY = 3, 41, 2.0, 9.81


def compiled(path: Path, floating: bool) -> mujoco.MjModel:
    """Return MuJoCo's model of a URDF without its shapes."""
    root = ET.parse(path).getroot()
    for link in root.iter("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
    for joint in root.iter("joint"):
        for mimic in joint.findall("mimic"):
            joint.remove(mimic)
    ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", fusestatic="false", boundmass="0", boundinertia="0")
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    if floating:
        spec.worldbody.first_body().add_freejoint()
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    return spec.compile()


def readings(model: mujoco.MjModel) -> dict[str, np.ndarray]:
    """Return names of the hinges, q, v, lower triangles of M and bias at random poses; a base moves freely first."""
    data, rng = mujoco.MjData(model), np.random.default_rng(SEED)
    kinds = {0: mujoco.mjtJoint.mjJNT_FREE, 1: mujoco.mjtJoint.mjJNT_HINGE}
    free, hinges = (np.flatnonzero(model.jnt_type == kind) for kind in kinds.values())
    qs = np.concatenate([np.arange(7 * len(free)), model.jnt_qposadr[hinges]]).astype(int)
    vs = np.concatenate([np.arange(6 * len(free)), model.jnt_dofadr[hinges]]).astype(int)
    rows = []
    for _ in range(POSES):
        data.qpos[model.jnt_qposadr[hinges]] = rng.uniform(*np.clip(model.jnt_range[hinges], -np.pi, np.pi).T)
        if len(free):
            data.qpos[:7] = rng.normal(size=7)
            data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
        data.qvel[vs] = rng.uniform(-SPEED, SPEED, len(vs))
        mujoco.mj_forward(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        lower = inertia[np.ix_(vs, vs)][np.tril_indices(len(vs))]
        rows.append((data.qpos[qs], data.qvel[vs], lower, data.qfrc_bias[vs]))
    columns = dict(zip(("q", "v", "inertia", "bias"), map(np.array, zip(*rows, strict=True)), strict=True))
    return {"joints": np.array([model.joint(k).name for k in hinges]), **columns}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--floating", action="store_true")
    words = parser.parse_args()
    np.savez_compressed(words.out, allow_pickle=False, **readings(compiled(words.file, words.floating)))
