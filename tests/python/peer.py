"""A DDS program from another vendor (Cyclone DDS), told what to do by one JSON object per line on standard input.

Answers one JSON object per line. Commands: subscribe, take, listen, publish, flood, call,
matched, rihs01, endpoints, user_data, quit.
"""

import hashlib
import json
import math
import sys
import time

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription
from cyclonedds.core import InstanceState, Policy, Qos, ReadCondition, SampleState, ViewState, WaitSet
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

import ros_types

# What this client calls itself in the header of rmw_cyclonedds.
CLIENT = 0x1122334455667788


def qos(kind, depth=50):
    """`reliable`, `best_effort`, `latched` (reliable and transient local), `hoarding` (reliable, has room for five only)."""
    policies = [Policy.History.KeepLast(depth)]
    if kind == "hoarding":
        policies = [Policy.History.KeepAll, Policy.ResourceLimits(5, 1, 5)]
    if kind == "best_effort":
        policies.append(Policy.Reliability.BestEffort)
    else:
        policies.append(Policy.Reliability.Reliable(duration(milliseconds=100)))
    policies.append(Policy.Durability.TransientLocal if kind == "latched" else Policy.Durability.Volatile)
    return Qos(*policies)


class Peer:
    def __init__(self, domain):
        self.participant = DomainParticipant(domain)
        self.readers = {}
        self.writers = {}
        self.sequence = 0

    def reader(self, name, made, kind, depth=50):
        return DataReader(self.participant, Topic(self.participant, name, made), qos=qos(kind, depth))

    def subscribe(self, topic, type, kind="reliable", depth=50):
        self.readers[topic] = self.reader("rt" + topic, ros_types.make(type), kind, depth)
        return {"id": self.readers[topic].get_guid().hex}

    def take(self, topic, seconds=0.0, count=1):
        """Messages until there are `count` or time is up."""
        found, deadline = [], time.monotonic() + seconds
        while True:
            # That a writer has gone comes as a sample without data.
            samples = [sample for sample in self.readers[topic].take(N=1000) if sample.sample_info.valid_data]
            found += [ros_types.to_plain(sample) for sample in samples]
            if len(found) >= count or time.monotonic() >= deadline:
                return {"messages": found}
            time.sleep(0.005)

    def listen(self, topics, seconds):
        """Per topic [stamp, written, received] of each message, in ns since 1970, as it arrives; takes what is old first.

        `stamp` is the header's, `written` the sender's own time in DDS (0 when it does not tell), `received` is taken
        when this program has the message decoded.
        """
        waitset, found = WaitSet(self.participant), {topic: [] for topic in topics}
        conditions = {}
        for topic in topics:
            self.readers[topic].take(N=1000)
            mask = ViewState.Any | InstanceState.Alive | SampleState.NotRead
            conditions[topic] = ReadCondition(self.readers[topic], mask)
            waitset.attach(conditions[topic])
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            waitset.wait(duration(seconds=left))
            for topic, condition in conditions.items():
                while samples := self.readers[topic].take(condition=condition):
                    received = time.time_ns()
                    stamp = samples[0].header.stamp
                    written = max(samples[0].sample_info.source_timestamp, 0)
                    found[topic].append([stamp.sec * 10**9 + stamp.nanosec, written, received])
        return {"received": found}

    def publish(self, topic, type, value, kind="reliable", wait=5.0, short=False):
        made = ros_types.short(type) if short else ros_types.make(type)
        key = (topic, "short") if short else topic
        is_new = key not in self.writers
        if is_new:
            self.writers[key] = DataWriter(self.participant, Topic(self.participant, "rt" + topic, made), qos=qos(kind))
        writer, deadline = self.writers[key], time.monotonic() + wait
        while not writer.get_matched_subscriptions() and time.monotonic() < deadline:
            time.sleep(0.01)
        if is_new:
            # The other side may learn of this writer a moment later, and it reads best effort.
            time.sleep(0.5)
        value = {field: float(item) if item in ("NaN", "Infinity", "-Infinity") else item for field, item in value.items()}
        writer.write(ros_types.from_plain(made, value))
        return {"matched": len(writer.get_matched_subscriptions())}

    def flood(self, topic, type, value, seconds):
        """Writes the same again and again, as fast as it can; how often."""
        self.publish(topic, type, value)
        writer, message = self.writers[topic], ros_types.from_plain(ros_types.make(type), value)
        count, end = 0, time.monotonic() + seconds
        while time.monotonic() < end:
            writer.write(message)
            count += 1
        return {"count": count}

    def matched(self, topic):
        return {"matched": len(self.readers[topic].get_matched_publications())}

    def endpoints(self, seconds=2.0):
        """All writers and readers of others: topic in DDS, and whether it is latched."""
        time.sleep(seconds)
        found = {}
        for name, builtin in (("writers", BuiltinTopicDcpsPublication), ("readers", BuiltinTopicDcpsSubscription)):
            samples = BuiltinDataReader(self.participant, builtin).take(N=1000)
            others = [
                sample
                for sample in samples
                if sample.sample_info.valid_data and sample.participant_key != self.participant.guid
            ]
            found[name] = [[each.topic_name, Policy.Durability.TransientLocal in each.qos] for each in others]
        return found

    def user_data(self, seconds=2.0):
        """What all writers and readers of others announce as USER_DATA, by the topic in DDS."""
        time.sleep(seconds)
        found = {}
        for builtin in (BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription):
            for sample in BuiltinDataReader(self.participant, builtin).take(N=1000):
                if not sample.sample_info.valid_data or sample.participant_key == self.participant.guid:
                    continue
                data = [policy.data for policy in sample.qos if isinstance(policy, Policy.Userdata)]
                found.setdefault(sample.topic_name, []).append(bytes(data[0]).decode() if data else "")
        return {"user_data": found}

    def rihs01(self, description):
        """The hash of a type description, from itself."""
        whole = {
            "type_description": individual(description["type_description"]),
            "referenced_type_descriptions": [individual(each) for each in description["referenced_type_descriptions"]],
        }
        return {"hash": "RIHS01_" + hashlib.sha256(json.dumps(whole).encode()).hexdigest()}

    def call(self, service, type, request, header=False, seconds=5.0):
        """Calls a service: plain, or with the header of rmw_cyclonedds."""
        wrap = ros_types.with_cyclone_header if header else ros_types.make
        request_type, reply_type = wrap(type + "_Request"), wrap(type + "_Response")
        key = (service, header)
        if key not in self.writers:
            self.writers[key] = (
                DataWriter(self.participant, Topic(self.participant, f"rq{service}Request", request_type), qos=qos("reliable")),
                self.reader(f"rr{service}Reply", reply_type, "reliable"),
            )
        writer, reader = self.writers[key]
        deadline = time.monotonic() + seconds
        while not (writer.get_matched_subscriptions() and reader.get_matched_publications()):
            if time.monotonic() > deadline:
                return {"error": "no server"}
            time.sleep(0.01)
        self.sequence += 1
        identity = {"client_id": CLIENT, "sequence": self.sequence} if header else {}
        message = ros_types.from_plain(request_type, {**identity, **request})
        reader.take(N=1000)
        writer.write(message)
        while time.monotonic() < deadline:
            for sample in reader.take(N=100):
                plain = ros_types.to_plain(sample)
                if all(plain.pop(field) == value for field, value in identity.items()):
                    return {"reply": plain}
            time.sleep(0.002)
        return {"error": "no reply"}


def individual(described):
    """A type of a reply as the canonical JSON of REP-2016 has it: without default values."""
    fields = [{"name": field["name"], "type": field["type"]} for field in described["fields"]]
    return {"type_name": described["type_name"], "fields": fields}


def finite(value):
    """NaN and infinities are not JSON."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return value


def main():
    peer = Peer(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    print(json.dumps({"ready": True}), flush=True)
    for line in sys.stdin:
        command = json.loads(line)
        name = command.pop("do")
        if name == "quit":
            break
        try:
            answer = getattr(peer, name)(**command)
        except Exception as error:  # told to the test, which fails on it
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(finite(answer)), flush=True)


if __name__ == "__main__":
    main()
