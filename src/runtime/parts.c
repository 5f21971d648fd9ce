/* The sections of the model file (docs/runtime.md). Each is read by one function, which asks the arena for room and
 * fills it. Where the arena only counts there is no room: the same function then checks and counts.
 */
#include "cursor.h"

enum { MOST_UNITS = 8192, MOST_SAMPLES = 10000, MOST_PHASES = 100 };

/* These are read at once, as they stand in the file. */
typedef char link_is_as_in_the_file[sizeof(struct link) == 392 ? 1 : -1];
typedef char drive_is_as_in_the_file[sizeof(struct drive) == 56 ? 1 : -1];
typedef char gate_is_as_in_the_file[sizeof(struct gate) == 64 ? 1 : -1];

static void read_robot(struct mobnet *m, struct arena *arena, struct cursor *c) {
    struct robot *robot = &m->robot;
    robot->floating = (int)whole(c, 0, 1);
    robot->links = whole(c, 2, MOST_LINKS);
    robot->feet = whole(c, 0, 2);
    whole(c, 0, 0);
    doubles(c, 3, -MOST, MOST, robot->gravity);
    robot->nu = robot->links - 1;
    robot->nq = robot->nu + (robot->floating ? BASE_Q : 0);
    robot->nv = robot->nu + (robot->floating ? BASE_V : 0);
    robot->link = mobnet_take(arena, robot->links, sizeof *robot->link);
    robot->moving = mobnet_take(arena, robot->links, sizeof *robot->moving);
    for (size_t k = 0; k < robot->links && !c->fault; k++) {
        struct link link;
        copy(c, &link, sizeof link);
        /* A parent stands before its links, so that the sweeps end and never leave the tree. */
        need(c, link.parent >= 0 && (link.parent < (int64_t)k || k == 0));
        need(c, within((const char *)&link + sizeof link.parent, sizeof link / sizeof(double) - 1));
        if (robot->link)
            robot->link[k] = link;
    }
}

static void read_joints(struct mobnet *m, struct arena *arena, struct cursor *c) {
    m->joint = mobnet_take(arena, m->robot.nv, NAME);
    for (size_t k = 0; k < m->robot.nv; k++)
        name(c, m->joint ? m->joint[k] : NULL);
}

static void read_columns(struct mobnet *m, struct arena *arena, struct cursor *c) {
    const struct robot *robot = &m->robot;
    m->columns = robot->nq + robot->nv + 2 * robot->nu + (robot->floating ? 3 : 0) + 2 * robot->feet;
    m->column = mobnet_take(arena, m->columns, sizeof *m->column);
    for (size_t k = 0; k < m->columns && !c->fault; k++) {
        struct column column = {"", 0.0, 0.0};
        name(c, column.name);
        doubles(c, 1, -MOST, MOST, &column.low);
        doubles(c, 1, column.low, MOST, &column.high);
        if (m->column)
            m->column[k] = column;
    }
}

static void read_observer(struct mobnet *m, struct cursor *c) {
    doubles(c, 1, 0.0, 1.0, &m->observer.pole);
    doubles(c, 1, LEAST, MOST, &m->observer.rate_hz);
    m->observer.sampled = (int)whole(c, 0, 1);
    whole(c, 0, 0);
}

static void read_drives(struct mobnet *m, struct arena *arena, struct cursor *c) {
    m->observer.drive = mobnet_take(arena, m->robot.nu, sizeof *m->observer.drive);
    for (size_t k = 0; k < m->robot.nu && !c->fault; k++) {
        struct drive drive = {0};
        copy(c, &drive, sizeof drive);
        need(c, within(&drive.coulomb, sizeof drive / sizeof(double)));
        need(c, drive.smoothing >= LEAST && (drive.breakaway == 0.0 || drive.breakaway >= LEAST));
        if (m->observer.drive)
            m->observer.drive[k] = drive;
    }
}

