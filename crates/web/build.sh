#!/usr/bin/env bash
# Builds the demo into a folder that any static server serves: crates/web/build.sh [FOLDER] (default: crates/web/dist).
# CODE_URL: where the code is, for the page's links; without it they lead to copies of README.md and docs/method.md.
# PAGE_URL: where the page will be, with a slash at its end; the preview card needs it.
# Needs Node.js, and Rust with the target wasm32-unknown-unknown. If that is missing, it takes Debian's compiler for
# browsers, which it unpacks into crates/web/target/debian without installing it; the standard library is then compiled,
# too.
set -euo pipefail
here="$(realpath "$(dirname "$0")")"
to="$(realpath -m "${1:-$here/dist}")"
cd "$here"
target="${CARGO_TARGET_DIR:-$PWD/target}"
export CARGO_TARGET_DIR="$target"
wasm=wasm32-unknown-unknown
std=()

if [ ! -d "$(rustc --print target-libdir --target $wasm 2>/dev/null)" ]; then
    debian="$target/debian"
    if [ ! -x "$debian/usr/bin/rustc" ]; then
        command -v apt-get >/dev/null || { echo "no $wasm: run 'rustup target add $wasm'" >&2; exit 1; }
        mkdir -p "$debian/packages"
        (
            cd "$debian/packages"
            std_package=$(apt-cache depends rustc-web | grep -o 'libstd-rust-web-dev' | head -1)
            shared=$(apt-cache depends "$std_package" | grep -o 'libstd-rust-web-[0-9][0-9.]*' | head -1)
            llvm=$(apt-cache depends "$shared" | grep -o 'libllvm[0-9][0-9]*' | head -1)
            apt-get download -qq rustc-web rust-web-src "$std_package" "$shared" "$llvm" "lld-${llvm#libllvm}"
            for package in *.deb; do dpkg -x "$package" ..; done
            rm -- *.deb
        )
    fi
    export RUSTC="$debian/usr/bin/rustc" LD_LIBRARY_PATH="$debian/usr/lib/x86_64-linux-gnu"
    # build-std is not stable; Debian's compiler is a stable one.
    export RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(echo "$debian"/usr/bin/wasm-ld-*)
    std=(-Zbuild-std=std,panic_abort -Zbuild-std-features=optimize_for_size)
fi

# Messages of panics name files, of this machine without this.
home="${CARGO_HOME:-$HOME/.cargo}"
copy="$target/compact"
remapped="--remap-path-prefix=$home/registry/src= --remap-path-prefix=$target= --remap-path-prefix=$copy="
bindgen=(env -u RUSTC -u LD_LIBRARY_PATH -u RUSTC_BOOTSTRAP CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_LTO=off
    CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 cargo run --locked --release --package afterimage-web-bindgen --)

# The sources that the page is made of, in a copy whose shaders are compact: without comments and long names, and without
# those that it never asks for, because it closes no depth buffer, asks no doctor, offers no taau, has no albedo, and opens
# new contexts instead of resizing them.
rm -rf "$copy"
mkdir -p "$copy/crates/web"
cp -pr ../../{Cargo.toml,README.md,examples,shaders,src,tests} "$copy"
cp -pr Cargo.toml Cargo.lock bindgen src shaders "$copy/crates/web"
for unused in quad_prime_pass 'doctor*' 'resize*' 'taau*' demodulation quad_albedo_pass quad_observe_albedo_pass \
    sparse_albedo; do
    for shader in "$copy"/shaders/*/$unused.wgsl; do
        [ -f "$shader" ] || { echo "no shader $unused.wgsl to leave out: build.sh names an old one" >&2; exit 1; }
        : >"$shader"
    done
done
find "$copy" -name '*.wgsl' -exec "${bindgen[@]}" compact {} +

mkdir -p "$to"
# library NAME OPTIONS...: a library and its bindings.
library() {
    local name=$1
    shift
    (cd "$copy/crates/web" && RUSTFLAGS="$remapped" cargo build --locked --release --target $wasm "${std[@]}" "$@")
    "${bindgen[@]}" "$target/$wasm/release/afterimage_web.wasm" "$to" "$name"
}
library afterimage_web
library compare --features compare

cp page/* "$to"
cp ../../README.md "$to/readme.txt"
cp ../../docs/method.md "$to/method.txt"
code="${CODE_URL:-readme.txt}"
method="${CODE_URL:+$CODE_URL/blob/HEAD/docs/method.md}"
sed -i "s|@CODE@|$code|; s|@METHOD@|${method:-method.txt}|; s|@PAGE_URL@|${PAGE_URL:-}|" "$to/index.html"
node pack.mjs "$to"
