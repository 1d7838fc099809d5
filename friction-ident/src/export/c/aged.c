/* The age of contacts after a piece at a steady speed, of which exp(-renewed) outlasts. */
static double aged(double age, double duration, double renewed)
{
    const double left = exp(-renewed);
    const double mean = renewed < 1e-3 ? 1.0 - renewed * (0.5 - renewed / 6.0) : (1.0 - left) / renewed;
    return age * left + duration * mean;
}


