/* An instance: a module with memory of its own, and what its functions need to be called from C.
 *
 * Arguments that are pointers are copied into the module's memory and, unless constant, back after the call. */
#define PASTE(a, b) a##b
#define PASTE_ALL(a, b, c, d) a##b##c##d
#define EXPANDED_PASTE(a, b) PASTE(a, b)
#define EXPANDED_PASTE_ALL(a, b, c, d) PASTE_ALL(a, b, c, d)

/* wasm2c's names. */
#define MODULE_TYPE EXPANDED_PASTE_ALL(Z_, MODEL_IDENTIFIER, _instance_t, )
#define MODULE(action) EXPANDED_PASTE_ALL(Z_, MODEL_IDENTIFIER, _, action)
#define FUNCTION(name) EXPANDED_PASTE_ALL(Z_, MODEL_IDENTIFIER, Z_, name)

/* The standard's name of a function, with the prefix by which static linking tells FMUs apart. */
#ifdef FMI_FUNCTION_PREFIX
#define FMI(name) EXPANDED_PASTE(FMI_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

#ifndef FMI_EXPORT
#if defined _WIN32
#define FMI_EXPORT __declspec(dllexport)
#elif defined __GNUC__
#define FMI_EXPORT __attribute__((visibility("default")))
#else
#define FMI_EXPORT
#endif
#endif

/* Statuses of both versions of FMI. */
enum { STATUS_OK = 0, STATUS_ERROR = 3, STATUS_FATAL = 4 };

/* Marks memory as an instance's or a state's; other memory is unlikely to hold it. */
#define INSTANCE_MARK 0x65636e6174736e69u
#define STATE_MARK 0x6574617473756d66u

typedef struct {
  uint64_t mark;
  MODULE_TYPE module;
  u32 address;        /* the instance in the module's memory */
  u32 scratch, room;  /* memory for arguments, and its size */
  u32 used;
  bool broken;
  HostLogger logger;
  void *environment;
} Instance;

/* A saved state, as the host holds it: serialized, so that it belongs to no instance. */
typedef struct {
  uint64_t mark;
  u32 size;
  u8 bytes[1];
} State;

static u8 *memory_at(Instance *instance, u32 address) { return instance->module.w2c_memory.data + address; }

static char *text_at(Instance *instance, u32 address) { return (char *)memory_at(instance, address); }

static u32 word_at(Instance *instance, u32 address) {
  u32 word;
  memcpy(&word, memory_at(instance, address), sizeof word);
  return word;
}

static void set_word(Instance *instance, u32 address, u32 word) {
  memcpy(memory_at(instance, address), &word, sizeof word);
}

/* A number of values as the module takes it; one that is too large stays so. */
static u32 count32(size_t count) { return count < UINT32_MAX ? (u32)count : UINT32_MAX; }

/* Memory for an argument; 0 if there is not so much. */
static u32 reserve(Instance *instance, size_t count, size_t size) {
  u32 bytes, page, address;
  if (count > (UINT32_MAX / 2) / size) return 0;
  bytes = ((u32)(count * size) + 15u) & ~7u;
  if (bytes > instance->room - instance->used) {
    const u32 pages = bytes / WASM_RT_PAGE + 1;
    page = wasm_rt_grow_memory(&instance->module.w2c_memory, pages);
    if (page == (u32)-1) return 0;
    instance->scratch = page * WASM_RT_PAGE;
    instance->room = pages * WASM_RT_PAGE;
    instance->used = 0;
  }
  address = instance->scratch + instance->used;
  instance->used += bytes;
  return address;
}

/* An argument in the module's memory; null stays null. */
static u32 in(Instance *instance, const void *values, size_t count, size_t size) {
  const u32 address = values ? reserve(instance, count, size) : 0;
  if (address) memcpy(memory_at(instance, address), values, count * size);
  return address;
}

static u32 in_text(Instance *instance, const char *text) { return in(instance, text, text ? strlen(text) + 1 : 0, 1); }

static u32 in_texts(Instance *instance, const char *const texts[], size_t count) {
  const u32 list = texts ? reserve(instance, count, sizeof(u32)) : 0;
  size_t k;
  for (k = 0; list && k < count; k++) set_word(instance, list + (u32)(k * sizeof(u32)), in_text(instance, texts[k]));
  return list;
}

static void out(Instance *instance, void *values, u32 address, size_t count, size_t size) {
  if (values && address) memcpy(values, memory_at(instance, address), count * size);
}

