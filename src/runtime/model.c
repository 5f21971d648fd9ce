/* The model file (docs/runtime.md): every byte of it is checked before anything runs.
 *
 * Each part is read by one function, which asks the arena for room and fills it. Where the arena only counts, there is
 * no room: the same function then checks and counts.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "internal.h"

enum { VERSION = 1, HEADER = 64, ENTRY = 32, ALIGNED = 64, CHECKED = 12 /* bytes in front of what the checksum covers */ };
enum { ROBOT = 1, JOINTS, COLUMNS, OBSERVER, NETWORK, DETECTOR };
enum { MOST_PARTS = 64, MOST_UNITS = 8192, MOST_SAMPLES = 10000, MOST_PHASES = 100 };
static const double LARGEST = 1e9, SMALLEST = 1e-12;

/* What is left of a section. */
struct cursor {
    const unsigned char *at;
    size_t left;
    int fault; /* whether something was not there or is not accepted */
};

static const void *bytes(struct cursor *c, size_t count) {
    const unsigned char *found = c->at;
    if (c->left < count) {
        c->fault = 1;
        return NULL;
    }
    c->at += count;
    c->left -= count;
    return found;
}

/* Copy bytes; zeros where there are none left. */
static void copy(struct cursor *c, void *to, size_t count) {
    const void *from = bytes(c, count);
    if (from)
        memcpy(to, from, count);
    else
        memset(to, 0, count);
}

static uint32_t whole(struct cursor *c, uint32_t least, uint32_t most) {
    uint32_t value;
    copy(c, &value, sizeof value);
    if (value < least || value > most) {
        c->fault = 1;
        return least;
    }
    return value;
}

static void need(struct cursor *c, int good) {
    if (!good)
        c->fault = 1;
}

/* Read doubles between bounds; `to` may be NULL. */
static void doubles(struct cursor *c, size_t count, double low, double high, double *to) {
    for (size_t i = 0; i < count && !c->fault; i++) {
        double value;
        copy(c, &value, sizeof value);
        need(c, value >= low && value <= high);
        if (to)
            to[i] = value;
    }
}

static void floats(struct cursor *c, size_t count, float low, float *to) {
    for (size_t i = 0; i < count && !c->fault; i++) {
        float value;
        copy(c, &value, sizeof value);
        need(c, value >= low && value <= FLT_MAX);
        if (to)
            to[i] = value;
    }
}

static void name(struct cursor *c, char *to) {
    char text[NAME];
    copy(c, text, NAME);
    need(c, text[0] && !text[NAME - 1]);
    if (to)
        memcpy(to, text, NAME);
}

static int within(const void *values, size_t count) {
    double value;
    for (size_t i = 0; i < count; i++) {
        memcpy(&value, (const char *)values + i * sizeof value, sizeof value);
        if (!(fabs(value) <= LARGEST))
            return 0;
    }
    return 1;
}

static void read_robot(struct mobnet *m, struct arena *arena, struct cursor *c) {
    struct robot *robot = &m->robot;
    robot->floating = (int)whole(c, 0, 1);
    robot->links = whole(c, 2, MOST_LINKS);
    robot->feet = whole(c, 0, 2);
    whole(c, 0, 0);
    doubles(c, 3, -LARGEST, LARGEST, robot->gravity);
    robot->nu = robot->links - 1;
    robot->nq = robot->nu + (robot->floating ? BASE_Q : 0);
    robot->nv = robot->nu + (robot->floating ? BASE_V : 0);
    robot->link = take(arena, robot->links, sizeof *robot->link);
    robot->moving = take(arena, robot->links, sizeof *robot->moving);
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
    m->joint = take(arena, m->robot.nv, NAME);
    for (size_t k = 0; k < m->robot.nv; k++)
        name(c, m->joint ? m->joint[k] : NULL);
}

static void read_columns(struct mobnet *m, struct arena *arena, struct cursor *c) {
    const struct robot *robot = &m->robot;
    m->columns = robot->nq + robot->nv + 2 * robot->nu + (robot->floating ? 3 : 0) + 2 * robot->feet;
    m->column = take(arena, m->columns, sizeof *m->column);
    for (size_t k = 0; k < m->columns && !c->fault; k++) {
        struct column column;
        name(c, column.name);
        doubles(c, 1, -LARGEST, LARGEST, &column.low);
        doubles(c, 1, column.low, LARGEST, &column.high);
        if (m->column)
            m->column[k] = column;
    }
}

