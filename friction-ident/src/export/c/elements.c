/* Mean force and stiffness of the elements at the displacement so far. */
static void respond(Plant *m)
{
    m->elements = 0.0;
    m->stiffness = 0.0;
@RESPOND@}

/* Takes a piece into the elements. */
static void commit(Plant *m)
{
    (void)m;
@COMMIT@}

/* Mean velocity with the elements, from the displacement at hand. */
static void newton(Plant *m)
{
    int k;
    for (k = 0; k <= @ITERATIONS@; k++) {
        const double r = m->left;
        double linear;
        respond(m);
        linear = m->elements - m->stiffness * m->displacement;
        m->mean = (m->push - r * linear) / (m->inertia + r * r * m->stiffness);
        m->displacement = r * m->mean;
    }
}

