#!/usr/bin/env bash
# Format, spelling, lints and documentation of this workspace. Needs Rust with rustfmt and clippy.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/steps.sh

everything=(--locked --workspace --features cpu,serde,view)
target="${CARGO_TARGET_DIR:-target}"
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none

step "format"
# Crates outside the workspace too: the steps that build them come last.
for manifest in Cargo.toml crates/bevy/Cargo.toml crates/web/Cargo.toml; do
    cargo fmt --check --all --manifest-path "$manifest"
done

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
# Both doors, and nothing that slipped out: `tests/lint.sh` prints the difference, and the list is edited by hand.
items() { grep -o '<li><a href="[^#"]*"' "$target/doc/afterimage/all.html" | sed 's/.*href="//; s/\.html"//; s/\([a-z]*\)\.\([A-Za-z_]*\)$/\2 (\1)/; s,/,::,g' | LC_ALL=C sort; }
diff -u docs/public-items.txt <(items) || { echo "the drop-in's public items are not those of docs/public-items.txt" >&2; exit 1; }
echo "the drop-in has $(wc -l <docs/public-items.txt) public items"

step "packages, as they would be published"
if packaged=$(cargo publish --dry-run --workspace --no-verify --allow-dirty --locked 2>&1); then
    grep Packaged <<<"$packaged"
elif grep -qE 'failed to (download|fetch)|[Cc]ould not resolve|network failure' <<<"$packaged"; then
    printf '\nWARNING: no registry here: the packages are NOT CHECKED\n'
else
    echo "$packaged" >&2
    exit 1
fi

seconds_of_steps
