// What the page says when it cannot go on. The browser's own words are for a report, not for the reader.

const $ = (id) => document.getElementById(id);
const RECORDING = "Below is a recording of this page.";
const TROUBLES = {
    no_webgpu: ["This browser has no WebGPU.", `The page needs it. Current versions of Chrome, Edge and Safari have it, and Firefox on Windows and on Macs. ${RECORDING}`],
    insecure: ["This address is not secure.", `Browsers allow WebGPU only on pages that come by https. ${RECORDING}`],
    no_adapter: ["WebGPU finds no graphics device.", `The browser may have switched it off for this one: look for “hardware acceleration” in its settings. ${RECORDING}`],
    no_start: ["The page cannot start.", `Its parts could not be loaded, or the graphics device refused them. ${RECORDING}`],
    lost: ["The graphics device was lost.", "That happens when its driver restarts, or when the computer sleeps. Nothing of yours is lost."],
    fault: ["The frames have stopped.", "The graphics device refused one of them. Trying again may help."],
};

export function show_trouble(kind, raw = "") {
    [$("trouble_title").textContent, $("reason").textContent] = TROUBLES[kind];
    $("raw").hidden = !raw;
    $("raw").querySelector("p").textContent = raw;
    if (!$("trouble").open) $("trouble").showModal();
    $("clip").src = "clip.webm";
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) $("clip").play().catch(() => {});
}
