#!/usr/bin/env bash
# The main job: builds, starts the twin and a rig that plays a drilling log into it, and shows the twin in this terminal.
# Everything talks DDS over loopback, as separate programs. q or Ctrl-C ends it all.
set -euo pipefail
. "$(dirname "$0")/common.sh"

usage() {
    cat <<EOT
usage: launch_scripts/demo.sh [options] [LOG]
  LOG             a rig log (CSV) to play; default: the generated log in config/field_logs/
  --mapping FILE  how the log's columns are read; default: config/field_logs/rig_1hz.yaml
  --from S, --to S  play only this part of the log (seconds from its start)
  --config FILE   configuration of the twin; default: config/rig.yaml
  --record FILE   record a bag meanwhile
  --seconds N     end after N seconds of viewing (for CI)
  --plain         print lines instead of a full screen
  --web           show it in this machine's browser instead of this terminal; the address is printed too
  --steer         with --web: no rig plays a log, the page steers
EOT
}

log="" mapping="" config="" seconds="" rig_options=() node_options=() watch_options=() web="" steer=""
while [ $# -gt 0 ]; do
    case $1 in
    --mapping) mapping=${2:?--mapping needs a file} && shift ;;
    --from | --to) rig_options+=("$1" "${2:?$1 needs a value}") && shift ;;
    --config) config=${2:?--config needs a file} && shift ;;
    --record) node_options+=(--record "${2:?--record needs a file}") && shift ;;
    --seconds) seconds=${2:?--seconds needs a number} && shift ;;
    --plain) watch_options+=(--plain) ;;
    --web) web=1 ;;
    --steer) steer=1 ;;
    -h | --help) usage && exit 0 ;;
    -*) usage >&2 && exit 2 ;;
    *) log=$1 ;;
    esac
    shift
done
[ -n "$seconds" ] && watch_options+=(--duration "$seconds")
[ -z "$steer" ] || [ -n "$web" ] || fail "--steer goes with --web: in the terminal nobody steers"

build
local_dds
if [ -z "$log" ]; then
    log=$root/config/field_logs/demo.csv
    # It begins with a connection; 45 s later the tool turns and drilling is near.
    [ ${#rig_options[@]} -gt 0 ] || rig_options=(--from 45)
fi
[ -r "$log" ] || fail "cannot read the log $log"
case $log in
*.csv) rig_options+=(--mapping "${mapping:-$root/config/field_logs/rig_1hz.yaml}") ;;
esac

work=$(mktemp -d)
node_pid="" rig_pid="" web_pid=""
# Ends a program that this script started: politely, so that recordings are finished, then firmly.
end() {
    local pid=$1
    [ -n "$pid" ] && kill -0 "$pid" 2>/dev/null || return 0
    kill -TERM "$pid" 2>/dev/null || true
    for _ in $(seq 100); do
        kill -0 "$pid" 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL "$pid" 2>/dev/null || true
    wait "$pid" 2>/dev/null || true
}
finish() {
    local code=$?
    trap - EXIT INT TERM
    end "$web_pid"
    end "$rig_pid"
    end "$node_pid"
    if [ $code -ne 0 ] && [ -s "$work/node.log" ]; then
        say "the twin's last words:"
        tail -n 15 "$work/node.log" >&2
    fi
    rm -rf "$work"
    say "stopped"
    exit $code
}
trap finish EXIT
trap 'exit 0' INT TERM

# start_node CONFIG [OPTION...]
start_node() {
    # Alarms of a twin that is left running are not those of a demonstration.
    "$flexdrill" run --state-dir "$work/state" --config "$@" >"$work/node.log" 2>&1 &
    node_pid=$!
}

config=${config:-$root/config/rig.yaml}
say "starting the twin: $config"
start_node "$config" ${node_options[@]+"${node_options[@]}"}
if [ -z "$steer" ]; then
    say "starting the rig: $log"
    "$flexdrill" rig "$log" --loop ${rig_options[@]+"${rig_options[@]}"} >"$work/rig.log" 2>&1 &
    rig_pid=$!
fi
sleep 2
kill -0 "$node_pid" 2>/dev/null || fail "the twin ended at once"
[ -n "$steer" ] || kill -0 "$rig_pid" 2>/dev/null || fail "the rig ended at once: $(tail -n 5 "$work/rig.log")"
if [ -z "$web" ]; then
    "$flexdrill" watch ${watch_options[@]+"${watch_options[@]}"}
    exit
fi
[ -n "$steer" ] || say "the rig drives, so the page may not; --steer leaves the rig out"
"$flexdrill" dashboard --open --allow-control &
web_pid=$!
if [ -n "$seconds" ]; then
    sleep "$seconds"
    kill -0 "$web_pid" 2>/dev/null || fail "the dashboard ended"
else
    wait "$web_pid"
fi
