"""Messages of flexdrill held against rosbags' own type system.

messages.py    reads lines `type hash [cdr-in-hex]` and answers each with `same` or what differs: the hash computed by
               rosbags from the .msg files, and the bytes, if given, decoded and encoded again by rosbags

Ends with 77 when the package is missing.
"""

import sys
from pathlib import Path

try:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
except ImportError as missing:
    print(f"missing: {missing.name}")
    sys.exit(77)

ROOT = Path(__file__).resolve().parents[2]


def main():
    store = get_typestore(Stores.ROS2_JAZZY)
    for path in sorted((ROOT / "msg").glob("*.msg")):
        store.register(get_types_from_msg(path.read_text(), f"flexdrill/msg/{path.stem}"))
    # Packages that rosbags has keep its own definitions.
    for path in sorted((ROOT / "crates/flexdrill-messages/external").glob("*/msg/*.msg")):
        name = f"{path.parts[-3]}/msg/{path.stem}"
        if name not in store.fielddefs:
            store.register(get_types_from_msg(path.read_text(), name))
    for line in sys.stdin:
        name, digest, *text = line.split()
        expected = store.hash_rihs01(name)
        if digest != expected:
            print(f"{name}: hash {expected}")
            continue
        if not text:
            print("same")
            continue
        data = bytes.fromhex(text[0])
        again = bytes(store.serialize_cdr(store.deserialize_cdr(data, name), name))
        # rosbags pads to a multiple of four.
        if again[: len(data)] != data or len(again) - len(data) > 3:
            print(f"{name}: other bytes")
        else:
            print("same")


main()
