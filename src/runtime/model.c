/* The model file (docs/runtime.md): header, checksum and sections. Every byte of it is checked before anything runs. */
#include "cursor.h"

enum { VERSION = 1, HEADER = 64, ENTRY = 32, ALIGNED = 64, MOST_PARTS = 64 };
enum { CHECKED = 12 }; /* bytes in front of what the checksum covers */

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
    if (*sections < OBSERVER || *sections > OBSERVER + 1 + 2 * MOST_PARTS || HEADER + *sections * ENTRY > size)
        return MOBNET_SECTION;
    return MOBNET_OK;
}

/* Return the kind of a section and set the cursor to its bytes; 0 where it does not lie in the file, behind the one
 * before, which ends at `*end`. */
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
        /* One section of each of the first kinds, drives if there are any, then networks, then detectors. */
        if (k == OBSERVER && kind == DRIVES) {
            m->driven = 1;
            continue;
        }
        if (k < OBSERVER ? kind != k + 1 : kind < (m->detectors ? DETECTOR : NETWORK) || kind > DETECTOR)
            return MOBNET_SECTION;
        m->networks += kind == NETWORK;
        m->detectors += kind == DETECTOR;
    }
    return m->networks > MOST_PARTS || m->detectors > MOST_PARTS ? MOBNET_SECTION : MOBNET_OK;
}

static void take_ticks(struct mobnet *m, struct arena *arena) {
    for (int i = 0; i < 2; i++) {
        struct tick *tick = &m->tick[i];
        double **numbers[] = {&tick->momentum, &tick->beta, &tick->residual, &tick->torque, &tick->tau_ext};
        for (int k = 0; k < 5; k++)
            *numbers[k] = mobnet_take(arena, m->robot.nv, sizeof(double));
        tick->bend = m->driven ? mobnet_take(arena, m->robot.nu, sizeof(double)) : NULL;
        tick->friction = m->driven ? mobnet_take(arena, m->robot.nu, sizeof(double)) : NULL;
        tick->mean = mobnet_take(arena, m->robot.nv, sizeof(float));
        tick->std = mobnet_take(arena, m->robot.nv, sizeof(float));
        tick->hidden = mobnet_take(arena, m->hidden, sizeof(float));
    }
}

mobnet_status mobnet_read_model(struct mobnet *m, struct arena *arena, const void *model, size_t size) {
    uint32_t sections = 0;
    mobnet_status status = check_header(model, size, &sections);
    if (status == MOBNET_OK)
        status = count_parts(m, model, size, sections);
    if (status != MOBNET_OK)
        return status;
    size_t end = HEADER + sections * ENTRY;
    m->network = mobnet_take(arena, m->networks, sizeof *m->network);
    m->detector = mobnet_take(arena, m->detectors, sizeof *m->detector);
    m->alarm = mobnet_take(arena, m->detectors, sizeof *m->alarm);
    for (uint32_t k = 0; k < sections; k++) {
        struct cursor c;
        mobnet_read_part(m, arena, find(model, size, k, &end, &c), k, &c);
        if (c.fault)
            return MOBNET_VALUE;
        if (c.left)
            return MOBNET_SECTION;
    }
    take_ticks(m, arena);
    return MOBNET_OK;
}
