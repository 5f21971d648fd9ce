/* The interface of the library (mobnet.h): setting up, one step, names. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "internal.h"

enum { ALIGNED = 64 }; /* a line of the cache, and the widest vector */
static const double LARGEST = 1e12; /* beyond it no torque or momentum has a meaning */
static const double NORM = 0.01;    /* by which a quaternion's norm may differ from 1 (`mobnet.core.contract`) */
static const char *const KIND[KINDS] = {"mean", "std", "ratio"};

/* Return zeroed room for an array, aligned; NULL where the arena only counts. */
void *mobnet_take(struct arena *arena, size_t count, size_t size) {
    unsigned char *room = arena->begin ? arena->begin + arena->used : NULL;
    size_t bytes = (count * size + ALIGNED - 1) / ALIGNED * ALIGNED;
    arena->used += bytes;
    return room ? memset(room, 0, bytes) : NULL;
}

static int is_known_host(void) {
    const double one = 1.0;
    const unsigned char bytes[8] = {0, 0, 0, 0, 0, 0, 0xF0, 0x3F};
    return sizeof one == 8 && sizeof(float) == 4 && memcmp(&one, bytes, sizeof bytes) == 0;
}

mobnet_status mobnet_size(const void *model, size_t model_size, size_t *size) {
    struct arena counted = {NULL, 0};
    struct mobnet m;
    if (!model || !size)
        return MOBNET_NULL;
    if (!is_known_host())
        return MOBNET_HOST;
    memset(&m, 0, sizeof m);
    mobnet_take(&counted, 1, sizeof m);
    mobnet_status status = mobnet_read_model(&m, &counted, model, model_size);
    *size = status == MOBNET_OK ? counted.used + ALIGNED : 0;
    return status;
}

mobnet_status mobnet_init(void *memory, size_t size, const void *model, size_t model_size, mobnet **handle) {
    size_t needed;
    if (!memory || !handle)
        return MOBNET_NULL;
    *handle = NULL;
    mobnet_status status = mobnet_size(model, model_size, &needed);
    if (status != MOBNET_OK)
        return status;
    if (size < needed)
        return MOBNET_MEMORY;
    struct arena arena = {(unsigned char *)memory + (ALIGNED - (uintptr_t)memory % ALIGNED) % ALIGNED, 0};
    struct mobnet *m = mobnet_take(&arena, 1, sizeof *m);
    status = mobnet_read_model(m, &arena, model, model_size);
    if (status == MOBNET_OK)
        *handle = m;
    return status;
}

void mobnet_reset(mobnet *m) {
    if (!m)
        return;
    m->begun = 0;
    memset(m->tick[m->now].residual, 0, m->robot.nv * sizeof(double));
    memset(m->tick[m->now].hidden, 0, m->hidden * sizeof(float));
    for (size_t k = 0; k < m->detectors; k++) {
        struct detector *d = &m->detector[k];
        memset(&d->state, 0, sizeof d->state);
        memset(d->low, 0, d->signals * sizeof(double));
        memset(d->held, 0, d->hold * d->signals * sizeof(double));
        d->samples = d->highest = 0;
    }
}

/* Return whether a part of a sample, which begins at `*column`, lies in its bounds. The column moves on to the next
 * part, or to the number that does not. */
static int is_accepted(const struct mobnet *m, const double *part, size_t count, size_t *column) {
    for (size_t k = 0; k < count; k++, ++*column)
        if (!(part[k] >= m->column[*column].low && part[k] <= m->column[*column].high))
            return 0;
    return 1;
}

static mobnet_status check_sample(const struct mobnet *m, const mobnet_sample *s, size_t *column) {
    const struct robot *robot = &m->robot;
    const double *parts[] = {s->q, s->v, s->tau_motor, s->tau_des, s->acc, s->swing, s->landing};
    size_t counts[] = {robot->nq, robot->nv, robot->nu, robot->nu, robot->floating ? 3 : 0, robot->feet, robot->feet};
    *column = 0;
    for (int i = 0; i < 7; i++)
        if (counts[i] && !parts[i])
            return MOBNET_NULL;
    for (int i = 0; i < 7; i++)
        if (!is_accepted(m, parts[i], counts[i], column))
            return MOBNET_SAMPLE;
    if (robot->floating) {
        double norm = 0.0;
        for (int i = 3; i < BASE_Q; i++)
            norm += s->q[i] * s->q[i];
        *column = 3;
        if (!(fabs(sqrt(norm) - 1.0) <= NORM))
            return MOBNET_SAMPLE;
    }
    return MOBNET_OK;
}

