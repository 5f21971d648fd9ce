/* Run a model over a recording: `example model.bin recording.csv` prints its alarms, `... recording.csv torque` the
 * estimated external torque.
 *
 * The recording is a CSV file whose first line names the columns, such as `q.LL1`; others than those of the model may
 * stand between them. A line is printed for each sample at which a detector's signal lies above its threshold, or for
 * every sample, and one in any case for each sample that is not accepted.
 */
#include <string.h>

#include "files.h"

enum { LINE = 1 << 17, FIELDS = 4096 };

/* Cut a line at its commas; return how many fields it has. */
static size_t cut(char *line, char **fields) {
    size_t count = 0;
    line[strcspn(line, "\r\n")] = 0;
    while (line && count < FIELDS) {
        char *comma = strchr(line, ',');
        if (comma)
            *comma++ = 0;
        fields[count++] = line;
        line = comma;
    }
    return count;
}

/* Find each column of a sample among the fields of the first line; return 0, and say which one, if one is missing. */
static int find_columns(const mobnet *model, size_t columns, char **fields, size_t count, size_t *place) {
    for (size_t k = 0; k < columns; k++) {
        for (place[k] = 0; place[k] < count; place[k]++)
            if (strcmp(fields[place[k]], mobnet_column_name(model, k)) == 0)
                break;
        if (place[k] == count) {
            fprintf(stderr, "column %s is missing\n", mobnet_column_name(model, k));
            return 0;
        }
    }
    return 1;
}

static void tell_names(const mobnet *model, const mobnet_sizes *sizes) {
    printf("row,time_s");
    for (size_t k = 0; k < sizes->nv; k++)
        printf(",tau_ext.%s", mobnet_joint_name(model, k));
    printf("\n");
}

static void tell_torque(const mobnet_sizes *sizes, size_t row, const mobnet_result *result) {
    printf("%lu,%.6f", (unsigned long)row, (double)row / sizes->rate_hz);
    for (size_t k = 0; k < sizes->nv; k++)
        printf(",%.9g", result->tau_ext[k]);
    printf("\n");
}

static void tell_alarms(const mobnet *model, const mobnet_sizes *sizes, size_t row, const mobnet_result *result) {
    for (size_t k = 0; k < sizes->detectors; k++) {
        const mobnet_alarm *alarm = &result->alarms[k];
        size_t signal = (size_t)alarm->signal;
        if (alarm->ratio > 1.0)
            printf("%lu,%.6f,%s,%s.%s,%.6f\n", (unsigned long)row, (double)row / sizes->rate_hz,
                   mobnet_detector_name(model, k), mobnet_signal_kind(model, k, signal),
                   mobnet_signal_joint(model, k, signal), alarm->ratio);
    }
}

static int run(mobnet *model, FILE *recording, int torque) {
    static char line[LINE], *fields[FIELDS];
    static double numbers[FIELDS];
    static size_t place[FIELDS];
    mobnet_sizes sizes = mobnet_sizes_of(model);
    mobnet_sample sample = sample_of(&sizes, numbers);
    mobnet_result result;
    if (sizes.columns > FIELDS || !fgets(line, LINE, recording) ||
        !find_columns(model, sizes.columns, fields, cut(line, fields), place))
        return 1;
    if (torque)
        tell_names(model, &sizes);
    else
        printf("row,time_s,detector,signal,ratio\n");
    for (size_t row = 0; fgets(line, LINE, recording); row++) {
        size_t count = cut(line, fields);
        for (size_t k = 0; k < sizes.columns; k++)
            numbers[k] = strtod(place[k] < count ? fields[place[k]] : "nan", NULL);
        mobnet_status status = mobnet_step(model, &sample, &result);
        if (status == MOBNET_OK && torque)
            tell_torque(&sizes, row, &result);
        else if (status == MOBNET_OK)
            tell_alarms(model, &sizes, row, &result);
        else
            fprintf(stderr, "row %lu: %s: %s\n", (unsigned long)row, mobnet_text(status),
                    status == MOBNET_SAMPLE ? mobnet_column_name(model, result.fault) : "");
    }
    return 0;
}

int main(int count, char **words) {
    void *memory = NULL;
    if (count != 3 && !(count == 4 && strcmp(words[3], "torque") == 0)) {
        fprintf(stderr, "usage: %s MODEL RECORDING [torque]\n", words[0]);
        return 2;
    }
    mobnet *model = load(words[1], &memory);
    FILE *recording = fopen(words[2], "r");
    if (!recording)
        fprintf(stderr, "%s: this file cannot be read\n", words[2]);
    int status = model && recording ? run(model, recording, count == 4) : 1;
    if (recording)
        fclose(recording);
    free(memory);
    return status;
}