static void report(Instance *instance, int status, const char *category, const char *text);

/* Marks an instance that trapped: its memory may be half changed. */
static void set_broken(Instance *instance) {
  instance->broken = true;
  report(instance, STATUS_FATAL, "logStatusError", "internal error, please report it; only freeing the instance is left");
}

/* Calls into the module. A trap gives the status 'fatal'. */
#define GUARDED(instance, result, call) \
  do { \
    jmp_buf here, *const outer = wasm_rt_target; \
    wasm_rt_target = &here; \
    if (setjmp(here) == 0) { \
      result = (call); \
    } else { \
      result = STATUS_FATAL; \
      (instance)->broken = true; \
    } \
    wasm_rt_target = outer; \
  } while (0)

static Instance *instance_at(void *pointer) {
  Instance *const instance = pointer;
  return instance && instance->mark == INSTANCE_MARK ? instance : NULL;
}

/* Begins a function: declares `instance` and `status`. */
#define BEGIN(pointer) \
  Instance *const instance = instance_at(pointer); \
  int status; \
  if (!instance) return STATUS_ERROR; \
  if (instance->broken) return STATUS_FATAL; \
  instance->used = 0

/* Calls the module's function of this name with the instance and these arguments. */
#define CALL(name, ...) \
  do { \
    GUARDED(instance, status, (int)FUNCTION(name)(&instance->module, __VA_ARGS__)); \
    if (instance->broken) set_broken(instance); \
  } while (0)

/* A new module whose function for messages has this type. NULL without memory for it. */
static Instance *new_instance(uint32_t log_type, wasm_rt_function_ptr_t log) {
  Instance *const instance = calloc(1, sizeof *instance);
  wasm_rt_funcref_table_t *table;
  int made = STATUS_FATAL;
  if (!instance) return NULL;
  GUARDED(instance, made, (MODULE(init_module)(), MODULE(instantiate)(&instance->module), STATUS_OK));
  if (made != STATUS_OK) {
    MODULE(free)(&instance->module);
    free(instance);
    return NULL;
  }
  table = &instance->module.w2c_T0;
  table->data[table->size - 1].func_type = log_type;
  table->data[table->size - 1].func = log;
  table->data[table->size - 1].module_instance = instance;
  /* Memory for the arguments of every usual call, so that it is not allocated in a step. */
  reserve(instance, WASM_RT_PAGE / 2, 1);
  return instance;
}

static u32 log_function(const Instance *instance) { return instance->logger ? instance->module.w2c_T0.size - 1 : 0; }

static void free_instance(Instance *instance) {
  instance->mark = 0;
  MODULE(free)(&instance->module);
  free(instance);
}

/* An instance that has been made, or NULL for one that has not. */
static Instance *made(Instance *instance, int address) {
  if (instance->broken || address == 0) {
    if (instance->broken) set_broken(instance);
    free_instance(instance);
    return NULL;
  }
  instance->address = (u32)address;
  instance->mark = INSTANCE_MARK;
  return instance;
}

static int refused(Instance *instance, const char *reason) {
  report(instance, STATUS_ERROR, "logStatusError", reason);
  return STATUS_ERROR;
}

/* The host's state at this place; NULL with a message if there is none. */
static State *state_at(Instance *instance, void *pointer) {
  State *const state = pointer;
  if (state && state->mark == STATE_MARK) return state;
  refused(instance, "the state is null, freed already, or none of this model's");
  return NULL;
}

/* Room for a state of this size in place of the one that is there. */
static State *state_of_size(State *old, u32 size) {
  State *const state = realloc(old, sizeof *state + size);
  if (state) {
    state->mark = STATE_MARK;
    state->size = size;
  }
  return state;
}

/* Functions that are the same in both versions of FMI but for their names. */

#define WITHOUT_ARGUMENTS(name) \
  FMI_EXPORT int FMI(name)(void *pointer) { \
    BEGIN(pointer); \
    CALL(name, instance->address); \
    return status; \
  }

/* A function that fails whatever its arguments, which are not handed on. */
#define UNSUPPORTED(name, arguments, ...) \
  FMI_EXPORT int FMI(name) arguments { \
    BEGIN(pointer); \
    CALL(name, instance->address, __VA_ARGS__); \
    return status; \
  }

#define FREE_INSTANCE(name) \
  FMI_EXPORT void FMI(name)(void *pointer) { \
    Instance *const instance = instance_at(pointer); \
    if (instance) free_instance(instance); \
  }

