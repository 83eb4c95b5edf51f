"""Runs the installed package and prints the SHA-256 of all bits: python digest.py.

It needs the package alone, so that every Python that the wheel supports can run it. All must print the same line.
"""

from __future__ import annotations

import hashlib
import pickle
import platform
import sys

import flexdrill

HALF_S = 1.0


def main() -> None:
    twin = flexdrill.Twin()
    digest = hashlib.sha256(twin.configuration_hash.encode())
    first = twin.run(HALF_S, speed_rpm=[40.0, 57.3], weight_kn=10.0, record="all")
    # By way of every form in which a twin is passed on.
    others = [twin.fork(), pickle.loads(pickle.dumps(twin)), flexdrill.Twin.from_bytes(twin.to_bytes())]
    runs = flexdrill.rollout([twin, *others], {"weight_kn": 5.0}, HALF_S, record="all", threads=2)
    for run in runs:
        if run.failure is not None:
            raise run.failure
        for name, column in runs[0].columns.items():
            if column.tobytes() != run.columns[name].tobytes():
                raise SystemExit(f"{name} of a copy of the twin differs from that of the twin itself")
    for run in (first, runs[0]):
        for name, column in sorted(run.columns.items()):
            digest.update(f"{name} {column.dtype.str} {column.shape}".encode())
            digest.update(column.tobytes())
    try:
        flexdrill.Twin(tool__joint__limit_deg=-1.0)
    except flexdrill.ConfigError as error:
        digest.update(str(error).encode())
    else:
        raise SystemExit("tool.joint.limit_deg = -1 was accepted")
    if first.bit.torque_nm.max() < 10.0:
        raise SystemExit(f"the bit turns under {first.bit.torque_nm.max():.1f} N m: must be above 10 N m at 10 kN")
    print(f"Python {platform.python_version()}: {len(first.columns)} columns", file=sys.stderr)
    print(digest.hexdigest())


if __name__ == "__main__":
    main()
