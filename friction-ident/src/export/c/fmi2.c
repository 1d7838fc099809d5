/* The plant as a co-simulation slave of FMI 2.0. Between two communication points the input is what was set, plus its
 * first derivative where the master gives one. */
#include "fmi2.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plant.h"

#define GUID "@GUID@"

/* Value references: the input, three outputs, what the start needs, then the parameters of the model. */
enum { INPUT, POSITION, VELOCITY, DRIVE_FORCE, POSITION_START, VELOCITY_START, CONTACT_START, MAX_STEP, FIRST_PARAMETER };
#define REFERENCES (FIRST_PARAMETER + PARAMETERS)

typedef enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED, FAILED } Phase;

typedef struct {
    Plant plant;
    Phase phase;
    int started; /* 1 while the plant is where the start values say */
    double start_time, time;
    double input, input_slope;
    double position_start, velocity_start, contact_start, max_step;
    fmi2CallbackFunctions callbacks;
    char *name;
} Slave;

static fmi2Status failed(Slave *slave, const char *why)
{
    if (slave->callbacks.logger != NULL) {
        slave->callbacks.logger(slave->callbacks.componentEnvironment, slave->name, fmi2Error, "logStatusError", "%s", why);
    }
    return fmi2Error;
}

static void put_defaults(Slave *slave)
{
    plant_defaults(&slave->plant);
    slave->phase = INSTANTIATED;
    slave->started = 0;
    slave->start_time = 0.0;
    slave->time = 0.0;
    slave->input = 0.0;
    slave->input_slope = 0.0;
    slave->position_start = 0.0;
    slave->velocity_start = 0.0;
    slave->contact_start = 0.0;
    slave->max_step = @MAX_STEP@;
}

static fmi2Status start(Slave *slave)
{
    Start at;
    int k;
    for (k = 0; k < PARAMETERS; k++) {
        if (!isfinite(slave->plant.p[k])) {
            return failed(slave, "a parameter is not finite");
        }
    }
    if (!(slave->plant.p[0] > 0.0)) {
        return failed(slave, "the mass must be above 0");
    }
    if (!(slave->max_step > 0.0)) {
        return failed(slave, "max_step must be above 0 s");
    }
    at.time = slave->start_time;
    at.x = slave->position_start;
    at.v = slave->velocity_start;
    at.used = slave->contact_start;
    at.command = slave->input;
    if (!plant_start(&slave->plant, &at)) {
        return failed(slave, "no memory is left");
    }
    slave->time = slave->start_time;
    slave->started = 1;
    return fmi2OK;
}

FMI2_EXPORT const char *FMI2(fmi2GetTypesPlatform)(void)
{
    return "default";
}

FMI2_EXPORT const char *FMI2(fmi2GetVersion)(void)
{
    return "2.0";
}

FMI2_EXPORT fmi2Component FMI2(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                                const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                                                fmi2Boolean logging)
{
    Slave *slave;
    (void)resources;
    (void)visible;
    (void)logging;
    if (type != fmi2CoSimulation || guid == NULL || strcmp(guid, GUID) != 0) {
        if (callbacks != NULL && callbacks->logger != NULL) {
            callbacks->logger(callbacks->componentEnvironment, name, fmi2Error, "logStatusError", "%s",
                              type != fmi2CoSimulation ? "this FMU is for co-simulation" : "the GUID is another model's");
        }
        return NULL;
    }
    slave = (Slave *)calloc(1, sizeof *slave);
    if (slave == NULL) {
        return NULL;
    }
    if (callbacks != NULL) {
        slave->callbacks = *callbacks;
    }
    if (name != NULL) {
        slave->name = (char *)malloc(strlen(name) + 1);
        if (slave->name == NULL) {
            free(slave);
            return NULL;
        }
        strcpy(slave->name, name);
    }
    put_defaults(slave);
    return slave;
}

FMI2_EXPORT void FMI2(fmi2FreeInstance)(fmi2Component c)
{
    Slave *slave = (Slave *)c;
    if (slave != NULL) {
        plant_free(&slave->plant);
        free(slave->name);
        free(slave);
    }
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetDebugLogging)(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)c;
    (void)on;
    (void)count;
    (void)categories;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetupExperiment)(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real from,
                                                 fmi2Boolean ends, fmi2Real to)
{
    Slave *slave = (Slave *)c;
    (void)tolerant;
    (void)tolerance;
    (void)ends;
    (void)to;
    if (slave->phase != INSTANTIATED) {
        return failed(slave, "fmi2SetupExperiment belongs before the initialization");
    }
    slave->start_time = from;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2EnterInitializationMode)(fmi2Component c)
{
    Slave *slave = (Slave *)c;
    if (slave->phase != INSTANTIATED) {
        return failed(slave, "it is initialized already");
    }
    slave->phase = INITIALIZING;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2ExitInitializationMode)(fmi2Component c)
{
    Slave *slave = (Slave *)c;
    if (slave->phase != INITIALIZING) {
        return failed(slave, "fmi2EnterInitializationMode comes first");
    }
    if (start(slave) != fmi2OK) {
        slave->phase = FAILED;
        return fmi2Error;
    }
    slave->phase = STEPPING;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2Terminate)(fmi2Component c)
{
    ((Slave *)c)->phase = TERMINATED;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2Reset)(fmi2Component c)
{
    Slave *slave = (Slave *)c;
    plant_free(&slave->plant);
    put_defaults(slave);
    return fmi2OK;
}

