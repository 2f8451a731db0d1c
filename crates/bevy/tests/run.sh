#!/usr/bin/env bash
# All checks of the Bevy plugin, which is a workspace of its own: lints, tests, examples, documentation. Needs
# Rust 1.95 and a Vulkan driver, software or not. Bevy asks for Rust 1.97.1, hence --ignore-rust-version.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== bevy: %s (%d s so far)\n' "$*" "$SECONDS"; }
export CARGO_INCREMENTAL=0 NODEVICE_SELECT=1
target="${CARGO_TARGET_DIR:-target}"

step "lints"
cargo clippy --locked --ignore-rust-version --all-targets --features window -- -D warnings

step "tests"
# Two at a time: each has an application and a software renderer with threads of its own.
cargo test --locked --ignore-rust-version -- --test-threads 2

step "examples"
cargo run --locked --ignore-rust-version --example headless_png -- "$target/headless.png"
cargo run --locked --ignore-rust-version --example soak -- 20

step "documentation"
# With the lints' features and those of examples, so that they share what is checked.
RUSTDOCFLAGS="-D warnings" cargo doc --locked --ignore-rust-version --no-deps --lib --examples --features window

step "all checks passed"
