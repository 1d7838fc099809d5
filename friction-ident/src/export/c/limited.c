/* x within +-cap. */
static double limited(double x, double cap)
{
    return fmin(fmax(x, -cap), cap);
}

