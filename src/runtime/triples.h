/* Vectors of three numbers by value, which stay in registers (`mobnet.kernel.triples`). */
#ifndef MOBNET_TRIPLES_H
#define MOBNET_TRIPLES_H

typedef struct triple {
    double x, y, z;
} triple;

static inline triple vector(const double *a) {
    triple r = {a[0], a[1], a[2]};
    return r;
}

static inline void put(double *a, triple x) {
    a[0] = x.x;
    a[1] = x.y;
    a[2] = x.z;
}

static inline triple add(triple a, triple b) {
    triple r = {a.x + b.x, a.y + b.y, a.z + b.z};
    return r;
}

static inline triple times(double factor, triple a) {
    triple r = {factor * a.x, factor * a.y, factor * a.z};
    return r;
}

static inline double dot(triple a, triple b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline triple cross(triple a, triple b) {
    triple r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return r;
}

/* A matrix times a vector: with a link's rotation, into the parent's axes. */
static inline triple product(double matrix[3][3], triple x) {
    triple r = {dot(vector(matrix[0]), x), dot(vector(matrix[1]), x), dot(vector(matrix[2]), x)};
    return r;
}

/* The transpose of a matrix times a vector: with a link's rotation, out of the parent's axes. */
static inline triple transposed(double matrix[3][3], triple x) {
    return add(add(times(x.x, vector(matrix[0])), times(x.y, vector(matrix[1]))), times(x.z, vector(matrix[2])));
}

#endif
