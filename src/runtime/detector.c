/* From an estimate to an alarm: gate of a leg, low-pass, threshold, a time without a gap.
 *
 * (D1) to (D8) are derived in docs/notes/detection.md.
 */
#include <math.h>

#include "internal.h"
#include "triples.h"

static const double IN_THE_AIR = 0.5; /* of a flag */
static const double VANISHES = 1e-9;  /* a pivot: no single wrench explains the torques */

/* A point of a link, or with `points` zero a direction, in world axes about the base's origin. */
static triple to_world(const struct robot *robot, size_t link, triple x, int points) {
    for (; link > 0; link = (size_t)robot->link[link].parent) {
        x = product(robot->moving[link].rotation, x);
        if (points)
            x = add(x, vector(robot->link[link].offset));
    }
    return product(robot->moving[0].rotation, x);
}

/* The height of the lowest corner of a sole. */
static double lowest(const struct robot *robot, const struct sole *sole) {
    double least = HUGE_VAL;
    for (int k = 0; k < CORNERS; k++)
        least = fmin(least, to_world(robot, (size_t)sole->link, vector(sole->corner[k]), 1).z);
    return least;
}

static void exchange(double *a, double *b) {
    double kept = *a;
    *a = *b;
    *b = kept;
}

/* Solve matrix x = right by elimination with pivoting; right becomes x. Return 0 if a pivot vanishes. */
static int solve(double matrix[LEG_JOINTS][LEG_JOINTS], double *right) {
    for (int i = 0; i < LEG_JOINTS; i++) {
        int pivot = i;
        for (int j = i + 1; j < LEG_JOINTS; j++)
            if (fabs(matrix[j][i]) > fabs(matrix[pivot][i]))
                pivot = j;
        if (!(fabs(matrix[pivot][i]) >= VANISHES))
            return 0;
        for (int k = i; k < LEG_JOINTS; k++)
            exchange(&matrix[i][k], &matrix[pivot][k]);
        exchange(&right[i], &right[pivot]);
        for (int j = i + 1; j < LEG_JOINTS; j++) {
            double factor = matrix[j][i] / matrix[i][i];
            for (int k = i + 1; k < LEG_JOINTS; k++)
                matrix[j][k] -= factor * matrix[i][k];
            right[j] -= factor * right[i];
        }
    }
    for (int i = LEG_JOINTS - 1; i >= 0; i--) {
        for (int k = i + 1; k < LEG_JOINTS; k++)
            right[i] -= matrix[i][k] * right[k];
        right[i] /= matrix[i][i];
    }
    return 1;
}

/* Write which wrench on the foot, world axes, about its origin, explains the torques of the leg's joints: tau = J^T F.
 * Return 0 where none does. */
static int foot_load(const struct robot *robot, const struct leg *leg, const double *tau, double *load) {
    /* (D5): six joints and six numbers of a wrench, so that one pose gives one wrench. */
    double jacobian[LEG_JOINTS][LEG_JOINTS];
    triple foot = to_world(robot, (size_t)leg->foot.link, vector(leg->foot.origin), 1), zero = {0.0, 0.0, 0.0};
    for (int j = 0; j < LEG_JOINTS; j++) {
        size_t link = (size_t)leg->first + 1 + (size_t)j;
        triple axis = to_world(robot, link, vector(robot->link[link].axis), 0);
        triple arm = add(foot, times(-1.0, to_world(robot, link, zero, 1)));
        put(jacobian[j], cross(axis, arm));
        put(jacobian[j] + 3, axis);
        load[j] = tau[j];
    }
    return solve(jacobian, load);
}

/* Whether the force on the foot looks like the ground's; -1 where the pose does not tell. */
static int is_ground(const struct robot *robot, const struct gate *gate, const struct leg *leg, const double *tau) {
    double load[LEG_JOINTS];
    if (!foot_load(robot, leg, tau, load))
        return -1;
    double size = sqrt(load[0] * load[0] + load[1] * load[1] + load[2] * load[2]);
    double height = lowest(robot, &leg->foot) - lowest(robot, &leg->other);
    return size > gate->force && load[2] > gate->upright * size && height < gate->low;
}

