"""Clients that take what they can get of a live server: connections, memory, patience. Standard library alone.

crowd.py half HOST:PORT COUNT SECONDS         COUNT requests whose heads stay unfinished; meanwhile whole ones are made
crowd.py fragments HOST:PORT COUNT            COUNT viewers, each with an unfinished message of 16 MB, whole and in fragments
crowd.py stall HOST:PORT SECONDS              a viewer of everything that reads nothing for a time, then all

Answers one JSON object.
"""

import base64
import json
import os
import resource
import select
import socket
import struct
import sys
import time

PROTOCOL = "foxglove.sdk.v1"
PATIENCE = 10.0


def connected(place, **options):
    host, port = place.rsplit(":", 1)
    made = socket.socket()
    for option, value in options.items():
        made.setsockopt(socket.SOL_SOCKET, getattr(socket, option), value)
    made.settimeout(PATIENCE)
    made.connect((host, int(port)))
    return made


def upgraded(place, **options):
    made = connected(place, **options)
    key = base64.b64encode(os.urandom(16)).decode()
    head = ["GET / HTTP/1.1", f"Host: {place}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"]
    head += [f"Sec-WebSocket-Key: {key}", f"Sec-WebSocket-Protocol: {PROTOCOL}", "", ""]
    made.sendall("\r\n".join(head).encode())
    answer = b""
    while b"\r\n\r\n" not in answer:
        piece = made.recv(1)
        assert piece, answer
        answer += piece
    assert answer.startswith(b"HTTP/1.1 101"), answer
    return made


def exactly(made, count):
    data = b""
    while len(data) < count:
        piece = made.recv(count - len(data))
        if not piece:
            raise EOFError
        data += piece
    return data


def frame_of(made):
    """Opcode and payload of the server's next frame."""
    first, second = exactly(made, 2)
    length = second & 0x7F
    if length == 126:
        length = struct.unpack(">H", exactly(made, 2))[0]
    elif length == 127:
        length = struct.unpack(">Q", exactly(made, 8))[0]
    return first & 0x0F, exactly(made, length)


def masked(opcode, payload, final=True, announced=None):
    """A frame whose mask is zero; it may announce more than it has."""
    length = len(payload) if announced is None else announced
    return bytes([opcode | (0x80 if final else 0), 0x80 | 127]) + struct.pack(">Q", length) + bytes(4) + payload


def half(place, count, seconds):
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, count + 200), hard))
    held, answered, asked = [], 0, 0
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        # The server lets the oldest go, so they come again.
        while len(held) < count:
            try:
                made = connected(place)
                made.sendall(b"GET / HTTP/1.1\r\nHost: ")
                held.append(made)
            except OSError:
                break
        asked += 1
        try:
            made = connected(place)
            made.sendall(f"GET / HTTP/1.1\r\nHost: {place}\r\nConnection: close\r\n\r\n".encode())
            answered += made.recv(64).startswith(b"HTTP/1.1 ")
            made.close()
        except OSError:
            pass
        time.sleep(0.2)
    return {"asked": asked, "answered": answered, "held": len(held)}


def fragments(place, count):
    """How many bytes of each message were accepted before the connection was closed."""
    accepted = []
    piece = bytes(32 << 10)
    for number in range(count):
        made = upgraded(place)
        made.settimeout(2.0)
        sent = 0
        try:
            if number % 2:
                made.sendall(masked(2, b"", announced=16 << 20))
                while sent < 16 << 20:
                    sent += made.send(piece)
            else:
                made.sendall(masked(2, piece, final=False))
                while sent < 16 << 20:
                    made.sendall(masked(0, piece, final=False))
                    sent += len(piece)
        except OSError:
            pass
        accepted.append(sent)
        made.close()
    return {"accepted": accepted}


def stall(place, seconds):
    made = upgraded(place)
    channels = None
    while channels is None:
        opcode, payload = frame_of(made)
        if opcode == 1 and (said := json.loads(payload))["op"] == "advertise":
            channels = said["channels"]
    topics = {channel["id"]: channel["topic"] for channel in channels}
    wanted = [{"id": id, "channelId": id} for id in topics]
    made.sendall(masked(1, json.dumps({"op": "subscribe", "subscriptions": wanted}).encode()))
    print("stalled", file=sys.stderr, flush=True)
    time.sleep(seconds)
    resumed, ages = time.monotonic(), []
    while time.monotonic() < resumed + 3.0:
        opcode, payload = frame_of(made)
        if opcode != 2 or payload[0] != 1:
            continue
        subscription, stamp = struct.unpack_from("<IQ", payload, 1)
        if topics[subscription].endswith("/twin/joint_deflections"):
            ages.append(time.time() - stamp * 1e-9)
    # By the stamps of the messages, which are those of the same clock.
    return {"messages": len(ages), "old": sum(age > 2.0 for age in ages), "oldest": max(ages), "newest": min(ages)}


def main():
    command, place, *numbers = sys.argv[1:]
    answer = {"half": half, "fragments": fragments, "stall": stall}[command](place, *map(int, numbers))
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
