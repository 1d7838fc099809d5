/* (e^(-zeta t) cosh(k t), e^(-zeta t) sinh(k t)/k), k^2 = zeta^2 - 1 of either sign, t in units of tau. */
static void lag_response(double zeta, double t, double *even, double *odd)
{
    const double square = zeta * zeta - 1.0;
    const double k = sqrt(fabs(square));
    const double fades = exp(-zeta * t);
    if (fades == 0.0 && square < 0.0) {
        *even = 0.0;
        *odd = 0.0;
    } else if (k * t < 1e-4) {
        const double bend = square * t * t;
        *even = fades * (1.0 + bend / 2.0);
        *odd = fades * t * (1.0 + bend / 6.0);
    } else if (square < 0.0) {
        *even = fades * cos(k * t);
        *odd = fades * sin(k * t) / k;
    } else {
        const double slow = exp(-t / (zeta + k)), fast = exp(-(zeta + k) * t);
        *even = 0.5 * (slow + fast);
        *odd = 0.5 * (slow - fast) / k;
    }
}

