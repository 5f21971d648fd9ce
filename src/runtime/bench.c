/* The time of a tick at a paced 1 kHz: `bench MODEL TICKS` prints median, 99th percentile and largest [us], the ticks
 * above 1 ms, and how often memory was asked for or given back meanwhile.
 *
 * Joints move smoothly about the middle of their ranges; a foot is always in the air and near its landing, so that the
 * gate looks for the ground at every tick.
 */
#define _POSIX_C_SOURCE 200112L
#include <math.h>
#include <string.h>
#include <time.h>

#include "files.h"

enum { NUMBERS = 4096, WARM_UP = 500 };
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

static int run(mobnet *model, size_t ticks, double *times) {
    static double numbers[NUMBERS];
    mobnet_sizes sizes = mobnet_sizes_of(model);
    mobnet_sample sample = sample_of(&sizes, numbers);
    mobnet_result result;
    double started = seconds();
    unsigned long before = calls;
    for (size_t k = 0; k < WARM_UP + ticks; k++) {
        move(&sizes, (double)k * PERIOD_S, numbers);
        wait_until(started + (double)(k + 1) * PERIOD_S);
        double begun = seconds();
        mobnet_status status = mobnet_step(model, &sample, &result);
        if (k >= WARM_UP)
            times[k - WARM_UP] = seconds() - begun;
        if (status != MOBNET_OK) {
            fprintf(stderr, "%s: %s\n", mobnet_text(status), mobnet_column_name(model, result.fault));
            return 1;
        }
    }
    unsigned long asked = calls - before, late = 0;
    qsort(times, ticks, sizeof *times, rising);
    for (size_t k = 0; k < ticks; k++)
        late += times[k] > PERIOD_S;
    double median = times[ticks / 2], p99 = times[ticks * 99 / 100], largest = times[ticks - 1];
    printf("%.3f %.3f %.3f %lu %lu\n", 1e6 * median, 1e6 * p99, 1e6 * largest, late, asked);
    return 0;
}

int main(int count, char **words) {
    size_t ticks = count == 3 ? (size_t)strtoul(words[2], NULL, 10) : 0;
    void *memory = NULL;
    if (!ticks) {
        fprintf(stderr, "usage: %s MODEL TICKS\n", words[0]);
        return 2;
    }
    mobnet *model = load(words[1], &memory);
    double *times = malloc(ticks * sizeof *times);
    int status = model && times ? run(model, ticks, times) : 1;
    free(times);
    free(memory);
    return status;
}