static void read_inputs(struct mobnet *m, struct network *net, struct cursor *c) {
    size_t most[SOURCES] = {m->robot.nu, m->robot.nu, m->robot.nu, 6, 3, 3};
    for (size_t i = 0; i < net->inputs && !c->fault; i++) {
        struct input input;
        copy(c, &input, sizeof input);
        need(c, input.source < SOURCES && input.place < most[input.source < SOURCES ? input.source : 0]);
        need(c, m->robot.floating || input.source < FROM_ROTATION);
        if (net->input)
            net->input[i] = input;
    }
}

/* Read a matrix (rows, columns) into blocks of rows. */
static float *blocks(struct arena *arena, struct cursor *c, size_t rows, size_t columns) {
    float *to = mobnet_take(arena, mobnet_padded(rows) * columns, sizeof *to);
    struct cursor before = *c;
    floats(c, rows * columns, -FLT_MAX, NULL);
    if (to && !c->fault)
        mobnet_lay_out(rows, columns, before.at, to);
    return to;
}

static void read_weights(struct network *net, struct arena *arena, struct cursor *c) {
    size_t n = net->hidden, sums = mobnet_padded(3 * n), outputs = mobnet_padded(2 * net->joints);
    net->w_in = blocks(arena, c, 3 * n, net->inputs);
    net->w_state = blocks(arena, c, 3 * n, n);
    net->b_state = mobnet_take(arena, sums, sizeof(float));
    net->b_in = mobnet_take(arena, sums, sizeof(float));
    floats(c, 3 * n, -FLT_MAX, net->b_state);
    floats(c, n, -FLT_MAX, net->b_in ? net->b_in + 2 * n : NULL);
    net->w_out = blocks(arena, c, 2 * net->joints, n);
    net->b_out = mobnet_take(arena, outputs, sizeof(float));
    floats(c, 2 * net->joints, -FLT_MAX, net->b_out);
    net->by_state = mobnet_take(arena, sums, sizeof(float));
    net->by_in = mobnet_take(arena, sums, sizeof(float));
    net->output = mobnet_take(arena, outputs, sizeof(float));
}

static float *scores(struct arena *arena, struct cursor *c, size_t count, float low) {
    float *to = mobnet_take(arena, count, sizeof *to);
    floats(c, count, low, to);
    return to;
}

static void read_network(struct mobnet *m, size_t k, struct arena *arena, struct cursor *c) {
    struct network local = {0}, *net = m->network ? &m->network[k] : &local;
    name(c, NULL); /* of the limb, for those who look at the file */
    net->inputs = whole(c, 0, MOST_UNITS);
    net->hidden = whole(c, 0, MOST_UNITS);
    net->joints = whole(c, 1, (uint32_t)m->robot.nv);
    net->direct = (int)whole(c, 0, 1);
    floats(c, 1, FLT_MIN, &net->std_min);
    net->input = mobnet_take(arena, net->inputs, sizeof *net->input);
    read_inputs(m, net, c);
    net->joint = mobnet_take(arena, net->joints, sizeof *net->joint);
    for (size_t i = 0; i < net->joints && !c->fault; i++) {
        uint32_t joint = whole(c, 0, (uint32_t)m->robot.nv - 1);
        need(c, !m->predicted[joint]);
        m->predicted[joint] = 1;
        if (net->joint)
            net->joint[i] = joint;
    }
    net->scaled = mobnet_take(arena, net->inputs, sizeof(float));
    net->input_mean = scores(arena, c, net->inputs, -FLT_MAX);
    net->input_std = scores(arena, c, net->inputs, FLT_MIN);
    net->target_mean = scores(arena, c, net->joints, -FLT_MAX);
    net->target_std = scores(arena, c, net->joints, FLT_MIN);
    /* Detectors divide by standard deviations: the smallest one must not vanish. */
    net->std_unit = scores(arena, c, net->joints, FLT_MIN / (net->std_min < 1.0f ? net->std_min : 1.0f));
    read_weights(net, arena, c);
    net->first = m->hidden;
    m->hidden += mobnet_padded(net->hidden);
}

