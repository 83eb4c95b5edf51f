"""A viewer that steers, from other hands: websockets for the protocol, mcap-ros2-support for what it writes and reads.

steering_viewer.py steer URL             parameters, services and inputs, well and badly; says what came of each
steering_viewer.py drive URL RPM SECONDS  sends a speed ten times a second; says what the twin made of it at the end

Answers one JSON object. Ends with 77 when the packages are missing.
"""

import asyncio
import json
import struct
import sys
import time

from viewer import Schema, Viewer, DecoderFactory, opened
from mcap_ros2._dynamic import serialize_dynamic

SPEED, WEIGHT, BOTH = "/rig/rotary_speed_rpm", "/rig/weight_on_bit_kn", "/rig/inputs"
FRICTION, LARGEST, LINKS = "contact.inner.friction_axial", "inputs.rotary_speed.max_rpm", "tool.links"
SLEW = "inputs.weight_on_bit.slew_kn_per_s"


class Steering(Viewer):
    def __init__(self, socket):
        super().__init__(socket)
        self.services, self.values, self.replies, self.said, self.statuses = {}, [], {}, [], []

    async def greet(self):
        await super().greet()
        if "services" in self.info["capabilities"]:
            said = await self.word("advertiseServices")
            self.services = {service["name"]: service for service in said["services"]}

    def take(self, frame, decode=True):
        if isinstance(frame, str):
            said = json.loads(frame)
            if said["op"] == "parameterValues":
                self.values.append(said)
            elif said["op"] == "serviceCallFailure":
                self.replies[said["callId"]] = said["message"]
            elif said["op"] == "status":
                self.said.append(said["message"])
            return
        if frame[0] == 3:
            service, call, length = struct.unpack_from("<III", frame, 1)
            self.replies[call] = (service, frame[13 + length :])
            return
        if frame[0] == 1 and self.channels[struct.unpack_from("<I", frame, 1)[0]]["topic"] == "/twin/status":
            self.statuses.append(self.decode(struct.unpack_from("<I", frame, 1)[0], frame[13:]))
        elif frame[0] == 1:
            return

    async def until(self, condition, seconds=10.0):
        await self.listen(seconds, until=condition)
        return condition()

    async def ask(self, op, id, **what):
        """Parameters: their values as the answer has them."""
        await self.socket.send(json.dumps({"op": op, "id": id, **what}))
        await self.until(lambda: any(values.get("id") == id for values in self.values))
        found = [values for values in self.values if values.get("id") == id]
        return {each["name"]: each["value"] for values in found for each in values["parameters"]}

    async def call(self, name, request, call, payload=None):
        """A service: its reply as a plain dictionary, or why there is none."""
        service = self.services[name]
        kind = service["type"]
        encode = serialize_dynamic(kind + "_Request", service["request"]["schema"])[kind + "_Request"]
        body = encode(request) if payload is None else payload
        await self.socket.send(struct.pack("<BIII", 2, service["id"], call, 3) + b"cdr" + body)
        await self.until(lambda: call in self.replies)
        reply = self.replies.get(call)
        if reply is None or isinstance(reply, str):
            return reply
        schema = Schema(id=1, name=kind + "_Response", encoding="ros2msg", data=service["response"]["schema"].encode())
        message = DecoderFactory().decoder_for("cdr", schema)(reply[1])
        return {field: getattr(message, field) for field in message.__slots__ if not field.startswith("_")}

    async def advertise(self, channels):
        named = [
            {"id": id, "topic": topic, "encoding": encoding, "schemaName": kind}
            for id, (topic, encoding, kind) in channels.items()
        ]
        await self.socket.send(json.dumps({"op": "advertise", "channels": named}))

    async def publish(self, id, body):
        await self.socket.send(struct.pack("<BI", 1, id) + body)

    async def drive(self, seconds, **samples):
        """Sends ten times a second, by the channel's number."""
        for _ in range(int(10 * seconds)):
            for id, make in samples.items():
                await self.publish(int(id[1:]), make())
            await self.listen(0.1)

    def state(self):
        """What the newest status says of the inputs."""
        status = self.statuses[-1]
        fields = ("driver", "publishers", "received", "rejected", "source", "not_driving", "several_drivers", "unreadable")
        plain = lambda value: None if value != value else value
        return {field: [plain(value) for value in getattr(status, "input_" + field)] for field in fields}


def number(value):
    return b"\0\1\0\0" + struct.pack("<d", value)


