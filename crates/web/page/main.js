// Controls of the demo: gaze, pictures, settings, and what is measured. The frames are made by the Rust library.

import init, { Demo } from "./afterimage_web.js";
import { draw_text_page, fitted } from "./pictures.js";

const $ = (id) => document.getElementById(id);
const canvas = $("canvas");
const is_still = matchMedia("(prefers-reduced-motion: reduce)");

// Frames are small on phones, and where a query says so.
const query = new URLSearchParams(location.search);
function frame_size() {
    const asked = query.get("size")?.match(/^(\d+)x(\d+)$/);
    if (asked) return [Number(asked[1]), Number(asked[2])];
    return innerWidth < 700 ? [480, 270] : [640, 360];
}

const METHOD_WORDS = {
    smr: "smr keeps the sharpest sample of every surface point as long as it explains the new frames.",
    wrs: "wrs keeps a random sample of every surface point, weighted by how sharply the eye saw it; it speckles.",
    taa: "taa blends a tenth of each frame in and clips what came before to the new frame's colors: detail is lost.",
    none: "Without a method both sides are the same: what the renderer delivers.",
};

const SCANPATH_HZ = 25;
// After this time without a hand, the scanpath goes on.
const IDLE_S = 5;

let demo;
let size = [0, 0];
let scanpath = [];
let gaze = [0, 0];
let divider = 0.5;
// When the pointer or a key moved the gaze last.
let taken_ms = -Infinity;
let own_picture;
// Waits between two frames for what must not happen during one.
const jobs = [];
let running = 0;

const chosen = (name) => document.querySelector(`input[name=${name}]:checked`).value;
const between = (x, low, high) => Math.min(Math.max(x, low), high);

function progress(text) {
    $("progress").textContent = text;
    // Lets the browser show it before the page is busy.
    return new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
}

function trouble(title, reason) {
    running = 0;
    progress("");
    $("trouble").querySelector("h2").textContent = title;
    $("reason").textContent = reason;
    if (!$("trouble").open) $("trouble").showModal();
    $("clip").src = "clip.webm";
    if (!is_still.matches) $("clip").play().catch(() => {});
}

async function load_scanpath() {
    const text = await (await fetch("scanpath.csv")).text();
    scanpath = text.split("\n").filter((line) => /^-?\d/.test(line)).map((line) => line.split(",").map((v) => v / 1000));
}

// Position at a time, in shares of the picture; the path starts again when it ends.
function scanpath_at(seconds) {
    return scanpath[Math.floor(seconds * SCANPATH_HZ) % scanpath.length];
}

async function show_scene() {
    const scene = chosen("scene");
    if (scene === "space") demo.space();
    else if (scene === "courtyard" || (scene === "own" && own_picture)) {
        const file = scene === "own" ? own_picture : await (await fetch("courtyard.jpg")).blob();
        demo.picture(fitted(await createImageBitmap(file), size));
    } else demo.picture(draw_text_page(size));
    // The scene draws its samples itself.
    $("filter").disabled = scene === "space";
}

function configure() {
    const number = (id) => Number($(id).value);
    $("mid").value = Math.max(number("mid"), number("fovea"));
    $("rate_far").value = Math.max(number("rate_far"), number("rate_mid"));
    for (const id of ["fovea", "mid"]) document.querySelector(`output[for=${id}]`).textContent = `${$(id).value}°`;
    const filter = chosen("scene") === "space" ? "sparse" : $("filter").value;
    demo.configure(chosen("method"), filter, number("fovea"), number("mid"), number("rate_mid"), number("rate_far"));
    $("words").textContent = METHOD_WORDS[chosen("method")];
    $("compared").textContent = "";
}

// One frame; the time of the camera stands still for those who want that.
function draw(seconds) {
    if (performance.now() - taken_ms > 1000 * IDLE_S) {
        const [x, y] = scanpath_at(is_still.matches ? 0 : seconds);
        gaze = [x * size[0] - 0.5, y * size[1] - 0.5];
    }
    demo.frame(gaze[0], gaze[1], is_still.matches ? 0 : seconds, divider * size[0]);
}

// The first frame of a configuration compiles its pipelines.
async function prepare(what) {
    await progress(`${what}: preparing the pipelines …`);
    draw(0);
    await demo.finished();
    await progress("");
}

async function measure() {
    const [left, right] = await demo.quality();
    $("quality_left").textContent = `${left.toFixed(1)} dB`;
    $("quality_right").textContent = `${right.toFixed(1)} dB`;
}