static void read_sole(struct mobnet *m, struct sole *sole, struct cursor *c) {
    copy(c, &sole->link, sizeof sole->link);
    need(c, sole->link >= 0 && sole->link < (int64_t)m->robot.links);
    doubles(c, 3, -MOST, MOST, sole->origin);
    doubles(c, 3 * CORNERS, -MOST, MOST, &sole->corner[0][0]);
}

static void read_gate(struct mobnet *m, struct detector *d, struct cursor *c) {
    struct gate *gate = &d->gate;
    need(c, m->robot.floating && d->foot < m->robot.feet);
    copy(c, gate, sizeof *gate);
    double numbers[] = {gate->landing, gate->near, gate->low, gate->force, gate->upright};
    need(c, gate->period >= LEAST && gate->period <= MOST && within(numbers, 5));
    need(c, gate->lift_off >= 0 && gate->hold > 0);
    copy(c, &d->leg.first, sizeof d->leg.first);
    need(c, d->leg.first >= 0 && d->leg.first <= (int64_t)m->robot.nu - LEG_JOINTS);
    read_sole(m, &d->leg.foot, c);
    read_sole(m, &d->leg.other, c);
}

/* Read which joints are watched: of the residual, and where no network predicts, there is no standard deviation. */
static void read_watched(struct mobnet *m, struct detector *d, struct arena *arena, struct cursor *c) {
    int mean = 1;
    for (size_t i = 0; i < d->kinds; i++)
        mean &= d->kind[i] == 0;
    d->joint = mobnet_take(arena, d->joints, sizeof *d->joint);
    for (size_t i = 0; i < d->joints && !c->fault; i++) {
        uint32_t joint = whole(c, 0, (uint32_t)m->robot.nv - 1);
        need(c, mean || (m->predicted[joint] && !d->residual));
        if (d->joint)
            d->joint[i] = joint;
    }
}

static void read_detector(struct mobnet *m, size_t k, struct arena *arena, struct cursor *c) {
    struct detector local = {0}, *d = m->detector ? &m->detector[k] : &local;
    name(c, d->name);
    d->joints = whole(c, 1, (uint32_t)m->robot.nv);
    d->kinds = whole(c, 1, KINDS);
    for (size_t i = 0; i < KINDS; i++)
        d->kind[i] = whole(c, 0, KINDS - 1);
    d->phases = whole(c, 1, MOST_PHASES);
    d->hold = whole(c, 1, MOST_SAMPLES);
    d->gated = (int)whole(c, 0, 1);
    d->foot = whole(c, 0, 1);
    d->residual = (int)whole(c, 0, 1);
    d->settle = whole(c, 0, UINT32_MAX);
    whole(c, 0, 0);
    doubles(c, 1, 0.0, 1.0, &d->pole);
    d->signals = d->kinds * d->joints;
    d->threshold = mobnet_take(arena, d->phases * d->signals, sizeof(double));
    doubles(c, d->phases * d->signals, LEAST, MOST, d->threshold);
    if (d->gated)
        read_gate(m, d, c);
    read_watched(m, d, arena, c);
    d->signal = mobnet_take(arena, d->signals, sizeof(double));
    d->low = mobnet_take(arena, d->signals, sizeof(double));
    d->held = mobnet_take(arena, d->hold * d->signals, sizeof(double));
}

void mobnet_read_part(struct mobnet *m, struct arena *arena, uint32_t kind, uint32_t number, struct cursor *c) {
    if (kind == ROBOT)
        read_robot(m, arena, c);
    else if (kind == JOINTS)
        read_joints(m, arena, c);
    else if (kind == COLUMNS)
        read_columns(m, arena, c);
    else if (kind == OBSERVER)
        read_observer(m, c);
    else if (kind == DRIVES)
        read_drives(m, arena, c);
    else if (kind == NETWORK)
        read_network(m, number - OBSERVER - m->driven, arena, c);
    else
        read_detector(m, number - OBSERVER - m->driven - m->networks, arena, c);
}
