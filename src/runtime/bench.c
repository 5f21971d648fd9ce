/* The time of a tick at a paced 1 kHz, beside that of reading as many bytes as the model's weights have once.
 *
 * `bench MODEL TICKS` prints median, 99th percentile and largest of a tick [us], and the ticks above 1 ms; median and
 * 99th percentile of a read [us]; the median over all turns of a read's share in a tick; the bytes of the weights; and
 * how often memory was asked for or given back meanwhile.
 *
 * Joints move smoothly about the middle of their ranges; a foot is always in the air and near its landing, so that the
 * gate looks for the ground at every tick. Ticks and reads take turns of half a second in one paced loop, so that both
 * find the same machine, and caches in which others may have written since the last one, but not each other.
 */
#define _POSIX_C_SOURCE 200112L
#include <math.h>
#include <string.h>
#include <time.h>

#include "files.h"
#include "internal.h"

enum { NUMBERS = 4096, TURN = 500, SETTLE = 50 }; /* numbers of a sample; ticks of a turn, and before they count */
static const double PERIOD_S = 1e-3;
static unsigned long calls; /* of malloc, calloc, realloc and free, which the linker leads here */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void __real_free(void *old);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void __wrap_free(void *old);

void *__wrap_malloc(size_t size) {
    calls++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size) {
    calls++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size) {
    calls++;
    return __real_realloc(old, size);
}

void __wrap_free(void *old) {
    calls++;
    __real_free(old);
}

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void wait_until(double time_s) {
    struct timespec until;
    until.tv_sec = (time_t)time_s;
    until.tv_nsec = (long)((time_s - (double)until.tv_sec) * 1e9);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
}

static void move(const mobnet_sizes *sizes, double time_s, double *numbers) {
    size_t base = sizes->nq - sizes->nu, torques = sizes->nq + sizes->nv;
    for (size_t k = 0; k < sizes->columns; k++) {
        double size = k < sizes->nq ? 0.2 : k < torques ? 0.5 : 5.0;
        numbers[k] = k < base ? k == 3 : size * sin(time_s * (1.0 + 0.1 * (double)k));
    }
    double *feet = numbers + sizes->columns - 2 * sizes->feet;
    for (size_t k = 0; k < sizes->feet; k++) {
        feet[k] = 1.0;
        feet[sizes->feet + k] = 0.1;
    }
}

static int rising(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t weights_of(const mobnet *m) {
    size_t count = 0;
    for (size_t k = 0; k < m->networks; k++) {
        const struct network *net = &m->network[k];
        count += 3 * net->hidden * (net->inputs + net->hidden) + 4 * net->hidden;
        count += 2 * net->joints * (net->hidden + 1);
    }
    return count;
}

/* Add numbers up side by side, as the library does: nothing is left of a tick but reading. */
static float read_once(const float *numbers, size_t count) {
    float sums[ROWS] = {0}, sum = 0.0f;
    for (size_t j = 0; j < count; j += ROWS)
        for (size_t i = 0; i < ROWS; i++)
            sums[i] += numbers[j + i];
    for (size_t i = 0; i < ROWS; i++)
        sum += sums[i];
    return sum;
}

struct loop {
    mobnet *model;
    mobnet_sizes sizes;
    float *weights; /* of the reads; a multiple of ROWS */
    size_t count;
    volatile float sum; /* so that no compiler leaves a read out */
    double started;     /* [s] */
    size_t ticks;       /* since then */
};

/* Take a turn of so many ticks, or reads, after some that do not count; return 0 where a sample is not accepted. */
static int take_turn(struct loop *loop, int reading, size_t count, double *times) {
    static double numbers[NUMBERS];
    mobnet_sample sample = sample_of(&loop->sizes, numbers);
    mobnet_result result;
    mobnet_status status = MOBNET_OK;
    for (size_t k = 0; k < SETTLE + count && status == MOBNET_OK; k++) {
        double due = (double)++loop->ticks * PERIOD_S;
        move(&loop->sizes, due, numbers);
        wait_until(loop->started + due);
        double begun = seconds();
        if (reading)
            loop->sum = read_once(loop->weights, loop->count);
        else
            status = mobnet_step(loop->model, &sample, &result);
        if (k >= SETTLE)
            times[k - SETTLE] = seconds() - begun;
    }
    if (status != MOBNET_OK)
        fprintf(stderr, "%s: %s\n", mobnet_text(status), mobnet_column_name(loop->model, result.fault));
    return status == MOBNET_OK;
}

static void sort(double *values, size_t count) {
    qsort(values, count, sizeof *values, rising);
}

static int run(struct loop *loop, size_t ticks, double *steps, double *reads, double *shares) {
    size_t turns = 0;
    unsigned long before = calls, asked = 0, late = 0;
    loop->started = seconds();
    for (size_t done = 0; done < ticks; done += TURN, turns++) {
        size_t count = ticks - done < TURN ? ticks - done : TURN;
        if (!take_turn(loop, 0, count, steps + done) || !take_turn(loop, 1, count, reads + done))
            return 1;
        asked += calls - before;
        sort(steps + done, count); /* which may ask for memory */
        sort(reads + done, count);
        shares[turns] = reads[done + count / 2] / steps[done + count / 2];
        before = calls;
    }
    for (size_t k = 0; k < ticks; k++)
        late += steps[k] > PERIOD_S;
    sort(steps, ticks);
    sort(reads, ticks);
    sort(shares, turns);
    printf("%.3f %.3f %.3f %lu ", 1e6 * steps[ticks / 2], 1e6 * steps[ticks * 99 / 100], 1e6 * steps[ticks - 1], late);
    printf("%.3f %.3f %.4f ", 1e6 * reads[ticks / 2], 1e6 * reads[ticks * 99 / 100], shares[turns / 2]);
    printf("%lu %lu\n", (unsigned long)(weights_of(loop->model) * sizeof(float)), asked);
    return 0;
}

int main(int count, char **words) {
    size_t ticks = count == 3 ? (size_t)strtoul(words[2], NULL, 10) : 0;
    void *memory = NULL;
    struct loop loop = {0};
    if (!ticks) {
        fprintf(stderr, "usage: %s MODEL TICKS\n", words[0]);
        return 2;
    }
    loop.model = load(words[1], &memory);
    if (!loop.model)
        return 1;
    loop.sizes = mobnet_sizes_of(loop.model);
    loop.count = mobnet_padded(weights_of(loop.model));
    loop.weights = malloc((loop.count + 1) * sizeof *loop.weights);
    double *times = malloc(3 * ticks * sizeof *times);
    for (size_t k = 0; loop.weights && k < loop.count; k++)
        loop.weights[k] = 1.0f; /* memory in which nothing was written is one page for all addresses */
    int status = loop.weights && times ? run(&loop, ticks, times, times + ticks, times + 2 * ticks) : 1;
    free(times);
    free(loop.weights);
    free(memory);
    return status;
}
