/* The functions of FMI 3.0 for co-simulation, by the module's functions of the same names. */

typedef void (*HostLogger)(void *environment, int status, const char *category, const char *message);
typedef void (*UnusedCallback)(void);

#ifdef FMI3_Export
#define FMI_EXPORT FMI3_Export
#endif
#ifdef FMI3_OVERRIDE_FUNCTION_PREFIX
#ifdef FMI3_ACTUAL_FUNCTION_PREFIX
#define FMI_FUNCTION_PREFIX FMI3_ACTUAL_FUNCTION_PREFIX
#endif
#elif defined FMI3_FUNCTION_PREFIX
#define FMI_FUNCTION_PREFIX FMI3_FUNCTION_PREFIX
#else
#define FMI_FUNCTION_PREFIX OWN_FUNCTION_PREFIX
#endif

#include "instance.h"

static void report(Instance *instance, int status, const char *category, const char *text) {
  if (instance->logger) instance->logger(instance->environment, status, category, text);
}

/* Called by the module. */
static void log_message(void *pointer, u32 environment, u32 status, u32 category, u32 message) {
  Instance *const instance = pointer;
  (void)environment;
  report(instance, (int)status, text_at(instance, category), text_at(instance, message));
}

FMI_EXPORT const char *FMI(fmi3GetVersion)(void) { return "3.0"; }

FMI_EXPORT void *FMI(fmi3InstantiateCoSimulation)(const char *name, const char *token, const char *resources,
                                                  bool visible, bool logging_on, bool event_mode_used,
                                                  bool early_return_allowed, const u32 intermediate_variables[],
                                                  size_t intermediate_variable_count, void *environment,
                                                  HostLogger logger, UnusedCallback intermediate_update) {
  const uint32_t log_type = wasm_rt_register_func_type(4, 0, WASM_RT_I32, WASM_RT_I32, WASM_RT_I32, WASM_RT_I32);
  Instance *const instance = new_instance(log_type, (wasm_rt_function_ptr_t)log_message);
  u32 own_name, own_token;
  int address = 0;
  (void)resources;
  (void)intermediate_variables;
  (void)intermediate_update;
  if (!instance) return NULL;
  instance->logger = logger;
  instance->environment = environment;
  instance->used = 0;
  own_name = in_text(instance, name);
  own_token = in_text(instance, token);
  GUARDED(instance, address,
          (int)FUNCTION(fmi3InstantiateCoSimulation)(&instance->module, own_name, own_token, 0, visible, logging_on,
                                                     event_mode_used, early_return_allowed, 0,
                                                     count32(intermediate_variable_count), 0, log_function(instance),
                                                     0));
  return made(instance, address);
}

static void *refuse(const char *text, void *environment, HostLogger logger) {
  if (logger) logger(environment, STATUS_ERROR, "logStatusError", text);
  return NULL;
}

FMI_EXPORT void *FMI(fmi3InstantiateModelExchange)(const char *name, const char *token, const char *resources,
                                                   bool visible, bool logging_on, void *environment,
                                                   HostLogger logger) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging_on;
  return refuse("fmi3InstantiateModelExchange: this FMU is for co-simulation only; use fmi3InstantiateCoSimulation",
                environment, logger);
}

FMI_EXPORT void *FMI(fmi3InstantiateScheduledExecution)(const char *name, const char *token, const char *resources,
                                                        bool visible, bool logging_on, void *environment,
                                                        HostLogger logger, UnusedCallback clock_update,
                                                        UnusedCallback lock, UnusedCallback unlock) {
  (void)name, (void)token, (void)resources, (void)visible, (void)logging_on, (void)clock_update, (void)lock;
  (void)unlock;
  return refuse(
      "fmi3InstantiateScheduledExecution: this FMU is for co-simulation only; use fmi3InstantiateCoSimulation",
      environment, logger);
}

FREE_INSTANCE(fmi3FreeInstance)

FMI_EXPORT int FMI(fmi3SetDebugLogging)(void *pointer, bool logging_on, size_t count, const char *const categories[]) {
  u32 list;
  BEGIN(pointer);
  list = in_texts(instance, categories, count);
  CALL(fmi3SetDebugLogging, instance->address, logging_on, count32(count), list);
  return status;
}

FMI_EXPORT int FMI(fmi3EnterInitializationMode)(void *pointer, bool tolerance_defined, double tolerance,
                                                double start_time, bool stop_time_defined, double stop_time) {
  BEGIN(pointer);
  CALL(fmi3EnterInitializationMode, instance->address, tolerance_defined, tolerance, start_time, stop_time_defined,
       stop_time);
  return status;
}

WITHOUT_ARGUMENTS(fmi3ExitInitializationMode)
WITHOUT_ARGUMENTS(fmi3Terminate)
WITHOUT_ARGUMENTS(fmi3Reset)

