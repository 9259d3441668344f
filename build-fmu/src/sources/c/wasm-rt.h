/* The runtime that code made by wasm2c 1.0.32 (WABT) asks for: linear memory, a table of functions, traps.
 *
 * It has no signal handlers, maps no memory and needs the C library only. Memory is allocated once. A trap returns to the
 * call from outside that is under way in this thread. Everything is static, so that several modules can be linked into
 * one program. */
#ifndef WASM_RT_H_
#define WASM_RT_H_

#include <assert.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#if defined __SSE2__
#include <emmintrin.h>
#endif

#if defined __FAST_MATH__
#error "Compile without -ffast-math: the results would differ."
#endif
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#error "These sources are for little-endian processors."
#endif

/* A fused multiplication and addition rounds once, not twice. */
#if defined _MSC_VER
#pragma fp_contract(off)
#elif defined __GNUC__ && !defined __clang__
#pragma GCC optimize("fp-contract=off")
#else
#pragma STDC FP_CONTRACT OFF
#endif

#if defined __GNUC__
/* What follows is not exported; the headers above are not ours. */
#pragma GCC visibility push(hidden)
#define UNLIKELY(x) __builtin_expect(!!(x), 0)
#define LIKELY(x) __builtin_expect(!!(x), 1)
#define WASM_RT_NO_RETURN __attribute__((noreturn))
#else
#define UNLIKELY(x) (x)
#define LIKELY(x) (x)
#if defined _MSC_VER
#define WASM_RT_NO_RETURN __declspec(noreturn)
#else
#define WASM_RT_NO_RETURN
#endif
#endif

/* For a target without threads, define it as nothing. */
#ifndef WASM_RT_THREAD_LOCAL
#if defined _MSC_VER
#define WASM_RT_THREAD_LOCAL __declspec(thread)
#elif defined __GNUC__
#define WASM_RT_THREAD_LOCAL __thread
#elif defined __STDC_VERSION__ && __STDC_VERSION__ >= 201112L
#define WASM_RT_THREAD_LOCAL _Thread_local
#else
#define WASM_RT_THREAD_LOCAL
#endif
#endif

#define wasm_rt_memcpy memcpy
/* Accesses to memory are not checked once more: the module was compiled from Rust, which checks them where needed. Calls
 * are not counted: there is no unbounded recursion. */
#define WASM_RT_MEMCHECK_SIGNAL_HANDLER 1
#define WASM_RT_USE_STACK_DEPTH_COUNT 0
#define WASM_RT_COPY(memory, to, from, count) memmove((memory) + (to), (memory) + (from), count)
#define WASM_RT_FILL(memory, to, value, count) memset((memory) + (to), (int)(value), count)

/* Pages of memory beyond those that the module begins with: for what it allocates, and for arguments. */
#ifndef WASM_RT_MORE_PAGES
#define WASM_RT_MORE_PAGES 32
#endif

/* Without the library of mathematics, where the compiler optimises: importers may link none. */
static double wasm_rt_ceil(double x) {
  double whole;
  if (!(fabs(x) < 4503599627370496.0)) return x;
  whole = (double)(int64_t)x;
  return copysign(whole < x ? whole + 1.0 : whole, x);
}
#define ceil wasm_rt_ceil

#if defined __SSE2__ || defined __aarch64__
static double wasm_rt_sqrt(double x) {
#if defined __SSE2__
  const __m128d pair = _mm_set_sd(x);
  return _mm_cvtsd_f64(_mm_sqrt_sd(pair, pair));
#else
  double root;
  __asm__("fsqrt %d0, %d1" : "=w"(root) : "w"(x));
  return root;
#endif
}
#define sqrt wasm_rt_sqrt
#endif

enum { WASM_RT_PAGE = 65536 };

typedef enum {
  WASM_RT_TRAP_NONE,
  WASM_RT_TRAP_OOB,
  WASM_RT_TRAP_INT_OVERFLOW,
  WASM_RT_TRAP_DIV_BY_ZERO,
  WASM_RT_TRAP_INVALID_CONVERSION,
  WASM_RT_TRAP_UNREACHABLE,
  WASM_RT_TRAP_CALL_INDIRECT,
  WASM_RT_TRAP_EXHAUSTION
} wasm_rt_trap_t;

typedef enum { WASM_RT_I32, WASM_RT_I64, WASM_RT_F32, WASM_RT_F64 } wasm_rt_type_t;

typedef void (*wasm_rt_function_ptr_t)(void);

typedef struct {
  uint32_t func_type;
  wasm_rt_function_ptr_t func;
  void *module_instance;
} wasm_rt_funcref_t;

/* No module here has tables of these, but the code made by wasm2c names them. */
typedef void *wasm_rt_externref_t;
typedef struct {
  wasm_rt_externref_t *data;
  uint32_t max_size, size;
} wasm_rt_externref_table_t;
static const wasm_rt_externref_t wasm_rt_externref_null_value = NULL;

typedef struct {
  uint8_t *data;
  uint32_t pages, max_pages, size;
} wasm_rt_memory_t;

typedef struct {
  wasm_rt_funcref_t *data;
  uint32_t max_size, size;
} wasm_rt_funcref_table_t;

/* Where a trap returns to. */
static WASM_RT_THREAD_LOCAL jmp_buf *wasm_rt_target;

static WASM_RT_NO_RETURN void wasm_rt_trap(wasm_rt_trap_t reason) {
  longjmp(*wasm_rt_target, (int)reason);
}

static bool wasm_rt_is_initialized(void) { return true; }

/* A number for a function's type, by which a call through the table is checked. */
static uint32_t wasm_rt_register_func_type(uint32_t parameters, uint32_t results, ...) {
  uint32_t number = (2166136261u ^ parameters) * 16777619u, k;
  va_list types;
  va_start(types, results);
  for (k = 0; k < parameters + results; k++) {
    number = (number ^ (uint32_t)va_arg(types, int)) * 16777619u;
  }
  va_end(types);
  return number;
}

static void wasm_rt_allocate_memory(wasm_rt_memory_t *memory, uint32_t pages, uint32_t max_pages) {
  (void)max_pages;
  memory->max_pages = pages + WASM_RT_MORE_PAGES;
  memory->data = calloc(memory->max_pages, WASM_RT_PAGE);
  if (!memory->data) wasm_rt_trap(WASM_RT_TRAP_EXHAUSTION);
  memory->pages = pages;
  memory->size = pages * WASM_RT_PAGE;
}

/* The memory does not move: functions of the module hold its address. */
static uint32_t wasm_rt_grow_memory(wasm_rt_memory_t *memory, uint32_t delta) {
  const uint32_t old = memory->pages;
  if (delta > memory->max_pages - old) return (uint32_t)-1;
  memory->pages += delta;
  memory->size = memory->pages * WASM_RT_PAGE;
  return old;
}

static void wasm_rt_free_memory(wasm_rt_memory_t *memory) { free(memory->data); }

/* One element more than asked for: the last is the host's function for messages. */
static void wasm_rt_allocate_funcref_table(wasm_rt_funcref_table_t *table, uint32_t elements, uint32_t max_elements) {
  table->data = calloc(elements + 1, sizeof *table->data);
  if (!table->data) wasm_rt_trap(WASM_RT_TRAP_EXHAUSTION);
  table->size = elements + 1;
  table->max_size = max_elements;
}

static void wasm_rt_free_funcref_table(wasm_rt_funcref_table_t *table) { free(table->data); }

#endif
