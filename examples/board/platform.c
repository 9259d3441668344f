/* Telemetry in, servo pulses out: a platform of six linear servos, or of six servos with cranks,
 * beside a vehicle or a game. The rig in moris_parameters.h says which.
 *
 * A line of telemetry is the specific force [m/s2] and the angular velocity [rad/s], as six decimals
 * separated by commas: "0.1,-0.2,9.8,0.01,0,0.3". At 50 Hz a frame answers with six pulses [us]:
 * "P 1500 1500 1500 1500 1500 1500". Without a line for 200 ms the platform returns to neutral and
 * then to its lowest pose; "parked" ends its frames there. With new lines it rises and goes on. */
#include "board.h"
#include "moris_board.h"
#include "moris_parameters.h"

#define STEP 0.001              /* [s] */
#define STEPS_PER_FRAME 20      /* 50 Hz */
#define LINE_TIMEOUT 200u       /* time without a line after which the platform returns [ms] */
#define PULSE_SHORTEST 1000.0   /* pulse at the shortest and at the longest leg [us] */
#define PULSE_LONGEST 2000.0
#define PULSE_PER_RADIAN 636.62 /* of a servo that turns by 180 degrees from 500 to 2500 us */
#define LIFT_TIME 6.0           /* time from the lowest pose to neutral [s] */
#define REST_SPEED 1e-4         /* speed of an actuator below which it is at rest [m/s] ... */
#define REST_STEPS 1000         /* ... if it lasts for so many steps */

/* Servos with cranks: pulse at which the arm is level [us], as trimmed on the platform, and 1 where a
 * longer pulse raises the arm, -1 where the servo is mounted the other way round. */
static const struct {
    double level, direction;
} servos[6] = {{1500.0, 1.0}, {1500.0, -1.0}, {1500.0, 1.0}, {1500.0, -1.0}, {1500.0, 1.0}, {1500.0, -1.0}};

/* Reads a decimal number; returns NULL where there is none. */
static const char *read_number(const char *text, double *number)
{
    double sign = *text == '-' ? -1.0 : 1.0, value = 0.0, scale = 1.0;
    int digits = 0, is_fraction = 0;
    if (*text == '-' || *text == '+')
        text++;
    for (; (*text >= '0' && *text <= '9') || (*text == '.' && !is_fraction); text++) {
        if (*text == '.') {
            is_fraction = 1;
        } else {
            value = 10.0 * value + (*text - '0');
            scale *= is_fraction ? 10.0 : 1.0;
            digits++;
        }
    }
    *number = sign * value / scale;
    return digits > 0 ? text : NULL;
}

/* Takes a line of telemetry; 0 where it is none. */
static int read_line(const char *text, double *input)
{
    double numbers[6];
    for (int k = 0; k < 6; k++) {
        text = read_number(text, &numbers[k]);
        if (text == NULL || *text != (k < 5 ? ',' : '\0'))
            return 0;
        text++;
    }
    for (int k = 0; k < 3; k++) {
        input[MORIS_vehicle_specificForce_x + k] = numbers[k];
        input[MORIS_vehicle_angularVelocity_x + k] = numbers[3 + k];
    }
    return 1;
}

/* The pulse of an actuator, `lift` of the way from its lowest position to that of the output [us]. */
static double pulse_of(int actuator, const double *output, double lift)
{
    if (moris_parameters[MORIS_crank_arm] > 0.0) {
        const double lowest = moris_parameters[MORIS_crank_minAngle];
        double angle = lowest + lift * (output[MORIS_actuator_1_angle + actuator] - lowest);
        return servos[actuator].level + servos[actuator].direction * PULSE_PER_RADIAN * angle;
    }
    const double shortest = moris_parameters[MORIS_actuator_minLength];
    const double stroke = moris_parameters[MORIS_actuator_maxLength] - shortest;
    double fraction = lift * (output[MORIS_actuator_1_length + actuator] - shortest) / stroke;
    return PULSE_SHORTEST + fraction * (PULSE_LONGEST - PULSE_SHORTEST);
}

static void send_frame(const double *output, double lift)
{
    int pulses[6];
    for (int actuator = 0; actuator < 6; actuator++)
        pulses[actuator] = (int)(pulse_of(actuator, output, lift) + 0.5);
    board_send_pulses(pulses);
    char text[64], *end = text;
    *end++ = 'P';
    for (int actuator = 0; actuator < 6; actuator++) {
        *end++ = ' ';
        for (int unit = 1000; unit > 0; unit /= 10)
            *end++ = (char)('0' + pulses[actuator] / unit % 10);
    }
    *end = '\0';
    board_send(text);
    board_send(lift == 0.0 ? " parked\n" : "\n");
}

int run_platform(void)
{
    char line[96], message[256];
    size_t length = 0;
    moris_washout *washout =
        moris_create(board_buffer, BUFFER_SIZE, moris_parameters, MORIS_PARAMETER_COUNT, message, sizeof message);
    if (washout == NULL) {
        board_send(message);
        board_send("\n");
        return 1;
    }
    double input[MORIS_INPUT_COUNT], output[MORIS_OUTPUT_COUNT];
    for (int k = 0; k < MORIS_INPUT_COUNT; k++)
        input[k] = moris_input_at_rest[k];
    uint32_t stepped = board_milliseconds(), heard = stepped - LINE_TIMEOUT;
    uint32_t steps = 0, resting = REST_STEPS;
    double raised = 0.0; /* fraction of the time from the lowest pose to neutral */
    for (;;) {
        int character = board_receive();
        if (character == '\n' || character == '\r') {
            line[length] = '\0';
            if (read_line(line, input))
                heard = board_milliseconds();
            length = 0;
        } else if (character >= 0) {
            line[length] = (char)character;
            length += length + 1 < sizeof line;
        }
        uint32_t now = board_milliseconds();
        if (now == stepped)
            continue;
        stepped++;
        int is_driven = now - heard < LINE_TIMEOUT;
        /* The lift moves only while the washout rests at neutral, and the washout only at full lift. */
        input[MORIS_engaged] = is_driven && raised >= 1.0;
        moris_step(washout, input, STEP);
        moris_read(washout, output);
        int is_moving = input[MORIS_engaged] != 0.0;
        for (int leg = 0; leg < 6; leg++)
            is_moving |= __builtin_fabs(output[MORIS_actuator_1_velocity + leg]) > REST_SPEED;
        resting = is_moving ? 0 : resting + 1;
        if (is_driven)
            raised += STEP / LIFT_TIME;
        else if (resting >= REST_STEPS)
            raised -= STEP / LIFT_TIME;
        raised = raised > 1.0 ? 1.0 : raised < 0.0 ? 0.0 : raised;
        if (++steps % STEPS_PER_FRAME == 0)
            send_frame(output, raised * raised * (3.0 - 2.0 * raised));
    }
}
