#!/usr/bin/env bash
# EXUDYN and flexdrill on the same tool and machine: ./benches/peers/compare.sh [arguments of compare.py]
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ ! -x .venv-peers/bin/python ]; then
    python3 -m venv .venv-peers
fi
.venv-peers/bin/python -c 'import exudyn' 2>/dev/null || .venv-peers/bin/pip install --quiet 'exudyn==1.13.6'
cargo build --release
# One processor for both, the last one: the first takes most interrupts.
last=$(($(nproc --all) - 1))
exec taskset -c "$last" .venv-peers/bin/python benches/peers/compare.py "$@"
