/* Trapezoidal rule for a load on spring and damper over a step in which the mass moves by `moved`: mean force on the
 * mass, its slope against `moved`, and the load's mean velocity. */
static double swing(const double p[3], double r, double moved, double stretch, double velocity, double *slope, double *mean)
{
    const double load = p[0], w = 6.283185307179586 * p[1], zeta = p[2];
    const double stiffness = w * w, damping = 2.0 * zeta * w;
    double inertia, coupling;
    if (r <= 0.0) {
        *slope = 0.0;
        *mean = velocity;
        return -load * stiffness * stretch;
    }
    inertia = 2.0 / r + 0.5 * stiffness * r + damping;
    coupling = 0.5 * stiffness + damping / r;
    *mean = (2.0 * velocity / r - stiffness * stretch + coupling * moved) / inertia;
    *slope = 2.0 * load * coupling / (r * inertia);
    return 2.0 * load * (*mean - velocity) / r;
}

