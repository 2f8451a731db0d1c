// The recordings that are enough: most tests run the same pipelines on other data, and the browser compares what the
// second compiler and the second device make of a pipeline.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { constantsOf, parseRon } from "./ron.mjs";

// Pipelines of a recording: shader, entry point and constants.
function pipelinesOf(folder) {
    const modules = new Map();
    const pipelines = new Set();
    for (const call of parseRon(readFileSync(join(folder, "trace.ron"), "utf8"))) {
        const { CreateShaderModule: module, CreateComputePipeline: pipeline } = call;
        if (module) {
            const content = JSON.stringify(module.data);
            const [, file] = content.match(/"(data[0-9]+\.wgsl)"/) ?? [];
            const code = file ? readFileSync(join(folder, file)) : content;
            modules.set(JSON.stringify(module.id), createHash("sha256").update(code).digest("hex"));
        } else if (pipeline) {
            const { stage } = pipeline.desc;
            const code = modules.get(JSON.stringify(stage.module));
            pipelines.add(JSON.stringify([code, stage.entry_point, constantsOf(stage)]));
        }
    }
    return pipelines;
}

// Those of `names` that, taken from the smallest on, have every pipeline.
export function covering(folder, names) {
    const recordings = names.map((name) => {
        const path = join(folder, name);
        const bytes = readdirSync(path).reduce((sum, file) => sum + statSync(join(path, file)).size, 0);
        return { name, bytes, pipelines: pipelinesOf(path) };
    });
    recordings.sort((a, b) => a.bytes - b.bytes);
    const count = new Map();
    const add = (recording, by) => {
        for (const key of recording.pipelines) count.set(key, (count.get(key) ?? 0) + by);
    };
    const kept = recordings.filter((recording) => {
        const isNew = [...recording.pipelines].some((key) => (count.get(key) ?? 0) === 0);
        if (isNew) add(recording, 1);
        return isNew;
    });
    // A larger one may have made smaller ones unnecessary.
    const enough = kept.filter((recording) => {
        const isEnough = [...recording.pipelines].every((key) => count.get(key) > 1);
        if (isEnough) add(recording, -1);
        return !isEnough;
    });
    return enough.map(({ name }) => name).sort();
}
