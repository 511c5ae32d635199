"""Decides when the motors turn, and how fast; uses no pins, so it can be tested without a Pico."""

import protocol

FLAGS = "EWLRUHAN"
_STANDING = "EWLRUHA"
_SIDES = (0, 1)


class Control:
    """Obeys lines, and keeps the motors off when in doubt.

    `board` has: now_ms, since_ms, write, drive, brake, off, steer, faults, currents_ma,
    battery_mv, counts (see board.py). `config` is the module of that name, or an object like it.
    """

    def __init__(self, board, config):
        self.board, self.config = board, config
        self.reader = protocol.Reader()
        self.flags = {"W", "H", "A"}
        if board.counts() is None:
            self.flags.add("N")
        now = board.now_ms()
        self._drove_ms = self._heard_ms = self._told_ms = self._stepped_ms = self._well_ms = now
        self._uptime_ms = 0
        self._heard_any = False
        self._asked = [0, 0]
        self._speeds = [0, 0]
        self._sums = [0, 0]
        self._counts = board.counts() or (0, 0)
        self._steering = 0
        self._obeyed = 0
        self._any_obeyed = False
        self._sequence = 0
        board.off()

    @property
    def stands(self):
        """Whether something keeps the motors off."""
        for flag in _STANDING:
            if flag in self.flags:
                return True
        return False

    # ------------------------------------------------------------ lines

    def feed(self, octet):
        """Take one byte from the computer."""
        fields = self.reader.feed(octet)
        if fields is None:
            return
        self._heard_ms, self._heard_any = self.board.now_ms(), True
        getattr(self, "_take_" + fields[0].lower())(*fields[1:])

    def _take_v(self, sequence, version):
        self._stop_anew()
        self._any_obeyed = False
        if version == self.config.PROTOCOL:
            self.flags.discard("H")
        else:
            self.flags.add("H")
        self._say("W", self.config.PROTOCOL, self.config.FIRMWARE)

    def _take_e(self, sequence):
        self.flags.add("E")
        self._stop_anew()

    def _take_r(self, sequence):
        self.flags.discard("E")
        self._stop_anew()

    def _take_d(self, sequence, left, right, steering):
        if self._any_obeyed and not 0 < (sequence - self._obeyed) & 0xFFFF < 32768:
            self._refuse()
            return
        if self._is_beyond(left, right, steering):
            # It must be an error, so it does not count as a sign of life either.
            self._refuse()
            self._stop_anew()
            return
        self._obeyed, self._any_obeyed = sequence, True
        if left == 0 and right == 0 and not self.flags & {"E", "L", "R", "U", "H"}:
            self.flags.discard("A")
        self.flags.discard("W")
        self._drove_ms = self.board.now_ms()
        self._asked = [left, right]
        if "H" not in self.flags and "E" not in self.flags and "A" not in self.flags:
            self._steering = steering
            self.board.steer(self._servo_us(steering))
        self._drive()

    def _is_beyond(self, left, right, steering):
        most = self.config.LIMIT_SPEED_MRAD_S
        return max(abs(left), abs(right)) > most or abs(steering) > self.config.LIMIT_STEERING_MRAD

    def _refuse(self):
        self.reader.refused = (self.reader.refused + 1) & 0xFFFFFFFF

    def _servo_us(self, steering):
        c = self.config
        return min(max(c.CENTRE_US + steering * c.US_PER_RAD // 1000, c.SERVO_LOW_US), c.SERVO_HIGH_US)

    def _stop_anew(self):
        """Stop until a drive line with zero speed comes."""
        self.flags.add("A")
        self._asked = [0, 0]
        self._drive()

    # ------------------------------------------------------------ time

    def guard(self, _timer=None):
        """Switch the motors off in time, even while something else blocks; called by a timer."""
        if self.board.since_ms(self._drove_ms) > self.config.WATCHDOG_MS:
            # A computer that was silent may first send a line that is long out of date.
            self.flags.add("W")
            self.flags.add("A")
        self._look_for_faults()
        if self.stands:
            self._drive()

    def step(self):
        """Do what is due; call this as often as possible."""
        self.guard()
        passed = self.board.since_ms(self._stepped_ms)
        if passed >= self.config.STEP_MS:
            self._stepped_ms = self.board.now_ms()
            self._uptime_ms = (self._uptime_ms + passed) & 0xFFFFFFFF
            self._look_at_battery()
            self._measure(passed)
            self._drive(passed)
        if not self._listens():
            # Renewed while it waits: after 6.2 days the time since it would be negative.
            self._told_ms = self.board.now_ms()
        elif self.board.since_ms(self._told_ms) >= self.config.TELEMETRY_MS:
            self._told_ms = self.board.now_ms()
            self._tell()

    def _listens(self):
        """Whether a line came lately; an old one is forgotten, because the time wraps."""
        if self.board.since_ms(self._heard_ms) >= self.config.QUIET_MS:
            self._heard_any = False
        return self._heard_any

    def _look_for_faults(self):
        for flag, fault in zip("LR", self.board.faults()):
            if fault:
                self.flags.add(flag)
                self.flags.add("A")
            else:
                self.flags.discard(flag)

    def _look_at_battery(self):
        millivolts = self.board.battery_mv()
        if millivolts < 0 or millivolts >= self.config.BATTERY_LOW_MV:
            self._well_ms = self.board.now_ms()
        if self.board.since_ms(self._well_ms) > self.config.BATTERY_LOW_FOR_MS:
            self.flags.add("U")
            self.flags.add("A")
        elif millivolts < 0 or millivolts >= self.config.BATTERY_BACK_MV:
            self.flags.discard("U")

    # ------------------------------------------------------------ motors

    def _measure(self, passed):
        counts = self.board.counts()
        if counts is None:
            self._speeds = [0, 0] if self.stands else self._asked
            return
        for side in _SIDES:
            turned = (counts[side] - self._counts[side]) * 6283185 // self.config.COUNTS_PER_TURN
            fresh = turned // max(passed, 1)
            # One count in 10 ms is coarse: the mean of the last few is more precise.
            self._speeds[side] += (fresh - self._speeds[side]) // 4
        self._counts = counts

    def _drive(self, passed=0):
        if self.stands:
            self._sums = [0, 0]
            if "L" in self.flags or "R" in self.flags:
                self.board.off()
            else:
                self.board.brake()
            return
        self.board.drive(self._duty(0, passed), self._duty(1, passed))

    def _duty(self, side, passed):
        """Return permille of full power; 0 for a wheel that should stand."""
        asked = self._asked[side]
        if asked == 0:
            self._sums[side] = 0
            return 0
        duty = asked * 1000 // self.config.MAX_SPEED_MRAD_S
        if "N" not in self.flags:
            error = asked - self._speeds[side]
            self._sums[side] += error * passed * self.config.GAIN_I // 1000000
            self._sums[side] = min(max(self._sums[side], -500), 500)
            duty += error * self.config.GAIN_P // 1000 + self._sums[side]
        # Never against the commanded direction.
        return min(max(duty, 0), 1000) if asked > 0 else min(max(duty, -1000), 0)

    # ------------------------------------------------------------ telemetry

    def _tell(self):
        flags = "".join([flag for flag in FLAGS if flag in self.flags]) or "-"
        left_ma, right_ma = self.board.currents_ma()
        self._say(
            "T", self._uptime_ms, self._obeyed,
            _within(self._speeds[0]), _within(self._speeds[1]), self._steering,
            self.board.battery_mv(), left_ma, right_ma, self.reader.refused, flags,
        )

    def _say(self, letter, *fields):
        self.board.write(protocol.wrap(letter, self._sequence, *fields))
        self._sequence = (self._sequence + 1) & 0xFFFF


def _within(speed):
    return min(max(speed, -200000), 200000)
