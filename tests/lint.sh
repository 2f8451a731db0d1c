#!/usr/bin/env bash
# Format, spelling, lints and documentation of this workspace. Needs Rust with rustfmt and clippy.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/steps.sh

everything=(--locked --workspace --features cpu,serde,view)
target="${CARGO_TARGET_DIR:-target}"
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none

step "format"
cargo fmt --check

step "spelling"
if command -v typos >/dev/null; then typos; else echo "no typos (cargo install typos-cli): SKIPPED"; fi

step "lints: every target, and the combinations of features that users build"
cargo clippy "${everything[@]}" --all-targets -- -D warnings
cargo clippy --locked -p afterimage -- -D warnings
cargo clippy --locked -p afterimage --no-default-features --features cpu -- -D warnings
# For engines on wgpu 29: nothing here uses it otherwise.
cargo clippy --locked -p afterimage --no-default-features --features wgpu-29 -- -D warnings
# What `cargo demo` builds.
cargo clippy --locked -p afterimage-eval -p afterimage-program -- -D warnings
# The fuzzing targets have a lock file of their own, which changes of dependencies must not leave behind.
cargo metadata --locked --format-version 1 --manifest-path crates/tool/tests/fuzz/Cargo.toml >/dev/null

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc "${everything[@]}" --no-deps
items=$(grep -o '<li><a href="[^#]' "$target/doc/afterimage/all.html" | wc -l)
echo "the drop-in documents $items items; at most 60"
[ "$items" -le 60 ]

seconds_of_steps
