"""Dimensions and pins, to adapt to the robot. Nothing else needs to be changed."""

PROTOCOL = 1
FIRMWARE = "1.1.0"

# Pins (GP numbers). None if nothing is connected.
LEFT_PINS = {"ina": 2, "inb": 3, "pwm": 4, "fault": 6, "current": 26, "encoder": None}
RIGHT_PINS = {"ina": 7, "inb": 8, "pwm": 10, "fault": 11, "current": 27, "encoder": None}
# An encoder is a pair of pins (A, B), for example (16, 17).
SERVO_PIN = 15
BATTERY_PIN = 28
# Pins 4 and 10 share no PWM slice with 15: the servo needs 50 Hz, the motors 20 kHz.

WATCHDOG_MS = 250
STEP_MS = 10
TELEMETRY_MS = 20
QUIET_MS = 1000  # after this long without a good line: no telemetry, nobody listens

MAX_SPEED_MRAD_S = 20000  # of a wheel at full duty
COUNTS_PER_TURN = 390  # rising edges of A in one turn of a wheel
LIMIT_SPEED_MRAD_S = 17907  # commands for a faster wheel are refused; as in robot/limits.py
LIMIT_STEERING_MRAD = 500  # the same for the steering
GAIN_P = 30  # permille of duty for a wheel that is 1000 mrad/s too slow
GAIN_I = 120  # the same, per second

CENTRE_US = 1500
US_PER_RAD = 637  # 2000 us for half a turn
SERVO_LOW_US, SERVO_HIGH_US = 1000, 2000

BATTERY_RATIO = 11.0  # of the divider: 10 kOhm over 1 kOhm
BATTERY_LOW_MV = 6000
BATTERY_BACK_MV = 6300
BATTERY_LOW_FOR_MS = 500
