/* What the elastic contact holds at the start: a level that fell takes a loaded contact down with it. */
static double contact_at_start(double held, double slides, double level, double hold)
{
    return limited(held, slides > 0.0 ? level : fmax(hold, level));
}

/* Contact force at the end of a step that is elastic at first, and whether it breaks or slides then. */
static double contact_at_end(double start, double trial, double slides, double level, double hold, int *breaks)
{
    const int goes_on = slides > 0.0 && trial * start >= start * start;
    const double cap = goes_on ? level : fmax(hold, level);
    const int over = fabs(trial) > cap;
    *breaks = over || (goes_on && fabs(trial) >= level);
    return over ? copysign(level, trial) : trial;
}

/* Mean force over the step. Where the contact falls from what it holds to the level, the fall has its place in time. */
static double contact_mean(double start, double trial, double end, int breaks, double slides, double level, double hold)
{
    const int goes_on = slides > 0.0 && trial * start >= start * start;
    const int falls = breaks && !goes_on && hold > level;
    const double top = copysign(hold, trial);
    const double until = fmax(limited((top - start) / (trial - start), 1.0), 0.0);
    return falls ? until * 0.5 * (start + top) + (1.0 - until) * end : 0.5 * (start + end);
}