FMI_EXPORT int FMI(fmi3DoStep)(void *pointer, double time, double step, bool no_going_back,
                               bool *event_handling_needed, bool *terminate, bool *early_return, double *last_time) {
  u32 places[4];
  BEGIN(pointer);
  places[0] = in(instance, event_handling_needed, 1, sizeof(bool));
  places[1] = in(instance, terminate, 1, sizeof(bool));
  places[2] = in(instance, early_return, 1, sizeof(bool));
  places[3] = in(instance, last_time, 1, sizeof(double));
  CALL(fmi3DoStep, instance->address, time, step, no_going_back, places[0], places[1], places[2], places[3]);
  out(instance, event_handling_needed, places[0], 1, sizeof(bool));
  out(instance, terminate, places[1], 1, sizeof(bool));
  out(instance, early_return, places[2], 1, sizeof(bool));
  out(instance, last_time, places[3], 1, sizeof(double));
  return status;
}

#define GET(name, type) \
  FMI_EXPORT int FMI(name)(void *pointer, const u32 references[], size_t count, type values[], size_t value_count) { \
    u32 own_references, place; \
    BEGIN(pointer); \
    own_references = in(instance, references, count, sizeof *references); \
    place = in(instance, values, value_count, sizeof *values); \
    CALL(name, instance->address, own_references, count32(count), place, count32(value_count)); \
    out(instance, values, place, value_count, sizeof *values); \
    return status; \
  }
GET(fmi3GetFloat64, double)
GET(fmi3GetInt32, int32_t)
GET(fmi3GetInt64, int64_t)
GET(fmi3GetBoolean, bool)

#define SET(name, type) \
  FMI_EXPORT int FMI(name)(void *pointer, const u32 references[], size_t count, const type values[], \
                           size_t value_count) { \
    u32 own_references, place; \
    BEGIN(pointer); \
    own_references = in(instance, references, count, sizeof *references); \
    place = in(instance, values, value_count, sizeof *values); \
    CALL(name, instance->address, own_references, count32(count), place, count32(value_count)); \
    return status; \
  }
SET(fmi3SetFloat64, double)
SET(fmi3SetInt32, int32_t)
SET(fmi3SetInt64, int64_t)
SET(fmi3SetBoolean, bool)

FMI_EXPORT int FMI(fmi3GetOutputDerivatives)(void *pointer, const u32 references[], size_t count,
                                             const int32_t orders[], double values[], size_t value_count) {
  u32 own_references, own_orders, place;
  BEGIN(pointer);
  own_references = in(instance, references, count, sizeof *references);
  own_orders = in(instance, orders, count, sizeof *orders);
  place = in(instance, values, value_count, sizeof *values);
  CALL(fmi3GetOutputDerivatives, instance->address, own_references, count32(count), own_orders, place,
       count32(value_count));
  out(instance, values, place, value_count, sizeof *values);
  return status;
}

STATE_FUNCTIONS(fmi3GetFMUState, fmi3SetFMUState, fmi3FreeFMUState, fmi3SerializedFMUStateSize, fmi3SerializeFMUState,
                fmi3DeserializeFMUState)

/* Types that no variable has. */

#define NONE_OF_THIS_TYPE(name, type) \
  UNSUPPORTED(name, (void *pointer, const u32 references[], size_t count, type values[], size_t value_count), \
              ((void)references, (void)values, (void)value_count, 0), count32(count), 0, 0)
#define NO_BINARY(name, size_type, type) \
  UNSUPPORTED(name, \
              (void *pointer, const u32 references[], size_t count, size_type sizes[], type values[], \
               size_t value_count), \
              ((void)references, (void)sizes, (void)values, (void)value_count, 0), count32(count), 0, 0, 0)
NONE_OF_THIS_TYPE(fmi3GetFloat32, float)
NONE_OF_THIS_TYPE(fmi3GetInt8, int8_t)
NONE_OF_THIS_TYPE(fmi3GetUInt8, uint8_t)
NONE_OF_THIS_TYPE(fmi3GetInt16, int16_t)
NONE_OF_THIS_TYPE(fmi3GetUInt16, uint16_t)
NONE_OF_THIS_TYPE(fmi3GetUInt32, uint32_t)
NONE_OF_THIS_TYPE(fmi3GetUInt64, uint64_t)
NONE_OF_THIS_TYPE(fmi3GetString, const char *)
NO_BINARY(fmi3GetBinary, size_t, const uint8_t *)
NONE_OF_THIS_TYPE(fmi3SetFloat32, const float)
NONE_OF_THIS_TYPE(fmi3SetInt8, const int8_t)
NONE_OF_THIS_TYPE(fmi3SetUInt8, const uint8_t)
NONE_OF_THIS_TYPE(fmi3SetInt16, const int16_t)
NONE_OF_THIS_TYPE(fmi3SetUInt16, const uint16_t)
NONE_OF_THIS_TYPE(fmi3SetUInt32, const uint32_t)
NONE_OF_THIS_TYPE(fmi3SetUInt64, const uint64_t)
NONE_OF_THIS_TYPE(fmi3SetString, const char *const)
NO_BINARY(fmi3SetBinary, const size_t, const uint8_t *const)

