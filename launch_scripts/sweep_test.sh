#!/usr/bin/env bash
# Fills a sweep over two nodes, kills one of them with -9 while it works, and compares the collected bytes with those of
# `sweep work --jobs 1`. The nodes are namespaces of this machine: own network, host name and processes. Needs root.
#   launch_scripts/sweep_test.sh slurm|parallel|dask...
# FLEXDRILL_BINARY names the program if it is built already, FLEXDRILL_SWEEP_WORK a folder that is kept.
set -euo pipefail
. "$(dirname "$0")/common.sh"

usage() {
    sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
    exit 2
}
[ $# -gt 0 ] || usage
for engine in "$@"; do
    case $engine in slurm | parallel | dask) ;; *) usage ;; esac
done

# --- Outside: what needs the network, then again in namespaces of its own --------------------------------------------
if [ -z "${SWEEP_TEST_INSIDE:-}" ]; then
    [ "$(id -u)" -eq 0 ] || fail "namespaces with daemons of Slurm and ssh need root"
    packages=(util-linux iproute2 procps)
    case "$*" in *slurm*) packages+=(slurm-wlm munge) ;; esac
    case "$*" in *parallel*) packages+=(parallel openssh-server openssh-client) ;; esac
    need_packages "${packages[@]}"
    if [ -z "${FLEXDRILL_BINARY:-}" ]; then
        build --features sweep
        FLEXDRILL_BINARY=$flexdrill
    fi
    work=${FLEXDRILL_SWEEP_WORK:-$(mktemp -d)}
    [ -n "${FLEXDRILL_SWEEP_WORK:-}" ] || trap 'rm -rf "$work"' EXIT
    mkdir -p "$work" && chmod 755 "$work"
    case "$*" in
    *dask*)
        python3 -m venv "$work/venv"
        "$work/venv/bin/pip" --quiet --disable-pip-version-check install 'distributed>=2025.1' ||
            fail "pip could not install the package distributed; is there a network?"
        ;;
    esac
    FLEXDRILL_BINARY=$(realpath "$FLEXDRILL_BINARY") SWEEP_TEST_INSIDE=$(realpath "$work")
    export FLEXDRILL_BINARY SWEEP_TEST_INSIDE
    # The end of the first process ends all that was started in here.
    timeout -k 10 "${FLEXDRILL_SWEEP_LIMIT:-600}" \
        unshare --net --uts --mount --pid --fork --kill-child --mount-proc "$0" "$@"
    exit
fi

# --- Inside: two nodes on a bridge -----------------------------------------------------------------------------------
work=$SWEEP_TEST_INSIDE
hostname ctl
printf '127.0.0.1 localhost\n10.77.0.1 ctl\n10.77.0.11 n1\n10.77.0.12 n2\n' >"$work/hosts"
mount --bind "$work/hosts" /etc/hosts
mount -t tmpfs tmpfs /run
ip link set lo up
ip link add br0 type bridge
ip addr add 10.77.0.1/24 dev br0
ip link set br0 up

# node N COMMAND: starts a node that runs COMMAND once its network is there, and sets node_N to its first process.
node() {
    local number=$1 command=$2 outer inner=""
    unshare --net --uts --mount --pid --fork --mount-proc bash -c "
        hostname n$number
        mount -t sysfs sysfs /sys
        until [ -e /sys/class/net/eth0 ]; do sleep 0.05; done
        ip link set lo up
        ip addr add 10.77.0.1$number/24 dev eth0
        ip link set eth0 up
        $command & wait" >"$work/n$number.log" 2>&1 &
    outer=$!
    until inner=$(pgrep -P $outer) && [ -n "$inner" ]; do sleep 0.05; done
    # Its namespaces are there when its name is.
    until [ "$(nsenter -t "$inner" -u hostname)" = "n$number" ]; do sleep 0.05; done
    ip link add "v$number" type veth peer name eth0 netns "$inner"
    ip link set "v$number" master br0 up
    eval "node_$number=$inner"
}

spec=$work/spec.yaml
cat >"$spec" <<SPEC
configuration: $root/tests/data/small.yaml
horizon: 10
members: 2
grid:
  inputs.rotary_speed.initial_rpm: {from: 30, to: 100, count: ${FLEXDRILL_SWEEP_SPEEDS:-8}}
  inputs.weight_on_bit.initial_kn: [1, 2, 4]
running: {rpm: 100, time: 2}
SPEC
done_points() { "$FLEXDRILL_BINARY" sweep status "$1" | awk '$1 == "done" { print $2 }'; }
all_points() { "$FLEXDRILL_BINARY" sweep status "$1" | awk '$1 == "points" { print $2 }'; }

"$FLEXDRILL_BINARY" sweep plan "$spec" "$work/alone"
"$FLEXDRILL_BINARY" sweep work "$work/alone" --jobs 1 2>/dev/null
"$FLEXDRILL_BINARY" sweep collect "$work/alone"
points=$(all_points "$work/alone")

