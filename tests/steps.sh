# Steps of the test scripts, which source this file: their seconds, and the sum of the tests.
step_names=()
step_starts=()

# step NAME: a new step begins.
step() {
    step_names+=("$*")
    step_starts+=("$SECONDS")
    printf '\n== %s (%d s so far)\n' "$*" "$SECONDS"
}

# The table of all steps, at the end.
seconds_of_steps() {
    local i end
    printf '\nseconds  step\n'
    for i in "${!step_names[@]}"; do
        end="${step_starts[i + 1]:-$SECONDS}"
        printf '%7d  %s\n' "$((end - step_starts[i]))" "${step_names[i]}"
    done
}

# summary_of_tests LOG: the sum of `cargo test`'s results in one line.
summary_of_tests() {
    awk -v seconds="$SECONDS" '/^test result:/ {passed += $4; failed += $6; skipped += $8}
        END {printf "\ntests: %d passed, %d failed, %d skipped, %.1f minutes\n", passed, failed, skipped, seconds / 60}' "$1"
}