static void read_observer(struct mobnet *m, struct cursor *c) {
    doubles(c, 1, 0.0, 1.0, &m->observer.pole);
    doubles(c, 1, SMALLEST, LARGEST, &m->observer.rate_hz);
    m->observer.sampled = (int)whole(c, 0, 1);
    whole(c, 0, 0);
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
    float *to = take(arena, padded(rows) * columns, sizeof *to);
    struct cursor before = *c;
    floats(c, rows * columns, -FLT_MAX, NULL);
    if (to && !c->fault)
        lay_out(rows, columns, before.at, to);
    return to;
}

static void read_weights(struct network *net, struct arena *arena, struct cursor *c) {
    size_t n = net->hidden, sums = padded(3 * n), outputs = padded(2 * net->joints);
    net->w_in = blocks(arena, c, 3 * n, net->inputs);
    net->w_state = blocks(arena, c, 3 * n, n);
    net->b_state = take(arena, sums, sizeof(float));
    net->b_in = take(arena, sums, sizeof(float));
    floats(c, 3 * n, -FLT_MAX, net->b_state);
    floats(c, n, -FLT_MAX, net->b_in ? net->b_in + 2 * n : NULL);
    net->w_out = blocks(arena, c, 2 * net->joints, n);
    net->b_out = take(arena, outputs, sizeof(float));
    floats(c, 2 * net->joints, -FLT_MAX, net->b_out);
    net->by_state = take(arena, sums, sizeof(float));
    net->by_in = take(arena, sums, sizeof(float));
    net->output = take(arena, outputs, sizeof(float));
}

static float *scores(struct arena *arena, struct cursor *c, size_t count, float low) {
    float *to = take(arena, count, sizeof *to);
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
    net->input = take(arena, net->inputs, sizeof *net->input);
    read_inputs(m, net, c);
    net->joint = take(arena, net->joints, sizeof *net->joint);
    for (size_t i = 0; i < net->joints && !c->fault; i++) {
        uint32_t joint = whole(c, 0, (uint32_t)m->robot.nv - 1);
        need(c, !m->predicted[joint]);
        m->predicted[joint] = 1;
        if (net->joint)
            net->joint[i] = joint;
    }
    net->scaled = take(arena, net->inputs, sizeof(float));
    net->input_mean = scores(arena, c, net->inputs, -FLT_MAX);
    net->input_std = scores(arena, c, net->inputs, FLT_MIN);
    net->target_mean = scores(arena, c, net->joints, -FLT_MAX);
    net->target_std = scores(arena, c, net->joints, FLT_MIN);
    /* Detectors divide by standard deviations: the smallest one must not vanish. */
    net->std_unit = scores(arena, c, net->joints, FLT_MIN / (net->std_min < 1.0f ? net->std_min : 1.0f));
    read_weights(net, arena, c);
    net->first = m->hidden;
    m->hidden += padded(net->hidden);
}

static void read_sole(struct mobnet *m, struct sole *sole, struct cursor *c) {
    copy(c, &sole->link, sizeof sole->link);
    need(c, sole->link >= 0 && sole->link < (int64_t)m->robot.links);
    doubles(c, 3, -LARGEST, LARGEST, sole->origin);
    doubles(c, 3 * CORNERS, -LARGEST, LARGEST, &sole->corner[0][0]);
}

static void read_gate(struct mobnet *m, struct detector *d, struct cursor *c) {
    struct gate *gate = &d->gate;
    need(c, m->robot.floating && d->foot < m->robot.feet);
    copy(c, gate, sizeof *gate);
    double numbers[] = {gate->landing, gate->near, gate->low, gate->force, gate->upright};
    need(c, gate->period >= SMALLEST && gate->period <= LARGEST && within(numbers, 5));
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
    d->joint = take(arena, d->joints, sizeof *d->joint);
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
    doubles(c, 1, 0.0, 1.0, &d->pole);
    d->signals = d->kinds * d->joints;
    d->threshold = take(arena, d->phases * d->signals, sizeof(double));
    doubles(c, d->phases * d->signals, SMALLEST, LARGEST, d->threshold);
    if (d->gated)
        read_gate(m, d, c);
    read_watched(m, d, arena, c);
    d->signal = take(arena, d->signals, sizeof(double));
    d->low = take(arena, d->signals, sizeof(double));
    d->held = take(arena, d->hold * d->signals, sizeof(double));
}

/* CRC-32 as zlib has it, four bits at a time. */
static uint32_t checksum(const unsigned char *from, size_t count) {
    uint32_t table[16], sum = 0xFFFFFFFFu;
    for (uint32_t i = 0; i < 16; i++) {
        table[i] = i;
        for (int bit = 0; bit < 4; bit++)
            table[i] = table[i] & 1 ? table[i] >> 1 ^ 0xEDB88320u : table[i] >> 1;
    }
    for (size_t i = 0; i < count; i++) {
        sum ^= from[i];
        sum = sum >> 4 ^ table[sum & 15];
        sum = sum >> 4 ^ table[sum & 15];
    }
    return ~sum;
}

