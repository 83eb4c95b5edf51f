"""Bags of flexdrill held against foreign programs: rosbags and mcap-ros2-support.

bags.py check BAG    reads the recording that the Rust test has made, with both, and checks types, hashes and values
bags.py live BAG     reads a recording that the node has made while it ran, with both, and holds one against the other
bags.py parts BAG    reads a recording in several files, and its metadata
bags.py killed BAG   finds that a recording that was killed is refused
bags.py record BAG   writes BAG again as BAG_mcap, BAG_sqlite and BAG_humble.db3, as `ros2 bag record -a` does that begins in the run
bags.py write DIR    writes DIR/mcap and DIR/sqlite with rosbags, for the Rust test to read

Ends with 77 when the packages are missing.
"""

import dataclasses
import math
import sqlite3
import sys
from collections import defaultdict
from pathlib import Path

try:
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory
    from rosbags.highlevel import AnyReader
    from rosbags.rosbag2 import Reader, ReaderError, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError as missing:
    print(f"missing: {missing.name}")
    sys.exit(77)

START = 1_700_000_000_000_000_000
PERIOD = 20_000_000
TOPICS = ["/rig_7/rig/rotary_speed_rpm", "/rig_7/twin/bit_state", "/rig_7/twin/contact_forces"]
ROOT = Path(__file__).resolve().parents[2]


