"""Pins, timers and USB of the Pico 2: the only file that knows `machine`."""

import select
import sys
import time

from machine import ADC, PWM, WDT, Pin, Timer

_ADC_MV = 3300
_SENSE_MV_PER_A = 140  # of the VNH5019
_MOTOR_HZ, _SERVO_HZ = 20000, 50


class Motor:
    """One VNH5019: forward 1/0, reverse 0/1, brake 0/0 with PWM, fault when EN/DIAG is low."""

    def __init__(self, pins):
        self._ina, self._inb = Pin(pins["ina"], Pin.OUT, value=0), Pin(pins["inb"], Pin.OUT, value=0)
        self._pwm = PWM(Pin(pins["pwm"]), freq=_MOTOR_HZ, duty_u16=0)
        self._fault = Pin(pins["fault"], Pin.IN, Pin.PULL_UP)
        self._sense = None if pins["current"] is None else ADC(pins["current"])

    def drive(self, permille):
        """Set the power, -1000..1000 permille; 0 brakes."""
        if permille == 0:
            self.brake()
            return
        # The pins first, so that there is never power in the wrong direction.
        if (self._ina.value(), self._inb.value()) != (int(permille > 0), int(permille < 0)):
            self._pwm.duty_u16(0)
            self._ina.value(int(permille > 0))
            self._inb.value(int(permille < 0))
        self._pwm.duty_u16(abs(permille) * 65535 // 1000)

    def brake(self):
        self._ina.value(0)
        self._inb.value(0)
        self._pwm.duty_u16(65535)

    def off(self):
        """Let the wheel coast."""
        self._pwm.duty_u16(0)
        self._ina.value(0)
        self._inb.value(0)

    def fault(self):
        """Whether the driver reports a fault."""
        return self._fault.value() == 0

    def current_ma(self):
        """Return the current, -1 if not measured."""
        if self._sense is None:
            return -1
        return self._sense.read_u16() * _ADC_MV // 65535 * 1000 // _SENSE_MV_PER_A


class Encoder:
    """Counts rising edges of A, downwards if B is high."""

    def __init__(self, pins):
        self.count = 0
        self._b = Pin(pins[1], Pin.IN, Pin.PULL_UP)
        self._a = Pin(pins[0], Pin.IN, Pin.PULL_UP)
        self._a.irq(self._edge, Pin.IRQ_RISING)

    def _edge(self, _pin):
        self.count += -1 if self._b.value() else 1


class Usb:
    """Bytes from and to the computer, blocking only if unavoidable."""

    def __init__(self):
        import micropython

        micropython.kbd_intr(-1)  # byte 03 is data, not Ctrl-C
        self._in, self._out = sys.stdin.buffer, sys.stdout.buffer
        self._readable, self._writable = select.poll(), select.poll()
        self._readable.register(sys.stdin, select.POLLIN)
        self._writable.register(sys.stdout, select.POLLOUT)

    def read(self):
        """Return the next byte, None if there is none."""
        return self._in.read(1)[0] if self._readable.poll(0) else None

    def write(self, data):
        """Send data, or drop them if the computer does not read."""
        if self._writable.poll(0):
            self._out.write(data)


class Board:
    """The whole board, as control.py needs it."""

    def __init__(self, config, usb):
        self._config, self._usb = config, usb
        self._motors = Motor(config.LEFT_PINS), Motor(config.RIGHT_PINS)
        self._servo = PWM(Pin(config.SERVO_PIN), freq=_SERVO_HZ, duty_ns=0)
        pairs = config.LEFT_PINS["encoder"], config.RIGHT_PINS["encoder"]
        self._encoders = None if None in pairs else (Encoder(pairs[0]), Encoder(pairs[1]))
        self._battery = None if config.BATTERY_PIN is None else ADC(config.BATTERY_PIN)
        self.write, self.read = usb.write, usb.read
        self._dog = self._timer = None

    def watch(self, guard):
        """Call `guard` every 10 ms from now on; reset the Pico if `alive` is not called for 1 s."""
        self._timer = Timer(period=self._config.STEP_MS, mode=Timer.PERIODIC, callback=guard)
        self._dog = WDT(timeout=1000)

    def alive(self):
        """Feed the chip's watchdog."""
        self._dog.feed()

    def now_ms(self):
        """Return milliseconds; use them only with `since_ms`, as they wrap."""
        return time.ticks_ms()

    def since_ms(self, then):
        """Return the milliseconds since a `now_ms`."""
        return time.ticks_diff(time.ticks_ms(), then)

    def drive(self, left, right):
        """Set the power of both motors, -1000..1000 permille."""
        self._motors[0].drive(left)
        self._motors[1].drive(right)

    def brake(self):
        for motor in self._motors:
            motor.brake()

    def off(self):
        """Let both wheels coast."""
        for motor in self._motors:
            motor.off()

    def steer(self, us):
        """Set the pulse width of the servo."""
        self._servo.duty_ns(us * 1000)

    def faults(self):
        """Return the fault of the left and the right driver."""
        return self._motors[0].fault(), self._motors[1].fault()

    def currents_ma(self):
        """Return left and right, -1 if not measured."""
        return self._motors[0].current_ma(), self._motors[1].current_ma()

    def battery_mv(self):
        """Return the voltage, -1 if not measured."""
        if self._battery is None:
            return -1
        return min(int(self._battery.read_u16() * _ADC_MV / 65535 * self._config.BATTERY_RATIO), 60000)

    def counts(self):
        """Return the edges counted so far, left and right; None without encoders."""
        if self._encoders is None:
            return None
        return self._encoders[0].count, self._encoders[1].count