static int get(Slave *slave, fmi2ValueReference reference, double *value)
{
    switch (reference) {
    case INPUT: *value = slave->input; return 1;
    case POSITION: *value = plant_shown(&slave->plant); return 1;
    case VELOCITY: *value = slave->plant.v; return 1;
    case DRIVE_FORCE: *value = slave->plant.drive; return 1;
    case POSITION_START: *value = slave->position_start; return 1;
    case VELOCITY_START: *value = slave->velocity_start; return 1;
    case CONTACT_START: *value = slave->contact_start; return 1;
    case MAX_STEP: *value = slave->max_step; return 1;
    default:
        if (reference >= REFERENCES) {
            return 0;
        }
        *value = slave->plant.p[reference - FIRST_PARAMETER];
        return 1;
    }
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetReal)(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Real values[])
{
    Slave *slave = (Slave *)c;
    size_t k;
    if (slave->phase == INITIALIZING && !slave->started && start(slave) != fmi2OK) {
        return fmi2Error;
    }
    for (k = 0; k < count; k++) {
        if (!get(slave, references[k], &values[k])) {
            return failed(slave, "there is no real variable with this value reference");
        }
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetReal)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                         const fmi2Real values[])
{
    Slave *slave = (Slave *)c;
    size_t k;
    for (k = 0; k < count; k++) {
        const double value = values[k];
        if (references[k] == INPUT) {
            slave->input = value;
            slave->input_slope = 0.0;
        } else if (slave->phase != INSTANTIATED && slave->phase != INITIALIZING) {
            return failed(slave, "parameters and start values can only be set before the simulation");
        } else if (references[k] == POSITION_START) {
            slave->position_start = value;
        } else if (references[k] == VELOCITY_START) {
            slave->velocity_start = value;
        } else if (references[k] == CONTACT_START) {
            slave->contact_start = value;
        } else if (references[k] == MAX_STEP) {
            slave->max_step = value;
        } else if (references[k] >= FIRST_PARAMETER && references[k] < REFERENCES) {
            slave->plant.p[references[k] - FIRST_PARAMETER] = value;
        } else {
            return failed(slave, "this variable cannot be set");
        }
    }
    slave->started = slave->phase == STEPPING;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetRealInputDerivatives)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                                         const fmi2Integer orders[], const fmi2Real values[])
{
    Slave *slave = (Slave *)c;
    size_t k;
    for (k = 0; k < count; k++) {
        if (references[k] != INPUT || orders[k] != 1) {
            return failed(slave, "only the input has a derivative here, and only the first one");
        }
        slave->input_slope = values[k];
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2DoStep)(fmi2Component c, fmi2Real at, fmi2Real length, fmi2Boolean no_way_back)
{
    Slave *slave = (Slave *)c;
    double steps, duration;
    long k;
    (void)at;
    (void)no_way_back;
    if (slave->phase != STEPPING) {
        return failed(slave, "fmi2DoStep comes after the initialization");
    }
    if (!(length > 0.0) || !isfinite(length)) {
        return failed(slave, "the communication step must be above 0 s");
    }
    /* What exceeds the longest step by rounding alone is one step. */
    steps = fmax(ceil(length / slave->max_step - 1e-6), 1.0);
    duration = length / steps;
    for (k = 0; k < (long)steps; k++) {
        const double middle = (((double)k + 0.5) / steps) * length;
        if (!plant_step(&slave->plant, duration, slave->input + middle * slave->input_slope)) {
            slave->phase = FAILED;
            return failed(slave, "no memory is left");
        }
    }
    slave->time += length;
    if (!isfinite(slave->plant.x) || !isfinite(slave->plant.v)) {
        slave->phase = FAILED;
        return failed(slave, "the motion is no longer finite");
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2CancelStep)(fmi2Component c)
{
    return failed((Slave *)c, "steps are not asynchronous");
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetRealStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    Slave *slave = (Slave *)c;
    if (kind != fmi2LastSuccessfulTime) {
        return fmi2Discard;
    }
    *value = slave->time;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetBooleanStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    Slave *slave = (Slave *)c;
    if (kind != fmi2Terminated) {
        return fmi2Discard;
    }
    *value = slave->phase == TERMINATED || slave->phase == FAILED;
    return fmi2OK;
}

/* What this FMU has not: variables that are no reals, states to be kept, asynchronous steps, derivatives of outputs. */
static fmi2Status none(fmi2Component c, size_t count)
{
    return count == 0 ? fmi2OK : failed((Slave *)c, "this FMU has only real variables");
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetInteger)(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Integer values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetInteger)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                    const fmi2Integer values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetBoolean)(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Boolean values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetBoolean)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                    const fmi2Boolean values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetString)(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2String values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetString)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                    const fmi2String values[])
{
    (void)references;
    (void)values;
    return none(c, count);
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    (void)state;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate state)
{
    (void)state;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    (void)state;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)state;
    (void)size;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2SerializeFMUstate)(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    (void)state;
    (void)bytes;
    (void)size;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2DeSerializeFMUstate)(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    (void)bytes;
    (void)size;
    (void)state;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetDirectionalDerivative)(fmi2Component c, const fmi2ValueReference of[], size_t count, const fmi2ValueReference by[],
    size_t known, const fmi2Real seed[], fmi2Real values[])
{
    (void)of;
    (void)count;
    (void)by;
    (void)known;
    (void)seed;
    (void)values;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetRealOutputDerivatives)(fmi2Component c, const fmi2ValueReference references[], size_t count,
    const fmi2Integer orders[], fmi2Real values[])
{
    (void)references;
    (void)count;
    (void)orders;
    (void)values;
    return failed((Slave *)c, "modelDescription.xml does not offer this function");
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetIntegerStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

FMI2_EXPORT fmi2Status FMI2(fmi2GetStringStatus)(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}
