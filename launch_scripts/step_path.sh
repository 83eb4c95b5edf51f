#!/usr/bin/env bash
# What one step of the model runs through: launch_scripts/step_path.sh [CONFIG] [STEPS]
# Counts the source files of the core whose instructions ran, and the types of the core that these files name, over some
# steps of a tool that drills. Needs valgrind; takes some minutes, most of them for the static start under valgrind.
set -euo pipefail
. "$(dirname "$0")/common.sh"

config=${1:-$root/config/rig.yaml} steps=${2:-20}
need_packages build-essential python3 valgrind
need_rust
cd "$root"
target=${CARGO_TARGET_DIR:-target}/step_path
# Valgrind reads the fourth version of debugging information; inlined functions keep their files in it.
RUSTFLAGS="-C dwarf-version=4" CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_DEBUG=2 CARGO_PROFILE_RELEASE_STRIP=none \
    CARGO_PROFILE_RELEASE_LTO=off cargo build --quiet --release --locked --package flexdrill-measurements --example step_path --target-dir "$target"
program=$target/release/examples/step_path
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" "$config" "$work/state"
valgrind --quiet --tool=callgrind --collect-atstart=no '--toggle-collect=*one_step_of_the_twin*' \
    --callgrind-out-file="$work/calls" "$program" "$config" "$work/state" "$steps"
python3 - "$work/calls" "$root/crates/flexdrill-core/src" <<'COUNT'
import collections, os, re, sys

calls, core = sys.argv[1:]
names, cost, current, inherited = {}, collections.Counter(), None, False
for line in open(calls, errors="replace"):
    line = line.rstrip("\n")
    # A file gets its number where it is first named, which may be where a function of it is called.
    found = re.match(r"c?f[lie]=\((\d+)\)(?: (.*))?$", line)
    if found:
        number, name = found.groups()
        if name:
            names[number] = name
        if not line.startswith("c"):
            current = names.get(number)
    elif line.startswith("calls="):
        # The next line is the cost of what is called, which is counted there.
        inherited = True
    elif re.match(r"[+*-]?\d* ?", line) and line[:1] in "+-*0123456789" and current:
        numbers = line.split()
        if not inherited and len(numbers) > 1:
            cost[current] += int(numbers[1])
        inherited = False
ran = {}
for name, instructions in cost.items():
    index = name.find("flexdrill-core/src/")
    if index >= 0 and instructions > 0:
        ran[name[index + len("flexdrill-core/src/"):]] = instructions
# Observers take what a step leaves; they have no part in it.
path = {name: n for name, n in ran.items() if not name.startswith(("twin/observe", "twin/quality"))}
whole = sum(path.values())

def code(name):
    text = open(os.path.join(core, name)).read().split("#[cfg(test)]\nmod tests {")[0]
    return "\n".join(line for line in text.split("\n") if not line.lstrip().startswith("//"))

own = set()
for folder, _, files in os.walk(core):
    for name in files:
        if name.endswith(".rs") and "/tests" not in folder and "/stations" not in folder:
            own |= set(re.findall(r"\b(?:struct|enum|trait) ([A-Z]\w+)", code(os.path.join(folder, name))))
texts = {name: code(name) for name in path}
types = {name for text in texts.values() for name in re.findall(r"\b[A-Z]\w+", text)} & own
lines = sum(text.count("\n") for text in texts.values())
many = [name for name, n in path.items() if n >= whole / 1000]
main, counted = 0, 0
for n in sorted(path.values(), reverse=True):
    if counted < 0.9 * whole:
        counted, main = counted + n, main + 1
rooms = collections.Counter(name.split("/")[0] for name in path)
print(f"files: {len(path)} with {lines} lines without comments; {len(many)} with a thousandth of the instructions or more; "
      f"{main} have 90 %")
print("rooms:", ", ".join(f"{room} {n}" for room, n in rooms.most_common()))
print(f"own types that they name: {len(types)}")
for name in sorted(path):
    print(f"  {path[name] / whole:8.3%} {name}")
COUNT
