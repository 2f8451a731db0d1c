// The page: its controls, its frames, and what is measured of them. The frames are made by the Rust library.

import init, { Demo } from "./afterimage_web.js";
import { read_address, write_address } from "./address.js";
import { Gaze } from "./gaze.js";
import { draw_text_page, filling, letterboxed } from "./pictures.js";
import { show_trouble } from "./trouble.js";

const $ = (id) => document.getElementById(id);
const canvas = $("canvas");
const stage = $("stage");
const gaze = new Gaze(stage, canvas);
const is_still = matchMedia("(prefers-reduced-motion: reduce)");

const METHOD_WORDS = {
    smr: "Scale-matched reservoirs show a sample for as long as it explains the new frames.",
    wrs: "Weighted reservoirs prefer what the eye saw sharply. They speckle.",
    taa: "Each frame is blended in by a tenth, and older color is clipped to the new frame’s: detail is lost.",
    none: "Both sides are the same.",
};
// Pixels of a frame: at first, and the least and the most that a device's speed changes them to.
const FIRST_PIXELS = 640 * 360;
const LEAST_PIXELS = 480 * 270;
const MOST_PIXELS = 1920 * 1080;
// Frame times below which a device gets larger frames, and above which smaller ones.
const FAST_MS = 9;
const SLOW_MS = 60;
// After so many frames it is decided about.
const TRIED_FRAMES = 20;
// Motion goes on by at most this from frame to frame: on a slow device it is slow, not jerky, and memory is of use.
const LONGEST_STEP_S = 1 / 30;
const COMPARED_FRAMES = 4;
// Block edges of frames whose pixels the memory chooses.
const PLANNED_RATES = [2, 8];

let demo;
let size = [0, 0];
let pixels = FIRST_PIXELS;
let own_picture;
let courtyard;
// Time of the camera and of the scanpath.
let clock_s = 0;
// Number of the loop that runs; 0: none.
let running = 0;
// What the next frame waits for.
const jobs = [];
// Choices since the last frame; many are one.
let changed;

const number = (id) => Number($(id).value);
const chosen = (name) => document.querySelector(`input[name=${name}]:checked`)?.value;
const scene = () => chosen("scene") ?? "own";

// The stage's device pixels, as many as the device is fast enough for; fixed where the address says so.
function frame_size() {
    const asked = new URLSearchParams(location.search).get("size")?.match(/^(\d+)x(\d+)$/);
    if (asked) return [Number(asked[1]), Number(asked[2])];
    const full = [stage.clientWidth, stage.clientHeight].map((side) => side * devicePixelRatio);
    const scale = Math.min(1, Math.sqrt(pixels / (full[0] * full[1])));
    return full.map((side) => Math.max(16, Math.round(side * scale)));
}

function progress(text) {
    $("progress").textContent = text;
    // Lets the browser show it before the page is busy.
    return new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
}

let noticed;
function notice(text) {
    $("notice").textContent = text;
    clearTimeout(noticed);
    noticed = setTimeout(() => ($("notice").textContent = ""), 8000);
}

function trouble(kind, error) {
    running = 0;
    progress("");
    show_trouble(kind, error?.message ?? error);
}

async function picture(size) {
    if (scene() === "own") return letterboxed(own_picture, size);
    if (scene() === "text") return draw_text_page(size);
    courtyard ??= await createImageBitmap(await (await fetch("courtyard.jpg")).blob());
    return filling(courtyard, size);
}

async function show_scene(demo, size) {
    if (scene() === "space") demo.space();
    else demo.picture(await picture(size));
}

// The scene is drawn at its chosen pixels.
const filter = () => (scene() === "space" ? "quads" : $("filter").value);

function configure(demo) {
    demo.configure(chosen("method"), filter(), number("fovea"), number("mid"), number("rate_mid"), number("rate_far"));
}

