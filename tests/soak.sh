#!/usr/bin/env bash
# 100,000 frames of wrs and of smr at 320x180, on the CPU and on the adapter in lockstep, with resets, resizes, lost gaze, broken pixels
# and exposure steps. Hours on two cores; SOAK_FRAMES=10000 for less.
set -euo pipefail
cd "$(dirname "$0")/.."
export AFTERIMAGE_GPU=require NODEVICE_SELECT=1
cargo test --locked --all-features --test soak -- --ignored --nocapture --test-threads "${SOAK_THREADS:-2}"
