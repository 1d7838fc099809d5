/* Whether the contact slides, and for how long it has been at rest. */
static void watch(Plant *m)
{
    const double slides = @SLIDING@;
    m->dwell = slides == 0.0 ? (m->sliding > 0.0 ? 0.0 : m->dwell) + m->left : m->dwell;
    m->sliding = slides;
    m->taken = m->left;
    m->displacement = m->left * m->mean;
    remember(m);
}

static void take_step(Plant *m, double duration)
{
    double slope, others, change;
    m->left = duration;
    predict(m);
    levels(m);
    m->level = positive(m->level);
    slope = positive(m->damping);
    others = m->drive - m->force + slope * m->predicted;
    m->inertia = 2.0 * MASS + m->left * slope;
    m->push = 2.0 * MASS * m->v + m->left * others;
#if @SOLVES@
    solve(m);
#else
    m->displacement = 0.0;
    newton(m);
    m->taken = m->left;
    commit(m);
#endif
    change = m->left > 0.0 ? 2.0 * (m->mean - m->v) : 0.0;
    m->slope = m->left > 0.0 ? change * (1.0 / m->left) : m->slope;
    m->x += m->left * m->mean;
    m->v += change;
    m->time += m->left;
    watch(m);
}