/* Take one sample, after its momentum, whose rotations the gate uses; return whether the limb is watched. */
static int watch(const struct robot *robot, struct detector *d, const mobnet_sample *sample, const double *tau) {
    struct gate_state *s = &d->state;
    /* Observer and network start from zero, and what they have not yet found would look like a push. */
    if (!d->gated)
        return d->samples >= d->settle;
    double swing = sample->swing[d->foot], landing = sample->landing[d->foot];
    if (swing < IN_THE_AIR) {
        s->air = s->touching = s->landed = 0;
        s->phase = 0.0;
        return 0;
    }
    /* (D4): the plan's own clock. A phase of the measured motion would jump when something stops the leg. */
    s->air++;
    double since = (double)s->air * d->gate.period;
    s->phase = since / (since + landing);
    /* (D3) [5.3]: while a foot leaves or meets the ground, ground forces are expected. */
    if (s->landed || s->air < d->gate.lift_off || landing <= d->gate.landing)
        return 0;
    /* (D6) [7]: an early landing ends the swing, though the plan does not know yet. */
    if (landing < d->gate.near) {
        double own[LEG_JOINTS];
        for (size_t k = 0; k < LEG_JOINTS; k++)
            own[k] = tau[(size_t)d->leg.first + robot->nv - robot->nu + k];
        int ground = is_ground(robot, &d->gate, &d->leg, own);
        if (ground >= 0)
            s->touching = ground ? s->touching + 1 : 0;
    }
    s->landed = s->touching >= d->gate.hold;
    return !s->landed;
}

/* What a detector takes for the external torque of all joints. */
static const double *watched_torque(const struct detector *d, const struct tick *tick) {
    return d->residual ? tick->residual : tick->tau_ext;
}

/* Signals of an estimate, one kind after the other, joint by joint (D1). */
static void find_signals(const struct detector *d, const struct tick *tick) {
    const double *torque = watched_torque(d, tick);
    for (size_t i = 0; i < d->kinds; i++)
        for (size_t k = 0; k < d->joints; k++) {
            double mean = torque[d->joint[k]], std = tick->std[d->joint[k]];
            d->signal[i * d->joints + k] = d->kind[i] == 0 ? mean : d->kind[i] == 1 ? std : mean / std;
        }
}

/* Take one sample; return how often the highest signal lies above its threshold, held without a gap. */
static double advance_chain(struct detector *d, const struct tick *tick, int watched) {
    /* Bounds come before the conversion, as that of a double which no size_t holds is not defined in C. */
    double place = fmin(fmax(d->state.phase * (double)d->phases, 0.0), (double)(d->phases - 1));
    const double *threshold = d->threshold + (size_t)place * d->signals;
    size_t row = d->samples++ % d->hold;
    double highest = 0.0;
    find_signals(d, tick);
    for (size_t k = 0; k < d->signals; k++) {
        /* (D7). The filter runs on the ground too: a state that began at the gate would hide the start of a swing. */
        d->low[k] = d->pole * d->low[k] + (1.0 - d->pole) * d->signal[k];
        /* (D8): a sample that is not watched breaks what is held: no alarm reaches back to before the gate. */
        double least = d->held[row * d->signals + k] = watched ? fabs(d->low[k]) / threshold[k] : 0.0;
        for (size_t i = 0; i < d->hold; i++)
            least = fmin(least, d->held[i * d->signals + k]);
        /* The OR of [5.3]: one signal over its threshold is enough, and the highest one names the alarm. */
        if (least > highest) {
            highest = least;
            d->highest = k;
        }
    }
    return highest;
}

void mobnet_detect(const struct robot *robot, struct detector *d, const mobnet_sample *sample, const struct tick *tick,
                   mobnet_alarm *alarm) {
    alarm->watched = watch(robot, d, sample, watched_torque(d, tick));
    alarm->ratio = advance_chain(d, tick, alarm->watched);
    alarm->signal = (int)d->highest;
}
