#!/usr/bin/env bash
# Writes docs/stability.csv and docs/stability.md: runs all tests, and collects what they measured for the hard cases.
set -euo pipefail
cd "$(dirname "$0")/.."
export AFTERIMAGE_GPU=require NODEVICE_SELECT=1 AFTERIMAGE_STABILITY="$PWD/target/stability"
rm -rf "$AFTERIMAGE_STABILITY"
cargo test --locked --workspace --features cpu,view
AFTERIMAGE_BLESS=1 cargo test --locked --workspace --features cpu,view --test stability -- --ignored
