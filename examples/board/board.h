/* What platform.c needs of a board. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

#ifndef BUFFER_SIZE
#define BUFFER_SIZE (24 * 1024) /* at least moris_buffer_size() [bytes] */
#endif
/* Memory for the washout. */
extern double board_buffer[BUFFER_SIZE / sizeof(double)];

/* The next character of the serial line, or -1. */
int board_receive(void);
/* Sends a text on the serial line. */
void board_send(const char *text);
/* Sends six pulses [us] to the servos, at 50 Hz. */
void board_send_pulses(const int *pulses);
/* Milliseconds since the start; called at least every 100 s. */
uint32_t board_milliseconds(void);

/* The program, in platform.c. Returns where the washout cannot be made, which it says. */
int run_platform(void);

#endif
