/* GRU-Linear of Table 1 with its z-scores, one time step at batch 1, and cell `constant`, which has no hidden units.
 *
 * The time goes into reading the weights once. They lie in blocks of rows, column by column, so that a vector
 * instruction takes rows and no sum changes its order: every compiler and processor gives the same numbers, but for exp
 * and log. (N1) to (N11) are derived in docs/notes/networks.md.
 */
#include <math.h>
#include <string.h>

#include "internal.h"

size_t mobnet_padded(size_t rows) {
    return (rows + ROWS - 1) / ROWS * ROWS;
}

/* Lay a matrix of floats in rows (rows, columns) out in blocks; what a block has more than the matrix stays zero. */
void mobnet_lay_out(size_t rows, size_t columns, const unsigned char *from, float *to) {
    for (size_t i = 0; i < mobnet_padded(rows); i++)
        for (size_t j = 0; j < columns; j++) {
            float value = 0.0f;
            if (i < rows)
                memcpy(&value, from + (i * columns + j) * sizeof value, sizeof value);
            to[(i / ROWS * columns + j) * ROWS + i % ROWS] = value;
        }
}

/* out = begin + weight x, of so many rows, a multiple of ROWS. */
static void multiply(size_t rows, size_t columns, const float *restrict weight, const float *restrict begin,
                     const float *restrict x, float *restrict out) {
    for (size_t row = 0; row < rows; row += ROWS) {
        float sums[ROWS];
        for (size_t i = 0; i < ROWS; i++)
            sums[i] = begin[row + i];
        for (size_t j = 0; j < columns; j++, weight += ROWS)
            for (size_t i = 0; i < ROWS; i++)
                sums[i] += weight[i] * x[j];
        for (size_t i = 0; i < ROWS; i++)
            out[row + i] = sums[i];
    }
}

/* tanh(x) within a few roundings, by (N8) at half the argument and (N9); NaN stays NaN. */
static inline float rational_tanh(float x) {
    x = x > 9.0f ? 9.0f : x; /* (N8) grows without bound further out, where tanh is 1 to a rounding */
    x = x < -9.0f ? -9.0f : x;
    float y = 0.5f * x, s = y * y;
    float u = y * (135135.0f + s * (17325.0f + s * (378.0f + s)));
    float q = 135135.0f + s * (62370.0f + s * (3150.0f + s * 28.0f));
    return (u + u) * q / (q * q + u * u);
}

/* Turn sums into gates and write the next state: (N5) and (N6), with (N7) for the logistic function. */
static void open_gates(size_t n, const float *restrict by_state, const float *restrict by_in,
                       const float *restrict last, float *restrict next) {
    for (size_t j = 0; j < n; j++) {
        float reset = 0.5f + 0.5f * rational_tanh(0.5f * (by_state[n + j] + by_in[j]));
        float update = 0.5f + 0.5f * rational_tanh(0.5f * (by_state[2 * n + j] + by_in[n + j]));
        float fresh = rational_tanh(by_in[2 * n + j] + reset * by_state[j]);
        next[j] = fresh + update * (last[j] - fresh);
    }
}

/* The first two columns of the rotation of a quaternion w x y z, (N1). */
void mobnet_first_columns(const double *quaternion, double *rotation) {
    double w = quaternion[0], x = quaternion[1], y = quaternion[2], z = quaternion[3];
    double columns[6] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
                         2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
    memcpy(rotation, columns, sizeof columns);
}

/* An input in float32, as networks see it. */
static float seen(const struct mobnet *m, struct input input, const mobnet_sample *sample) {
    const struct robot *robot = &m->robot;
    switch (input.source) {
    case FROM_Q:
        return (float)sample->q[robot->nq - robot->nu + input.place];
    case FROM_V:
        return (float)sample->v[robot->nv - robot->nu + input.place];
    case FROM_TORQUE:
        return (float)sample->tau_des[input.place];
    case FROM_ROTATION:
        return (float)m->rotation[input.place];
    case FROM_OMEGA:
        return (float)sample->v[3 + input.place];
    default:
        return (float)sample->acc[input.place];
    }
}

void mobnet_predict(const struct mobnet *m, const struct network *net, const mobnet_sample *sample,
                    const struct tick *last, struct tick *next) {
    size_t n = net->hidden, joints = net->joints;
    for (size_t i = 0; i < net->inputs; i++)
        net->scaled[i] = (seen(m, net->input[i], sample) - net->input_mean[i]) / net->input_std[i];
    multiply(mobnet_padded(3 * n), n, net->w_state, net->b_state, last->hidden + net->first, net->by_state);
    multiply(mobnet_padded(3 * n), net->inputs, net->w_in, net->b_in, net->scaled, net->by_in);
    open_gates(n, net->by_state, net->by_in, last->hidden + net->first, next->hidden + net->first);
    multiply(mobnet_padded(2 * joints), n, net->w_out, net->b_out, next->hidden + net->first, net->output);
    for (size_t k = 0; k < joints; k++) {
        float raw = net->output[joints + k];
        /* (N10), the softplus in a form that does not overflow, and (N11). */
        float soft = (raw > 0.0f ? raw : 0.0f) + logf(1.0f + expf(-fabsf(raw)));
        size_t joint = net->joint[k];
        next->mean[joint] = net->output[k] * net->target_std[k] + net->target_mean[k];
        next->std[joint] = (soft < net->std_min ? net->std_min : soft) * net->std_unit[k];
        /* (O9) of docs/notes/observer.md, from (15). */
        next->tau_ext[joint] = net->direct ? next->mean[joint] : next->residual[joint] - next->mean[joint];
    }
}
