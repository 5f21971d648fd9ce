/* Try to break the library: `fuzz samples MODEL COUNT SEED` steps through random samples, a quarter of them with
 * numbers that are not finite, huge or out of bounds. `fuzz models MODEL COUNT SEED` reads damaged copies of a model
 * file, their checksum made right again, and steps through those that are accepted. Built with the compiler's checks
 * (Makefile), it ends at the first wrong access; it returns 1 where a state is not finite.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "files.h"
#include "internal.h"

enum { STEPS = 20, CHANGES = 4, HEADER = 64, CHECKED = 12 };
static uint64_t seed;

/* A random number (xorshift, Marsaglia 2003). */
static uint64_t draw(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return seed;
}

static double uniform(double low, double high) {
    return low + (high - low) * (double)(draw() >> 11) / 9007199254740992.0;
}

/* A number that a careless reader would not expect. */
static double odd(void) {
    const double some[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e30, -1e12, 5e-324, -0.0, 1e6};
    uint64_t bits = draw();
    double any;
    memcpy(&any, &bits, sizeof any);
    return bits % 2 ? any : some[draw() % (sizeof some / sizeof *some)];
}

static void fill(const mobnet *m, double *numbers) {
    double norm = 0.0;
    for (size_t k = 0; k < m->columns; k++)
        numbers[k] = uniform(m->column[k].low, m->column[k].high);
    if (m->robot.floating) {
        for (size_t k = 3; k < BASE_Q; k++)
            norm += numbers[k] * numbers[k];
        for (size_t k = 3; k < BASE_Q; k++)
            numbers[k] /= sqrt(norm);
    }
    for (size_t k = m->columns - 2 * m->robot.feet; k < m->columns - m->robot.feet; k++)
        numbers[k] = draw() % 16 > 0;
    if (draw() % 4 == 0)
        for (uint64_t left = 1 + draw() % 3; left > 0; left--)
            numbers[draw() % m->columns] = odd();
}

static int are_all_finite(const mobnet *m) {
    const struct tick *tick = &m->tick[m->now];
    double sum = 0.0;
    for (size_t k = 0; k < m->robot.nv; k++)
        sum += 0.0 * (tick->momentum[k] + tick->beta[k] + tick->residual[k] + tick->torque[k] + tick->tau_ext[k]) +
               0.0 * (double)(tick->mean[k] + tick->std[k]);
    for (size_t k = 0; k < m->hidden; k++)
        sum += 0.0 * (double)tick->hidden[k];
    for (size_t k = 0; k < m->detectors; k++) {
        const struct detector *d = &m->detector[k];
        sum += 0.0 * (m->alarm[k].ratio + d->state.phase);
        for (size_t i = 0; i < d->signals; i++)
            sum += 0.0 * d->low[i];
        for (size_t i = 0; i < d->hold * d->signals; i++)
            sum += 0.0 * d->held[i];
    }
    return sum == 0.0;
}

/* Step through random samples; return how many were accepted, or -1 once a state is not finite. */
static long step(mobnet *m, unsigned long count) {
    mobnet_sizes sizes = mobnet_sizes_of(m);
    double *numbers = malloc(sizes.columns * sizeof *numbers);
    mobnet_sample sample = sample_of(&sizes, numbers);
    mobnet_result result;
    long accepted = 0;
    for (unsigned long k = 0; numbers && k < count && accepted >= 0; k++) {
        fill(m, numbers);
        accepted += mobnet_step(m, &sample, &result) == MOBNET_OK;
        if (draw() % 1000 == 0)
            mobnet_reset(m);
        if (!are_all_finite(m))
            accepted = -1;
    }
    free(numbers);
    return accepted;
}

static uint32_t checksum(const unsigned char *from, size_t count) {
    uint32_t sum = 0xFFFFFFFFu;
    for (size_t i = 0; i < count; i++) {
        sum ^= from[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum & 1 ? sum >> 1 ^ 0xEDB88320u : sum >> 1;
    }
    return ~sum;
}

/* Change some bytes, most of them near the beginning, where the sizes stand. */
static void damage(unsigned char *model, size_t size) {
    for (uint64_t left = 1 + draw() % CHANGES; left > 0; left--) {
        size_t place = HEADER / 4 + (size_t)(draw() % (draw() % 2 ? size - HEADER / 4 : 600));
        model[place] = draw() % 3 ? (unsigned char)draw() : draw() % 2 ? 0xFF : 0;
    }
    uint32_t sum = checksum(model + CHECKED, size - CHECKED);
    memcpy(model + 8, &sum, sizeof sum);
}

/* Read damaged models; return how many were accepted, or -1 where the state of one is not finite. */
static long read_damaged(const char *path, unsigned long count) {
    size_t size, needed;
    unsigned char *model = read_file(path, &size), *copy = malloc(size);
    long accepted = 0;
    for (unsigned long k = 0; model && copy && k < count && accepted >= 0; k++) {
        mobnet *handle = NULL;
        memcpy(copy, model, size);
        damage(copy, size);
        if (mobnet_size(copy, size, &needed) != MOBNET_OK)
            continue;
        void *memory = malloc(needed);
        if (memory && mobnet_init(memory, needed, copy, size, &handle) == MOBNET_OK)
            accepted += step(handle, STEPS) < 0 ? -(long)count : 1;
        free(memory);
    }
    free(model);
    free(copy);
    return accepted;
}

int main(int count, char **words) {
    void *memory = NULL;
    if (count != 5)
        return 2;
    unsigned long times = strtoul(words[3], NULL, 10);
    seed = 0x9E3779B97F4A7C15u + strtoul(words[4], NULL, 10);
    long accepted = -1;
    if (strcmp(words[1], "samples") == 0) {
        mobnet *model = load(words[2], &memory);
        accepted = model ? step(model, times) : -1;
        free(memory);
    } else if (strcmp(words[1], "models") == 0) {
        accepted = read_damaged(words[2], times);
    }
    printf("%ld\n", accepted);
    return accepted < 0;
}
