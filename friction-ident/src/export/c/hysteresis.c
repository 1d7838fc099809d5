/* Share of the force of a hysteresis after a way in units of its length, both positive in the direction of motion: slope
   and derivative of the slope at the begin, integrated exactly. */
static double bent(double share, double way, double n, double beta)
{
    const double size = fmax(fabs(share), 1e-3), power = pow(size, n);
    const double turns = share < 0.0 ? 2.0 * beta - 1.0 : -1.0;
    const double bend = (share < 0.0 ? -turns : turns) * n * power / size, x = bend * way;
    const double grown = fabs(x) < 1e-6 ? way : (exp(x) - 1.0) / bend;
    return fmin(fmax(share + (1.0 + turns * power) * grown, -1.0), 1.0);
}
