/* The board that QEMU emulates (mps2-an500): start, serial line and clock. It has no servos. */
#include "board.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define UART_DATA REGISTER(0x40004000u)
#define UART_STATE REGISTER(0x40004004u)
#define UART_CONTROL REGISTER(0x40004008u)
#define UART_DIVIDER REGISTER(0x40004010u)
#define TIMER_CONTROL REGISTER(0x40000000u)
#define TIMER_VALUE REGISTER(0x40000004u)
#define TIMER_RELOAD REGISTER(0x40000008u)
#define COPROCESSOR_ACCESS REGISTER(0xE000ED88u)
#define TICKS_PER_MILLISECOND 25000u

double board_buffer[BUFFER_SIZE / sizeof(double)];

extern uint32_t __stack_top;
void reset(void);

void reset(void)
{
    COPROCESSOR_ACCESS |= 0xFu << 20;
    __asm volatile("dsb\n\tisb");
    UART_DIVIDER = 217u; /* 115200 baud */
    UART_CONTROL = 3u;
    TIMER_RELOAD = 0xFFFFFFFFu;
    TIMER_VALUE = 0xFFFFFFFFu;
    TIMER_CONTROL = 1u;
    run_platform();
    for (;;) {
    }
}

static void stop(void)
{
    for (;;) {
    }
}

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &__stack_top, (void *)reset, (void *)stop, (void *)stop, (void *)stop, (void *)stop, (void *)stop,
};

int board_receive(void)
{
    return UART_STATE & 2u ? (int)(UART_DATA & 0xFFu) : -1;
}

void board_send(const char *text)
{
    for (; *text; text++) {
        while (UART_STATE & 1u) {
        }
        UART_DATA = (uint32_t)(unsigned char)*text;
    }
}

void board_send_pulses(const int *pulses)
{
    (void)pulses;
}

uint32_t board_milliseconds(void)
{
    /* The timer counts down and wraps after 171 s, so the time is kept in a sum. */
    static uint32_t last, ticks, milliseconds;
    uint32_t now = 0xFFFFFFFFu - TIMER_VALUE;
    ticks += now - last;
    last = now;
    milliseconds += ticks / TICKS_PER_MILLISECOND;
    ticks %= TICKS_PER_MILLISECOND;
    return milliseconds;
}
