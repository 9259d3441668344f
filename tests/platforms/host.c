/* The smallest host of an FMI 2.0 co-simulation library, for any platform: steps it with the inputs on standard input.
 *
 *     host LIBRARY GUID
 *
 * Standard input has the number of inputs and their value references, the number of outputs and their value references, the
 * communication step in s, the number of steps, and for each step the inputs to set before it. Standard output gets
 * the outputs after each step, a line a step, with all their digits.
 *
 * Declarations are written down here as the standard has them, so that nothing has to be installed.
 */
#include <stdarg.h>
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

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate_memory)(size_t, size_t);
    void (*free_memory)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;

static void on_message(void *environment, const char *instance, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s: status %d, %s: ", instance, status, category);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, "\n");
}

static void stop(const char *why) {
    fprintf(stderr, "host: %s\n", why);
    exit(1);
}

static void expect_ok(int status, const char *function) {
    if (status != OK) stop(function);
}

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
    static const Callbacks callbacks = {on_message, calloc, free, NULL, NULL};
    void *library, *instance;
    size_t input_count, output_count, k, n, steps;
    unsigned *inputs, *outputs;
    double *in, *out, step;

    if (argc != 3) stop("usage: host LIBRARY GUID");
    library = load(argv[1]);
    if (!library) stop("the library cannot be loaded");

#define FIND(result, name, ...) \
    result (*name)(__VA_ARGS__) = (result(*)(__VA_ARGS__))find(library, #name); \
    if (!name) stop("the library lacks " #name)
    FIND(void *, fmi2Instantiate, const char *, int, const char *, const char *, const Callbacks *, int, int);
    FIND(int, fmi2SetupExperiment, void *, int, double, double, int, double);
    FIND(int, fmi2EnterInitializationMode, void *);
    FIND(int, fmi2ExitInitializationMode, void *);
    FIND(int, fmi2SetReal, void *, const unsigned *, size_t, const double *);
    FIND(int, fmi2DoStep, void *, double, double, int);
    FIND(int, fmi2GetReal, void *, const unsigned *, size_t, double *);
    FIND(int, fmi2Terminate, void *);
    FIND(void, fmi2FreeInstance, void *);

    inputs = references(&input_count);
    outputs = references(&output_count);
    step = number();
    steps = (size_t)number();
    in = malloc((input_count + 1) * sizeof *in);
    out = malloc((output_count + 1) * sizeof *out);

    instance = fmi2Instantiate("host", CO_SIMULATION, argv[2], NULL, &callbacks, FALSE_, FALSE_);
    if (!instance) stop("fmi2Instantiate");
    expect_ok(fmi2SetupExperiment(instance, FALSE_, 0.0, 0.0, FALSE_, 0.0), "fmi2SetupExperiment");
    expect_ok(fmi2EnterInitializationMode(instance), "fmi2EnterInitializationMode");
    expect_ok(fmi2ExitInitializationMode(instance), "fmi2ExitInitializationMode");
    for (n = 0; n < steps; n++) {
        for (k = 0; k < input_count; k++) in[k] = number();
        expect_ok(fmi2SetReal(instance, inputs, input_count, in), "fmi2SetReal");
        expect_ok(fmi2DoStep(instance, (double)n * step, step, TRUE_), "fmi2DoStep");
        expect_ok(fmi2GetReal(instance, outputs, output_count, out), "fmi2GetReal");
        for (k = 0; k < output_count; k++) printf("%.17g%c", out[k], k + 1 < output_count ? ' ' : '\n');
    }
    expect_ok(fmi2Terminate(instance), "fmi2Terminate");
    fmi2FreeInstance(instance);
    return 0;
}
