#!/usr/bin/env bash
# All checks: format, lints, tests, documentation. Needs Rust; installs a software Vulkan driver if the machine has none and
# may (Debian, root). Real frames and scanpaths are read from ../shared/data where that folder exists, and missed loudly where not.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "a Vulkan driver"
has_icd() { ls /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json "${VK_DRIVER_FILES:-/nonexistent}" 2>/dev/null | grep -q .; }
if ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' && has_icd; then
    echo "there is one"
elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libvulkan1 mesa-vulkan-drivers
else
    echo "none found: install one (Debian: mesa-vulkan-drivers); tests that need it will fail" >&2
fi
# Tests that need an adapter fail without one. The other silences a line of Mesa's about windows.
export AFTERIMAGE_GPU=require NODEVICE_SELECT=1

step "a display without a screen, for the viewer"
if command -v Xvfb >/dev/null && command -v xdotool >/dev/null && command -v openbox >/dev/null; then
    echo "there is one"
elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        xvfb xauth xdotool openbox libxkbcommon-x11-0 libxcursor1 libxi6; } || echo "not installed: the test of the viewer's window is SKIPPED" >&2
else
    echo "none found: install one (Debian: xvfb xdotool openbox libxkbcommon-x11-0); the test of the viewer's window is SKIPPED without" >&2
fi

step "format"
cargo fmt --check

step "lints, in every combination of features that users meet"
cargo clippy --locked --all-targets --all-features -- -D warnings
cargo clippy --locked -- -D warnings
cargo clippy --locked --no-default-features -- -D warnings
cargo clippy --locked --no-default-features --features lab -- -D warnings

step "the library alone against wgpu 29"
tests/wgpu29.sh

if [ ! -d ../shared/data ]; then
    printf '\nWARNING: no ../shared/data here: tests on real frames and recorded scanpaths are SKIPPED\n'
fi

step "tests"
# What they measure of the hard cases is left here, and compared with the table in docs/stability.md when all have run.
export AFTERIMAGE_STABILITY="$PWD/target/stability"
rm -rf "$AFTERIMAGE_STABILITY"
cargo test --locked --all-features
cargo test --locked --all-features --test stability -- --ignored

step "examples"
# With the features of the tests, so that nothing is compiled twice. 05 is a long experiment.
for example in 01_smallest 02_moving_camera 03_scanpath 04_stereo 06_gpu_headless 07_gpu_moving_camera 08_gpu_scanpath \
    09_gpu_stereo 10_cpu_fallback 11_debug_views 12_engine 16_path_trace; do
    cargo run --locked --quiet --all-features --example "$example"
done
if command -v xvfb-run >/dev/null; then
    AFTERIMAGE_FRAMES=20 xvfb-run -a cargo run --locked --quiet --all-features --example viewer_in_your_app
else
    echo "no xvfb-run: the example viewer_in_your_app is SKIPPED" >&2
fi

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --all-features

step "all checks passed"
