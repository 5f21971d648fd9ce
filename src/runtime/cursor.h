/* What is left of a section of the model file, and how it is read: a fault stays, what is missing reads as zero. */
#ifndef MOBNET_CURSOR_H
#define MOBNET_CURSOR_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "internal.h"

static const double MOST = 1e9, LEAST = 1e-12; /* bounds of numbers that are not weights */

struct cursor {
    const unsigned char *at;
    size_t left;
    int fault; /* whether something was not there or is not accepted */
};

static inline void need(struct cursor *c, int good) {
    if (!good)
        c->fault = 1;
}

static inline void copy(struct cursor *c, void *to, size_t count) {
    need(c, c->left >= count);
    if (c->left < count) {
        memset(to, 0, count);
        return;
    }
    memcpy(to, c->at, count);
    c->at += count;
    c->left -= count;
}

static inline uint32_t whole(struct cursor *c, uint32_t least, uint32_t most) {
    uint32_t value;
    copy(c, &value, sizeof value);
    if (value < least || value > most) {
        c->fault = 1;
        return least;
    }
    return value;
}

/* Read doubles between bounds; `to` may be NULL. */
static inline void doubles(struct cursor *c, size_t count, double low, double high, double *to) {
    for (size_t i = 0; i < count && !c->fault; i++) {
        double value;
        copy(c, &value, sizeof value);
        need(c, value >= low && value <= high);
        if (to)
            to[i] = value;
    }
}

static inline void floats(struct cursor *c, size_t count, float low, float *to) {
    for (size_t i = 0; i < count && !c->fault; i++) {
        float value;
        copy(c, &value, sizeof value);
        need(c, value >= low && value <= FLT_MAX);
        if (to)
            to[i] = value;
    }
}

static inline void name(struct cursor *c, char *to) {
    char text[NAME];
    copy(c, text, NAME);
    need(c, text[0] && !text[NAME - 1]);
    if (to)
        memcpy(to, text, NAME);
}

static inline int within(const void *values, size_t count) {
    double value;
    for (size_t i = 0; i < count; i++) {
        memcpy(&value, (const char *)values + i * sizeof value, sizeof value);
        if (!(fabs(value) <= MOST))
            return 0;
    }
    return 1;
}

#endif
