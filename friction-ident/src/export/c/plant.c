/* The plant: implicit in the set-valued friction, second order between events.
 *
@ABOUT@
 *
 * Over a step r with the mean velocity u = (v + v1)/2: 2 m (u - v) = r (F - S - L d - c (u - v_p) - f(r u)), where F is
 * the drive's mean force, S and c the smooth forces and their slope at the predicted middle, L d the rigid friction and
 * f the mean force of elastic elements. Compile with -ffp-contract=off to get the library's motion to the last digits.
 */
#include "plant.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MASS (m->p[0])
@CONSTANTS@
const char *const PARAMETER_NAME[PARAMETERS] = {@NAMES@};
const double PARAMETER_VALUE[PARAMETERS] = {@VALUES@};

static double sign(double x)
{
    return (double)((x > 0.0) - (x < 0.0));
}

static double positive(double x)
{
    return x < 0.0 ? 0.0 : x;
}

@HELPERS@
/* --- what the effects do ------------------------------------------------------------------------------------- */

/* Forces that resist the motion, and their slope against the velocity. */
static void smooth_forces(Plant *m)
{
    const double x = m->middle, v = m->predicted, t = m->when, drive = m->drive;
    double force = 0.0, damping = 0.0;
    (void)x;
    (void)v;
    (void)t;
    (void)drive;
@SMOOTH@    m->force = force;
    m->damping = damping;
}

/* Friction level in the direction of sliding, from what the memories add on; not yet cut off at 0. */
static double friction_level(const Plant *m, int at_rest)
{
    const double x = m->middle, s = m->direction, w = at_rest ? 0.0 : m->level_velocity;
    const double a = at_rest ? 0.0 : m->slope, t = m->when, drive = m->drive;
    const double dwell = m->dwell, bond = m->bond;
    double level = m->remembered;
    (void)x;
    (void)s;
    (void)w;
    (void)a;
    (void)t;
    (void)drive;
    (void)dwell;
    (void)bond;
@LEVEL@    return level;
}

/* Replaces the mean command by the mean of what comes out of the drive. Returns 0 where there is no memory. */
static int advance_drives(Plant *m, double duration)
{
    const double end = m->time + duration;
    double force = m->drive;
    (void)end;
@DRIVE@    m->drive = force;
    return 1;
}

static void start_states(Plant *m, double velocity, double command)
{
    (void)m;
    (void)velocity;
    (void)command;
@START@}

/* Loads the elements at the friction level where they are. */
static void load_elements(Plant *m, double level, double used, double velocity)
{
    (void)m;
    (void)level;
    (void)used;
    (void)velocity;
@LOAD@}

/* What the memories say to the level. */
static void recall(Plant *m)
{
    m->level_velocity = m->predicted;
    m->bond = 1.0;
    m->remembered = 0.0;
@RECALL@}

/* Takes a piece of motion into the memories. */
static void remember(Plant *m)
{
    const double w = m->level_velocity;
    (void)w;
@HUMP@@REMEMBER@}

double plant_shown(const Plant *m)
{
    double position = m->x;
@SHOWN@    return position;
}

/* --- the step ------------------------------------------------------------------------------------------------ */

static void predict(Plant *m)
{
    const double half = 0.5 * m->left, s = sign(m->v);
    const double along = (m->v + half * m->slope) * s;
    m->when = m->time + half;
    m->middle = m->x + half * m->v;
    /* The prediction stays on this side of a stop: what comes behind it is another piece. */
    m->predicted = along < 0.0 ? 0.0 : along * s;
    m->direction = s;
    smooth_forces(m);
    recall(m);
}

static void levels(Plant *m)
{
    m->level = friction_level(m, 0);
#if @BREAKAWAY@
    m->breakaway = positive(friction_level(m, 1));
#endif
}

@ELEMENTS@@STEP@
int plant_step(Plant *m, double duration, double command)
{
    m->drive = command;
    if (!advance_drives(m, duration)) {
        return 0;
    }
    take_step(m, duration);
@KEEP@    return 1;
}

void plant_defaults(Plant *m)
{
    memset(m, 0, sizeof *m);
    memcpy(m->p, PARAMETER_VALUE, sizeof m->p);
}

int plant_start(Plant *m, const Start *start)
{
    m->time = start->time;
    m->x = start->x;
    m->v = start->v;
    m->slope = 0.0;
    m->dwell = 0.0;
    m->sliding = @SLIDES@;
    m->hump = 1.0;
@PASTS@    start_states(m, start->v, start->command);
    m->left = 0.0;
    m->when = m->time;
    m->middle = m->x;
    m->predicted = m->v;
    m->direction = sign(start->used);
    m->drive = start->command;
    recall(m);
    levels(m);
    load_elements(m, positive(m->level), start->used, start->v);
    return 1;
}

void plant_free(Plant *m)
{
@FREE@    (void)m;
}