async function loop(number) {
    let frame_ms = 0;
    let measured = performance.now();
    while (running === number) {
        await new Promise(requestAnimationFrame);
        if (running !== number) return;
        try {
            while (jobs.length > 0) await jobs.shift()();
            const now = performance.now();
            draw(now / 1000);
            await demo.finished();
            const fault = demo.fault();
            if (fault) throw new Error(fault);
            frame_ms += 0.1 * (performance.now() - now - frame_ms);
            $("time").textContent = `${frame_ms.toFixed(1)} ms`;
            $("shaded").textContent = `${(100 * demo.shaded()).toFixed(1)} %`;
            if (now - measured > 1500) {
                await measure();
                measured = performance.now();
            }
            window.frames_shown = (window.frames_shown ?? 0) + 1;
        } catch (error) {
            trouble("The frames have stopped.", demo.fault() ?? error.message);
        }
    }
}

// Runs between two frames.
function later(job) {
    return new Promise((resolve, reject) => jobs.push(() => job().then(resolve, (error) => {
        reject(error);
        throw error;
    })));
}

async function start() {
    if (!navigator.gpu) {
        trouble("This browser has no WebGPU.", "The demo needs it: a current Chrome or Edge, Safari 26, or Firefox 141 on Windows. Below is a recording.");
        return;
    }
    try {
        const begin = performance.now();
        await progress("Loading …");
        await Promise.all([init(), load_scanpath()]);
        size = frame_size();
        [canvas.width, canvas.height] = size;
        demo = await Demo.open(canvas, ...size);
        $("adapter").textContent = demo.adapter() || "WebGPU";
        await show_scene();
        configure();
        await prepare("First frame");
        window.first_frame_ms = performance.now() - begin;
        $("trouble").close();
        loop(++running);
    } catch (error) {
        trouble("The demo cannot start.", `${demo?.fault() ?? error.message ?? error} Below is a recording.`);
    }
}

function take_gaze(event) {
    const box = canvas.getBoundingClientRect();
    taken_ms = performance.now();
    gaze = [((event.clientX - box.left) / box.width) * size[0] - 0.5, ((event.clientY - box.top) / box.height) * size[1] - 0.5];
}

canvas.addEventListener("pointermove", take_gaze);
canvas.addEventListener("pointerdown", take_gaze);
canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8] }[event.key];
    if (step) {
        taken_ms = performance.now();
        gaze = [0, 1].map((i) => between(gaze[i] + step[i], 0, size[i] - 1));
    } else if (event.key === "[" || event.key === "]") {
        divider = between(divider + (event.key === "[" ? -0.02 : 0.02), 0, 1);
        $("divider").value = 100 * divider;
    } else return;
    event.preventDefault();
});
$("divider").addEventListener("input", () => {
    divider = $("divider").value / 100;
});
$("own").addEventListener("change", () => {
    own_picture = $("own").files[0];
    document.querySelector("input[value=own]").checked = true;
    $("controls").dispatchEvent(new Event("change"));
});
$("controls").addEventListener("change", (event) => {
    if (!demo || event.target === $("own")) return;
    const is_scene = event.target.name === "scene" || event.target === $("controls");
    later(async () => {
        try {
            if (is_scene) await show_scene();
        } catch {
            $("words").textContent = "The browser cannot read this picture.";
            return;
        }
        configure();
        await prepare("New settings");
    }).catch(() => {});
});
$("controls").addEventListener("input", () => {
    for (const id of ["fovea", "mid"]) document.querySelector(`output[for=${id}]`).textContent = `${$(id).value}°`;
});
$("controls").addEventListener("submit", (event) => event.preventDefault());
$("compare").addEventListener("click", () => {
    later(async () => {
        const frames = 4;
        $("compared").textContent = "Comparing …";
        await progress("Comparing with the CPU …");
        const [values, different, ms] = await demo.compare(frames);
        await progress("");
        $("compared").textContent = `${different} of ${values.toLocaleString("en")} values of ${frames} frames differ (${ms.toFixed(0)} ms a frame on the CPU).`;
    }).catch(() => {});
});
$("again").addEventListener("click", () => location.reload());
let resizing;
addEventListener("resize", () => {
    clearTimeout(resizing);
    resizing = setTimeout(() => {
        if (!demo || running === 0 || String(frame_size()) === String(size)) return;
        later(async () => {
            size = frame_size();
            [canvas.width, canvas.height] = size;
            demo.resize(...size);
            await show_scene();
            configure();
            await prepare("New size");
        }).catch(() => {});
    }, 200);
});

// For the tests of the page, and for the recording of it.
window.page = { later, draw, demo: () => demo, gaze: () => gaze, scanpath: () => scanpath, show: () => show_scene().then(configure) };

start();
