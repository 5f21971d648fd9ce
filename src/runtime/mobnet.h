/* The external torque of a robot and its collisions, sample by sample: what this project learned, on the robot itself.
 *
 * A model file, which `./reproduce export` writes, holds the robot's tree, the observer, the networks of its limbs and
 * the detectors with their thresholds. The library reads it once into memory that the caller gives. After that it
 * allocates nothing, opens nothing, and keeps no state outside of this memory, so that several handles may run beside
 * each other; one handle belongs to one thread at a time. docs/runtime.md says what the numbers mean.
 */
#ifndef MOBNET_H
#define MOBNET_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mobnet_status {
    MOBNET_OK = 0,
    MOBNET_NULL,       /* a pointer that is needed is NULL */
    MOBNET_HOST,       /* the machine is not little-endian, or its numbers are not those of IEEE 754 */
    MOBNET_TRUNCATED,  /* the model file is shorter or longer than it says */
    MOBNET_MAGIC,      /* it is no model file */
    MOBNET_VERSION,    /* it is one of another version of the format */
    MOBNET_CHECKSUM,   /* its bytes are not those that were written */
    MOBNET_SECTION,    /* a section of it is missing, or is not where or as long as it must be */
    MOBNET_VALUE,      /* a value in it is not accepted */
    MOBNET_MEMORY,     /* the memory is smaller than mobnet_size said */
    MOBNET_SAMPLE,     /* a number of the sample is not finite or out of bounds; mobnet_column_name(fault) names it */
    MOBNET_NOT_FINITE  /* the sample led to a number that is not finite */
} mobnet_status;

/* What the robot senses at a tick; bounds are those of the model file. What the robot does not have may be NULL. */
typedef struct mobnet_sample {
    const double *q;         /* (nq) position: base [m] in world, quaternion w x y z, joints [rad] */
    const double *v;         /* (nv) velocity: base linear [m/s] in world, angular [rad/s] in base, joints [rad/s] */
    const double *tau_motor; /* (nu) torque that the motors gave [N m] */
    const double *tau_des;   /* (nu) desired torque [N m] */
    const double *acc;       /* (3) specific force of the IMU in base axes [m/s^2]; of a floating base */
    const double *swing;     /* (feet) 1 where the walking plan has the foot in the air */
    const double *landing;   /* (feet) time until the planned landing [s] */
} mobnet_sample;

/* What a detector says of a sample. */
typedef struct mobnet_alarm {
    double ratio; /* of the highest signal to its threshold, held for long enough: above 1 is a collision */
    int signal;   /* which of the detector's signals that is: one kind after the other, joint by joint */
    int watched;  /* whether the limb is watched: a leg in its swing, another limb once its estimate has settled */
} mobnet_alarm;

/* What a sample led to. The arrays belong to the handle and hold until its next step. */
typedef struct mobnet_result {
    const double *residual;     /* (nv) r of (9) [N, N m] */
    const double *tau_ext;      /* (nv) estimated external torque, (15) [N, N m]; r itself where no network predicts */
    const float *mean;          /* (nv) what the networks predict [N, N m]; 0 without one */
    const float *std;           /* (nv) its standard deviation [N, N m]; 0 without one */
    const mobnet_alarm *alarms; /* (detectors) */
    size_t fault;               /* the column of the sample that is not accepted, where the status is MOBNET_SAMPLE */
} mobnet_result;

typedef struct mobnet_sizes {
    size_t nq, nv, nu, feet; /* positions, velocities, motors, feet */
    size_t columns;          /* all numbers of a sample, in the order of mobnet_sample */
    size_t networks, detectors;
    int floating; /* whether the base floats */
    double rate_hz;
} mobnet_sizes;

typedef struct mobnet mobnet;

/* Write how many bytes of memory a model takes. The whole file is checked. */
mobnet_status mobnet_size(const void *model, size_t model_size, size_t *size);

/* Set a model up in memory of any alignment, from a file that may be freed afterwards. */
mobnet_status mobnet_init(void *memory, size_t size, const void *model, size_t model_size, mobnet **handle);

/* Take one sample. With any status but MOBNET_OK nothing moves but the observer's last sample, which is forgotten: the
 * residual keeps its value for the next accepted sample and moves on with the one after it. */
mobnet_status mobnet_step(mobnet *handle, const mobnet_sample *sample, mobnet_result *result);

/* Return to the state before the first sample, as after a gap in the samples. */
void mobnet_reset(mobnet *handle);

mobnet_sizes mobnet_sizes_of(const mobnet *handle);

/* Names; NULL where there is none of that number. A signal is named as `mean.LL3`. */
const char *mobnet_text(mobnet_status status);
const char *mobnet_column_name(const mobnet *handle, size_t column);
const char *mobnet_joint_name(const mobnet *handle, size_t joint);
const char *mobnet_detector_name(const mobnet *handle, size_t detector);
const char *mobnet_signal_kind(const mobnet *handle, size_t detector, size_t signal);
const char *mobnet_signal_joint(const mobnet *handle, size_t detector, size_t signal);

#ifdef __cplusplus
}
#endif

#endif
