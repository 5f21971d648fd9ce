/* The momentum observer in discrete time; (O1) to (O5) are derived in docs/notes/observer.md. */
#include <math.h>

#include "internal.h"

/* u_k from the motors' torque at this sample and at the one before. */
static double mean_torque(const struct observer *observer, double now, double before) {
    /* (O2): a value at the tick taken for the mean would be half a sample late. */
    return observer->sampled ? (now + before) / 2 : now;
}

/* Set the friction of a drive at this sample, and the bend of Dahl's law that it has. */
static double friction(const struct drive *drive, double v, double torque, double period, double before, double *bend) {
    double sign = tanh(v / drive->smoothing);
    *bend = before;
    if (drive->breakaway > 0.0) {
        /* (O19), exact for a velocity that is constant over the sample. */
        double side = v > 0.0 ? 1.0 : -1.0;
        sign = *bend = side + (before - side) * exp(-fabs(v) * period / drive->breakaway);
    }
    return (drive->coulomb + drive->load * fabs(torque)) * sign + drive->viscous * v + drive->offset;
}

void mobnet_observe(const struct mobnet *m, const mobnet_sample *sample, const struct tick *last, struct tick *next) {
    const struct robot *robot = &m->robot;
    const struct observer *observer = &m->observer;
    size_t motors = robot->nv - robot->nu;
    mobnet_momentum(robot, sample->q, sample->v, next->momentum, next->beta);
    for (size_t k = 0; k < robot->nu; k++)
        next->torque[k] = sample->tau_motor[k];
    for (size_t k = 0; observer->drive && k < robot->nu; k++) {
        double before = m->begun ? last->bend[k] : 0.0, v = sample->v[motors + k];
        next->friction[k] =
            friction(&observer->drive[k], v, next->torque[k], 1.0 / observer->rate_hz, before, &next->bend[k]);
    }
    for (size_t k = 0; k < robot->nv; k++) {
        /* (O5): without a sample just before there is no momentum to take a difference from. */
        next->residual[k] = last->residual[k];
        if (!m->begun)
            continue;
        double applied = 0.0;
        if (k >= motors)
            applied = mean_torque(observer, next->torque[k - motors], last->torque[k - motors]);
        if (k >= motors && observer->drive)
            applied = observer->drive[k - motors].scale * applied -
                      (next->friction[k - motors] + last->friction[k - motors]) / 2;
        /* (O1): beta is known at both ends of the sample; either of them alone would cost an order in T. */
        double change = (next->momentum[k] - last->momentum[k]) * observer->rate_hz;
        double raw = change - applied - (next->beta[k] + last->beta[k]) / 2;
        /* (O4), the solution of (10) over a sample. */
        next->residual[k] = observer->pole * last->residual[k] + (1 - observer->pole) * raw;
    }
}
