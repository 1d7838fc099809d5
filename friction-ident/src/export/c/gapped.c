/* A step of a load behind a gap; p: m_L, F_L, d_L, b, k, zeta. */
static double gapped(const double p[6], double r, double moved, double stretch, double velocity, double *slope, double *mean)
{
    const double rate = r > 0.0 ? 1.0 / r : 0.0;
    /* Next to nothing on the ground holds a load of nothing. */
    const double viscous = fmax(p[2], 1e-14 * p[4] * r);
    const double half = 0.5 * p[3];
    Connection c;
    double place;
    memset(&c, 0, sizeof c);
    c.gap = 1;
    c.side = -stretch < 0.0 ? -1.0 : 1.0;
    place = -stretch * c.side;
    c.open = fmax(half - place, 0.0);
    c.pressed = fmax(place - half, 0.0);
    c.behind = place + half;
    c.stiffness = p[4];
    c.damping = 2.0 * p[5] * sqrt(p[4] * p[0]) * rate;
    return load_step(p[0], p[1], viscous, velocity, r, moved, &c, slope, mean);
}

