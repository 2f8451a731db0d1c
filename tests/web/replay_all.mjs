// Repeats recordings of the GPU tests in headless Chromium: Dawn with Tint and SwiftShader, which share nothing with
// wgpu, naga and llvmpipe. Every word that the tests read must be the same.
//
// node replay_all.mjs FOLDER [PART OF A NAME]
//
// Without a part: the smallest recordings in which every pipeline runs. With one: all whose name contains it.

import { readdirSync } from "node:fs";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, serve } from "./chromium.mjs";
import { covering } from "./covering.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const [folder, part] = process.argv.slice(2);

// Recordings that differ: the start of their name, the most words that do, and why.
const EXCEPTIONS = [
    ["simulator.lifecycle.the_fovea_of_a_half_float_frame", 8000, "a device rounds to halves as it likes"],
];

// Recordings that read nothing, by the start of their name: of tests about what is refused, what is allowed, and memory.
// They are left out; in every other one something must be read, or nothing is compared.
const UNREAD = [
    "pass.engines.every_storable_format_is_written_and_others_say_what_to_change",
    "pass.planned.both_eyes_have_quarters_until_history_is_there",
    "pass.quads.plans_follow_size_and_settings",
];

// Planted errors: a recording by the start of its name, what its shaders contain, and what is put in its place.
const PLANTED = [
    ["twins.functions.reservoir", "draw * w_sum < w2", "draw * w_sum <= w2"],
    ["twins.functions.approx", "1.6666665e-1", "1.6666667e-1"],
    ["pass.surfaces.", "reuse.finer * acceptance", "reuse.finer"],
    ["pass.sparse.", "(history - r.candidate) * share", "(history - r.candidate) * (share * 0.999)"],
    ["simulator.equal", "3.0 * sigma_px", "2.0 * sigma_px"],
];

const all = readdirSync(folder).filter((name) => !UNREAD.some((start) => name.startsWith(start))).sort();
const names = part === undefined ? covering(folder, all) : all.filter((name) => name.includes(part));
if (names.length === 0) throw new Error(`no recordings in ${folder}`);
console.log(`${names.length} of ${all.length} recordings`);
const server = await serve({ page: here, recordings: folder });
const browser = await launch();
let failed = 0;
try {
    const complaints = [];
    browser.on("Runtime.exceptionThrown", ({ exceptionDetails }) => complaints.push(exceptionDetails.text));
    await browser.goto(`${server.url}/page/replay.html`);
    console.log(`adapter: ${await browser.evaluate("open_browser()")}`);
    const run = (...args) => browser.evaluate(`replay(${args.map((arg) => JSON.stringify(arg)).join(",")})`);
    const sum = { recordings: 0, reads: 0, words: 0, different: 0, pipelines: 0 };
    // Seconds of each test, whose recordings differ by the number at their end.
    const took = new Map();
    for (const name of names) {
        const start = performance.now();
        const result = await run(name);
        const seconds = (performance.now() - start) / 1000;
        const test = name.replace(/\.\d+$/, "");
        took.set(test, (took.get(test) ?? 0) + seconds);
        const exception = EXCEPTIONS.find(([start]) => name.startsWith(start));
        if (result.reads === 0) result.error = "nothing is read";
        const outcome = result.error ?? (result.different > 0 ? `${result.different} differ: ${result.faults.slice(0, 8).join("; ")}` : "equal");
        const is_expected = !result.error && result.different <= (exception?.[1] ?? 0);
        if (outcome !== "equal" || seconds > 5) {
            console.log(`${name}: ${result.words ?? 0} words, ${outcome} (${seconds.toFixed(1)} s)${exception && is_expected ? `; expected: ${exception[2]}` : ""}`);
        }
        if (!is_expected) failed++;
        sum.recordings++;
        for (const key of ["reads", "words", "different"]) sum[key] += result[key] ?? 0;
        sum.pipelines = result.pipelines ?? sum.pipelines;
    }
    console.log(`${sum.recordings} recordings, ${sum.reads} reads, ${sum.words} words, ${sum.different} differ; ${sum.pipelines} pipelines`);
    const longest = [...took].sort(([, a], [, b]) => b - a).slice(0, 20);
    console.log(`longest tests:${longest.map(([test, seconds]) => `\n${seconds.toFixed(1).padStart(7)} s ${test}`).join("")}`);
    for (const [start, right, wrong] of part === undefined ? PLANTED : []) {
        let isCaught = false;
        for (const name of all.filter((name) => name.startsWith(start))) {
            const result = await run(name, right, wrong);
            isCaught = result.planted && result.different > 0;
            if (isCaught) break;
        }
        console.log(`planted in ${start}, ${wrong}: ${isCaught ? "caught" : "NOT CAUGHT"}`);
        if (!isCaught) failed++;
    }
    for (const complaint of complaints) console.log(`error in the page: ${complaint}`);
    failed += complaints.length;
} finally {
    await browser.close();
    server.close();
}
if (failed > 0) {
    console.log(`${failed} failures`);
    process.exit(1);
}
