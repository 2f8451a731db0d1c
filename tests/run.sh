#!/usr/bin/env bash
# All tests of this workspace, and its examples; tests/lint.sh has the lints. Needs Rust. Installs a software Vulkan driver and a
# virtual display if they are missing and it may (Debian, root). Tests on rendered sequences and recorded scanpaths need
# ../shared/data; a warning says so if it is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/steps.sh

# Every package with every feature, on the newest wgpu: one set of features, so that tests, examples and documentation share
# compiled dependencies. Not --all-features, since wgpu-30 and wgpu-29 exclude each other.
everything=(--locked --workspace --features cpu,serde,view)
target="${CARGO_TARGET_DIR:-target}"
# Incremental compilation pays off in later builds only, and costs time in this one. So do symbols for debuggers.
# Backtraces of errors that a library keeps (wgpu, at each lock) cost up to half of the time of recording.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none RUST_LIB_BACKTRACE=0

step "Vulkan driver"
has_icd() { ls /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json "${VK_DRIVER_FILES:-/nonexistent}" 2>/dev/null | grep -q .; }
if ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' && has_icd; then
    echo "found"
elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libvulkan1 mesa-vulkan-drivers
else
    echo "none found: install one (Debian: mesa-vulkan-drivers); tests that need it will fail" >&2
fi
# Tests that need an adapter fail without one. NODEVICE_SELECT silences a message of Mesa's about windows.
export AFTERIMAGE_GPU=require NODEVICE_SELECT=1

step "virtual display, for the viewer"
if command -v Xvfb >/dev/null && command -v xdotool >/dev/null && command -v openbox >/dev/null; then
    echo "found"
elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        xvfb xauth xdotool openbox libxkbcommon-x11-0 libxcursor1 libxi6; } || echo "not installed: the test of the viewer's window is SKIPPED" >&2
else
    echo "none found: install one (Debian: xvfb xdotool openbox libxkbcommon-x11-0); the test of the viewer's window is SKIPPED without" >&2
fi

if [ ! -d ../shared/data ]; then
    printf '\nWARNING: no ../shared/data here: tests on rendered sequences and recorded scanpaths are SKIPPED\n'
fi

step "build of the tests"
cargo test "${everything[@]}" --no-run

step "tests"
# Tests of hard cases write what they measure here. When all have run, it is compared with docs/stability.csv.
export AFTERIMAGE_STABILITY="$PWD/target/stability"
rm -rf "$AFTERIMAGE_STABILITY"
mkdir -p target
run_tests() { cargo test "${everything[@]}" "$@" 2>&1 | tee -a target/tests.log; }
: >target/tests.log
run_tests --no-fail-fast || failed=1
[ -n "${failed:-}" ] || run_tests --test stability -- --ignored || failed=1
if [ -n "${failed:-}" ]; then
    summary_of_tests target/tests.log
    grep -E '^(error: test failed|    .+ \.\.\. FAILED|test .* FAILED)' target/tests.log >&2 || true
    exit 1
fi

step "examples"
# `cargo test` has compiled them. Not here: 09 of the lab, which is long.
for example in 01_planned 02_engine 03_stereo 05_doctor 06_own_mask 07_levels \
    01_moving_camera 02_gpu_moving_camera 03_scanpath 04_gpu_scanpath 05_cpu_fallback 06_debug_views 10_path_trace; do
    printf '\n-- %s\n' "$example"
    "$target/debug/examples/$example"
done
if command -v xvfb-run >/dev/null; then
    AFTERIMAGE_FRAMES=20 xvfb-run -a "$target/debug/examples/04_window"
else
    echo "no xvfb-run: the example 04_window is SKIPPED" >&2
fi

seconds_of_steps
summary_of_tests target/tests.log
