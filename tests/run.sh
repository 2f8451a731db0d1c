#!/usr/bin/env bash
# All checks: format, lints, tests, examples, documentation. Needs Rust. Installs a software Vulkan driver and a virtual display if
# they are missing and it may (Debian, root). Tests on rendered sequences and recorded scanpaths need ../shared/data; a warning
# says so if it is missing.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s (%d s so far)\n' "$*" "$SECONDS"; }
# Every package with every feature, on the newest wgpu: one set of features, so that tests, examples and documentation share
# compiled dependencies. Not --all-features, since wgpu-30 and wgpu-29 exclude each other.
everything=(--locked --workspace --features cpu,serde,view)
# The same on the other wgpu.
everything_29=(--locked --workspace --no-default-features --features wgpu-29,cpu,serde,view)
target="${CARGO_TARGET_DIR:-target}"
# Incremental compilation pays off in later builds only, and costs time in this one. So do symbols for debuggers.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none

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

step "format"
cargo fmt --check

step "spelling"
if command -v typos >/dev/null; then typos; else echo "no typos (cargo install typos-cli): SKIPPED"; fi

step "lints: every target, and the combinations of features that users build"
cargo clippy "${everything[@]}" --all-targets -- -D warnings
cargo clippy "${everything_29[@]}" --lib --bins --examples -- -D warnings
cargo clippy --locked -p afterimage -- -D warnings
cargo clippy --locked -p afterimage --no-default-features --features cpu -- -D warnings
# What `cargo demo` builds.
cargo clippy --locked -p afterimage-clip -- -D warnings
# The fuzzing targets have a lock file of their own, which changes of dependencies must not leave behind.
cargo metadata --locked --format-version 1 --manifest-path crates/tool/tests/fuzz/Cargo.toml >/dev/null

if [ ! -d ../shared/data ]; then
    printf '\nWARNING: no ../shared/data here: tests on rendered sequences and recorded scanpaths are SKIPPED\n'
fi

# Without planted errors and sequences of many frames, which the same tests on wgpu 30 have. The plugin for Bevy is on
# wgpu 29, too.
step "tests on wgpu 29: the drop-in on the GPU, lost devices"
long=(thousand h07 h11 h12 h53 h91 h92 h95 h96 h97 h99 h100 h101 h102)
cargo test "${everything_29[@]}" --test gpu --test gpu_cost --test gpu_memory --test device_loss -- \
    --skip caught --skip planted "${long[@]/#/--skip=}"

step "tests"
# Tests of hard cases write what they measure here. When all have run, it is compared with the table in docs/stability.md.
export AFTERIMAGE_STABILITY="$PWD/target/stability"
rm -rf "$AFTERIMAGE_STABILITY"
cargo test "${everything[@]}"
cargo test "${everything[@]}" --test stability -- --ignored

step "examples"
# `cargo test` has compiled them. Not here: 09 of the lab, which is long, and the experiments of `crates/research`.
for example in 01_smallest 02_engine 03_stereo 04_cpu 05_cpu_stereo 07_doctor \
    01_moving_camera 02_gpu_moving_camera 03_scanpath 04_gpu_scanpath 05_cpu_fallback 06_debug_views 10_path_trace; do
    printf '\n-- %s\n' "$example"
    "$target/debug/examples/$example"
done
if command -v xvfb-run >/dev/null; then
    AFTERIMAGE_FRAMES=20 xvfb-run -a "$target/debug/examples/06_window"
else
    echo "no xvfb-run: the example 06_window is SKIPPED" >&2
fi

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc "${everything[@]}" --no-deps
items=$(grep -o '<li><a href="[^#]' "$target/doc/afterimage/all.html" | wc -l)
echo "the drop-in documents $items items; at most 60"
[ "$items" -le 60 ]

step "all checks passed"
