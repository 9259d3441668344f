/* The smallest host of a co-simulation library, FMI 2.0 or 3.0, for any platform: steps it with the inputs on standard input.
 *
 *     host LIBRARY VERSION TOKEN
 *
 * VERSION is 2 or 3; TOKEN is the GUID or the instantiation token. Standard input has the number of enumerations to set before
 * initialization, the value reference and the item of each, the number of inputs and their value references, the number of outputs and their value references, the communication step in s, the number of steps, and for
 * each step the inputs to set before it. Standard output gets the outputs after each step, a line a step, with all their
 * digits.
 *
 * Declarations are written down here as the standards have them, so that nothing has to be installed.
 */
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>
static void *load(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *load(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

enum { OK = 0, CO_SIMULATION = 1, FALSE_ = 0, TRUE_ = 1 };

static void stop(const char *why) {
    fprintf(stderr, "host: %s\n", why);
    exit(1);
}

static void expect_ok(int status, const char *function) {
    if (status != OK) stop(function);
}

#define CALL(function, ...) expect_ok(function(__VA_ARGS__), #function)

/* Each list has a function's result, name and arguments. */
#define DECLARE(result, name, ...) static result (*name)(__VA_ARGS__);
#define FIND(result, name, ...) \
    name = (result(*)(__VA_ARGS__))find(library, #name); \
    if (!name) stop("the library lacks " #name);

/* A loaded library's one instance, whatever its version. */
typedef struct {
    void *(*start)(void *library, const char *token);
    void (*choose)(void *instance, unsigned reference, int item);
    void (*initialize)(void *instance);
    void (*set)(void *instance, const unsigned *references, size_t count, const double *values);
    void (*step)(void *instance, double time, double step);
    void (*get)(void *instance, const unsigned *references, size_t count, double *values);
    void (*end)(void *instance);
} Version;

/* FMI 2.0 */

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate_memory)(size_t, size_t);
    void (*free_memory)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;

#define FMI2(F) \
    F(void *, fmi2Instantiate, const char *, int, const char *, const char *, const Callbacks *, int, int) \
    F(int, fmi2SetupExperiment, void *, int, double, double, int, double) \
    F(int, fmi2EnterInitializationMode, void *) \
    F(int, fmi2ExitInitializationMode, void *) \
    F(int, fmi2SetInteger, void *, const unsigned *, size_t, const int *) \
    F(int, fmi2SetReal, void *, const unsigned *, size_t, const double *) \
    F(int, fmi2DoStep, void *, double, double, int) \
    F(int, fmi2GetReal, void *, const unsigned *, size_t, double *) \
    F(int, fmi2Terminate, void *) \
    F(void, fmi2FreeInstance, void *)

FMI2(DECLARE)

static void log2_message(void *environment, const char *instance, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s: status %d, %s: ", instance, status, category);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, "\n");
}

static void *start2(void *library, const char *token) {
    static const Callbacks callbacks = {log2_message, calloc, free, NULL, NULL};
    void *instance;
    FMI2(FIND)
    instance = fmi2Instantiate("host", CO_SIMULATION, token, NULL, &callbacks, FALSE_, FALSE_);
    if (!instance) stop("fmi2Instantiate");
    return instance;
}

static void choose2(void *instance, unsigned reference, int item) { CALL(fmi2SetInteger, instance, &reference, 1, &item); }

static void initialize2(void *instance) {
    CALL(fmi2SetupExperiment, instance, FALSE_, 0.0, 0.0, FALSE_, 0.0);
    CALL(fmi2EnterInitializationMode, instance);
    CALL(fmi2ExitInitializationMode, instance);
}

static void set2(void *instance, const unsigned *references, size_t count, const double *values) {
    CALL(fmi2SetReal, instance, references, count, values);
}

static void step2(void *instance, double time, double step) { CALL(fmi2DoStep, instance, time, step, TRUE_); }

static void get2(void *instance, const unsigned *references, size_t count, double *values) {
    CALL(fmi2GetReal, instance, references, count, values);
}

static void end2(void *instance) {
    CALL(fmi2Terminate, instance);
    fmi2FreeInstance(instance);
}

/* FMI 3.0 */

typedef void (*LogMessage)(void *, int, const char *, const char *);

#define FMI3(F) \
    F(void *, fmi3InstantiateCoSimulation, const char *, const char *, const char *, bool, bool, bool, bool, \
      const unsigned *, size_t, void *, LogMessage, void (*)(void)) \
    F(int, fmi3EnterInitializationMode, void *, bool, double, double, bool, double) \
    F(int, fmi3ExitInitializationMode, void *) \
    F(int, fmi3SetInt64, void *, const unsigned *, size_t, const long long *, size_t) \
    F(int, fmi3SetFloat64, void *, const unsigned *, size_t, const double *, size_t) \
    F(int, fmi3DoStep, void *, double, double, bool, bool *, bool *, bool *, double *) \
    F(int, fmi3GetFloat64, void *, const unsigned *, size_t, double *, size_t) \
    F(int, fmi3Terminate, void *) \
    F(void, fmi3FreeInstance, void *)

FMI3(DECLARE)

static void log3_message(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    fprintf(stderr, "status %d, %s: %s\n", status, category, message);
}

static void *start3(void *library, const char *token) {
    void *instance;
    FMI3(FIND)
    instance = fmi3InstantiateCoSimulation("host", token, NULL, false, false, false, false, NULL, 0, NULL, log3_message, NULL);
    if (!instance) stop("fmi3InstantiateCoSimulation");
    return instance;
}

static void choose3(void *instance, unsigned reference, int item) {
    const long long value = item;
    CALL(fmi3SetInt64, instance, &reference, 1, &value, 1);
}

static void initialize3(void *instance) {
    CALL(fmi3EnterInitializationMode, instance, false, 0.0, 0.0, false, 0.0);
    CALL(fmi3ExitInitializationMode, instance);
}

static void set3(void *instance, const unsigned *references, size_t count, const double *values) {
    CALL(fmi3SetFloat64, instance, references, count, values, count);
}

static void step3(void *instance, double time, double step) {
    bool event = true, terminate = true, early = true;
    double last;
    CALL(fmi3DoStep, instance, time, step, true, &event, &terminate, &early, &last);
    if (event || terminate || early) stop("fmi3DoStep asks for an event, wants to end, or returned early");
}

static void get3(void *instance, const unsigned *references, size_t count, double *values) {
    CALL(fmi3GetFloat64, instance, references, count, values, count);
}

static void end3(void *instance) {
    CALL(fmi3Terminate, instance);
    fmi3FreeInstance(instance);
}

/* What stands on standard input. */

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1) stop("a number is missing");
    return value;
}

static unsigned *references(size_t *count) {
    size_t k;
    unsigned *list;
    *count = (size_t)number();
    list = malloc((*count + 1) * sizeof *list);
    for (k = 0; k < *count; k++) list[k] = (unsigned)number();
    return list;
}

int main(int argc, char **argv) {
    static const Version versions[] = {{start2, choose2, initialize2, set2, step2, get2, end2},
                                       {start3, choose3, initialize3, set3, step3, get3, end3}};
    const Version *version;
    void *library, *instance;
    size_t input_count, output_count, k, n, steps;
    unsigned *inputs, *outputs;
    double *in, *out, step;

    if (argc != 4 || (argv[2][0] != '2' && argv[2][0] != '3')) stop("usage: host LIBRARY 2|3 TOKEN");
    version = &versions[argv[2][0] - '2'];
    library = load(argv[1]);
    if (!library) stop("the library cannot be loaded");

    instance = version->start(library, argv[3]);
    for (k = (size_t)number(); k > 0; k--) {
        const unsigned reference = (unsigned)number();
        version->choose(instance, reference, (int)number());
    }
    version->initialize(instance);

    inputs = references(&input_count);
    outputs = references(&output_count);
    step = number();
    steps = (size_t)number();
    in = malloc((input_count + 1) * sizeof *in);
    out = malloc((output_count + 1) * sizeof *out);

    for (n = 0; n < steps; n++) {
        for (k = 0; k < input_count; k++) in[k] = number();
        version->set(instance, inputs, input_count, in);
        version->step(instance, (double)n * step, step);
        version->get(instance, outputs, output_count, out);
        for (k = 0; k < output_count; k++) printf("%.17g%c", out[k], k + 1 < output_count ? ' ' : '\n');
    }
    version->end(instance);
    return 0;
}
