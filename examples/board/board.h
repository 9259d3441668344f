/* What main.c needs of a board. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* The next character of the serial line, or -1. */
int board_receive(void);
/* Sends a text on the serial line. */
void board_send(const char *text);
/* Milliseconds since the start; called at least every 100 s. */
uint32_t board_milliseconds(void);

#endif