# compare ENGINE COMMAND...: fills a sweep with the command, kills node 2 with -9 once a fifth is done, and again with the
# command where it gave up.
compare() {
    local engine=$1 dir=$work/$1 began=$SECONDS killed="" filler
    shift
    "$FLEXDRILL_BINARY" sweep plan "$spec" "$dir" >/dev/null
    "$@" "$dir" >"$work/$engine.log" 2>&1 &
    filler=$!
    until [ "$(done_points "$dir")" -ge $((points / 5)) ]; do sleep 0.2; done
    kill -9 "$node_2"
    killed=$(done_points "$dir")
    [ "$killed" -lt "$points" ] || fail "$engine: all $points points were done before the node was killed"
    say "$engine: node 2 killed after $((SECONDS - began)) s, with $killed of $points points done"
    if [ "$engine" = slurm ]; then
        # Slurm holds what the dead node had for two minutes; a new array does not wait for it.
        "$@" "$dir" >>"$work/$engine.log" 2>&1 || true
    else
        wait $filler || "$@" "$dir" >>"$work/$engine.log" 2>&1
    fi
    "$FLEXDRILL_BINARY" sweep collect "$dir" || {
        tail -n 30 "$work/$engine.log" "$work"/n?.log >&2
        fail "$engine: not all points were computed"
    }
    cmp "$work/alone/points.csv" "$dir/points.csv" || fail "$engine: the table differs from that of --jobs 1"
    say "$engine: the table is that of --jobs 1, byte for byte; $((SECONDS - began)) s"
}

slurm() {
    mkdir -p "$work/slurm_state"
    (umask 077 && head -c 128 /dev/urandom >"$work/munge.key")
    munged --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
        --log-file="$work/munge.log" --seed-file="$work/munge.seed"
    cat >"$work/slurm.conf" <<CONF
ClusterName=twin
SlurmctldHost=ctl
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SlurmdParameters=config_overrides
SlurmdTimeout=8
ReturnToService=2
JobRequeue=1
StateSaveLocation=$work/slurm_state
SlurmdSpoolDir=$work/spool_%n
SlurmdPidFile=$work/slurmd_%n.pid
SlurmctldPidFile=$work/slurmctld.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd_%n.log
NodeName=n[1-2] CPUs=1
PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP
CONF
    echo "CgroupPlugin=cgroup/v1" >"$work/cgroup.conf"
    export SLURM_CONF=$work/slurm.conf
    slurmctld -D >"$work/slurmctld.out" 2>&1 &
    node 1 "slurmd -D -N n1"
    node 2 "slurmd -D -N n2"
    until [ "$(sinfo --noheader --Node --states=idle 2>/dev/null | wc -l)" -eq 2 ]; do sleep 0.2; done
    slurm_array() { bash "$root/launch_scripts/sweep_slurm.sh" "$1" 6; }
    compare slurm slurm_array
    # What waits for the dead node finds nothing left to do.
    scancel --name=flexdrill
}

parallel_over_ssh() {
    mkdir -p /run/sshd
    ssh-keygen -q -t ed25519 -N '' -f "$work/host_key"
    ssh-keygen -q -t ed25519 -N '' -f "$work/key"
    # An account whose password is locked may not log in, with a key neither.
    sed 's/^root:[^:]*:/root:*:/' /etc/shadow >"$work/shadow" && mount --bind "$work/shadow" /etc/shadow
    printf '%s\n' "HostKey $work/host_key" "AuthorizedKeysFile $work/key.pub" "StrictModes no" "UsePAM no" \
        "PermitRootLogin prohibit-password" "PidFile none" >"$work/sshd.conf"
    printf '%s\n' "Host n?" "IdentityFile $work/key" "StrictHostKeyChecking no" "UserKnownHostsFile /dev/null" \
        "LogLevel ERROR" >"$work/ssh.conf"
    for number in 1 2; do node $number "/usr/sbin/sshd -D -e -f $work/sshd.conf"; done
    export PARALLEL_SSH="ssh -F $work/ssh.conf -o ServerAliveInterval=2 -o ServerAliveCountMax=2 -o ConnectTimeout=3"
    for host in n1 n2; do until $PARALLEL_SSH $host true 2>/dev/null; do sleep 0.2; done; done
    over_ssh() { HOME=$work bash "$root/launch_scripts/sweep_parallel.sh" "$1" 1/n1,1/n2 8; }
    compare parallel over_ssh
}

dask_cluster() {
    export PATH="$work/venv/bin:$PATH"
    dask scheduler --host 10.77.0.1 --no-dashboard >"$work/scheduler.log" 2>&1 &
    for number in 1 2; do
        node $number "dask worker tcp://10.77.0.1:8786 --nworkers 1 --nthreads 1 --no-dashboard --local-directory $work/n$number"
    done
    with_dask() { python3 "$root/docs/examples/sweep_dask.py" tcp://10.77.0.1:8786 "$1" 8; }
    compare dask with_dask
}

for engine in "$@"; do
    case $engine in
    slurm) slurm ;;
    parallel) parallel_over_ssh ;;
    dask) dask_cluster ;;
    esac
    # The next engine has nodes of its own.
    for first in "$node_1" "$node_2"; do kill -9 "$first" 2>/dev/null || true; done
    for number in 1 2; do ip link del "v$number" 2>/dev/null || true; done
done
say "all engines gave the bytes of --jobs 1: $*"
