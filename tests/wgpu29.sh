#!/usr/bin/env bash
# The drop-in compiles against the oldest wgpu that Cargo.toml admits: a copy of its sources, with wgpu locked to that version.
set -euo pipefail
cd "$(dirname "$0")/.."
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
copy=target/wgpu29
rm -rf "$copy"
mkdir -p "$copy"
# With the lock file, all other dependencies have the versions of the other checks, and are not compiled again.
cp -r Cargo.toml Cargo.lock src shaders "$copy"
cd "$copy"
# Drops sections of development, and the members of the workspace.
awk '
    /^\[/ { keep = !/dev-dependencies|^\[\[(example|test)\]\]/ }
    /^(members|exclude) = / { next }
    keep
' ../../Cargo.toml | sed 's/^wgpu = { version = ">=29, <31"/wgpu = { version = "29"/' >Cargo.toml
CARGO_TARGET_DIR="$target" cargo check --quiet --lib --features gpu,cpu
grep -A1 '^name = "wgpu"' Cargo.lock
