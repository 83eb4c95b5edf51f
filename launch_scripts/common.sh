# Shared by the scripts in this folder; sourced, not run.
# Sets $root (the repository) and offers say, fail, need_packages, need_rust, build and local_dds.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
name=$(basename "$0")

say() { printf '[%s] %s\n' "$name" "$*"; }

fail() {
    printf '[%s] error: %s\n' "$name" "$*" >&2
    exit 1
}

# need_packages PACKAGE...: installs those Debian or Ubuntu packages that are missing, as root or with sudo.
need_packages() {
    command -v dpkg-query >/dev/null || {
        say "no dpkg here: make sure yourself that these are installed: $*"
        return 0
    }
    local missing=() package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "packages are there: $*"
        return 0
    fi
    local sudo=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "packages are missing (${missing[*]}) and there is no sudo; run: apt-get install ${missing[*]}"
        sudo=(sudo)
    fi
    say "installing packages: ${missing[*]}"
    "${sudo[@]}" apt-get -q update || say "apt-get update failed; trying with the lists that are there"
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends "${missing[@]}" ||
        fail "apt-get could not install: ${missing[*]}"
}

# Rust: rustup's own folder counts even when the shell does not know it yet.
need_rust() {
    command -v cargo >/dev/null || PATH="$HOME/.cargo/bin:$PATH"
    command -v cargo >/dev/null || fail "cargo is not there; install Rust from https://rustup.rs and run this again"
    local wanted have
    wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$root/Cargo.toml")
    have=$(cd "$root" && rustc --version | cut -d' ' -f2)
    [ "$(printf '%s\n%s\n' "$wanted" "$have" | sort -V | head -n 1)" = "$wanted" ] ||
        fail "Rust $have is too old, $wanted or newer is needed; run: rustup update stable"
    say "Rust $have"
}

# Builds the release binary and sets $flexdrill.
build() {
    need_packages build-essential
    need_rust
    say "building (a few minutes the first time)"
    (cd "$root" && cargo build --release --locked) || fail "the build failed; see above"
    flexdrill="${CARGO_TARGET_DIR:-$root/target}/release/flexdrill"
}

# DDS stays on this machine unless the caller has said otherwise. No multicast on the loopback interface is needed.
local_dds() {
    export ROS_LOCALHOST_ONLY="${ROS_LOCALHOST_ONLY:-1}"
    say "DDS domain ${ROS_DOMAIN_ID:-0}, $([ "$ROS_LOCALHOST_ONLY" = 1 ] && echo "this machine only" || echo "all networks")"
}
