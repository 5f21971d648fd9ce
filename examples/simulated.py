"""Logs for the examples: a model follows sines by its motors, and something pushes it for half a second."""

import numpy as np
import pinocchio as pin

RATE_HZ = 1000.0
WAVES, SIZE_RAD = 5, 0.15  # sines of a joint that wanders
STIFFNESS, DAMPING = 400.0, 40.0  # of the acceleration that is asked for [1/s^2], [1/s]


def moved(model, push, start_s=1.0, end_s=1.5, seconds=2.0, lost=None):
    """Return what a robot of a model logs at 1 kHz: positions (T, nq), velocities (T, nv), torques of motors (T, nu).

    From `start_s` to `end_s` something pushes with generalized torques `push` (nv,). A free-flyer has no motors; joints
    may lose a torque `lost(v)` (nv,) to friction.
    """
    data = model.createData()
    home = pin.neutral(model)
    q = home.copy()
    v = np.zeros(model.nv)
    free = 6 if model.joints[1].shortname() == "JointModelFreeFlyer" else 0
    log = []
    for k in range(round(seconds * RATE_HZ)):
        t = k / RATE_HZ
        turn = 0.3 * min(t, 1.0) * np.sin(2.0 * t + np.arange(model.nv))
        turn[:free] = 0.0
        asked = STIFFNESS * pin.difference(model, q, pin.integrate(model, home, turn)) - DAMPING * v
        mass, bias = pin.crba(model, data, q), pin.nonLinearEffects(model, data, q, v)
        # What has no motor accelerates as the rest lets it.
        asked[:free] = np.linalg.solve(mass[:free, :free], -mass[:free, free:] @ asked[free:] - bias[:free])
        friction = np.zeros(model.nv) if lost is None else lost(v)
        tau = pin.rnea(model, data, q, v, asked) + friction
        tau[:free] = 0.0
        log.append((q, v, tau[free:]))
        outside = push if start_s <= t < end_s else np.zeros(model.nv)
        v = v + pin.aba(model, data, q, v, tau - friction + outside) / RATE_HZ
        q = pin.integrate(model, q, v / RATE_HZ)
    return tuple(np.array(values) for values in zip(*log, strict=True))


def wandered(model, seconds):
    """Return the same of a robot without a free-flyer that nothing pushes, on slow sines that are drawn."""
    rng = np.random.default_rng(0)
    rates = 2.0 * np.pi * rng.uniform(0.02, 0.3, size=(WAVES, model.nv))  # [rad/s]
    phases = rng.uniform(0.0, 2.0 * np.pi, size=(WAVES, model.nv))
    angles = rates * np.arange(round(seconds * RATE_HZ))[:, None, None] / RATE_HZ + phases
    q = SIZE_RAD * np.sin(angles).sum(axis=1)
    v = SIZE_RAD * (rates * np.cos(angles)).sum(axis=1)
    acceleration = -SIZE_RAD * (rates**2 * np.sin(angles)).sum(axis=1)
    data = model.createData()
    tau = [pin.rnea(model, data, *row) for row in zip(q, v, acceleration, strict=True)]
    return q, v, np.array(tau)


def draw(name, residual, joints, push):
    """Draw the residual of some velocities, joint name -> column, beside what pushed, into NAME.png."""
    import matplotlib.pyplot as plt

    time = np.arange(len(residual)) / RATE_HZ
    for joint, column in joints.items():
        (line,) = plt.plot(time, residual[:, column], label=joint)
        plt.plot(time, np.where((time >= 1.0) & (time < 1.5), push[column], 0.0), ":", color=line.get_color())
    plt.xlabel("time [s]")
    plt.ylabel("external torque [N m], [N]; dotted: true")
    plt.legend()
    plt.savefig(f"{name}.png")
