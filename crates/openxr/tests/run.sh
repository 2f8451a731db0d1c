#!/usr/bin/env bash
# The example `headset` on a real OpenXR runtime: Monado with a simulated headset on software Vulkan, under Vulkan's and OpenXR's
# validation, with an eye tracker and events that an API layer plays. Needs Debian (bookworm or trixie, x86-64), root, gcc and
# Rust; says loudly if it cannot run. 190 MB are downloaded the first time. `run.sh soak SECONDS` repeats the events for so long.
# `run.sh picture FILE.png` writes what Monado's compositor shows of both eyes in a window; it needs python3, too.
set -euo pipefail
cd "$(dirname "$0")/../../.."
tests="$PWD/crates/openxr/tests"
target="${CARGO_TARGET_DIR:-$PWD/target}"
root="${AFTERIMAGE_XR_ROOT:-$target/openxr-root}"
everything=(--locked --workspace --features cpu,serde,view)
# As in tests/run.sh, whose builds these are.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG="${CARGO_PROFILE_DEV_DEBUG:-none}"

step() { printf '\n== openxr: %s (%d s so far)\n' "$*" "$SECONDS"; }

step "example"
cargo build "${everything[@]}" --example headset

has() { for command in "$@"; do command -v "$command" >/dev/null || return 1; done; }
if [ "$(id -u)" != 0 ] || [ "$(uname -m)" != x86_64 ] || ! has apt-get dpkg-deb unshare gcc ||
    [ ! -f /usr/share/keyrings/debian-archive-keyring.gpg ]; then
    printf '\nWARNING: no Debian on x86-64 with root, apt and gcc: the tests with an OpenXR runtime are SKIPPED\n'
    exit 0
fi

step "runtime"
[ -f "$root/xr/complete" ] || [ -x "$root/usr/bin/monado-service" ] || "$tests/root.sh" "$root"
gcc -O2 -Wall -Wextra -shared -fPIC -I"$root/usr/include" -o "$root/xr/layers/libplayer.so" "$tests/player.c" -lm
cp "$tests/player.json" "$root/xr/layers/"
cp "$target/debug/examples/headset" fixtures/scanpath_viewing.csv "$root/xr/"
printf '%s\n' 'khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG' \
    'khronos_validation.log_filename = /xr/vulkan.txt' 'khronos_validation.validate_sync = true' \
    >"$root/xr/vk_layer_settings.txt"

in_root() { "$tests/in_root.sh" "$root" "$@"; }
# Without a terminal, monado-service needs a standard input that stays open.
rm -f "$root/xr/stdin" "$root/run/user/0/monado_comp_ipc"
mkfifo "$root/xr/stdin"
sleep 100000 >"$root/xr/stdin" &
holder=$!
compositor=(XRT_COMPOSITOR_NULL=1)
window=
if [ "${1:-}" = picture ]; then
    mkdir -p "$root/xr/screen"
    in_root Xvfb :77 -screen 0 1280x720x24 -fbdir /xr/screen -nolisten tcp >/dev/null 2>&1 &
    window=$!
    sleep 2
    compositor=(DISPLAY=:77 XRT_COMPOSITOR_FORCE_XCB=1)
fi
in_root SIMULATED_ENABLE=1 "${compositor[@]}" /usr/bin/monado-service <"$root/xr/stdin" >"$root/xr/monado.log" 2>&1 &
service=$!
trap 'kill $service $holder $window 2>/dev/null || true' EXIT
for _ in $(seq 100); do [ -S "$root/run/user/0/monado_comp_ipc" ] && break; sleep 0.1; done
[ -S "$root/run/user/0/monado_comp_ipc" ] || { echo "monado-service did not start:"; cat "$root/xr/monado.log"; exit 1; }

