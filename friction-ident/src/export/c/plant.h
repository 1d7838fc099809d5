/* The plant: a mass and the effects that act on it, advanced like the library's simulator does. C99. */
#ifndef AEP_PLANT_H
#define AEP_PLANT_H

#include <stddef.h>

#define PARAMETERS @PARAMETERS@
#define STATES @STATES@

/* A signal's recent past: linear between samples, with a given slope before the first one. */
typedef struct {
    double *time, *value;
    size_t first, end, room;
    double slope, length;
} Past;

typedef struct {
    double p[PARAMETERS];  /* mass, then the effects' parameters: see PARAMETER in plant.c */
    double s[STATES];      /* states of the effects */
    double time, x, v;     /* s; of the mass: m or rad, m/s or rad/s */
    double slope;          /* mean acceleration of the last step */
    double dwell;          /* s, time at rest */
    double sliding;        /* 1 while the friction slides */
    double drive;          /* mean force of the drive on the mass in the last step */
    Past slow;             /* velocity so far */
    Past input;            /* integral of what came into the drive so far */
    /* Of the step that is being taken. */
    double left, taken, middle, predicted, direction, when, force, damping, level, breakaway, remembered;
    double level_velocity, bond, hump, elements, stiffness, inertia, push, mean, displacement;
} Plant;

/* How a plant starts. */
typedef struct {
    double time;     /* s */
    double x, v;     /* m or rad, m/s or rad/s */
    double used;     /* utilisation of an elastic contact, -1..1 */
    double command;  /* command up to here */
} Start;

extern const char *const PARAMETER_NAME[PARAMETERS];
extern const double PARAMETER_VALUE[PARAMETERS];

/* Puts the parameters of the model in. To be called once, before the rest. */
void plant_defaults(Plant *m);
/* Starts it. Returns 0 where there is no memory. */
int plant_start(Plant *m, const Start *start);
/* Advances it by `duration` (s) under `command`, the mean over the step. Returns 0 where there is no memory. */
int plant_step(Plant *m, double duration, double command);
/* Position as the sensor shows it, m or rad. */
double plant_shown(const Plant *m);
/* Gives back what it has allocated. */
void plant_free(Plant *m);

#endif
