#!/usr/bin/env bash
# Measures and checks a real GPU, in ten minutes at most, and writes one Markdown table for docs/performance.md: arithmetic and
# pictures against the CPU, the passes at 1080p and 4K, a whole frame, and the plugin for Bevy at 1080p and 4K.
#   tests/gpu.sh [TABLE.md]               builds, and runs; the table is target/gpu.md unless named
#   tests/gpu.sh build FOLDER             builds only: FOLDER then holds the programs, for a machine without Rust
#   tests/gpu.sh run FOLDER [TABLE.md]    runs what is in FOLDER
# AFTERIMAGE_ADAPTER=NAME chooses the adapter. Without a GPU it measures the software adapter, and says so.
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/steps.sh

build() {
    step "build of the tool"
    cargo build --locked --release -p afterimage-cli --bin afterimage
    step "build of Bevy's example"
    (cd crates/bevy && cargo build --locked --ignore-rust-version --release --example measure)
    mkdir -p "$1"
    cp "${CARGO_TARGET_DIR:-target}/release/afterimage" "${CARGO_TARGET_DIR:-crates/bevy/target}/release/examples/measure" "$1/"
}

# limited SECONDS COMMAND...: a measurement that ends in time; its output, or a line that says that it failed.
limited() {
    local limit="$1"
    shift
    timeout "$limit" "$@" 2>&1 || echo "FAILED (status $?, limit $limit s): $*"
}

run() {
    local afterimage="$1/afterimage" measure="$1/measure" table="$2"
    work="$(mktemp -d)"
    trap 'rm -rf "$work"' EXIT
    mkdir -p "$(dirname "$table")"

    step "self-test: arithmetic, and pictures against the CPU"
    limited 60 "$afterimage" info adapters --self-test | tee "$work/self_test.txt"

    step "pictures and scores against the CPU"
    for backend in cpu gpu; do
        limited 60 "$afterimage" run analytic:lateral --size 640x360 --frames 30 --method none,wrs,taa,smr --backend $backend \
            --no-flip --no-jod --out "$work/$backend" >"$work/$backend.txt"
        grep -E "^ *(none|wrs|taa|smr) " "$work/$backend.txt" | sed "s/^/$backend: /" | tee -a "$work/scores.txt" || cat "$work/$backend.txt"
    done

    for size in 1920x1080 3840x2160; do
        step "passes, $size"
        limited 90 "$afterimage" bench post --backend gpu --size $size --frames 200 | tee "$work/bench_$size.txt"
    done

    step "a whole frame"
    for size in 1920x1080 3840x2160; do
        limited 60 "$afterimage" run builtin:courtyard --source raster --foveation planned --size $size --frames 6 \
            --method none,smr,taau --backend gpu --no-flip --no-jod --reference-samples 1 --out "$work/whole" |
            tee "$work/whole_$size.txt"
        rm -rf "$work/whole"
    done

    if [ -x "$measure" ]; then
        for size in 1920x1080 3840x2160; do
            for scene in courtyard cheap both; do
                step "Bevy: $scene, $size"
                for mode in full prepass quads; do
                    limited 40 "$measure" "$scene@$size" $mode fixtures/scanpath_viewing.csv 60 | tail -n 1 | tee -a "$work/bevy.txt"
                done
            done
        done
    fi

    {
        echo "Measured by \`tests/gpu.sh\` on $(date -u +%F), $(nproc) CPU threads."
        for part in self_test scores bench_1920x1080 bench_3840x2160 whole_1920x1080 whole_3840x2160 bevy; do
            [ -s "$work/$part.txt" ] || continue
            printf '\n| %s |\n|---|\n' "$part"
            grep -vE '^\s*$' "$work/$part.txt" | sed -E 's/\|/,/g; s/^ +//; s/(.*)/| \1 |/'
        done
    } >"$table"
    echo "wrote $table"
    seconds_of_steps
}

case "${1:-}" in
build) build "${2:?a folder for the programs}" ;;
run) run "${2:?the folder of the programs}" "${3:-target/gpu.md}" ;;
*)
    build target/gpu-programs
    run target/gpu-programs "${1:-target/gpu.md}"
    ;;
esac
