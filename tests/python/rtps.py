"""RTPS packets of a participant that announces itself as the specification has it, and what can be made of them.

Field names are those of the DDSI-RTPS 2.5 specification, chapters 8.3 and 9.4 to 9.6.
"""

import random
import struct
import time

PREFIX = b"\x01\x0fflexdrill!"[:12]
UNKNOWN = bytes(4)
PARTICIPANT = bytes([0, 0, 1, 0xC1])
SPDP = (bytes([0, 1, 0, 0xC2]), bytes([0, 1, 0, 0xC7]))
PUBLICATIONS = (bytes([0, 0, 3, 0xC2]), bytes([0, 0, 3, 0xC7]))
SUBSCRIPTIONS = (bytes([0, 0, 4, 0xC2]), bytes([0, 0, 4, 0xC7]))
LIVELINESS = (bytes([0, 2, 0, 0xC2]), bytes([0, 2, 0, 0xC7]))
BUILTIN = [SPDP, PUBLICATIONS, SUBSCRIPTIONS, LIVELINESS]
# A user's writer and reader, both without key.
WRITER = bytes([0, 0, 0x12, 0x03])
READER = bytes([0, 0, 0x13, 0x04])
FAR = 1 << 40
INPUT = ("rt/rig/rotary_speed_rpm", "std_msgs::msg::dds_::Float64_")
STATUS = ("rt/twin/status", "flexdrill::msg::dds_::TwinStatus_")


def header(prefix=PREFIX):
    return b"RTPS" + bytes([2, 4, 1, 0x0F]) + prefix


def submessage(kind, flags, body):
    return struct.pack("<BBH", kind, flags, len(body)) + body


def number(sequence):
    return struct.pack("<iI", sequence >> 32, sequence & 0xFFFF_FFFF)


def number_set(base, bits=0, bitmap=b""):
    return number(base) + struct.pack("<I", bits) + bitmap


def data(ids, sequence, payload):
    writer, reader = ids
    return submessage(0x15, 0x05, struct.pack("<HH", 0, 16) + reader + writer + number(sequence) + payload)


def data_frag(ids, sequence, start, size, fragment_size, payload):
    writer, reader = ids
    body = struct.pack("<HH", 0, 28) + reader + writer + number(sequence)
    return submessage(0x16, 0x01, body + struct.pack("<IHHI", start, 1, fragment_size, size) + payload)


def heartbeat(ids, first, last, count):
    writer, reader = ids
    return submessage(0x07, 0x01, reader + writer + number(first) + number(last) + struct.pack("<i", count))


def gap(ids, start, base, bits=0, bitmap=b""):
    writer, reader = ids
    return submessage(0x08, 0x01, reader + writer + number(start) + number_set(base, bits, bitmap))


def acknack(ids, base, bits, bitmap, count):
    writer, reader = ids
    body = reader + writer + number_set(base, bits, bitmap) + struct.pack("<i", count)
    return submessage(0x06, 0x01, body)


def nack_frag(ids, sequence, count):
    writer, reader = ids
    body = reader + writer + number(sequence) + struct.pack("<III", 1, 32, 0xFFFF_FFFF) + struct.pack("<i", count)
    return submessage(0x12, 0x01, body)


def heartbeat_frag(ids, sequence, last, count):
    writer, reader = ids
    return submessage(0x13, 0x01, reader + writer + number(sequence) + struct.pack("<Ii", last, count))


def info_timestamp():
    return submessage(0x09, 0x01, struct.pack("<II", int(time.time()), 0))


def info_destination(prefix=bytes(12)):
    return submessage(0x0E, 0x01, prefix)


def info_source():
    return submessage(0x0C, 0x01, bytes(4) + bytes([2, 4, 1, 0x0F]) + PREFIX)


def info_reply(port):
    return submessage(0x0F, 0x01, struct.pack("<I", 1) + locator(port))


def locator(port):
    return struct.pack("<iI", 1, port) + bytes(12) + bytes([127, 0, 0, 1])


def text(value):
    value = value.encode() + b"\0"
    return struct.pack("<I", len(value)) + value + bytes(-len(value) % 4)


def parameters(pairs):
    """A parameter list with its encapsulation."""
    body = b"".join(struct.pack("<HH", name, len(value)) + value for name, value in pairs)
    return b"\0\3\0\0" + body + struct.pack("<HH", 1, 0)


def participant(port):
    """What SPDP says of us."""
    return parameters(
        [
            (0x15, bytes([2, 4, 0, 0])),
            (0x16, bytes([1, 0x0F, 0, 0])),
            (0x50, PREFIX + PARTICIPANT),
            (0x58, struct.pack("<I", 0x0C3F)),
            (0x02, struct.pack("<iI", 20, 0)),
            (0x31, locator(port)),
            (0x32, locator(port)),
            (0x62, text("/")),
        ]
    )


