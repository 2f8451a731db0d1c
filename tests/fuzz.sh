#!/usr/bin/env bash
# Fuzzes the readers of untrusted files with libFuzzer: all targets or those named, SECONDS_EACH (default 600) each.
#   tests/fuzz.sh [TARGET...]
# Needs a nightly compiler and cargo-fuzz (cargo install cargo-fuzz). libFuzzer writes findings to crates/tool/tests/fuzz/artifacts:
# fix the cause, then keep the input in fixtures/fuzz/TARGET, which crates/tool/tests/fuzz_replay.rs reads on stable Rust.
set -euo pipefail
cd "$(dirname "$0")/.."
targets=("$@")
[ $# -gt 0 ] || targets=(scanpath exr png gltf camera plan settings)
for target in "${targets[@]}"; do
    printf '\n== %s\n' "$target"
    mkdir -p "target/fuzz-corpus/$target"
    cargo +nightly fuzz run --fuzz-dir crates/tool/tests/fuzz "$target" "target/fuzz-corpus/$target" "fixtures/fuzz/$target" -- \
        -max_total_time="${SECONDS_EACH:-600}" -timeout=20 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1
done
