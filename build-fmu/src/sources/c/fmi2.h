/* The functions of FMI 2.0 for co-simulation, by the module's functions of the same names. */

typedef void (*HostLogger)(void *environment, const char *instance_name, int status, const char *category,
                           const char *message, ...);

typedef struct {
  HostLogger logger;
  void *(*allocate_memory)(size_t count, size_t size);
  void (*free_memory)(void *memory);
  void (*step_finished)(void *environment, int status);
  void *environment;
} Callbacks;

#ifdef FMI2_Export
#define FMI_EXPORT FMI2_Export
#endif
#ifdef FMI2_OVERRIDE_FUNCTION_PREFIX
#ifdef FMI2_ACTUAL_FUNCTION_PREFIX
#define FMI_FUNCTION_PREFIX FMI2_ACTUAL_FUNCTION_PREFIX
#endif
#elif defined FMI2_FUNCTION_PREFIX
#define FMI_FUNCTION_PREFIX FMI2_FUNCTION_PREFIX
#else
#define FMI_FUNCTION_PREFIX OWN_FUNCTION_PREFIX
#endif

#include "instance.h"

static void report(Instance *instance, int status, const char *category, const char *text) {
  if (instance->logger) instance->logger(instance->environment, "", status, category, "%s", text);
}

/* Called by the module. The message is "%s", and its argument the text. */
static void log_message(void *pointer, u32 environment, u32 name, u32 status, u32 category, u32 message, u32 arguments) {
  Instance *const instance = pointer;
  (void)environment;
  instance->logger(instance->environment, text_at(instance, name), (int)status, text_at(instance, category),
                   text_at(instance, message), text_at(instance, word_at(instance, arguments)));
}

FMI_EXPORT const char *FMI(fmi2GetTypesPlatform)(void) { return "default"; }
FMI_EXPORT const char *FMI(fmi2GetVersion)(void) { return "2.0"; }

FMI_EXPORT void *FMI(fmi2Instantiate)(const char *name, int type, const char *guid, const char *resources,
                                      const Callbacks *callbacks, int visible, int logging_on) {
  const uint32_t log_type = wasm_rt_register_func_type(6, 0, WASM_RT_I32, WASM_RT_I32, WASM_RT_I32, WASM_RT_I32,
                                                       WASM_RT_I32, WASM_RT_I32);
  /* As in the module: five words. */
  u32 own_callbacks[5] = {0, 0, 0, 0, 0}, own_name, own_guid, place;
  Instance *instance;
  int address = 0;
  (void)resources;
  if (!callbacks) return NULL;
  instance = new_instance(log_type, (wasm_rt_function_ptr_t)log_message);
  if (!instance) return NULL;
  instance->logger = callbacks->logger;
  instance->environment = callbacks->environment;
  own_callbacks[0] = log_function(instance);
  instance->used = 0;
  own_name = in_text(instance, name);
  own_guid = in_text(instance, guid);
  place = in(instance, own_callbacks, 1, sizeof own_callbacks);
  GUARDED(instance, address,
          (int)FUNCTION(fmi2Instantiate)(&instance->module, own_name, (u32)type, own_guid, 0, place, (u32)visible,
                                         (u32)logging_on));
  return made(instance, address);
}

FREE_INSTANCE(fmi2FreeInstance)

FMI_EXPORT int FMI(fmi2SetDebugLogging)(void *pointer, int logging_on, size_t count, const char *const categories[]) {
  u32 list;
  BEGIN(pointer);
  list = in_texts(instance, categories, count);
  CALL(fmi2SetDebugLogging, instance->address, (u32)logging_on, count32(count), list);
  return status;
}

FMI_EXPORT int FMI(fmi2SetupExperiment)(void *pointer, int tolerance_defined, double tolerance, double start_time,
                                        int stop_time_defined, double stop_time) {
  BEGIN(pointer);
  CALL(fmi2SetupExperiment, instance->address, (u32)tolerance_defined, tolerance, start_time, (u32)stop_time_defined,
       stop_time);
  return status;
}

WITHOUT_ARGUMENTS(fmi2EnterInitializationMode)
WITHOUT_ARGUMENTS(fmi2ExitInitializationMode)
WITHOUT_ARGUMENTS(fmi2Terminate)
WITHOUT_ARGUMENTS(fmi2Reset)

FMI_EXPORT int FMI(fmi2DoStep)(void *pointer, double time, double step, int no_going_back) {
  BEGIN(pointer);
  CALL(fmi2DoStep, instance->address, time, step, (u32)no_going_back);
  return status;
}

