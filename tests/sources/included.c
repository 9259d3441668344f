/* The sources of the washout's FMU of FMI 2.0, compiled into one program with the host that tests them: function names have
 * the model's prefix, and calls of the C library's allocation are counted.
 *
 *     included GUID INPUT INPUT INPUT OUTPUT ... (value references: three inputs, six outputs)
 */
#include <stdio.h>
#include <stdlib.h>

static unsigned allocations;

static void *counted_malloc(size_t size) {
    allocations++;
    return malloc(size);
}

static void *counted_calloc(size_t count, size_t size) {
    allocations++;
    return calloc(count, size);
}

static void *counted_realloc(void *memory, size_t size) {
    allocations++;
    return realloc(memory, size);
}

#define malloc counted_malloc
#define calloc counted_calloc
#define realloc counted_realloc
#include "MorisWashout.c"

enum { CO_SIMULATION = 1, STEPS = 200, SAVED = 300 };

static int failures;
static char last_message[1000];

static void check(bool passed, const char *what) {
    if (!passed) fprintf(stderr, "FAILED: %s (last message: %s)\n", what, last_message);
    failures += !passed;
}

static void log_text(void *environment, const char *name, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment, (void)name, (void)status, (void)category;
    va_start(arguments, format);
    vsnprintf(last_message, sizeof last_message, format, arguments);
    va_end(arguments);
}

static const Callbacks callbacks = {log_text, NULL, NULL, NULL, NULL};

/* Value references of the inputs set and the outputs read. */
static u32 inputs[3], outputs[6];

static void *initialized(const char *guid) {
    void *const instance = MorisWashout_fmi2Instantiate("one", CO_SIMULATION, guid, NULL, &callbacks, 0, 0);
    check(instance != NULL, "instantiation");
    if (!instance) exit(1);
    check(MorisWashout_fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0) == STATUS_OK, "fmi2SetupExperiment");
    check(MorisWashout_fmi2EnterInitializationMode(instance) == STATUS_OK, "fmi2EnterInitializationMode");
    check(MorisWashout_fmi2ExitInitializationMode(instance) == STATUS_OK, "fmi2ExitInitializationMode");
    return instance;
}

/* Steps from step `first` on, and leaves the last outputs in `values`. */
static void ride(void *instance, int first, int count, double values[6]) {
    int k;
    for (k = first; k < first + count; k++) {
        const double input[3] = {2.0 * sin(0.03 * k), 1.5 * cos(0.02 * k), 0.2 * sin(0.01 * k)};
        int status = MorisWashout_fmi2SetReal(instance, inputs, 3, input);
        if (status == STATUS_OK) status = MorisWashout_fmi2DoStep(instance, 0.01 * k, 0.01, 1);
        if (status == STATUS_OK) status = MorisWashout_fmi2GetReal(instance, outputs, 6, values);
        check(status == STATUS_OK, "a step");
    }
}

static bool same(const double a[6], const double b[6]) { return memcmp(a, b, 6 * sizeof *a) == 0; }

static void nothing_is_allocated_in_a_step(void *instance) {
    const unsigned before = allocations;
    double values[6];
    check(before > 0, "allocations are counted");
    ride(instance, 0, STEPS, values);
    check(allocations == before, "no allocation in a step");
    check(values[0] != 0.0 && values[0] != values[1], "the platform moves");
}

static void a_state_goes_back_and_to_another_instance(void *instance, const char *guid) {
    void *const other = initialized(guid), *state = NULL, *copy = NULL;
    double expected[6], again[6], elsewhere[6];
    size_t size = 0;
    u8 *bytes;
    check(MorisWashout_fmi2GetFMUstate(instance, &state) == STATUS_OK, "fmi2GetFMUstate");
    ride(instance, STEPS, STEPS, expected);
    check(MorisWashout_fmi2SetFMUstate(instance, state) == STATUS_OK, "fmi2SetFMUstate");
    ride(instance, STEPS, STEPS, again);
    check(same(expected, again), "a state repeats the ride");
    check(MorisWashout_fmi2SerializedFMUstateSize(instance, state, &size) == STATUS_OK && size > 0, "a state's size");
    bytes = malloc(size);
    check(MorisWashout_fmi2SerializeFMUstate(instance, state, bytes, size - 1) == STATUS_ERROR, "too little room");
    check(MorisWashout_fmi2SerializeFMUstate(instance, state, bytes, size) == STATUS_OK, "fmi2SerializeFMUstate");
    check(MorisWashout_fmi2DeSerializeFMUstate(other, bytes, size, &copy) == STATUS_OK, "fmi2DeSerializeFMUstate");
    check(MorisWashout_fmi2SetFMUstate(other, copy) == STATUS_OK, "a state of another instance");
    ride(other, STEPS, STEPS, elsewhere);
    check(same(expected, elsewhere), "another instance repeats the ride");
    bytes[size / 2] ^= 1;
    check(MorisWashout_fmi2DeSerializeFMUstate(other, bytes, size, &copy) == STATUS_ERROR, "a damaged state");
    check(MorisWashout_fmi2FreeFMUstate(instance, &state) == STATUS_OK && !state, "fmi2FreeFMUstate");
    check(MorisWashout_fmi2FreeFMUstate(other, &copy) == STATUS_OK && !copy, "fmi2FreeFMUstate");
    check(MorisWashout_fmi2SetFMUstate(instance, NULL) == STATUS_ERROR, "no state");
    free(bytes);
    MorisWashout_fmi2FreeInstance(other);
}