#define NO_PLACE "the place for the answer is null, or too small"

/* Frees the module's state at this place. */
#define FREE_OWN(free_, place) \
  do { \
    int freed = STATUS_OK; \
    if (!instance->broken) { \
      GUARDED(instance, freed, (int)FUNCTION(free_)(&instance->module, instance->address, place)); \
    } \
    if (freed == STATUS_FATAL) status = STATUS_FATAL; \
  } while (0)

/* In the module a state lives during a call only. */
#define STATE_FUNCTIONS(get, set, free_, serialized_size, serialize, deserialize) \
  FMI_EXPORT int FMI(get)(void *pointer, void **host_state) { \
    const u32 none = 0; \
    u32 place, size, bytes; \
    State *state; \
    BEGIN(pointer); \
    if (!host_state) return refused(instance, NO_PLACE); \
    if (*host_state && !state_at(instance, *host_state)) return STATUS_ERROR; \
    place = in(instance, &none, 1, sizeof none); \
    size = in(instance, &none, 1, sizeof none); \
    CALL(get, instance->address, place); \
    if (status != STATUS_OK) return status; \
    CALL(serialized_size, instance->address, word_at(instance, place), size); \
    if (status != STATUS_OK) return status; \
    size = word_at(instance, size); \
    bytes = reserve(instance, size, 1); \
    state = bytes ? state_of_size(*host_state, size) : NULL; \
    if (state) { \
      *host_state = state; \
      CALL(serialize, instance->address, word_at(instance, place), bytes, size); \
      out(instance, state->bytes, bytes, size, 1); \
    } else { \
      status = STATUS_ERROR; \
    } \
    FREE_OWN(free_, place); \
    return status; \
  } \
  FMI_EXPORT int FMI(set)(void *pointer, void *host_state) { \
    const u32 none = 0; \
    u32 place, bytes; \
    State *state; \
    BEGIN(pointer); \
    state = state_at(instance, host_state); \
    if (!state) return STATUS_ERROR; \
    place = in(instance, &none, 1, sizeof none); \
    bytes = in(instance, state->bytes, state->size, 1); \
    CALL(deserialize, instance->address, bytes, state->size, place); \
    if (status != STATUS_OK) return status; \
    CALL(set, instance->address, word_at(instance, place)); \
    FREE_OWN(free_, place); \
    return status; \
  } \
  FMI_EXPORT int FMI(free_)(void *pointer, void **host_state) { \
    State *state; \
    BEGIN(pointer); \
    status = STATUS_OK; \
    if (!host_state || !*host_state) return status; \
    state = state_at(instance, *host_state); \
    if (!state) return STATUS_ERROR; \
    state->mark = 0; \
    free(state); \
    *host_state = NULL; \
    return status; \
  } \
  FMI_EXPORT int FMI(serialized_size)(void *pointer, void *host_state, size_t *size) { \
    State *state; \
    BEGIN(pointer); \
    status = STATUS_OK; \
    state = state_at(instance, host_state); \
    if (!state) return STATUS_ERROR; \
    if (!size) return refused(instance, NO_PLACE); \
    *size = state->size; \
    return status; \
  } \
  FMI_EXPORT int FMI(serialize)(void *pointer, void *host_state, u8 *bytes, size_t size) { \
    State *state; \
    BEGIN(pointer); \
    status = STATUS_OK; \
    state = state_at(instance, host_state); \
    if (!state) return STATUS_ERROR; \
    if (!bytes || size < state->size) return refused(instance, NO_PLACE); \
    memcpy(bytes, state->bytes, state->size); \
    return status; \
  } \
  FMI_EXPORT int FMI(deserialize)(void *pointer, const u8 *bytes, size_t size, void **host_state) { \
    const u32 none = 0; \
    u32 place, own_bytes; \
    State *state; \
    BEGIN(pointer); \
    if (!host_state) return refused(instance, NO_PLACE); \
    if (*host_state && !state_at(instance, *host_state)) return STATUS_ERROR; \
    place = in(instance, &none, 1, sizeof none); \
    own_bytes = in(instance, bytes, size, 1); \
    CALL(deserialize, instance->address, own_bytes, count32(size), place); \
    if (status != STATUS_OK) return status; \
    FREE_OWN(free_, place); \
    state = state_of_size(*host_state, (u32)size); \
    if (!state) return STATUS_ERROR; \
    memcpy(state->bytes, bytes, size); \
    *host_state = state; \
    return status; \
  }