def own_types():
    """Our types in rosbags' store, parsed by rosbags from the .msg files."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for path in sorted((ROOT / "msg").glob("*.msg")):
        store.register(get_types_from_msg(path.read_text(), f"flexdrill/msg/{path.stem}"))
    return store


def check_value(index, topic, stamp, message):
    """Message number `index` as tests/bag_support records it."""
    assert topic == TOPICS[index % 3], (index, topic)
    assert stamp == START + index // 3 * PERIOD, (index, stamp)
    if index % 3 == 0:
        assert message.data == index
        return
    assert message.header.stamp.sec * 10**9 + message.header.stamp.nanosec == stamp
    assert message.header.frame_id == "flexible_tool"
    if index % 3 == 1:
        assert (message.torque, message.rotary_speed) == (index, 4.2)
    else:
        assert message.max_pipe_guide_force == index
        assert list(message.state) == [1] * 40 and len(message.pipe_guide_normal) == 40


def check(bag):
    store = own_types()
    # rosbags refuses a hash that does not fit the definition in the file.
    with Reader(bag) as reader:
        assert reader.message_count > 0
        hashes = {connection.topic: connection.digest for connection in reader.connections}
        types = {connection.topic: connection.msgtype for connection in reader.connections}
        assert len(hashes) == 4, hashes
        for topic, digest in hashes.items():
            assert digest == store.hash_rihs01(types[topic]), (topic, digest)
        for connection in reader.connections:
            [qos] = connection.ext.offered_qos_profiles
            latched = connection.topic.endswith("whirl_warnings")
            assert qos.durability.name == ("TRANSIENT_LOCAL" if latched else "VOLATILE"), qos
            assert qos.reliability.name == ("BEST_EFFORT" if "rpm" in connection.topic else "RELIABLE"), qos
    count = 0
    with AnyReader([bag]) as reader:
        for connection, stamp, data in reader.messages():
            check_value(count, connection.topic, stamp, reader.deserialize(data, connection.msgtype))
            count += 1
        assert reader.start_time == START and count == reader.message_count
    [file] = bag.glob("*.mcap")
    again = 0
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            assert schema.encoding == "ros2msg" and channel.message_encoding == "cdr"
            assert message.publish_time == message.log_time
            check_value(again, channel.topic, message.log_time, decoded)
            again += 1
    assert again == count
    print(f"messages {count}")


def same(one, other):
    """Whether the messages of both programs have the same values; `one` is of rosbags."""
    if dataclasses.is_dataclass(one):
        # rosbags lists constants too, which ROS writes in capitals.
        names = [field.name for field in dataclasses.fields(one) if field.name.islower() and not field.name.startswith("__")]
        return all(same(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, str):
        return one == other
    if hasattr(one, "__len__"):
        return len(one) == len(other) and all(same(a, b) for a, b in zip(one, other))
    return one == other or (math.isnan(one) and math.isnan(other))


def live(bag):
    store = own_types()
    by_topic, count = defaultdict(list), 0
    with AnyReader([bag]) as reader:
        for connection in reader.connections:
            assert connection.digest == store.hash_rihs01(connection.msgtype), (connection.topic, connection.digest)
        for connection, stamp, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            by_topic[connection.topic].append((stamp, connection.msgtype, message))
            count += 1
        assert count == reader.message_count
    waiting = {topic: iter(messages) for topic, messages in by_topic.items()}
    [file] = bag.glob("*.mcap")
    again = 0
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            stamp, msgtype, expected = next(waiting[channel.topic])
            assert (stamp, msgtype) == (message.log_time, schema.name), channel.topic
            assert same(expected, decoded), (channel.topic, expected, decoded)
            again += 1
    assert again == count
    print(f"topics {len(by_topic)} messages {count}")


def parts(bag):
    count = 0
    with Reader(bag) as reader:
        for connection, _, _ in reader.messages():
            count += 1
        assert count == reader.message_count
    metadata = (bag / "metadata.yaml").read_text()
    files = list(bag.glob("*.mcap"))
    assert len(files) > 1 and all(metadata.count(f'- path: "{file.name}"') == 1 for file in files), metadata
    again = 0
    for file in files:
        with file.open("rb") as stream:
            again += sum(1 for _ in make_reader(stream, validate_crcs=True).iter_messages())
    assert again == count
    print(f"messages {count}")


def killed(bag):
    try:
        with Reader(bag) as reader:
            print(f"taken for a bag of {reader.message_count} messages")
    except (ReaderError, FileNotFoundError) as error:
        print(f"refused: {error}")


def write(folder):
    store = own_types()
    float64 = store.types["std_msgs/msg/Float64"]
    time = store.types["builtin_interfaces/msg/Time"]
    header = store.types["std_msgs/msg/Header"]
    bit_state = store.types["flexdrill/msg/BitState"]
    for plugin, name in ((StoragePlugin.MCAP, "mcap"), (StoragePlugin.SQLITE3, "sqlite")):
        with Writer(folder / name, version=9, storage_plugin=plugin) as writer:
            speed = writer.add_connection("/rig_7/rig/rotary_speed_rpm", float64.__msgtype__, typestore=store)
            state = writer.add_connection("/rig_7/twin/bit_state", bit_state.__msgtype__, typestore=store)
            for index in range(700):
                stamp = START + index * PERIOD
                writer.write(speed, stamp, store.serialize_cdr(float64(float(index)), float64.__msgtype__))
                head = header(time(stamp // 10**9, stamp % 10**9), "flexible_tool")
                message = bit_state(head, float(index), 4.2, 1e4, 0.5, 0.1, 0.2, 0.3, 0.9, 1.5, 1)
                # Half an instant later, but written before the next.
                writer.write(state, stamp + PERIOD // 2, store.serialize_cdr(message, bit_state.__msgtype__))
    print("hash", store.hash_rihs01("flexdrill/msg/BitState"))


def record(bag):
    """What a recorder of all topics hears: latched states when it begins, all else as it comes, and what others publish."""
    store = own_types()
    log = store.types["rcl_interfaces/msg/Log"]
    time = store.types["builtin_interfaces/msg/Time"]
    text = get_types_from_msg("string secret\nfloat64[] numbers\n", "other_msgs/msg/Foreign")
    store.register(text)
    with AnyReader([bag], default_typestore=store) as reader:
        connections = list(reader.connections)
        heard = [(stamp, connection, bytes(data)) for connection, stamp, data in reader.messages()]
    begin = heard[0][0] + 3 * 10**9
    latched = {
        connection.topic
        for connection in connections
        if any(qos.durability.name == "TRANSIENT_LOCAL" for qos in connection.ext.offered_qos_profiles)
    }
    standing = {}
    for stamp, connection, data in heard:
        if stamp < begin and connection.topic in latched:
            standing[connection.topic] = (begin, connection, data)
    # A recorder notes when it heard a message, some milliseconds after it was sent.
    later = [(stamp + 3_000_000, connection, data) for stamp, connection, data in heard if stamp >= begin]
    for plugin, name in ((StoragePlugin.MCAP, "mcap"), (StoragePlugin.SQLITE3, "sqlite")):
        with Writer(bag.with_name(f"{bag.name}_{name}"), version=9, storage_plugin=plugin) as writer:
            written = {
                connection.topic: writer.add_connection(
                    connection.topic,
                    connection.msgtype,
                    typestore=store,
                    offered_qos_profiles=connection.ext.offered_qos_profiles,
                )
                for connection in connections
            }
            rosout = writer.add_connection("/rosout", log.__msgtype__, typestore=store)
            foreign = writer.add_connection("/other/foreign", "other_msgs/msg/Foreign", typestore=store)
            said = log(time(begin // 10**9, 0), 20, "/other", "hello", "other.cpp", "main", 1)
            writer.write(rosout, begin, store.serialize_cdr(said, log.__msgtype__))
            writer.write(foreign, begin, b"\0\1\0\0\1\2\3")
            for stamp, connection, data in [*standing.values(), *later]:
                writer.write(written[connection.topic], stamp, data)
    as_humble(bag.with_name(f"{bag.name}_sqlite") / f"{bag.name}_sqlite.db3", bag.with_name(f"{bag.name}_humble.db3"))
    print(f"messages {len(standing) + len(later) + 2} latched {sorted(standing)}")


def as_humble(file, out):
    """The tables of ROS 2 Humble, which know no definitions and no hashes, and no metadata."""
    old, new = sqlite3.connect(file), sqlite3.connect(out)
    text, whole = "TEXT NOT NULL", "INTEGER NOT NULL"
    names = ["name", "type", "serialization_format", "offered_qos_profiles"]
    new.execute(f"CREATE TABLE topics(id INTEGER PRIMARY KEY, {', '.join(f'{name} {text}' for name in names)})")
    new.execute(f"CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id {whole}, timestamp {whole}, data BLOB NOT NULL)")
    for table, columns in (("topics", ["id", *names]), ("messages", ["id", "topic_id", "timestamp", "data"])):
        rows = old.execute(f"SELECT {', '.join(columns)} FROM {table}")
        new.executemany(f"INSERT INTO {table} VALUES ({', '.join('?' * len(columns))})", rows)
    new.commit()
    new.close()
    old.close()


def main():
    action, path = sys.argv[1:]
    actions = {"check": check, "live": live, "parts": parts, "killed": killed, "record": record, "write": write}
    actions[action](Path(path))


main()
