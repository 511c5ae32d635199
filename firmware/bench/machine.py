"""The pins of a simulated Pico: the part of `machine` that board.py uses, and what it did to it."""

levels = {}  # pin -> 0 or 1
duties = {}  # pin -> 0..65535, or nanoseconds for a servo
analog = {}  # pin -> 0..65535
edges = {}  # pin -> function called at a rising edge
timers = []
fed = [0]


class Pin:
    OUT, IN, PULL_UP, IRQ_RISING = 0, 1, 2, 4

    def __init__(self, number, mode=None, pull=None, value=None):
        self.number = number
        if value is not None:
            levels[number] = value
        elif pull == Pin.PULL_UP:
            levels.setdefault(number, 1)

    def value(self, level=None):
        if level is None:
            return levels.get(self.number, 0)
        levels[self.number] = level

    def irq(self, handler, trigger):
        edges[self.number] = handler


class PWM:
    def __init__(self, pin, freq, duty_u16=0, duty_ns=0):
        self.number = pin.number
        duties[self.number] = duty_u16 + duty_ns

    def duty_u16(self, duty):
        if not 0 <= duty <= 65535:
            raise ValueError("duty")
        duties[self.number] = duty

    def duty_ns(self, duty):
        duties[self.number] = duty


class ADC:
    def __init__(self, number):
        self.number = number

    def read_u16(self):
        return analog.get(self.number, 0)


class Timer:
    PERIODIC = 1

    def __init__(self, period, mode, callback):
        timers.append(callback)


class WDT:
    def __init__(self, timeout):
        pass

    def feed(self):
        fed[0] += 1