/* What is not provided, and what belongs to other modes, clocks, model exchange and scheduled execution. */

UNSUPPORTED(fmi3GetNumberOfVariableDependencies, (void *pointer, u32 reference, size_t *count),
            ((void)count, reference), 0)
UNSUPPORTED(fmi3GetVariableDependencies,
            (void *pointer, u32 dependent, size_t elements[], u32 independents[], size_t independent_elements[],
             int kinds[], size_t count),
            ((void)elements, (void)independents, (void)independent_elements, (void)kinds, (void)count, dependent), 0, 0,
            0, 0, 0)
#define NO_DERIVATIVE(name) \
  UNSUPPORTED(name, \
              (void *pointer, const u32 unknowns[], size_t unknown_count, const u32 knowns[], size_t known_count, \
               const double seed[], size_t seed_count, double values[], size_t value_count), \
              ((void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)seed, (void)seed_count, \
               (void)values, (void)value_count, 0), \
              0, 0, 0, 0, 0, 0, 0)
NO_DERIVATIVE(fmi3GetDirectionalDerivative)
NO_DERIVATIVE(fmi3GetAdjointDerivative)

WITHOUT_ARGUMENTS(fmi3EnterConfigurationMode)
WITHOUT_ARGUMENTS(fmi3ExitConfigurationMode)
WITHOUT_ARGUMENTS(fmi3EnterEventMode)
WITHOUT_ARGUMENTS(fmi3EvaluateDiscreteStates)
WITHOUT_ARGUMENTS(fmi3EnterStepMode)
WITHOUT_ARGUMENTS(fmi3EnterContinuousTimeMode)
UNSUPPORTED(fmi3UpdateDiscreteStates,
            (void *pointer, bool *update, bool *terminate, bool *nominals, bool *values, bool *event, double *time),
            ((void)update, (void)terminate, (void)nominals, (void)values, (void)event, (void)time, 0), 0, 0, 0, 0, 0)

#define OF_CLOCKS(name, type) \
  UNSUPPORTED(name, (void *pointer, const u32 references[], size_t count, type values[]), \
              ((void)references, (void)values, (void)count, 0), 0, 0)
#define OF_CLOCKS_TWO(name, first_type, second_type) \
  UNSUPPORTED(name, (void *pointer, const u32 references[], size_t count, first_type first[], second_type second[]), \
              ((void)references, (void)first, (void)second, (void)count, 0), 0, 0, 0)
OF_CLOCKS(fmi3GetClock, bool)
OF_CLOCKS(fmi3SetClock, const bool)
OF_CLOCKS_TWO(fmi3GetIntervalDecimal, double, int)
OF_CLOCKS(fmi3GetShiftDecimal, double)
OF_CLOCKS_TWO(fmi3GetShiftFraction, uint64_t, uint64_t)
OF_CLOCKS(fmi3SetIntervalDecimal, const double)
OF_CLOCKS_TWO(fmi3SetIntervalFraction, const uint64_t, const uint64_t)
OF_CLOCKS(fmi3SetShiftDecimal, const double)
OF_CLOCKS_TWO(fmi3SetShiftFraction, const uint64_t, const uint64_t)
UNSUPPORTED(fmi3GetIntervalFraction,
            (void *pointer, const u32 references[], size_t count, uint64_t counters[], uint64_t resolutions[],
             int qualifiers[]),
            ((void)references, (void)counters, (void)resolutions, (void)qualifiers, (void)count, 0), 0, 0, 0, 0)

UNSUPPORTED(fmi3CompletedIntegratorStep, (void *pointer, bool no_set, bool *enter_event_mode, bool *terminate),
            ((void)enter_event_mode, (void)terminate, no_set), 0, 0)
UNSUPPORTED(fmi3SetTime, (void *pointer, double time), time)
#define OF_STATES(name, type) \
  UNSUPPORTED(name, (void *pointer, type values[], size_t count), ((void)values, (void)count, 0), 0)
OF_STATES(fmi3SetContinuousStates, const double)
OF_STATES(fmi3GetContinuousStateDerivatives, double)
OF_STATES(fmi3GetEventIndicators, double)
OF_STATES(fmi3GetContinuousStates, double)
OF_STATES(fmi3GetNominalsOfContinuousStates, double)
UNSUPPORTED(fmi3GetNumberOfEventIndicators, (void *pointer, size_t *count), ((void)count, 0))
UNSUPPORTED(fmi3GetNumberOfContinuousStates, (void *pointer, size_t *count), ((void)count, 0))
UNSUPPORTED(fmi3ActivateModelPartition, (void *pointer, u32 clock, double time), clock, time)
