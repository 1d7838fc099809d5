/* A second body with friction of its own, behind a connection: a coupling, or the two ends of a gap. */
typedef struct {
    int gap;                                                          /* 1 for a gap */
    double start, slope;                                              /* of a coupling */
    double side, open, pressed, behind, stiffness, damping;           /* of a gap */
} Connection;

/* Mean force on the load where the mass runs ahead by so much in the step, and its slope. */
static double pull(const Connection *c, double ahead, double *slope)
{
    double way, per_way, after, share, entering, leaving, tilt, spring, force, back, damped, stiff;
    int closed;
    if (!c->gap) {
        *slope = c->slope;
        return c->start + c->slope * ahead;
    }
    way = ahead * c->side;
    per_way = 1.0 / fmax(fabs(way), DBL_MIN);
    /* The end where it starts, pressed by `after` in the end. */
    after = fmax(c->pressed - c->open + way, 0.0);
    closed = c->pressed > 0.0 && after > 0.0;
    share = (after + c->pressed) * per_way;
    entering = share * (1.0 - 0.5 * share);
    leaving = 0.5 * share * share;
    tilt = closed ? 0.5 : (after > 0.0 ? entering : leaving);
    spring = (closed ? 0.5 : 0.5 * share) * (after + c->pressed);
    force = c->stiffness * spring + c->damping * (after - c->pressed);
    tilt = c->stiffness * tilt + (after > 0.0 ? c->damping : 0.0);
    if (!(force > 0.0)) {
        force = 0.0;
        tilt = 0.0;
    }
    /* The other end. */
    after = fmax(-c->behind - way, 0.0);
    share = after * per_way;
    back = (0.5 * c->stiffness * share + c->damping) * after;
    damped = after > 0.0 ? c->damping : 0.0;
    stiff = c->stiffness * share * (1.0 - 0.5 * share) + damped;
    *slope = tilt + stiff;
    return c->side * (force - back);
}

/* Where `inertia` times what the mass runs ahead and the pull are `total` together. */
static double run_ahead(const Connection *c, double inertia, double sum)
{
    const double stiffness = c->stiffness, damping = c->damping, pressed = c->pressed, open = c->open;
    double total, all, free, line, spring, let_go, way, toward, still, damped, square, linear, from, rest, root, above, t;
    int crosses, opens, closes, forth;
    if (!c->gap) {
        return (sum - c->start) / (inertia + c->slope);
    }
    total = sum * c->side;
    all = 0.5 * stiffness + damping + inertia;
    free = total / inertia;
    line = (total - stiffness * pressed) / all;
    spring = 0.5 * stiffness * pressed * pressed / fmax(c->behind, DBL_MIN);
    let_go = fmax(spring - damping * pressed, 0.0);
    crosses = total < let_go - inertia * c->behind;
    opens = pressed > 0.0 && line < -pressed && !crosses;
    closes = pressed <= 0.0 && free > open && !crosses;
    still = let_go > 0.0 ? pressed : 0.0;
    square = opens ? inertia : all;
    way = crosses ? c->behind : open;
    toward = crosses ? -total : total;
    damped = damping * (way - still);
    linear = opens ? -total - damping * pressed : stiffness * way + damped + toward;
    from = opens ? -pressed * pressed : way * way - still * still;
    rest = 0.5 * stiffness * from;
    root = sqrt(fmax(linear * linear - 4.0 * square * rest, 0.0));
    forth = linear >= 0.0;
    above = forth ? linear + root : -2.0 * rest;
    t = above / (forth ? 2.0 * square : root - linear);
    if (crosses) {
        return c->side * -t;
    }
    if (opens) {
        return c->side * fmin(free, -t);
    }
    if (closes) {
        return c->side * t;
    }
    return c->side * (pressed > 0.0 ? fmin(line, free) : free);
}

/* A step of the load: mean force on the mass, its slope against the displacement of the mass, mean velocity. The load
 * really sticks: friction takes what brings it to rest or keeps it there, and never drives it. */
static double load_step(double mass, double level, double viscous, double velocity, double r, double moved,
                        const Connection *c, double *slope, double *mean)
{
    const int moves = r > 0.0;
    const double rate = moves ? 1.0 / r : 1.0;
    const double inertia = 2.0 * mass * rate + viscous;
    const double momentum = 2.0 * mass * velocity * rate;
    const double s = velocity < 0.0 ? -1.0 : 1.0, half = 0.5 * velocity;
    double stop_stiffness, rest_stiffness, stiffness;
    const double stopping = pull(c, moved - r * half, &stop_stiffness);
    const double resting = pull(c, moved, &rest_stiffness);
    const double stop = s * (momentum + stopping - inertia * half);
    const double turn = s * (momentum + resting);
    const int stops = level > 0.0 && stop >= 0.0 && stop <= level;
    const int rests = level > 0.0 && stop < 0.0 && turn < 0.0 && turn >= -level;
    const double back = stop < 0.0 && turn < -level ? -s * level : 0.0;
    const double friction = stop > level ? s * level : back;
    const double per_way = fmax(inertia * rate, DBL_MIN);
    const double ahead = run_ahead(c, per_way, per_way * moved - (momentum - friction));
    const double sliding = pull(c, ahead, &stiffness);
    if (!moves) {
        *slope = 0.0;
        *mean = velocity;
        return resting;
    }
    if (rests) {
        *slope = rest_stiffness;
        *mean = 0.0;
        return resting;
    }
    *slope = stops ? stop_stiffness : stiffness * per_way / (per_way + stiffness);
    *mean = stops ? half : (moved - ahead) * rate;
    return stops ? stopping : sliding;
}