# run NAME LIMIT_S [VARIABLE=value ...] [-- options]: the example under both validations. Its output is in $log.
run() {
    local name="$1" limit="$2"
    shift 2
    local variables=()
    while [ $# -gt 0 ] && [ "$1" != -- ]; do variables+=("$1"); shift; done
    [ $# -gt 0 ] && shift
    log="$root/xr/$name.log"
    rm -f "$root/xr/vulkan.txt" "$root/xr/openxr.txt"
    step "$name"
    timeout "$limit" "$tests/in_root.sh" "$root" VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation \
        VK_LAYER_SETTINGS_PATH=/xr/vk_layer_settings.txt \
        XR_API_LAYER_PATH=/xr/layers:/usr/share/openxr/1/api_layers/explicit.d \
        XR_ENABLE_API_LAYERS=XR_APILAYER_LUNARG_core_validation:XR_APILAYER_TEST_player \
        XR_CORE_VALIDATION_EXPORT_TYPE=text XR_CORE_VALIDATION_FILE_NAME=/xr/openxr.txt "${variables[@]}" \
        /xr/headset $side --method "$method" "$@" </dev/null >"$log" 2>&1 || { tail -n 40 "$log"; echo "$name: failed"; exit 1; }
    grep -E "^(runtime|eye tracker|depth|views|again|frame|method|player)" "$log" | cut -c1-160 || true
}
# Size of the views.
side="--side 288"
# Full rate has one sample a pixel: what antialiases differs from it, and gains less.
method=smr
fail() { echo "FAILED: $*"; exit 1; }
silent() {
    [ ! -s "$root/xr/vulkan.txt" ] || { head -n 40 "$root/xr/vulkan.txt"; fail "$1: messages of Vulkan's validation"; }
    ! grep -qE "VALID_(ERROR|WARN)" "$root/xr/openxr.txt" 2>/dev/null ||
        { grep -E "VALID_(ERROR|WARN)" "$root/xr/openxr.txt" | head; fail "$1: messages of OpenXR's validation"; }
    ! grep -q panicked "$log" || fail "$1: a panic"
}
# gain FRAME: dB that memory gains in a checked frame.
gain() { awk -v at="frame $1:" 'index($0, at) == 1 {for (i = 1; i < NF; i++) if ($i == "dB," ) v[n++] = $(i - 1); print v[0] - v[1]}' "$log"; }
gains() { awk -v g="$(gain "$1")" -v least="$2" 'BEGIN {exit !(g != "" && g > least)}' || fail "frame $1: memory gains $(gain "$1") dB, at least $2 expected"; }
# loses FRAME: whether memory gains less than half of what it gained in the same frame of the scanpath without errors.
loses() { awk -v g="$(gain "$1")" -v right="$right" 'BEGIN {exit !(g != "" && right != "" && g < right / 2)}'; }
has_reset() { grep -q "^frame $1: All" "$log" || fail "frame $1: no reset after $2"; }

if [ "${1:-}" = soak ]; then
    # Every event once in 300 frames.
    run soak "$(($2 + 120))" PLAYER_CSV=/xr/scanpath_viewing.csv PLAYER_LOOP=300 \
        PLAYER_EVENTS=40:recentre,80:off,110:on,140:blind,170:see,220:lose -- --seconds "$2" --check 500
    silent soak
    grep -E "frames shown" "$log"
    step "soak passed: $(grep -c '^player: lose' "$log") sessions lost, $(grep -c '^player: off' "$log") times taken off"
    exit 0
fi

if [ "${1:-}" = picture ]; then
    in_root /xr/headset --gaze /xr/scanpath_viewing.csv --side 512 --check 20 --frames 100000 </dev/null >"$root/xr/picture.log" 2>&1 &
    window="$window $!"
    for _ in $(seq 240); do grep -q "^frame 60:" "$root/xr/picture.log" && break; sleep 0.5; done
    python3 "$tests/screen_to_png.py" "$root/xr/screen/Xvfb_screen0" "$2"
    step "wrote $2"
    exit 0
fi

run scanpath 120 -- --gaze /xr/scanpath_viewing.csv --frames 46 --check 15
silent scanpath
grep -q "eye tracker: no" "$log" || fail "a tracker that nobody plays"
grep -q "^player: depth of layers 0 and 1, 0 to 1 is inf to 0.05 m" "$log" || fail "the runtime gets no depth, or another range"
has_reset 0 "the start"
for frame in 30 45; do gains "$frame" 6; done
right=$(gain 30)

# Every frame is checked. Taken off for 105 periods of 1/90 s or more: a pause, which discards history. Frames that are shown count
# on without those. Blinks are in the scanpath.
run events 250 PLAYER_CSV=/xr/scanpath_viewing.csv \
    PLAYER_EVENTS=30:recentre,60:off,165:on,185:blind,200:see,220:lose -- --frames 170 --check 1 --stall 45 --resize 145 320
silent events
grep -q "eye tracker: yes" "$log" || fail "the tracker is not used"
# At the start, by recentring, after the pause, in the new session. Not by half a second without frames, and not by blinks.
resets=$(grep -c "^frame [0-9]*: All" "$log")
[ "$resets" = 4 ] || fail "$resets resets instead of 4"
for frame in 28 56 78 92 112 143 165; do gains "$frame" 2; done
gazes() { awk -v low="$1" -v high="$2" '/^frame/ {n = $2 + 0; if (n >= low && n <= high) {sub(/.*gaze/, ""); print}}' "$log" | sort -u | wc -l; }
[ "$(gazes 5 25)" -gt 3 ] || fail "the gaze does not move"
[ "$(gazes 82 92)" = 1 ] || fail "a lost gaze is not held"

# Another size is recommended, then the session is lost; the runtime ends, and the next one goes on.
side= method=antialias
run restarts 120 PLAYER_SIZES=256,320 PLAYER_EVENTS=15:size,20:lose,40:gone -- --gaze /xr/scanpath_viewing.csv --frames 60 --check 5
silent restarts
grep -q "^views: \[256, 256\] pixels each$" "$log" || fail "the recommended size is not taken"
grep -q "^views: \[320, 320\] pixels each, from frame" "$log" || fail "another recommended size is not taken"
[ "$(grep -c '^again: the OpenXR runtime was lost' "$log")" = 1 ] || fail "the end of the runtime is not said, or more than once"
[ "$(grep -c '^runtime: ' "$log")" = 2 ] && grep -q "^60 frames shown" "$log" || fail "no frames on the runtime that came after"
side="--side 288" method=smr

step "planted errors"
run planted-vulkan 60 -- --frames 2 --plant vulkan
[ -s "$root/xr/vulkan.txt" ] || fail "Vulkan's validation does not see a buffer of no bytes"
run planted-openxr 60 -- --frames 2 --plant openxr
grep -q "VALID_ERROR" "$root/xr/openxr.txt" || fail "OpenXR's validation does not see an unknown reference space"
run planted-eyes 60 -- --gaze /xr/scanpath_viewing.csv --frames 31 --check 15 --plant eyes
loses 30 || fail "swapped eyes are not seen"
run planted-motion 60 -- --gaze /xr/scanpath_viewing.csv --frames 31 --check 15 --plant motion
loses 30 || fail "wrong motion vectors are not seen"
run planted-quads 60 -- --gaze /xr/scanpath_viewing.csv --frames 31 --check 15 --plant quads
loses 30 || fail "quads of the other eye are not seen"
(run planted-choice 60 -- --frames 2 --plant choice) >/dev/null && fail "a frame whose quads were not chosen is shown"
grep -q "^headset: .* call HeadsetFrame::choose" "$root/xr/planted-choice.log" || fail "no error without a choice of quads"

step "all checks passed"
