"""A viewer as Foxglove is one, from other hands: the package websockets for the protocol, mcap-ros2-support for the messages.

viewer.py decode URL SECONDS [SUBPROTOCOL]   subscribes to everything; says per topic what came, decoded by its own schema
viewer.py crowd URL COUNT SECONDS            COUNT viewers that subscribe to everything, one of which takes nothing; one decodes
viewer.py light URL COUNT SECONDS            the same of a crowd that only empties its sockets; says how many bytes each got
viewer.py play URL                           pauses, seeks, plays faster, to the end; says what the server answered
viewer.py refused URL SUBPROTOCOL ORIGIN     says with which code it is not let in ("-" leaves either out)

Answers one JSON object. Ends with 77 when the packages are missing.
"""

import asyncio
import json
import math
import select
import socket as socketlib
import struct
import sys
import time

try:
    import websockets
    from mcap.records import Schema
    from mcap_ros2.decoder import DecoderFactory
    from websockets.asyncio.client import connect
except ImportError as missing:
    print(f"missing: {missing.name}")
    sys.exit(77)

PROTOCOL = "foxglove.sdk.v1"


class Viewer:
    def __init__(self, socket):
        self.socket = socket
        self.info = None
        self.channels = {}
        self.found = {}
        self.decoders = {}
        self.states = []
        self.times = []

    async def greet(self):
        """Server info and all channels, with an id that is not theirs for each."""
        self.info = json.loads(await self.socket.recv())
        assert self.info["op"] == "serverInfo", self.info
        said = await self.word("advertise")
        self.channels = {1000 + index: channel for index, channel in enumerate(said["channels"])}
        subscriptions = [{"id": id, "channelId": channel["id"]} for id, channel in self.channels.items()]
        await self.socket.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))

    async def word(self, op):
        """The next text, which is that one; a bag's player tells the time and its state meanwhile."""
        while not isinstance(frame := await self.socket.recv(), str):
            self.take(frame)
        said = json.loads(frame)
        assert said["op"] == op, said
        return said

    def decode(self, id, data):
        channel = self.channels[id]
        if id not in self.decoders:
            assert (channel["encoding"], channel["schemaEncoding"]) == ("cdr", "ros2msg"), channel
            schema = Schema(id=id, name=channel["schemaName"], encoding="ros2msg", data=channel["schema"].encode())
            self.decoders[id] = DecoderFactory().decoder_for("cdr", schema)
        return self.decoders[id](data)

    def take(self, frame, decode=True):
        if isinstance(frame, str):
            said = json.loads(frame)
            assert said["op"] != "status" or said["level"] == 0, said
            return
        if frame[0] == 5:
            status, now, speed, sought, length = struct.unpack_from("<BQfBI", frame, 1)
            request = frame[19 : 19 + length].decode()
            self.states.append({"status": status, "time": now, "speed": speed, "did_seek": sought, "request": request})
            return
        if frame[0] == 2:
            self.times.append(struct.unpack_from("<Q", frame, 1)[0])
            return
        assert frame[0] == 1, frame[0]
        id, stamp = struct.unpack_from("<IQ", frame, 1)
        topic = self.found.setdefault(self.channels[id]["topic"], {"count": 0, "stamps": []})
        topic["count"] += 1
        topic["stamps"].append(stamp)
        if decode:
            message = self.decode(id, frame[13:])
            topic["type"] = self.channels[id]["schemaName"]
            header = getattr(message, "header", None)
            if header is not None:
                topic["header"] = header.stamp.sec * 10**9 + header.stamp.nanosec
                topic["frame"] = header.frame_id
            for field in ("weight_on_bit", "real_time_factor", "data", "max_bend_angle", "sequence", "configuration"):
                value = getattr(message, field, None)
                if isinstance(value, (int, float, str)) and not (isinstance(value, float) and not math.isfinite(value)):
                    topic[field] = value

    async def listen(self, seconds, decode=True, until=None):
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0 and not (until and until()):
            try:
                self.take(await asyncio.wait_for(self.socket.recv(), min(left, 0.1)), decode)
            except TimeoutError:
                pass

    async def control(self, command, speed, seek, request):
        """Asks to play (0) or to pause (1); the server's answer."""
        text = request.encode()
        head = struct.pack("<BBfBQI", 3, command, speed, seek is not None, seek or 0, len(text))
        await self.socket.send(head + text)
        await self.listen(5.0, until=lambda: any(state["request"] == request for state in self.states))
        return next(state for state in self.states if state["request"] == request)


def opened(url, protocol=PROTOCOL, **more):
    return connect(url, subprotocols=[protocol], max_size=None, compression=None, **more)


async def decode(url, seconds, protocol=PROTOCOL):
    async with opened(url, protocol) as socket:
        viewer = Viewer(socket)
        await viewer.greet()
        await viewer.listen(float(seconds))
        for topic in viewer.found.values():
            stamps = topic.pop("stamps")
            topic["first"], topic["last"] = stamps[0], stamps[-1]
        return {
            "name": viewer.info["name"],
            "capabilities": viewer.info["capabilities"],
            "offered": [channel["topic"] for channel in viewer.channels.values()],
            "found": viewer.found,
        }


