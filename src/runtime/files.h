/* What the programs beside the library share: a whole file in memory, and a model set up from it. They may allocate. */
#ifndef MOBNET_FILES_H
#define MOBNET_FILES_H

#include <stdio.h>
#include <stdlib.h>

#include "mobnet.h"

/* Return the bytes of a file, which the caller frees; NULL if it cannot be read. */
static void *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    void *bytes = NULL;
    long length;
    *size = 0;
    if (file && fseek(file, 0, SEEK_END) == 0 && (length = ftell(file)) > 0 && fseek(file, 0, SEEK_SET) == 0 &&
        (bytes = malloc((size_t)length)) != NULL)
        *size = fread(bytes, 1, (size_t)length, file);
    if (file)
        fclose(file);
    return bytes;
}

/* Return a model of a file, in memory of its own; NULL, with a line that says why, if it is not accepted. */
static mobnet *load(const char *path, void **memory) {
    size_t file_size, size = 0;
    mobnet *handle = NULL;
    void *model = read_file(path, &file_size);
    mobnet_status status = model ? mobnet_size(model, file_size, &size) : MOBNET_TRUNCATED;
    *memory = status == MOBNET_OK ? malloc(size) : NULL;
    if (status == MOBNET_OK)
        status = mobnet_init(*memory, size, model, file_size, &handle);
    if (!model)
        fprintf(stderr, "%s: this file cannot be read\n", path);
    else if (status != MOBNET_OK)
        fprintf(stderr, "%s: %s\n", path, mobnet_text(status));
    free(model);
    return handle;
}

/* Point a sample to its numbers, all of which stand in one array in the order of the columns. */
static mobnet_sample sample_of(const mobnet_sizes *sizes, const double *numbers) {
    mobnet_sample sample;
    sample.q = numbers;
    sample.v = sample.q + sizes->nq;
    sample.tau_motor = sample.v + sizes->nv;
    sample.tau_des = sample.tau_motor + sizes->nu;
    sample.acc = sample.tau_des + sizes->nu;
    sample.swing = sample.acc + (sizes->floating ? 3 : 0);
    sample.landing = sample.swing + sizes->feet;
    return sample;
}

#endif
