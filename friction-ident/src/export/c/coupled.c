/* A step of a load behind a coupling; p: m_L, f, zeta, F_L, d_L. */
static double coupled(const double p[5], double r, double moved, double stretch, double velocity, double *slope, double *mean)
{
    const double w = 6.283185307179586 * p[1];
    const double stiffness = p[0] * w * w, damping = 2.0 * p[2] * p[0] * w;
    Connection c;
    memset(&c, 0, sizeof c);
    c.start = -stiffness * stretch;
    c.slope = 0.5 * stiffness + damping * (r > 0.0 ? 1.0 / r : 0.0);
    return load_step(p[0], p[3], p[4], velocity, r, moved, &c, slope, mean);
}