async def crowd(url, count, seconds):
    """All subscribe to everything. The first takes nothing after that, with the smallest buffer; the last decodes."""
    frozen = socketlib.socket()
    frozen.setsockopt(socketlib.SOL_SOCKET, socketlib.SO_RCVBUF, 4096)
    host, port = url.split("/")[2].rsplit(":", 1)
    frozen.connect((host, int(port)))
    viewers = []
    for index in range(int(count)):
        more = {"sock": frozen, "max_queue": 1} if index == 0 else {}
        viewer = Viewer(await opened(url, **more))
        await viewer.greet()
        viewers.append(viewer)
    viewers[0].socket.transport.pause_reading()

    async def take(viewer, is_last):
        await viewer.listen(float(seconds), decode=is_last)
        return sum(topic["count"] for topic in viewer.found.values())

    counts = await asyncio.gather(*(take(viewer, viewer is viewers[-1]) for viewer in viewers[1:]))
    stamps = viewers[-1].found["/twin/joint_deflections"]["stamps"]
    gaps = sum(later - earlier > 25_000_000 for earlier, later in zip(stamps, stamps[1:]))
    for viewer in viewers[1:]:
        await viewer.socket.close()
    frozen.close()
    return {"counts": counts, "joints": len(stamps), "gaps": gaps, "topics": len(viewers[-1].found)}


async def light(url, count, seconds):
    """Viewers that cost next to nothing: the handshake and a subscription by hand, then bytes that nobody looks at."""
    async with opened(url) as socket:
        first = Viewer(socket)
        await first.greet()
    wanted = json.dumps({
        "op": "subscribe",
        "subscriptions": [{"id": id, "channelId": channel["id"]} for id, channel in first.channels.items()],
    }).encode()
    frame = b"\x81\xfe" + struct.pack(">H", len(wanted)) + bytes(4) + wanted
    place = url.split("/")[2]
    upgrade = ["GET / HTTP/1.1", f"Host: {place}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"]
    upgrade += ["Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", f"Sec-WebSocket-Protocol: {PROTOCOL}", "", ""]
    host, port = place.rsplit(":", 1)
    sockets = {}
    for index in range(int(count)):
        viewer = socketlib.socket()
        if index == 0:
            viewer.setsockopt(socketlib.SOL_SOCKET, socketlib.SO_RCVBUF, 4096)
        viewer.connect((host, int(port)))
        viewer.sendall("\r\n".join(upgrade).encode())
        head = viewer.recv(4096)
        assert head.startswith(b"HTTP/1.1 101"), head
        viewer.sendall(frame)
        sockets[viewer] = 0
    frozen, *others = sockets
    room, deadline = bytearray(1 << 20), time.monotonic() + float(seconds)
    while time.monotonic() < deadline:
        # Ten times a second, all that lies there: a viewer's own pace.
        time.sleep(0.1)
        for viewer in select.select(others, [], [], 0)[0]:
            sockets[viewer] += viewer.recv_into(room)
    for viewer in sockets:
        viewer.close()
    return {"bytes": [sockets[viewer] for viewer in others]}


async def play(url):
    async with opened(url) as socket:
        viewer = Viewer(socket)
        await viewer.greet()
        start, end = (viewer.info[key]["sec"] * 10**9 + viewer.info[key]["nsec"] for key in ("dataStartTime", "dataEndTime"))
        middle = (start + end) // 2
        await viewer.listen(2.0, until=lambda: viewer.states)
        greeted = viewer.states[:1]
        paused = await viewer.control(1, 1.0, middle, "pause in the middle")
        await viewer.listen(1.0)
        named = lambda name: next(topic for topic in viewer.found if topic.endswith(name))
        status = named("/twin/status")
        at_rest = max(viewer.found[status]["stamps"][-1:] or [0])
        count = sum(topic["count"] for topic in viewer.found.values())
        async with opened(url) as another:
            late = Viewer(another)
            await late.greet()
            await late.listen(2.0, until=lambda: late.states)
        await viewer.listen(1.0)
        still = sum(topic["count"] for topic in viewer.found.values()) - count
        began = time.monotonic()
        played = await viewer.control(0, 4.0, None, "four times as fast")
        await viewer.listen(60.0, until=lambda: any(state["status"] == 3 for state in viewer.states))
        took = time.monotonic() - began
        again = await viewer.control(0, 1.0, start, "from the beginning")
        await viewer.listen(0.5)
        return {
            "capabilities": viewer.info["capabilities"],
            "start": start,
            "end": end,
            "middle": middle,
            "greeted": greeted,
            "late": late.states[:1],
            "paused": paused,
            "at_rest": at_rest,
            "still": still,
            "played": played,
            "took": took,
            "ended": next(state for state in viewer.states if state["status"] == 3),
            "again": again,
            "after": viewer.found[status]["stamps"][-1],
            "times": len(viewer.times),
            "session": viewer.found[named("/twin/session")]["count"],
        }


async def refused(url, protocol, origin):
    more = {} if origin == "-" else {"origin": origin}
    try:
        async with connect(url, subprotocols=None if protocol == "-" else [protocol], **more):
            return {"code": 101}
    except websockets.exceptions.InvalidStatus as error:
        return {"code": error.response.status_code, "body": error.response.body.decode()}


def main():
    command, *arguments = sys.argv[1:]
    commands = {"decode": decode, "crowd": crowd, "light": light, "play": play, "refused": refused}
    answer = asyncio.run(commands[command](*arguments))
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
