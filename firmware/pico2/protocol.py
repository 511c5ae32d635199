"""Lines between the computer and the Pico: see docs/pico-protocol.md. Runs on any Python."""

LONGEST = 128

_LIMITS = {
    "V": ((0, 255),),
    "D": ((-200000, 200000), (-200000, 200000), (-1571, 1571)),
    "E": (),
    "R": (),
}


def crc16(data):
    """Return the CRC-16/IBM-3740 of bytes."""
    crc = 0xFFFF
    for octet in data:
        crc ^= octet << 8
        for _ in range(8):
            crc = (crc << 1) ^ 0x1021 if crc & 0x8000 else crc << 1
        crc &= 0xFFFF
    return crc


def wrap(*fields):
    """Return the line for some fields, as bytes."""
    body = ",".join([str(field) for field in fields]).encode()
    return b"$%s*%04X\n" % (body, crc16(body))


def unwrap(line):
    """Return the body of a line (bytes without its end) as text, None if it is invalid."""
    if len(line) < 7 or line[0] != 0x24 or line[-5] != 0x2A:
        return None
    body = line[1:-5]
    for octet in body:
        if not 0x20 <= octet <= 0x7E or octet == 0x24 or octet == 0x2A:
            return None
    return body.decode() if line[-4:] == b"%04X" % crc16(body) else None


def number(word):
    """Return the value of a whole number in its shortest form, None for anything else."""
    digits = word[1:] if word.startswith("-") else word
    if not 0 < len(digits) <= 10:
        return None
    for digit in digits:
        if not "0" <= digit <= "9":
            return None
    if digits[0] == "0" and word != "0":
        return None
    return int(word)


def parse(body):
    """Return letter and numbers of a line from the computer, None if any part is invalid."""
    words = body.split(",")
    limits = _LIMITS.get(words[0])
    if limits is None or len(words) != len(limits) + 2:
        return None
    fields = [words[0]]
    for word, (low, high) in zip(words[1:], ((0, 65535),) + limits):
        value = number(word)
        if value is None or not low <= value <= high:
            return None
        fields.append(value)
    return fields


class Reader:
    """Finds lines in a stream, byte by byte; buffers at most `LONGEST` bytes."""

    def __init__(self):
        self.refused = 0
        self._line = bytearray(LONGEST)
        self._size = 0  # one more than fits means too long

    def feed(self, octet):
        """Return the fields of the line that this byte completes, None if there is no valid one."""
        if octet != 0x0A and octet != 0x0D:
            if octet == 0x24:
                self._size = 0
            if self._size < LONGEST:
                self._line[self._size] = octet
            self._size = min(self._size + 1, LONGEST + 1)
            return None
        size, self._size = self._size, 0
        if size == 0:
            return None
        body = unwrap(bytes(self._line[:size])) if size < LONGEST else None
        fields = None if body is None else parse(body)
        if fields is None:
            self.refused = (self.refused + 1) & 0xFFFFFFFF
        return fields
