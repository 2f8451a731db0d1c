#!/usr/bin/env bash
# All checks: format, lints, tests, documentation. Needs only Rust; finds everything else in the repository.
# Real frames and scanpaths are read from ../shared/data where that folder exists, and missed loudly where not.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

step "format"
cargo fmt --check

step "lints, in every combination of features that users meet"
cargo clippy --locked --all-targets --all-features -- -D warnings
cargo clippy --locked --no-default-features -- -D warnings
cargo clippy --locked --no-default-features --features lab -- -D warnings

if [ ! -d ../shared/data ]; then
    printf '\nWARNING: no ../shared/data here: tests on real frames and recorded scanpaths are SKIPPED\n'
fi

step "tests"
cargo test --locked --all-features

step "examples"
for example in 01_smallest 04_stereo; do
    cargo run --locked --quiet --example "$example"
done
for example in 02_moving_camera 03_scanpath; do
    cargo run --locked --quiet --features lab --example "$example"
done

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps --all-features

step "all checks passed"
