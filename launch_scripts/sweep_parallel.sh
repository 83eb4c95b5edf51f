#!/usr/bin/env bash
# Works on a sweep with GNU parallel over ssh, where there is no cluster. DIR must be the same folder on every host, and
# ssh must log in without a password.
#
#   launch_scripts/sweep_parallel.sh DIR 8/hostA,8/hostB [CHUNKS]      8: tasks at the same time on that host
#
# A part of the points whose host is lost runs again on another one. Without the keep-alive options of ssh a dead host
# would be waited for without end.
set -euo pipefail
dir=$(realpath "${1:?use: $0 DIR N/HOST,N/HOST [CHUNKS]}")
hosts=${2:?use: $0 DIR N/HOST,N/HOST [CHUNKS]}
chunks=${3:-32}
flexdrill=${FLEXDRILL_BINARY:-flexdrill}

"$flexdrill" sweep status "$dir"
export PARALLEL_SSH=${PARALLEL_SSH:-ssh -o ServerAliveInterval=2 -o ServerAliveCountMax=2 -o ConnectTimeout=3}
seq 0 $((chunks - 1)) | parallel --sshlogin "$hosts" --retries 4 --joblog "$dir/parallel.log" \
    "$flexdrill" sweep work "$dir" --chunk "{}/$chunks" ||
    echo "some parts did not end well: see $dir/parallel.log, and run this again" >&2
"$flexdrill" sweep status "$dir"
