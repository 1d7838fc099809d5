/* Takes what is left up to the stop, where there is one in it. Without a friction level there is nothing to stop for. */
static void close_piece(Plant *m)
{
    const double r = m->left, v = m->v, change = 2.0 * (m->mean - v), end = v + change;
    const int stops = r > 0.0 && m->level > 0.0 && end * m->direction <= 0.0;
    /* What cannot leave its rest, because the level rises with speed, stays there. */
    const int held = stops && v == 0.0;
    const double spent = (stops && !held ? -v / change : 1.0) * r;
    /* What rested has taken the time of its rest. */
    if (!(r > 0.0)) {
        m->displacement = 0.0;
        m->left = 0.0;
        return;
    }
    m->taken = spent;
    m->displacement = stops ? 0.5 * v * spent : r * m->mean;
    m->x += m->displacement;
    m->time += spent;
    m->slope = held ? 0.0 : change / r;
    m->dwell = held ? m->dwell + r : (stops ? 0.0 : m->dwell);
    m->v = stops ? 0.0 : end;
    m->sliding = stops ? 0.0 : 1.0;
    m->left = stops && !held ? r - spent : 0.0;
}

static void take_piece(Plant *m)
{
    double slope, others, applied;
    predict(m);
    m->displacement = 0.0;
    m->elements = 0.0;
#if @ATTACHED@
    respond(m);
#endif
    applied = m->drive - m->force - m->elements;
    if (m->v == 0.0) {
        m->direction = sign(applied);
    }
    levels(m);
    m->level = positive(m->level);
    m->taken = 0.0;
    if (m->v == 0.0 && fabs(applied) <= m->level) {
        m->taken = m->left;
        m->slope = m->left > 0.0 ? 0.0 : m->slope;
        m->dwell += m->left;
        m->time += m->left;
        m->left = 0.0;
    }
    slope = positive(m->damping);
    others = m->drive - m->force - m->level * m->direction + slope * m->predicted;
    m->inertia = 2.0 * MASS + m->left * slope;
    m->push = 2.0 * MASS * m->v + m->left * others;
#if @ATTACHED@
    m->displacement = m->left * m->v;
    newton(m);
#else
    m->mean = m->push / m->inertia;
#endif
    close_piece(m);
#if @ATTACHED@
    commit(m);
#endif
    remember(m);
}

static void take_step(Plant *m, double duration)
{
    int pieces;
    m->left = duration;
    for (pieces = 0; pieces < 6; pieces++) {
        take_piece(m);
        if (m->left <= 0.0) {
            return;
        }
    }
    /* What is left after so many events is spent at rest. */
    m->time += m->left;
}
