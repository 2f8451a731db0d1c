#!/usr/bin/env bash
# The GPU tests on a second implementation of WebGPU: Chromium's Dawn, with Tint and SwiftShader. wgpu records what the tests
# ask of it and what they read; the browser repeats the calls, and must read the same bits. Then the demo, in the same
# browser. Needs Rust, Node.js and a Vulkan driver; installs Chromium, and a compiler for WebAssembly if Rust has none, if it
# may (Debian, root). Run tests/run.sh first, which compiles the tests.
set -euo pipefail
cd "$(dirname "$0")/.."

. tests/steps.sh
everything=(--locked --workspace --features cpu,serde,view)
# As in tests/run.sh, whose builds these are.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none AFTERIMAGE_GPU=require NODEVICE_SELECT=1

step "Chromium, and validators of SPIR-V and GLSL"
if command -v chromium >/dev/null && command -v spirv-val >/dev/null && command -v glslangValidator >/dev/null; then
    echo "found"
elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium spirv-tools glslang-tools
else
    echo "not found: install them (Debian: chromium spirv-tools glslang-tools)" >&2
    exit 1
fi

step "shaders in the languages of other devices"
cargo test "${everything[@]}" --test twins --test render -- --nocapture backends::

step "recordings of the tests: twins, sequences, simulators"
recordings="$PWD/target/recordings"
rm -rf "$recordings"
# Not here: planted errors, which have their own below; views beside the frame and their targets, which need five
# storage textures; prime, which draws; and laws of hard cases, which say what frames do and not how a device computes
# them. What is recorded has every pass with every input.
skipped=(caught planted refused beside is_no_output record_compiles lost_device _hard:: h07 h11 h12)
for module in gaze lifecycle light limits motion objects prime submission; do skipped+=("pass::$module::"); done
# Rows of twins with NaN or with numbers below 2^-64 are left out of recordings (tests/gpu/twins/probe.rs): devices may
# flush denormals, and NaN has many bits. The passes' hostile inputs are not left out.
AFTERIMAGE_RECORD="$recordings" cargo test "${everything[@]}" --test gpu --test twins -- \
    functions:: pass:: simulator:: "${skipped[@]/#/--skip=}"

# Every pipeline in one of them; with a part of a name behind the folder, all whose name contains it.
step "the recordings in Chromium"
node tests/web/replay_all.mjs "$recordings"
rm -rf "$recordings"

step "the demo"
# A folder seen from here, where the page must then be.
crates/web/build.sh target/demo
node crates/web/test.mjs target/demo

seconds_of_steps
echo "all checks in the browser passed"
