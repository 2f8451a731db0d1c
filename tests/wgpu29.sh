#!/usr/bin/env bash
# The library compiles against the oldest wgpu that Cargo.toml admits: a copy of it, locked to that version.
set -euo pipefail
cd "$(dirname "$0")/.."
copy=target/wgpu29
rm -rf "$copy"
mkdir -p "$copy"
cp -r Cargo.toml src shaders "$copy"
cd "$copy"
# Only the library: no tool, no tests, no examples.
sed -i -e '/^\[\[bin\]\]/,$d' -e '/^\[dev-dependencies\]/,$d' Cargo.toml
printf '\n[workspace]\n' >>Cargo.toml
sed -i 's/wgpu = { version = ">=29, <31"/wgpu = { version = "29"/' Cargo.toml
CARGO_TARGET_DIR=../wgpu29-build cargo check --quiet --lib
grep -A1 '^name = "wgpu"' Cargo.lock