static int are_finite(const double *x, size_t count) {
    int good = 1;
    for (size_t i = 0; i < count; i++)
        good &= fabs(x[i]) <= LARGEST;
    return good;
}

static int are_finite_f(const float *x, size_t count) {
    int good = 1;
    for (size_t i = 0; i < count; i++)
        good &= fabsf(x[i]) <= FLT_MAX;
    return good;
}

/* Fill the next tick from a sample and the last one; return whether all of its numbers are finite. */
static int advance(struct mobnet *m, const mobnet_sample *sample, const struct tick *last, struct tick *next) {
    size_t nv = m->robot.nv;
    mobnet_observe(m, sample, last, next);
    if (m->robot.floating)
        mobnet_first_columns(sample->q + 3, m->rotation);
    for (size_t k = 0; k < nv; k++)
        next->tau_ext[k] = next->residual[k];
    for (size_t k = 0; k < m->networks; k++)
        mobnet_predict(m, &m->network[k], sample, last, next);
    return are_finite(next->momentum, nv) && are_finite(next->beta, nv) && are_finite(next->residual, nv) &&
           are_finite(next->tau_ext, nv) && are_finite_f(next->std, nv) && are_finite_f(next->hidden, m->hidden);
}

mobnet_status mobnet_step(mobnet *m, const mobnet_sample *sample, mobnet_result *result) {
    if (!m || !sample || !result)
        return MOBNET_NULL;
    mobnet_status status = check_sample(m, sample, &result->fault);
    if (status == MOBNET_OK && !advance(m, sample, &m->tick[m->now], &m->tick[1 - m->now]))
        status = MOBNET_NOT_FINITE;
    /* Without this sample, the next one has no difference of momentum over one period. */
    m->begun = status == MOBNET_OK;
    if (status == MOBNET_OK) {
        m->now = 1 - m->now;
        for (size_t k = 0; k < m->detectors; k++)
            mobnet_detect(&m->robot, &m->detector[k], sample, &m->tick[m->now], &m->alarm[k]);
    }
    const struct tick *tick = &m->tick[m->now];
    result->residual = tick->residual;
    result->tau_ext = tick->tau_ext;
    result->mean = tick->mean;
    result->std = tick->std;
    result->alarms = m->alarm;
    return status;
}

mobnet_sizes mobnet_sizes_of(const mobnet *m) {
    const struct robot *robot = &m->robot;
    mobnet_sizes sizes = {robot->nq,   robot->nv,    robot->nu,       robot->feet,         m->columns,
                          m->networks, m->detectors, robot->floating, m->observer.rate_hz};
    return sizes;
}

const char *mobnet_text(mobnet_status status) {
    static const char *const texts[] = {
        "all is well",
        "a pointer that is needed is NULL",
        "this machine is not little-endian with numbers of IEEE 754",
        "the model file is not as long as it says",
        "this is no model file",
        "the model file has another version of the format",
        "the model file is damaged: its checksum differs",
        "a section of the model file is missing, or not where or as long as it must be",
        "a value in the model file is not accepted",
        "the memory is smaller than mobnet_size says",
        "a number of the sample is not finite or out of its bounds",
        "the sample led to a number that is not finite"};
    size_t number = (size_t)status;
    return number < sizeof texts / sizeof *texts ? texts[number] : NULL;
}

const char *mobnet_column_name(const mobnet *m, size_t column) {
    return column < m->columns ? m->column[column].name : NULL;
}

const char *mobnet_joint_name(const mobnet *m, size_t joint) {
    return joint < m->robot.nv ? m->joint[joint] : NULL;
}

const char *mobnet_detector_name(const mobnet *m, size_t detector) {
    return detector < m->detectors ? m->detector[detector].name : NULL;
}

const char *mobnet_signal_kind(const mobnet *m, size_t detector, size_t signal) {
    if (detector >= m->detectors || signal >= m->detector[detector].signals)
        return NULL;
    return KIND[m->detector[detector].kind[signal / m->detector[detector].joints]];
}

const char *mobnet_signal_joint(const mobnet *m, size_t detector, size_t signal) {
    if (detector >= m->detectors || signal >= m->detector[detector].signals)
        return NULL;
    const struct detector *d = &m->detector[detector];
    return m->joint[d->joint[signal % d->joints]];
}
