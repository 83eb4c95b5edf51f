#!/usr/bin/env bash
# Installs the Debian package into a Debian of its own, boots it, and tries the service there:
# launch_scripts/service_test.sh [PACKAGE.deb]
# Needs root, debootstrap and systemd-container. The Debian is made once, in target/service (300 MB, from the mirror that
# apt uses here), and stays as it was made: what a test writes goes with the machine.
set -euo pipefail
. "$(dirname "$0")/common.sh"
cd "$root"
deb=${1:-$(find target/package -maxdepth 1 -name '*.deb' 2>/dev/null | head -n 1)}
[ -f "$deb" ] || fail "no package; launch_scripts/package.sh makes it"
[ "$(id -u)" = 0 ] || fail "only root can boot a system in a container"
for tool in debootstrap systemd-nspawn nsenter; do
    command -v "$tool" >/dev/null || fail "$tool is not there: apt install debootstrap systemd-container util-linux"
done
debian=${FLEXDRILL_SERVICE_ROOT:-$root/target/service}
if [ ! -x "$debian/usr/lib/systemd/systemd" ]; then
    say "a Debian to boot"
    debootstrap --variant=minbase --include=systemd,systemd-sysv,dbus,procps bookworm "$debian" >"$debian.log" 2>&1 ||
        fail "debootstrap did not end well: $(tail -n 3 "$debian.log")"
fi

scratch=$(mktemp -d)
cp "$deb" "$scratch/flexdrill.deb"
say "boot"
systemd-nspawn --quiet --directory="$debian" --volatile=overlay --boot --register=no --keep-unit --private-network \
    --bind-ro="$scratch:/mnt" --machine=flexdrill-test >"$scratch/console" 2>&1 &
nspawn=$!
# The first process of the machine is a child of it.
leader() { ps -o pid= --ppid "$nspawn" | tr -d ' ' | head -n 1; }
trap 'kill -KILL "$(leader)" 2>/dev/null || true; wait "$nspawn" 2>/dev/null || true; rm -rf "$scratch"' EXIT
inside() { nsenter --target "$(leader)" --mount --uts --ipc --net --pid --root --wd -- "$@"; }
# try SECONDS WHAT COMMAND...: until the command succeeds.
try() {
    local end=$((SECONDS + $1)) what=$2
    shift 2
    until "$@" >/dev/null 2>&1; do
        [ "$SECONDS" -lt "$end" ] || fail "$what: $(inside journalctl --no-pager -n 15 -u flexdrill 2>&1 || tail -n 15 "$scratch/console")"
        sleep 0.5
    done
}
property() { inside systemctl show -P "$1" flexdrill; }
is() { [ "$(property "$1")" = "$2" ]; }
recordings() { inside sh -c 'ls /var/lib/flexdrill/recordings | wc -l'; }
has_recordings() { [ "$(recordings)" = "$1" ]; }
try 60 "systemd does not come up" inside systemctl is-active multi-user.target

say "install: nothing starts"
inside dpkg --install /mnt/flexdrill.deb >"$scratch/dpkg" 2>&1 || fail "dpkg: $(tail -n 5 "$scratch/dpkg")"
inside getent passwd flexdrill >/dev/null || fail "there is no user flexdrill"
is ActiveState inactive || fail "the installation started it"

say "start"
inside systemctl start flexdrill
try 30 "it does not run" is SubState running
try 30 "it does not say that it runs" inside sh -c 'journalctl -u flexdrill --no-pager | grep -q "model time runs"'
try 30 "it does not record" has_recordings 1
pid=$(property MainPID)
[ "$(inside ps -o user= -p "$pid" | tr -d ' ')" = flexdrill ] || fail "it does not run as flexdrill"
inside env ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST flexdrill watch --once --plain --duration 20 >/dev/null ||
    fail "watch beside it hears nothing"

say "killed: it starts again, with a recording of its own"
inside kill -KILL "$pid"
# Nobody waits for the one that has gone.
new_one() { is SubState running && [ "$(property MainPID)" != "$pid" ]; }
try 30 "it does not come back" new_one
try 30 "the new one does not record" has_recordings 2
inside sh -c 'journalctl -u flexdrill --no-pager | grep -q "status=9/KILL"' || fail "the journal does not tell of the kill"
is NRestarts 1 || fail "$(property NRestarts) restarts, one was expected"

say "what it may not do"
# Even root sees the system as the service does: read-only but for its own folder.
as_it_sees() { inside nsenter --target "$(property MainPID)" --mount -- "$@"; }
as_it_sees touch /var/lib/flexdrill/state/probe || fail "it may not write to its own folder"
for place in /etc/flexdrill/flexdrill.yaml /usr/bin/flexdrill /var/log/probe; do
    as_it_sees touch "$place" 2>/dev/null && fail "it may write to $place"
done
inside grep -q '^CapEff:.0*$' "/proc/$(property MainPID)/status" || fail "it has capabilities"
inside grep -q '^NoNewPrivs:.1$' "/proc/$(property MainPID)/status" || fail "it may gain privileges"
inside grep -q '^Seccomp:.2$' "/proc/$(property MainPID)/status" || fail "its system calls are not filtered"

say "stop: the recording is finished"
inside systemctl stop flexdrill
is Result success || fail "it did not end well: $(property Result)"
last=$(inside sh -c 'ls -d /var/lib/flexdrill/recordings/* | tail -n 1')
inside test -s "$last/metadata.yaml" || fail "$last has no metadata.yaml"
inside runuser -u flexdrill -- flexdrill report "$last" --out /tmp/report >/dev/null || fail "$last cannot be read"

say "removed: recordings stay"
inside dpkg --purge flexdrill >"$scratch/dpkg" 2>&1 || fail "dpkg: $(tail -n 5 "$scratch/dpkg")"
has_recordings 2 || fail "the recordings have gone"
say "done"
