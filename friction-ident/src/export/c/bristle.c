/* Force of a bristle after a displacement, exact at constant level, and its slope. */
static double bristle(double held, double moved, double stiffness, double level, double *slope)
{
    const double most = fmax(level, DBL_MIN);
    const double from = limited(held, most);
    const double limit = copysign(most, moved);
    const double left = exp(-stiffness * fabs(moved) / most);
    *slope = stiffness * (1.0 - from * copysign(1.0, moved) / most) * left;
    return limit + (from - limit) * left;
}