#define GET(name, type) \
  FMI_EXPORT int FMI(name)(void *pointer, const u32 references[], size_t count, type values[]) { \
    u32 own_references, place; \
    BEGIN(pointer); \
    own_references = in(instance, references, count, sizeof *references); \
    place = in(instance, values, count, sizeof *values); \
    CALL(name, instance->address, own_references, count32(count), place); \
    out(instance, values, place, count, sizeof *values); \
    return status; \
  }
GET(fmi2GetReal, double)
GET(fmi2GetInteger, int)
GET(fmi2GetBoolean, int)

#define SET(name, type) \
  FMI_EXPORT int FMI(name)(void *pointer, const u32 references[], size_t count, const type values[]) { \
    u32 own_references, place; \
    BEGIN(pointer); \
    own_references = in(instance, references, count, sizeof *references); \
    place = in(instance, values, count, sizeof *values); \
    CALL(name, instance->address, own_references, count32(count), place); \
    return status; \
  }
SET(fmi2SetReal, double)
SET(fmi2SetInteger, int)
SET(fmi2SetBoolean, int)

FMI_EXPORT int FMI(fmi2SetRealInputDerivatives)(void *pointer, const u32 references[], size_t count, const int orders[],
                                                const double values[]) {
  u32 own_references, own_orders, place;
  BEGIN(pointer);
  own_references = in(instance, references, count, sizeof *references);
  own_orders = in(instance, orders, count, sizeof *orders);
  place = in(instance, values, count, sizeof *values);
  CALL(fmi2SetRealInputDerivatives, instance->address, own_references, count32(count), own_orders, place);
  return status;
}

FMI_EXPORT int FMI(fmi2GetRealOutputDerivatives)(void *pointer, const u32 references[], size_t count,
                                                 const int orders[], double values[]) {
  u32 own_references, own_orders, place;
  BEGIN(pointer);
  own_references = in(instance, references, count, sizeof *references);
  own_orders = in(instance, orders, count, sizeof *orders);
  place = in(instance, values, count, sizeof *values);
  CALL(fmi2GetRealOutputDerivatives, instance->address, own_references, count32(count), own_orders, place);
  out(instance, values, place, count, sizeof *values);
  return status;
}

#define GET_STATUS(name, type) \
  FMI_EXPORT int FMI(name)(void *pointer, int kind, type *value) { \
    u32 place; \
    BEGIN(pointer); \
    place = in(instance, value, 1, sizeof *value); \
    CALL(name, instance->address, (u32)kind, place); \
    out(instance, value, place, 1, sizeof *value); \
    return status; \
  }
GET_STATUS(fmi2GetStatus, int)
GET_STATUS(fmi2GetRealStatus, double)
GET_STATUS(fmi2GetIntegerStatus, int)
GET_STATUS(fmi2GetBooleanStatus, int)

STATE_FUNCTIONS(fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate, fmi2SerializedFMUstateSize, fmi2SerializeFMUstate,
                fmi2DeSerializeFMUstate)

/* Strings, which no variable is; what is not provided; model exchange. */

#define NO_STRING(name, type) \
  UNSUPPORTED(name, (void *pointer, const u32 references[], size_t count, type values[]), \
              ((void)references, (void)values, 0), count32(count), 0)
NO_STRING(fmi2GetString, const char *)
NO_STRING(fmi2SetString, const char *const)
UNSUPPORTED(fmi2GetStringStatus, (void *pointer, int kind, const char **value), ((void)value, (u32)kind), 0)
UNSUPPORTED(fmi2GetDirectionalDerivative,
            (void *pointer, const u32 unknowns[], size_t unknown_count, const u32 knowns[], size_t known_count,
             const double known_values[], double values[]),
            ((void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)known_values, (void)values, 0),
            0, 0, 0, 0, 0)
WITHOUT_ARGUMENTS(fmi2CancelStep)
WITHOUT_ARGUMENTS(fmi2EnterEventMode)
WITHOUT_ARGUMENTS(fmi2EnterContinuousTimeMode)
UNSUPPORTED(fmi2NewDiscreteStates, (void *pointer, void *info), ((void)info, 0))
UNSUPPORTED(fmi2CompletedIntegratorStep, (void *pointer, int no_set, int *enter_event_mode, int *terminate),
            ((void)enter_event_mode, (void)terminate, (u32)no_set), 0, 0)
UNSUPPORTED(fmi2SetTime, (void *pointer, double time), time)
#define OF_STATES(name, type) \
  UNSUPPORTED(name, (void *pointer, type values[], size_t count), ((void)values, (void)count, 0), 0)
OF_STATES(fmi2SetContinuousStates, const double)
OF_STATES(fmi2GetDerivatives, double)
OF_STATES(fmi2GetEventIndicators, double)
OF_STATES(fmi2GetContinuousStates, double)
OF_STATES(fmi2GetNominalsOfContinuousStates, double)
