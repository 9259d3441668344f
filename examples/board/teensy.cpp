/* A Teensy 4.1: USB's serial line, and a servo at each of six pins. */
#include <Arduino.h>
extern "C" {
#include "board.h"
}

static const uint8_t servo_pins[6] = {2, 3, 4, 5, 6, 7};
#define PERIOD 20000 /* of the pulses [us] */
#define PULSE_BITS 16

/* In the second memory: the first has code, constants and the stack. */
DMAMEM double board_buffer[BUFFER_SIZE / sizeof(double)];

int board_receive(void)
{
    return Serial.read();
}

void board_send(const char *text)
{
    Serial.print(text);
}

void board_send_pulses(const int *pulses)
{
    for (int servo = 0; servo < 6; servo++)
        analogWrite(servo_pins[servo], (pulses[servo] << PULSE_BITS) / PERIOD);
}

uint32_t board_milliseconds(void)
{
    return millis();
}

void setup()
{
    Serial.begin(115200);
    analogWriteResolution(PULSE_BITS);
    for (uint8_t pin : servo_pins)
        analogWriteFrequency(pin, 1e6f / PERIOD);
    run_platform();
}

void loop() {}
