"""Sends RTPS packets that no honest program sends, from nobody, to every DDS port of this machine's first participants.

Usage: packets.py KIND [SEED], one of `huge_fragment`, `large_fragments`, `prefixes`, `noise`, `mutated`,
`announced_gap`. The last two come from a participant that has announced itself. SEED makes `mutated` other packets.
"""

import os
import random
import socket
import struct
import sys

from rtps import announced_gap, mutated

# Domain 0: discovery and user traffic by unicast of the first eight participants, and discovery by multicast.
PORTS = [7400, 7401] + [7410 + offset for offset in range(16)]
SPDP_WRITER = bytes([0, 1, 0, 0xC2])
SPDP_READER = bytes([0, 1, 0, 0xC7])


def header(prefix):
    return b"RTPS" + bytes([2, 4, 1, 0x0F]) + prefix


def submessage(kind, flags, body):
    return struct.pack("<BBH", kind, flags, len(body)) + body


def fragment(sequence, size, fragment_size=1000, start=1, payload=b"\0" * 100):
    """DATA_FRAG of a sample of `size` bytes."""
    body = struct.pack("<HH", 0, 28) + SPDP_READER + SPDP_WRITER
    body += struct.pack("<iIIHHI", 0, sequence, start, 1, fragment_size, size) + payload
    return submessage(0x16, 0x01, body)


def data():
    body = struct.pack("<HH", 0, 16) + SPDP_READER + SPDP_WRITER + struct.pack("<iI", 0, 1) + b"\0\3\0\0\1\0\0\0"
    return submessage(0x15, 0x05, body)


def packets(kind):
    if kind == "huge_fragment":
        yield header(b"a" * 12) + fragment(1, 0xFFFF_FFFF)
    elif kind == "large_fragments":
        for index in range(12):
            yield header(b"b" * 11 + bytes([index])) + fragment(index + 1, 300_000_000)
    elif kind == "prefixes":
        for index in range(200_000):
            yield header(struct.pack("<IQ", 7, index)) + data()
    elif kind == "noise":
        random.seed(1)
        for _ in range(20_000):
            kind = random.choice([0x06, 0x07, 0x08, 0x09, 0x0C, 0x0E, 0x12, 0x13, 0x15, 0x16, random.randrange(256)])
            body = os.urandom(random.randrange(0, 120))
            yield header(os.urandom(12)) + submessage(kind, random.randrange(256), body)
    elif kind == "mutated":
        yield from mutated(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    elif kind == "announced_gap":
        yield from announced_gap()
    else:
        sys.exit(f"{kind}: no such packets")


def main():
    to = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for packet in packets(sys.argv[1]):
        for port in PORTS:
            try:
                to.sendto(packet, ("127.0.0.1", port))
            except OSError:
                # Nobody is there.
                pass


main()