// Controls that follow from others, and words about them.
function show_choices() {
    $("mid").value = Math.max(number("mid"), number("fovea"));
    const [least, most] = filter() === "quads" ? PLANNED_RATES : [1, 16];
    for (const option of document.querySelectorAll("#rate_mid option, #rate_far option")) {
        option.disabled = Number(option.value) < least || Number(option.value) > most;
    }
    $("rate_mid").value = Math.max(number("rate_mid"), least);
    $("rate_far").value = Math.min(Math.max(number("rate_far"), number("rate_mid")), most);
    for (const id of ["fovea", "mid"]) document.querySelector(`output[for=${id}]`).textContent = `${$(id).value}°`;
    $("filter").disabled = scene() === "space";
    $("own_label").classList.toggle("is-chosen", scene() === "own");
    $("words").textContent = METHOD_WORDS[chosen("method")];
    $("size").textContent = size.join(" × ");
    const share = number("divider");
    document.querySelector(".side.left").hidden = share < 25;
    document.querySelector(".side.right").hidden = share > 75;
}

// Pixels of the frame for each of the page's.
const density = () => size[0] / (stage.clientWidth || size[0]);

function draw() {
    const [x, y] = gaze.at.map((share, i) => share * size[i] - 0.5);
    demo.frame(x, y, is_still.matches ? 0 : clock_s, (number("divider") / 100) * size[0], Math.max(2, 2 * density()));
}

// Frames of what is chosen now. Their first compiles pipelines.
async function apply({ is_sized, is_scene }) {
    if (is_sized) {
        size = frame_size();
        [canvas.width, canvas.height] = size;
        demo.resize(...size);
    }
    if (is_sized || is_scene) await show_scene(demo, size);
    show_choices();
    configure(demo);
    await progress("Preparing …");
    draw();
    await demo.finished();
    await progress("");
}

function change(what) {
    changed = { ...changed, ...what };
}

async function measure() {
    const [left, right] = await demo.quality();
    $("shaded").textContent = `${(100 * (await demo.shaded())).toFixed(0)} %`;
    $("quality_left").textContent = `${left.toFixed(1)} dB`;
    $("quality_right").textContent = `${right.toFixed(1)} dB`;
    $("gain").textContent = `${Math.max(right - left, 0).toFixed(right - left < 9.95 ? 1 : 0)} dB`;
}

// Larger frames for fast devices, smaller ones for slow devices; once slow, never larger again.
function follow_speed(frame_ms, is_slow) {
    const before = pixels;
    if (frame_ms > SLOW_MS && pixels > LEAST_PIXELS) pixels = Math.max(pixels / 2, LEAST_PIXELS);
    else if (frame_ms < FAST_MS && !is_slow && pixels < MOST_PIXELS) pixels = Math.min(pixels * 2, MOST_PIXELS);
    if (pixels !== before && String(frame_size()) !== String(size)) change({ is_sized: true });
    return is_slow || frame_ms > SLOW_MS;
}

async function loop(number) {
    let frame_ms = 0;
    let tried = 0;
    let is_slow = false;
    let before = performance.now();
    let measure_at = before + 500;
    while (running === number) {
        await new Promise(requestAnimationFrame);
        if (running !== number) return;
        try {
            while (jobs.length > 0) await jobs.shift()();
            if (changed) {
                const what = changed;
                changed = undefined;
                await apply(what);
                [tried, frame_ms] = [0, 0];
                measure_at = performance.now() + 500;
                before = performance.now();
            }
            const now = performance.now();
            clock_s += Math.min((now - before) / 1000, LONGEST_STEP_S);
            before = now;
            gaze.advance(is_still.matches ? 0 : clock_s);
            draw();
            await demo.finished();
            const fault = demo.fault();
            if (fault) throw new Error(fault);
            const took_ms = performance.now() - now;
            frame_ms += (took_ms - frame_ms) / Math.min(++tried, 10);
            $("time").textContent = `${frame_ms.toFixed(1)} ms`;
            if (tried % TRIED_FRAMES === 0) is_slow = follow_speed(frame_ms, is_slow);
            if (now > measure_at) {
                await measure();
                // A tenth of the time at most.
                const done = performance.now();
                measure_at = done + Math.max(1000, 10 * (done - now - took_ms));
                before += done - now;
            }
            window.frames_shown = (window.frames_shown ?? 0) + 1;
        } catch (error) {
            const fault = demo.fault() ?? error.message ?? String(error);
            trouble(/lost|destroyed/i.test(fault) ? "lost" : "fault", fault);
        }
    }
}

// Runs between two frames.
function later(job) {
    return new Promise((resolve, reject) => jobs.push(() => job().then(resolve, reject)));
}

