/* Makes room for one more sample; drops what nobody can reach any more. */
static int past_room(Past *past)
{
    double *time, *value;
    size_t room;
    if (past->end < past->room) {
        return 1;
    }
    if (past->end > 0) {
        const double oldest = past->time[past->end - 1] - past->length;
        size_t drop = past->first;
        while (drop + 1 < past->end && past->time[drop + 1] < oldest) {
            drop++;
        }
        /* Who asks for a mean asks for a step more. */
        drop = drop > 4 ? drop - 4 : 0;
        if (2 * drop > past->end) {
            memmove(past->time, past->time + drop, (past->end - drop) * sizeof *past->time);
            memmove(past->value, past->value + drop, (past->end - drop) * sizeof *past->value);
            past->end -= drop;
            past->first = past->first > drop ? past->first - drop : 0;
            return 1;
        }
    }
    room = past->room > 0 ? 2 * past->room : 256;
    time = (double *)realloc(past->time, room * sizeof *time);
    if (time == NULL) {
        return 0;
    }
    past->time = time;
    value = (double *)realloc(past->value, room * sizeof *value);
    if (value == NULL) {
        return 0;
    }
    past->value = value;
    past->room = room;
    return 1;
}

static int past_push(Past *past, double time, double value)
{
    if (!past_room(past)) {
        return 0;
    }
    past->time[past->end] = time;
    past->value[past->end] = value;
    past->end++;
    return 1;
}

static int past_start(Past *past, double length, double time, double value, double slope)
{
    past->first = 0;
    past->end = 0;
    past->length = length;
    past->slope = slope;
    return past_push(past, time, value);
}

static double past_at(const Past *past, double time)
{
    size_t low = past->first, high = past->end - 1;
    if (time <= past->time[low]) {
        return past->value[low] + past->slope * (time - past->time[low]);
    }
    if (time >= past->time[high]) {
        return past->value[high];
    }
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (past->time[middle] <= time) {
            low = middle;
        } else {
            high = middle;
        }
    }
    {
        const double from = past->time[low], to = past->time[low + 1];
        const double share = to > from ? (time - from) / (to - from) : 0.0;
        return past->value[low] + share * (past->value[low + 1] - past->value[low]);
    }
}