def both(schema, speed, weight):
    encode = serialize_dynamic("flexdrill/msg/RigInputs", schema)["flexdrill/msg/RigInputs"]
    now = time.time_ns()
    stamp = {"sec": now // 10**9, "nanosec": now % 10**9}
    header = {"stamp": stamp, "frame_id": ""}
    return encode(
        {"header": header, "rotary_speed_rpm": speed, "weight_on_bit_kn": weight, "quality": 0, "source": "a hand"}
    )


async def steer(url):
    async with opened(url) as socket:
        viewer, found = Steering(socket), {}
        await viewer.greet()
        found["capabilities"] = viewer.info["capabilities"]
        found["encodings"] = viewer.info.get("supportedEncodings", [])
        found["services"] = {name: service["type"] for name, service in viewer.services.items()}
        await viewer.until(lambda: viewer.statuses)
        if not viewer.services:
            await refused(viewer, found)
            return found
        found["all"] = len(await viewer.ask("getParameters", "all", parameterNames=[]))
        found["before"] = await viewer.ask("getParameters", "some", parameterNames=[FRICTION, LARGEST, "no.such"])
        await viewer.socket.send(json.dumps({"op": "subscribeParameterUpdates", "parameterNames": [FRICTION, SLEW]}))
        changes = [{"name": FRICTION, "value": 0.31}, {"name": LARGEST, "value": 1000}, {"name": LINKS, "value": 3}]
        found["set"] = await viewer.ask("setParameters", "set", parameters=changes)
        # A whole number for a real one.
        await viewer.ask("setParameters", "whole", parameters=[{"name": SLEW, "value": 30}])
        found["whole"] = await viewer.ask("getParameters", "after", parameterNames=[SLEW])
        await viewer.until(lambda: sum("id" not in values for values in viewer.values) >= 2, 3.0)
        found["followed"] = [values["parameters"] for values in viewer.values if "id" not in values]
        found["refused"] = list(viewer.said)

        found["paused"] = await viewer.call("/flexdrill/pause", {"data": True}, 1)
        found["resumed"] = await viewer.call("/flexdrill/pause", {"data": False}, 2)
        listed = await viewer.call("/flexdrill/list_parameters", {"prefixes": ["bit"], "depth": 0}, 3)
        found["listed"] = listed is not None and list(listed["result"].names)
        unknown = {"id": "no_such", "operator_name": "a hand", "reason": "to see"}
        found["alarm"] = await viewer.call("/flexdrill/acknowledge_alarm", unknown, 4)
        found["broken"] = await viewer.call("/flexdrill/acknowledge_alarm", None, 5, b"\0\1\0\0\xff\xff\xff\xff")
        found["json"] = await viewer.call("/flexdrill/pause", None, 6, b'{"data": true}')

        viewer.said.clear()
        float64 = "std_msgs/msg/Float64"
        await viewer.advertise({1: (SPEED, "cdr", float64), 2: (WEIGHT, "cdr", "std_msgs/Float64")})
        await viewer.drive(2.0, _1=lambda: number(60.0), _2=lambda: number(12.0))
        found["driven"] = viewer.state()
        await viewer.publish(1, number(1000.0))
        await viewer.until(lambda: viewer.state()["rejected"][0] > 0)
        found["too_fast"] = viewer.state()
        await viewer.publish(1, b"\0\1\0\0\1\2")
        await viewer.until(lambda: viewer.state()["unreadable"][0] > 0)
        found["unreadable"] = viewer.state()
        schema = next(each["schema"] for each in viewer.channels.values() if each["topic"] == BOTH)
        await viewer.advertise({3: (BOTH, "cdr", "flexdrill/msg/RigInputs")})
        await viewer.drive(2.0, _3=lambda: both(schema, 50.0, 9.0))
        found["stamped"] = viewer.state()
        found["quiet"] = list(viewer.said)

        await viewer.advertise({4: ("/twin/status", "cdr", "flexdrill/msg/TwinStatus"), 5: (SPEED, "json", float64)})
        await viewer.publish(4, number(1.0))
        await viewer.publish(5, b'{"data": 1.0}')
        await viewer.publish(1, b"60")
        await viewer.until(lambda: len(viewer.said) >= 5, 5.0)
        found["no_input"] = list(viewer.said)
        # A channel stays what it was advertised as.
        await viewer.advertise({1: ("/mine", "cdr", float64)})
        await viewer.until(lambda: len(viewer.said) >= 6, 5.0)
        found["name"] = viewer.said[-1]
        return found


async def refused(viewer, found):
    """One that may only look, and tries."""
    for said in (
        {"op": "getParameters", "id": "a", "parameterNames": []},
        {"op": "setParameters", "id": "b", "parameters": [{"name": FRICTION, "value": 0.31}]},
        {"op": "subscribeParameterUpdates", "parameterNames": [FRICTION]},
        {"op": "advertise", "channels": [{"id": 1, "topic": SPEED, "encoding": "cdr", "schemaName": "std_msgs/msg/Float64"}]},
    ):
        await viewer.socket.send(json.dumps(said))
    await viewer.publish(1, number(60.0))
    await viewer.socket.send(struct.pack("<BIII", 2, 1, 7, 3) + b"cdr" + b"\0\1\0\0\1")
    await viewer.until(lambda: len(viewer.said) >= 5 and 7 in viewer.replies)
    await viewer.listen(0.5)
    found["said"] = viewer.said
    found["reply"] = viewer.replies.get(7)
    found["state"] = viewer.state()


async def drive(url, speed, seconds):
    async with opened(url) as socket:
        viewer = Steering(socket)
        await viewer.greet()
        await viewer.advertise({1: (SPEED, "cdr", "std_msgs/msg/Float64")})
        await viewer.drive(float(seconds), _1=lambda: number(float(speed)))
        return viewer.state()


def main():
    command, *arguments = sys.argv[1:]
    answer = asyncio.run({"steer": steer, "drive": drive}[command](*arguments))
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
