#!/usr/bin/env bash
# 100,000 frames each of wrs and of smr at 320x180, half of them radiance, on the CPU and on the adapter in lockstep, with resets,
# resizes, lost gaze, invalid pixels and exposure steps; and 1,000,000 planned frames of at most 36x24, with cuts, resizes, lost gaze,
# invalid pixels, another share in every tenth frame, and dropped encoders. Takes hours on two cores; SOAK_FRAMES=10000 for less.
set -euo pipefail
cd "$(dirname "$0")/.."
export AFTERIMAGE_GPU=require NODEVICE_SELECT=1
cargo test --locked --workspace --features cpu,view --test soak -- --ignored --nocapture --test-threads "${SOAK_THREADS:-2}"