async function start() {
    if (!isSecureContext) return trouble("insecure");
    if (!navigator.gpu) return trouble("no_webgpu");
    try {
        const begin = performance.now();
        read_address();
        await Promise.all([init(), gaze.load()]);
        size = frame_size();
        [canvas.width, canvas.height] = size;
        demo = await Demo.open(canvas, ...size);
        $("adapter").textContent = demo.adapter() || "WebGPU";
        if (scene() === "own") document.querySelector("input[name=scene]").checked = true;
        gaze.advance(0);
        await apply({ is_scene: true });
        window.first_frame_ms = performance.now() - begin;
        loop(++running);
    } catch (error) {
        trouble(/adapter/i.test(error.message ?? error) ? "no_adapter" : "no_start", demo?.fault() ?? error);
    }
}

// A picture of the visitor's; it stays on the device.
async function take_picture(file) {
    if (!file) return;
    try {
        own_picture = await createImageBitmap(file);
    } catch {
        const is_picture = file.type.startsWith("image/");
        notice(is_picture ? `This browser cannot read “${file.name}”. JPEG, PNG and WebP work.` : `“${file.name}” is not a picture.`);
        return;
    }
    notice("");
    for (const radio of document.querySelectorAll("input[name=scene]")) radio.checked = false;
    change({ is_scene: true });
    write_address();
}

async function compare() {
    $("compare").disabled = true;
    $("compared").textContent = "Comparing …";
    try {
        // A second library, with a device of its own: the frames on the screen keep their history.
        const library = await import("./compare.js");
        await library.default();
        const scale = Math.min(1, Math.sqrt(FIRST_PIXELS / (size[0] * size[1])));
        const compared_size = size.map((side) => Math.floor(side * scale));
        const twin = await library.Demo.open(document.createElement("canvas"), ...compared_size);
        await show_scene(twin, compared_size);
        configure(twin);
        const [values, different, ms] = await twin.compare(COMPARED_FRAMES);
        twin.free();
        $("compared").textContent = `${different} of ${values.toLocaleString("en")} values of ${COMPARED_FRAMES} frames differ (${ms.toFixed(0)} ms a frame on the CPU).`;
    } catch {
        $("compared").textContent = "The comparison could not be made: its library could not be loaded, or the graphics device refused it.";
    }
    $("compare").disabled = false;
}

document.addEventListener("change", ({ target }) => {
    if (target === $("own") || target === $("divider")) return;
    if (target.name === "scene" && target.value !== "own") notice("");
    show_choices();
    change({ is_scene: changed?.is_scene || target.name === "scene" });
    $("compared").textContent = "";
    write_address();
});
document.addEventListener("input", ({ target }) => {
    if (target.type === "range") show_choices();
});
$("divider").addEventListener("change", write_address);
canvas.addEventListener("keydown", ({ key }) => {
    if (key !== "[" && key !== "]") return;
    $("divider").value = number("divider") + (key === "[" ? -2 : 2);
    show_choices();
    write_address();
});
$("own").addEventListener("change", () => {
    take_picture($("own").files[0]);
    // So that the same file can be chosen again.
    $("own").value = "";
});
addEventListener("paste", (event) => {
    const [file] = event.clipboardData.files;
    if (file) take_picture(file);
    else notice("The clipboard holds no picture.");
});
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
    event.preventDefault();
    const [file] = event.dataTransfer.files;
    if (file) take_picture(file);
    else notice("Drop a picture’s file here.");
});
$("controls").addEventListener("submit", (event) => event.preventDefault());
$("compare").addEventListener("click", compare);
$("again").addEventListener("click", () => location.reload());
$("fullscreen").hidden = !document.fullscreenEnabled;
$("fullscreen").addEventListener("click", () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else stage.requestFullscreen();
});
let resizing;
new ResizeObserver(() => {
    clearTimeout(resizing);
    resizing = setTimeout(() => {
        if (running && String(frame_size()) !== String(size)) change({ is_sized: true });
    }, 150);
}).observe(stage);

// For the tests of the page, and for the recording of it.
window.page = { later, draw, picture, gaze, demo: () => demo, size: () => size, clock: () => clock_s, apply, set_clock: (s) => (clock_s = s) };

start();
