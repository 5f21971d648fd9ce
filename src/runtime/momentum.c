/* p = M v of (4) and beta = C^T v - g of (6) in one sweep out along the tree and one back.
 *
 * (a) to (d) are derived in src/mobnet/kernel/momentum.py. Every sum stands here in the same order as there, so that
 * both give the same bits where sine and cosine do.
 */
#include <math.h>

#include "internal.h"
#include "triples.h"

static void turn_base(const double *q, double rotation[3][3]) {
    double w = q[3], x = q[4], y = q[5], z = q[6];
    double s = 2.0 / (w * w + x * x + y * y + z * z);
    triple rows[3] = {{1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                      {s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)},
                      {s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)}};
    for (int i = 0; i < 3; i++)
        put(rotation[i], rows[i]);
}

/* Set momentum and first moment of the link alone. */
static void carry(struct link *link, struct moving *own) {
    triple velocity = vector(own->velocity), omega = vector(own->omega), moment = vector(link->moment);
    put(own->momentum, add(times(link->mass, velocity), cross(omega, moment)));
    put(own->spin, add(product(link->inertia, omega), cross(moment, velocity)));
    put(own->moment, moment);
}

static void start(const struct robot *robot, struct moving *base, const double *q, const double *v) {
    triple gravity = vector(robot->gravity), still = {0.0, 0.0, 0.0};
    put(base->velocity, still);
    put(base->omega, still);
    put(base->gravity, gravity);
    if (robot->floating) {
        turn_base(q, base->rotation);
        put(base->velocity, transposed(base->rotation, vector(v)));
        put(base->omega, vector(v + 3));
        put(base->gravity, transposed(base->rotation, gravity));
    }
    carry(robot->link, base);
}

static void go_out(struct link *link, struct moving *own, struct moving *parent, double q, double v) {
    double cosine = cos(q), sine = sin(q);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            own->rotation[i][j] = link->still[i][j] + (cosine * link->cosine[i][j] + sine * link->sine[i][j]);
    triple omega = vector(parent->omega);
    triple here = add(vector(parent->velocity), cross(omega, vector(link->offset)));
    put(own->velocity, transposed(own->rotation, here));
    put(own->omega, add(transposed(own->rotation, omega), times(v, vector(link->axis))));
    put(own->gravity, transposed(own->rotation, vector(parent->gravity)));
    carry(link, own);
}

/* h x v + n x w + s x g of (d). */
static triple rate(const struct moving *own) {
    triple moving = cross(vector(own->momentum), vector(own->velocity));
    triple turning = cross(vector(own->spin), vector(own->omega));
    return add(add(moving, turning), cross(vector(own->moment), vector(own->gravity)));
}

/* Add a subtree's momentum and first moment to its parent's. */
static void go_back(struct link *link, struct moving *own, struct moving *parent) {
    triple offset = vector(link->offset);
    triple momentum = product(own->rotation, vector(own->momentum));
    triple spin = add(product(own->rotation, vector(own->spin)), cross(offset, momentum));
    triple moment = add(product(own->rotation, vector(own->moment)), times(link->behind, offset));
    put(parent->momentum, add(vector(parent->momentum), momentum));
    put(parent->spin, add(vector(parent->spin), spin));
    put(parent->moment, add(vector(parent->moment), moment));
}

static void tell_base(const struct robot *robot, double *p, double *beta) {
    struct moving *base = robot->moving;
    put(p, product(base->rotation, vector(base->momentum)));
    put(p + 3, vector(base->spin));
    put(beta, times(robot->link->behind, vector(robot->gravity)));
    put(beta + 3, rate(base));
}

void mobnet_momentum(const struct robot *robot, const double *q, const double *v, double *p, double *beta) {
    struct link *link = robot->link;
    struct moving *moving = robot->moving;
    size_t q_joints = robot->nq - robot->nu, v_joints = robot->nv - robot->nu;
    start(robot, moving, q, v);
    for (size_t k = 1; k < robot->links; k++)
        go_out(&link[k], &moving[k], &moving[link[k].parent], q[q_joints + k - 1], v[v_joints + k - 1]);
    for (size_t k = robot->links - 1; k > 0; k--) {
        size_t joint = v_joints + k - 1;
        triple axis = vector(link[k].axis);
        p[joint] = dot(axis, vector(moving[k].spin)) + link[k].armature * v[joint];
        beta[joint] = dot(axis, rate(&moving[k]));
        go_back(&link[k], &moving[k], &moving[link[k].parent]);
    }
    if (robot->floating)
        tell_base(robot, p, beta);
}