def endpoint(entity, topic, reliable=True):
    """What SEDP says of a writer or reader of ours."""
    name, kind = topic
    return parameters(
        [
            (0x15, bytes([2, 4, 0, 0])),
            (0x16, bytes([1, 0x0F, 0, 0])),
            (0x50, PREFIX + PARTICIPANT),
            (0x5A, PREFIX + entity),
            (0x05, text(name)),
            (0x07, text(kind)),
            (0x1A, struct.pack("<IiI", 2 if reliable else 1, 0, 0)),
            (0x1D, struct.pack("<I", 0)),
            (0x1B, struct.pack("<IiI", 0, 0x7FFF_FFFF, 0xFFFF_FFFF)),
            (0x40, struct.pack("<Ii", 0, 10)),
            (0x2F, locator(7499)),
            (0x70, PREFIX + entity),
        ]
    )


def announcements(port=7499):
    """A participant, a writer of an input and a reader of the status, as they announce themselves."""
    yield header() + info_timestamp() + data(SPDP, 1, participant(port))
    yield header() + info_timestamp() + data(PUBLICATIONS, 1, endpoint(WRITER, INPUT))
    yield header() + info_timestamp() + data(SUBSCRIPTIONS, 1, endpoint(READER, STATUS))


def talk():
    """What the announced writer and reader go on to say."""
    sample = b"\0\1\0\0" + struct.pack("<d", 40.0)
    ours = (WRITER, UNKNOWN)
    theirs = (UNKNOWN, READER)
    yield header() + info_timestamp() + data(ours, 1, sample)
    yield header() + info_destination() + heartbeat(ours, 1, 3, 1)
    yield header() + gap(ours, 2, 3)
    yield header() + gap(ours, 2, 3, 40, struct.pack("<II", 0xAAAA_AAAA, 0xFF00_0000))
    yield header() + data_frag(ours, 4, 1, 3000, 1000, b"\0\1\0\0" + bytes(996))
    yield header() + heartbeat_frag(ours, 4, 3, 1)
    yield header() + info_source() + data(ours, 5, sample)
    yield header() + info_reply(7499) + acknack(theirs, 1, 32, struct.pack("<I", 0xFFFF_FFFF), 1)
    yield header() + nack_frag(theirs, 1, 1)
    for ids in BUILTIN:
        yield header() + heartbeat(ids, 1, 2, 1)
        yield header() + gap(ids, 1, 2)
        yield header() + acknack(ids, 1, 0, b"", 1)


LIMITS = [0, 1, 2, 3, 4, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFF_FFFF, 0x8000_0000, 0xFFFF_FFFF, FAR]


def mutate(packet, choose, others, numbers):
    """One to four changes of a packet; with `numbers` also whole fields at their limits."""
    packet = bytearray(packet)
    for _ in range(choose.randrange(1, 5)):
        place = choose.randrange(8, len(packet)) if len(packet) > 9 else 0
        change = choose.choice([0, 1, 4, 5, 6, 2, 3] if numbers else [0, 1, 4, 5, 6])
        if change == 0:
            packet[place] ^= 1 << choose.randrange(8)
        elif change == 1:
            packet[place] = choose.randrange(256)
        elif change == 2:
            form, most = choose.choice([("<H", 0xFFFF), ("<I", 0xFFFF_FFFF), (">I", 0xFFFF_FFFF)])
            value = struct.pack(form, choose.choice(LIMITS) & most)
            # Fields lie on multiples of four.
            place = min(place & ~3, len(packet) - len(value))
            packet[place : place + len(value)] = value
        elif change == 3:
            value = number(choose.choice([-1, 0, FAR, (1 << 63) - 1, -(1 << 63), 1 << 32]))
            place = min(place & ~3, len(packet) - len(value))
            packet[place : place + len(value)] = value
        elif change == 4:
            del packet[place:]
        elif change == 5:
            packet[place:place] = packet[place : place + choose.randrange(1, 64)]
        else:
            # Another message's submessages behind ours.
            packet += choose.choice(others)[20:]
        if len(packet) < 20:
            break
    return bytes(packet)


def mutated(seed, count=20_000):
    """Valid packets, each with a few changes; every hundredth as it should be, so that we stay announced.

    Whole fields are put at their limits with odd seeds only: the library soon ends with those and does not see the
    rest.
    """
    choose = random.Random(seed)
    valid = list(announcements()) + list(talk())
    for index in range(count):
        if index % 100 == 0:
            yield from announcements()
        yield mutate(choose.choice(valid), choose, valid, seed % 2 == 1)


def announced_gap():
    """Announced writers say that all their samples up to 2^40 are irrelevant, or that they have all of them."""
    for count in range(1, 4):
        yield from announcements()
        time.sleep(0.3)
        for ids in [*BUILTIN, (WRITER, UNKNOWN)]:
            # From what is awaited next on, and from behind it on.
            yield header() + gap(ids, 1, FAR)
            yield header() + gap(ids, 1000, FAR)
            yield header() + gap(ids, 1, FAR, 256, b"\xff" * 32)
            yield header() + heartbeat(ids, 1, FAR, count)
            yield header() + heartbeat(ids, FAR, 2 * FAR, count + 10)
            yield header() + gap(ids, 3 * FAR, 4 * FAR)
        for writer, _ in BUILTIN:
            yield header() + acknack((writer, UNKNOWN), FAR, 256, b"\xff" * 32, count)