static mobnet_status check_header(const unsigned char *model, size_t size, uint32_t *sections) {
    uint32_t sum, version;
    uint64_t told;
    if (size < HEADER)
        return MOBNET_TRUNCATED;
    if (memcmp(model, "MOBNETRT", 8) != 0)
        return MOBNET_MAGIC;
    memcpy(&sum, model + 8, sizeof sum);
    memcpy(&version, model + CHECKED, sizeof version);
    memcpy(&told, model + 16, sizeof told);
    memcpy(sections, model + 24, sizeof *sections);
    if (version != VERSION)
        return MOBNET_VERSION;
    if (told != size)
        return MOBNET_TRUNCATED;
    if (sum != checksum(model + CHECKED, size - CHECKED))
        return MOBNET_CHECKSUM;
    if (*sections < OBSERVER || *sections > OBSERVER + 2 * MOST_PARTS || HEADER + *sections * ENTRY > size)
        return MOBNET_SECTION;
    return MOBNET_OK;
}

/* Return the kind of a section and set the cursor to its bytes; 0 where it does not lie in the file behind the one before,
 * which ends at `*end`. */
static uint32_t find(const unsigned char *model, size_t size, uint32_t number, size_t *end, struct cursor *c) {
    const unsigned char *entry = model + HEADER + number * ENTRY;
    uint64_t offset, length;
    uint32_t kind;
    memcpy(&kind, entry, sizeof kind);
    memcpy(&offset, entry + 8, sizeof offset);
    memcpy(&length, entry + 16, sizeof length);
    if (offset % ALIGNED || offset < *end || offset > size || length > size - offset)
        return 0;
    c->at = model + offset;
    c->left = (size_t)length;
    c->fault = 0;
    *end = (size_t)(offset + length);
    return kind;
}

static mobnet_status count_parts(struct mobnet *m, const unsigned char *model, size_t size, uint32_t sections) {
    size_t end = HEADER + sections * ENTRY;
    for (uint32_t k = 0; k < sections; k++) {
        struct cursor c;
        uint32_t kind = find(model, size, k, &end, &c);
        /* One section of each of the first kinds, then networks, then detectors. */
        if (k < OBSERVER ? kind != k + 1 : kind < (m->detectors ? DETECTOR : NETWORK) || kind > DETECTOR)
            return MOBNET_SECTION;
        m->networks += kind == NETWORK;
        m->detectors += kind == DETECTOR;
    }
    return m->networks > MOST_PARTS || m->detectors > MOST_PARTS ? MOBNET_SECTION : MOBNET_OK;
}

static void read_section(struct mobnet *m, struct arena *arena, uint32_t kind, uint32_t number, struct cursor *c) {
    if (kind == ROBOT)
        read_robot(m, arena, c);
    else if (kind == JOINTS)
        read_joints(m, arena, c);
    else if (kind == COLUMNS)
        read_columns(m, arena, c);
    else if (kind == OBSERVER)
        read_observer(m, c);
    else if (kind == NETWORK)
        read_network(m, number - OBSERVER, arena, c);
    else
        read_detector(m, number - OBSERVER - m->networks, arena, c);
}

static void take_ticks(struct mobnet *m, struct arena *arena) {
    for (int i = 0; i < 2; i++) {
        struct tick *tick = &m->tick[i];
        double **numbers[] = {&tick->momentum, &tick->beta, &tick->residual, &tick->torque, &tick->tau_ext};
        for (int k = 0; k < 5; k++)
            *numbers[k] = take(arena, m->robot.nv, sizeof(double));
        tick->mean = take(arena, m->robot.nv, sizeof(float));
        tick->std = take(arena, m->robot.nv, sizeof(float));
        tick->hidden = take(arena, m->hidden, sizeof(float));
    }
}

mobnet_status read_model(struct mobnet *m, struct arena *arena, const void *model, size_t size) {
    uint32_t sections = 0;
    mobnet_status status = check_header(model, size, &sections);
    if (status == MOBNET_OK)
        status = count_parts(m, model, size, sections);
    if (status != MOBNET_OK)
        return status;
    size_t end = HEADER + sections * ENTRY;
    m->network = take(arena, m->networks, sizeof *m->network);
    m->detector = take(arena, m->detectors, sizeof *m->detector);
    m->alarm = take(arena, m->detectors, sizeof *m->alarm);
    for (uint32_t k = 0; k < sections; k++) {
        struct cursor c;
        read_section(m, arena, find(model, size, k, &end, &c), k, &c);
        if (c.fault)
            return MOBNET_VALUE;
        if (c.left)
            return MOBNET_SECTION;
    }
    take_ticks(m, arena);
    return MOBNET_OK;
}
