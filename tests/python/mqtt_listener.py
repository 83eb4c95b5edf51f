"""What a broker carries, as paho-mqtt and pysparkplug read it.

Arguments: host and port. Prints a JSON line per message, and {"connected": true} for every connection. A line
"rebirth GROUP NODE" on standard input asks that node for a birth, "send TOPIC TEXT" publishes a text.
"""

import json
import sys

try:
    import paho.mqtt.client as mqtt
    import pysparkplug as sparkplug
    from pysparkplug._protobuf import Payload
except ImportError as missing:
    print(missing)
    sys.exit(77)

births = {}


def units(raw):
    """Engineering units by alias: pysparkplug keeps no properties, its generated classes do."""
    found = {}
    for metric in Payload.FromString(raw).metrics:
        values = dict(zip(metric.properties.keys, metric.properties.values))
        if "engUnit" in values:
            found[metric.alias] = values["engUnit"].string_value
    return found


def sparkplug_message(topic, raw):
    place = sparkplug.Topic.from_str(topic)
    key = (place.group_id, place.edge_node_id)
    kind = str(place.message_type.value)
    decoder = place.message_type.payload
    if kind == "NDEATH":
        number = decoder.decode(raw).bd_seq_metric
        return {"kind": kind, "metrics": {number.name: number.value}, "seq": None}
    if kind == "NCMD":
        return {"kind": kind}
    message = decoder.decode(raw, birth=births.get(key))
    if kind == "NBIRTH":
        births[key] = message
    raw_metrics = Payload.FromString(raw).metrics
    return {
        "kind": kind,
        "seq": message.seq,
        "metrics": {metric.name: metric.value for metric in message.metrics},
        "types": {metric.name: metric.datatype.name for metric in message.metrics},
        "aliases": {metric.name: metric.alias for metric in message.metrics},
        "units": units(raw),
        "named": sum(metric.HasField("name") for metric in raw_metrics),
    }


def say(line):
    print(json.dumps(line, allow_nan=False), flush=True)


def on_message(_client, _data, message):
    line = {"topic": message.topic, "retained": bool(message.retain), "qos": message.qos}
    try:
        if message.topic.startswith("spBv1.0/"):
            line["sparkplug"] = sparkplug_message(message.topic, message.payload)
        else:
            line["json"] = json.loads(message.payload)
    except Exception as error:
        line["error"] = repr(error)
    say(line)


def on_connect(client, *_):
    client.subscribe("#", 1)


def main():
    client = mqtt.Client(client_id="listener")
    client.on_connect = on_connect
    client.on_subscribe = lambda *_: say({"connected": True})
    client.on_message = on_message
    client.reconnect_delay_set(1, 1)
    client.connect_async(sys.argv[1], int(sys.argv[2]))
    client.loop_start()
    for line in sys.stdin:
        word, *rest = line.rstrip("\n").split(" ", 2)
        if word == "rebirth":
            group, node = rest
            topic = sparkplug.Topic(message_type=sparkplug.MessageType.NCMD, group_id=group, edge_node_id=node)
            metric = sparkplug.Metric(
                timestamp=sparkplug.get_current_timestamp(),
                name="Node Control/Rebirth",
                datatype=sparkplug.DataType.BOOLEAN,
                value=True,
            )
            command = sparkplug.NCmd(timestamp=sparkplug.get_current_timestamp(), metrics=(metric,))
            client.publish(str(topic), command.encode(include_dtypes=True), 0)
        elif word == "send":
            client.publish(rest[0], rest[1], 1)


main()
