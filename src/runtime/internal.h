/* What the parts of the library share; nothing here is for its users. Functions have names by which the linker tells
 * them from those of a program.
 */
#ifndef MOBNET_INTERNAL_H
#define MOBNET_INTERNAL_H

#include <stddef.h>
#include <stdint.h>

#include "mobnet.h"

enum {
    BASE_Q = 7,     /* numbers of a floating base in a position, */
    BASE_V = 6,     /* and in a velocity */
    LEG_JOINTS = 6, /* six joints tell the six numbers of a wrench */
    CORNERS = 4,    /* of a sole */
    KINDS = 3,      /* of signals: mean, standard deviation, one over the other */
    NAME = 32,      /* bytes of a name, the last one zero */
    MOST_LINKS = 256,
    ROWS = 32       /* of a weight that are added up side by side, so that the compiler keeps the sums in registers */
};

/* A link as `mobnet.kernel.linkage` has it and as it stands in the file. */
struct link {
    int64_t parent;
    double still[3][3], cosine[3][3], sine[3][3]; /* rotation to the parent: still + cos(q) cosine + sin(q) sine */
    double offset[3], axis[3];
    double mass, moment[3], inertia[3][3];
    double behind;   /* mass of the link and of all that it carries [kg] */
    double armature; /* [kg m^2] */
};

/* What the sweeps keep of a link, in its axes and about its origin (`mobnet.kernel.momentum`). */
struct moving {
    double rotation[3][3]; /* to the parent's axes; of a floating base to the world's */
    double velocity[3], omega[3], gravity[3], momentum[3], spin[3], moment[3];
};

struct robot {
    int floating;
    size_t links, nq, nv, nu, feet;
    double gravity[3]; /* [m/s^2] */
    struct link *link; /* (links), the base first */
    struct moving *moving;
};

/* Friction and errors of a drive, as `mobnet.kernel.drive` has them and as they stand in the file. */
struct drive {
    double coulomb, viscous, load, offset, scale;
    double smoothing; /* width of the smooth sign of the velocity [rad/s] */
    double breakaway; /* angle of Dahl's law [rad]; zero with the smooth sign */
};

struct observer {
    double pole, rate_hz;
    struct drive *drive; /* (nu); none of a robot whose table has no friction */
    int sampled; /* whether torques are samples at the ticks, and not means over the intervals that end there */
};

/* Kinds of sections of a model file, in their order, but that DRIVES, which may be missing, follow the observer. */
enum part { ROBOT = 1, JOINTS, COLUMNS, OBSERVER, NETWORK, DETECTOR, DRIVES };

enum source { FROM_Q, FROM_V, FROM_TORQUE, FROM_ROTATION, FROM_OMEGA, FROM_ACC, SOURCES };

struct input {
    uint16_t source, place;
};

struct network {
    size_t inputs, hidden, joints;
    int direct; /* whether it predicts the external torque, and not what is taken off the residual */
    float std_min;
    struct input *input; /* (inputs) */
    uint32_t *joint;     /* (joints) where they stand in a velocity */
    float *input_mean, *input_std, *target_mean, *target_std, *std_unit;
    float *w_state, *w_in, *w_out; /* in blocks of ROWS rows, column by column: (3 H, H), (3 H, inputs), (2 n, H) */
    float *b_state, *b_in, *b_out; /* where the sums of inner, reset, update begin; reset, update, new; outputs */
    float *scaled, *by_state, *by_in, *output; /* room */
    size_t first;                              /* of its hidden units among those of all networks */
};

struct gate {
    double period;    /* [s] */
    int64_t lift_off; /* samples */
    double landing, near, low, force, upright;
    int64_t hold; /* samples */
};

struct sole {
    int64_t link; /* that carries the foot */
    double origin[3], corner[CORNERS][3];
};

struct leg {
    int64_t first; /* motor of the leg */
    struct sole foot, other;
};

struct gate_state {
    int64_t air, touching, landed;
    double phase;
};

struct detector {
    char name[NAME];
    size_t joints, kinds, signals, phases, hold;
    uint32_t kind[KINDS];
    uint32_t *joint; /* (joints) where they stand in a velocity */
    double pole, *threshold; /* (phases, signals) */
    int residual;            /* whether it watches the residual, and not the estimate */
    uint64_t settle;         /* samples after the start in which a limb without a gate is not watched */
    int gated;
    size_t foot; /* among the feet of a sample */
    struct gate gate;
    struct leg leg;
    struct gate_state state;
    double *signal, *low, *held; /* (signals), (signals), (hold, signals) */
    uint64_t samples;
    size_t highest;
};

/* What follows from a sample. There are two of them: the last one, and that of the sample that is being looked at,
 * which takes its place if all of its numbers are finite. */
struct tick {
    double *momentum, *beta, *residual, *torque, *tau_ext;
    double *bend, *friction; /* (nu) of the drives, where there are any */
    float *mean, *std, *hidden;
};

struct column {
    char name[NAME];
    double low, high;
};

struct mobnet {
    struct robot robot;
    struct observer observer;
    size_t columns, networks, detectors, hidden;
    size_t driven; /* whether there is a section of drives */
    struct column *column;
    char (*joint)[NAME];
    struct network *network;
    struct detector *detector;
    mobnet_alarm *alarm;
    struct tick tick[2];
    int now;                             /* which of the two is the last one */
    int begun;                           /* whether it is one period before the next one */
    double rotation[6];                  /* room: first two columns of the base's rotation */
    char predicted[MOST_LINKS + BASE_V]; /* whether a network predicts a joint's torque */
};

/* Where arrays go. Without a beginning it only counts what they take. */
struct arena {
    unsigned char *begin;
    size_t used;
};

struct cursor;

void *mobnet_take(struct arena *arena, size_t count, size_t size);
mobnet_status mobnet_read_model(struct mobnet *m, struct arena *arena, const void *model, size_t size);
void mobnet_read_part(struct mobnet *m, struct arena *arena, uint32_t kind, uint32_t number, struct cursor *c);

void mobnet_momentum(const struct robot *robot, const double *q, const double *v, double *p, double *beta);
void mobnet_observe(const struct mobnet *m, const mobnet_sample *sample, const struct tick *last, struct tick *next);

size_t mobnet_padded(size_t rows);
void mobnet_lay_out(size_t rows, size_t columns, const unsigned char *from, float *to);
void mobnet_first_columns(const double *quaternion, double *rotation);
void mobnet_predict(const struct mobnet *m, const struct network *net, const mobnet_sample *sample,
                    const struct tick *last, struct tick *next);

void mobnet_detect(const struct robot *robot, struct detector *d, const mobnet_sample *sample, const struct tick *tick,
                   mobnet_alarm *alarm);

#endif
