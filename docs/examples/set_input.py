"""Sends one input to the twin ten times a second, as any DDS program can (pip install cyclonedds==11.0.1).

    python3 docs/examples/set_input.py rotary_speed_rpm 60
    python3 docs/examples/set_input.py weight_on_bit_kn 15 --seconds 60
"""

import argparse
import os
import time
from dataclasses import dataclass

try:
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import IdlStruct, annotations
    from cyclonedds.idl.types import float64
    from cyclonedds.pub import DataWriter
    from cyclonedds.topic import Topic
except ImportError as missing:
    raise SystemExit(f"{missing.name} is missing: pip install cyclonedds==11.0.1") from None


@dataclass
@annotations.final
class Float64(IdlStruct, typename="std_msgs::msg::dds_::Float64_"):
    data: float64


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", choices=["rotary_speed_rpm", "weight_on_bit_kn"])
    parser.add_argument("value", type=float)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--namespace", default="/")
    given = parser.parse_args()
    participant = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
    name = "rt/" + f"{given.namespace.strip('/')}/rig/{given.input}".lstrip("/")
    writer = DataWriter(participant, Topic(participant, name, Float64))
    end = time.monotonic() + given.seconds
    while time.monotonic() < end:
        writer.write(Float64(given.value))
        time.sleep(0.1)


if __name__ == "__main__":
    main()