static void many_states_take_no_memory_of_the_module(void *instance) {
    static void *states[SAVED];
    int k;
    for (k = 0; k < SAVED; k++) check(MorisWashout_fmi2GetFMUstate(instance, &states[k]) == STATUS_OK, "a state of many");
    for (k = 0; k < SAVED; k++) check(MorisWashout_fmi2FreeFMUstate(instance, &states[k]) == STATUS_OK, "freeing it");
}

static void faults_of_a_host_are_refused(void *instance) {
    const u32 unknown = 1000000;
    double value = 1.0;
    check(!MorisWashout_fmi2Instantiate("one", CO_SIMULATION, "{no}", NULL, &callbacks, 0, 0), "another GUID");
    check(strstr(last_message, "{no}") != NULL, "its message");
    check(!MorisWashout_fmi2Instantiate("one", CO_SIMULATION, "{no}", NULL, NULL, 0, 0), "no callbacks");
    check(MorisWashout_fmi2GetReal(NULL, inputs, 1, &value) == STATUS_ERROR, "no instance");
    check(MorisWashout_fmi2GetReal(instance, &unknown, 1, &value) == STATUS_ERROR && value == 1.0, "no such variable");
    check(MorisWashout_fmi2GetReal(instance, NULL, 1, &value) == STATUS_ERROR, "no value references");
    check(MorisWashout_fmi2SetReal(instance, inputs, SIZE_MAX, &value) == STATUS_ERROR, "too many values");
    check(MorisWashout_fmi2DoStep(instance, 1e6, 0.01, 1) == STATUS_ERROR, "another time");
    check(MorisWashout_fmi2SetTime(instance, 0.0) == STATUS_ERROR, "model exchange");
    check(strstr(last_message, "fmi2SetTime: not allowed") != NULL, "its message");
    value = NAN;
    check(MorisWashout_fmi2SetReal(instance, inputs, 1, &value) == 2, "NaN is discarded");
}

/* Without memory the module traps. */
static void a_trap_is_fatal_for_one_instance(void *instance, const char *guid) {
    Instance *const starved = initialized(guid);
    double values[6];
    int k, status;
    starved->module.w2c_memory.max_pages = starved->module.w2c_memory.pages;
    for (k = 0; k < 1000 && !starved->broken; k++) {
        const u32 none = 0;
        u32 place;
        starved->used = 0;
        place = in(starved, &none, 1, sizeof none);
        /* A state that stays in the module. */
        GUARDED(starved, status, (int)FUNCTION(fmi2GetFMUstate)(&starved->module, starved->address, place));
    }
    check(starved->broken && status == STATUS_FATAL, "the module runs out of memory");
    check(MorisWashout_fmi2DoStep(starved, 0.0, 0.01, 1) == STATUS_FATAL, "a step after it");
    MorisWashout_fmi2FreeInstance(starved);
    ride(instance, 2 * STEPS, 1, values);
}

int main(int argc, char **argv) {
    void *instance;
    int k;
    if (argc != 11) return 2;
    for (k = 0; k < 3; k++) inputs[k] = (u32)atoi(argv[2 + k]);
    for (k = 0; k < 6; k++) outputs[k] = (u32)atoi(argv[5 + k]);
    instance = initialized(argv[1]);
    nothing_is_allocated_in_a_step(instance);
    a_state_goes_back_and_to_another_instance(instance, argv[1]);
    many_states_take_no_memory_of_the_module(instance);
    faults_of_a_host_are_refused(instance);
    a_trap_is_fatal_for_one_instance(instance, argv[1]);
    check(MorisWashout_fmi2Terminate(instance) == STATUS_OK, "fmi2Terminate");
    MorisWashout_fmi2FreeInstance(instance);
    return failures != 0;
}
