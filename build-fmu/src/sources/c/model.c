/* The model as a co-simulation FMU: the only file to compile.
 *
 * The model itself was compiled from Rust to WebAssembly, and that turned into C by wasm2c. Function names have the prefix
 * that the standard wants where FMUs are linked statically. A shared library has none: define FMI2_OVERRIDE_FUNCTION_PREFIX
 * for FMI 2.0, FMI3_OVERRIDE_FUNCTION_PREFIX for FMI 3.0. CMake says by itself that it builds one. */
#define MODEL_IDENTIFIER MODEL_NAME
#define OWN_FUNCTION_PREFIX MODEL_NAME_

#ifdef MODEL_NAME_EXPORTS
#define FMI2_OVERRIDE_FUNCTION_PREFIX
#define FMI3_OVERRIDE_FUNCTION_PREFIX
#endif

#include "module.h"
#include "module_code.h"
#include "functions.h"
