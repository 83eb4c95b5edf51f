#!/usr/bin/env bash
# Builds the Debian package and tries it out: launch_scripts/package.sh [--no-build]
# The package goes to target/package/; it is unpacked into a scratch folder and started from there, its unit file, man
# pages and contents are checked by the tools that are there. --no-build takes target/release/flexdrill as it is.
set -euo pipefail
. "$(dirname "$0")/common.sh"
cd "$root"
tools=${FLEXDRILL_TOOLS:-$root/target/tools}
PATH="$tools/bin:$PATH"
package=$root/target/package
release=${CARGO_TARGET_DIR:-$root/target}/release
not_checked() { say "NOT CHECKED: $*"; }

[ "${1:-}" = --no-build ] || build --features full
[ -x "$release/flexdrill" ] || fail "$release/flexdrill is not there"
command -v cargo-deb >/dev/null ||
    cargo install --quiet --locked cargo-deb --version '^3.8' --root "$tools" ||
    fail "cargo-deb is not there and could not be installed; cargo install --locked cargo-deb"

say "what goes into it beside the program"
rm -rf "$package"
mkdir -p "$package/completions"
"$release/flexdrill" man --out "$package/man"
"$release/flexdrill" completions bash >"$package/completions/flexdrill"
"$release/flexdrill" completions zsh >"$package/completions/_flexdrill"
"$release/flexdrill" completions fish >"$package/completions/flexdrill.fish"
sed 's|\$schema=flexdrill.schema.json|$schema=/usr/share/flexdrill/flexdrill.schema.json|' config/rig.yaml >"$package/flexdrill.yaml"
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
commit_date=$(date -u -R -d "@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}")
printf 'flexdrill (%s-1) unstable; urgency=medium\n\n  * See CHANGELOG.md of the source.\n\n -- %s  %s\n' \
    "$version" "flexdrill contributors <flexdrill@users.noreply.github.com>" "$commit_date" >"$package/changelog"
{
    printf 'flexdrill may be used under the Apache License 2.0, which Debian has as\n/usr/share/common-licenses/Apache-2.0, or under this one:\n\n'
    cat LICENSE-MIT
    printf '\nThe font Roboto in it is under the Apache License 2.0.\n'
    printf 'async-opcua in it, unchanged, is under the Mozilla Public License 2.0: https://crates.io/crates/async-opcua\n'
} >"$package/copyright"

say "the package"
cargo deb --no-build --no-strip --quiet --output "$package/"
deb=$(find "$package" -maxdepth 1 -name '*.deb' | head -n 1)
say "$deb: $(du -k "$deb" | cut -f1) kB"
dpkg-deb --info "$deb" | sed -n 's/^ \(Depends\|Installed-Size\|Architecture\)/  \1/p'

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
dpkg-deb --extract "$deb" "$scratch/root"
dpkg-deb --control "$deb" "$scratch/control"
installed=$scratch/root/usr/bin/flexdrill

say "started from the package"
"$installed" --version
"$installed" check "$scratch/root/etc/flexdrill/flexdrill.yaml" >/dev/null
# A program without MQTT says so instead.
[[ "$("$installed" bridge mqtt --broker host:0 2>&1)" == *"the port must be"* ]] ||
    fail "the program from the package has no MQTT"
# As the unit starts it, on this machine only, for three seconds of the model.
set -a
. "$scratch/root/etc/flexdrill/environment"
set +a
ROS_DOMAIN_ID=${FLEXDRILL_TEST_DOMAIN:-87} timeout 120 "$installed" run \
    --config "$scratch/root/etc/flexdrill/flexdrill.yaml" --state-dir "$scratch/state" \
    --record "$scratch/recordings/{start}" --duration 3 >"$scratch/run.log" 2>&1 ||
    { cat "$scratch/run.log"; fail "the program from the package did not run"; }
recording=$(find "$scratch/recordings" -mindepth 1 -maxdepth 1 -type d)
[ "$(printf '%s\n' "$recording" | grep -c 'T.*Z$')" = 1 ] || fail "one recording was expected, there is: $recording"
"$installed" report "$recording" --out "$scratch/report"
[ -s "$scratch/report/report.html" ] || fail "no report of $recording"

say "what belongs to it"
for file in etc/flexdrill/environment usr/lib/systemd/system/flexdrill.service usr/lib/sysusers.d/flexdrill.conf \
    usr/lib/systemd/system/flexdrill-dashboard.service usr/lib/systemd/system/flexdrill-bridge.service \
    usr/share/flexdrill/flexdrill.schema.json usr/share/man/man1/flexdrill.1.gz usr/share/man/man1/flexdrill-run.1.gz \
    usr/share/bash-completion/completions/flexdrill; do
    [ -s "$scratch/root/$file" ] || fail "the package lacks $file"
done
grep -qx /etc/flexdrill/flexdrill.yaml "$scratch/control/conffiles" || fail "the configuration is no conffile"
for script in postinst postrm; do sh -n "$scratch/control/$script"; done
bash -n "$scratch/root/usr/share/bash-completion/completions/flexdrill"

if command -v systemd-analyze >/dev/null; then
    for unit in flexdrill flexdrill-dashboard flexdrill-bridge; do
        # The unit names /usr/bin/flexdrill; here it is looked at where it was unpacked.
        sed "s|/usr/bin/flexdrill|$installed|; s/^User=.*/User=root/; s/^Group=.*/Group=root/" \
            "$scratch/root/usr/lib/systemd/system/$unit.service" >"$scratch/$unit.service"
        said=$(systemd-analyze verify --man=no "$scratch/$unit.service" 2>&1) || fail "systemd-analyze verify: $said"
        [ -z "$said" ] || say "systemd-analyze verify: $said"
        # 0 is closed, 10 is open; a service that has the network cannot be below 1.
        systemd-analyze security --offline=yes --threshold=25 "$scratch/$unit.service" | tail -n 1 ||
            fail "$unit.service is more open than it was"
    done
else
    not_checked "the unit file: no systemd-analyze here"
fi
if command -v mandoc >/dev/null; then
    gzip -dc "$scratch/root/usr/share/man/man1/flexdrill-run.1.gz" | mandoc -Tlint -Werror || fail "flexdrill-run.1 is no man page"
else
    not_checked "the man pages: no mandoc here"
fi
if command -v lintian >/dev/null; then
    # The names of functions stay in the program, for backtraces from the field.
    lintian --fail-on error --allow-root --suppress-tags unstripped-binary-or-object,initial-upload-closes-no-bugs "$deb" ||
        fail "lintian found an error"
else
    not_checked "Debian's rules: no lintian here"
fi
say "done: $deb"
