/* The washout on a microcontroller.
 *
 * Parameters, input, preview and output are arrays of double, one element for each variable of the
 * FMU, in SI units; a boolean is 0 or 1. moris_parameters.h has the places of all variables in
 * them: cargo moris parameters --c-header writes it, with the values of a parameter set and a rig.
 *
 * The functions are for one thread, and for no interrupt. A step allocates nothing and takes any
 * input: what is not a number counts as at rest. With a washout that is NULL they do nothing. */
#ifndef MORIS_BOARD_H
#define MORIS_BOARD_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct moris_washout moris_washout;

/* Bytes of the buffer for a washout of any strategy in this library. */
size_t moris_buffer_size(void);

/* Makes a washout at rest at neutral in the buffer, which is aligned to 8 bytes and its own from
 * then on. NULL if the buffer or the parameters cannot be used: message, if it is not NULL, then
 * names the variable, its value, the reason and the remedy.
 *
 * The buffer is the whole state. A copy of it saves the state; copied back to the same address it
 * restores it. */
moris_washout *moris_create(void *buffer, size_t size, const double *parameters, size_t count, char *message,
                            size_t message_size);

/* Advances by step seconds with this input. A step below 1e-12 s does nothing. */
void moris_step(moris_washout *washout, const double *input, double step);

/* Sets the specific force to come, as of the next step's start, for the predictive strategy. */
void moris_preview(moris_washout *washout, const double *preview);

/* Reads the output now. */
void moris_read(const moris_washout *washout, double *output);

#ifdef __cplusplus
}
#endif

#endif
