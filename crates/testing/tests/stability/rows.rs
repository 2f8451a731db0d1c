//! The contract: inputs, and what must hold for them. The numbering is that of the project's design document.

/// A hard case.
pub struct Row {
    pub id: &'static str,
    pub input: &'static str,
    pub must: &'static str,
    /// Sides that need a test, as `Side` prints them.
    pub sides: &'static [&'static str],
    /// Limit of the row: why it does not hold as stated, and the bound that does.
    pub limit: Option<&'static str>,
}

const CPU: &[&str] = &["CPU"];
const GPU: &[&str] = &["GPU"];
const BOTH: &[&str] = &["CPU", "GPU"];

const fn row(id: &'static str, input: &'static str, must: &'static str, sides: &'static [&'static str]) -> Row {
    Row { id, input, must, sides, limit: None }
}

impl Row {
    const fn but(self, limit: &'static str) -> Self {
        Self { limit: Some(limit), ..self }
    }
}

/// All rows, in order.
pub const ROWS: [Row; 109] = [
    // Reservoir arithmetic
    row("H01", "R1 empty, R2 w > 0, draw exactly 0", "R2 chosen", BOTH),
    row("H02", "R1 empty, R2 w = 0", "R2's color with w_sum 0; no NaN, not black", BOTH),
    row("H03", "w = 0 for 1e5 frames on valid history", "history and w_sum unchanged", BOTH),
    row("H04", "w_sum and w denormal (1e-40)", "selected with w/(w_sum+w), or taken as 0", BOTH),
    row("H05", "w_sum = 65504 in half storage, w = 1", "no Inf; saturates; documented selection floor", BOTH)
    .but("stored sums have 16 significant bits, up to 2^100; a sum of ones grows to 65536."),
    row("H06", "plain A-Chao, f16 w_sum, w = 1", "no stall at 2048, where halves stall", BOTH)
    .but("a stored sum of ones stalls at 65536."),
    row("H07", "biased recurrence, f16, w = 1", "stalls at 32.8; replacement probability >= stated floor", BOTH)
    .but("no cap: stored sums stall at 256 to 363 times the weight."),
    row("H08", "H07 in f32, 1e6 frames", "s = 1412.7 +- 0.5, as in f64", BOTH)
    .but("arithmetic alone; stored sums stall (H07)."),
    row("H09", "H07 with w = 0.05", "stalls at 2.83; s(w)/w equal for all w", CPU)
    .but("arithmetic alone; exact for powers of two, else to 3e-5."),
    row("H10", "1e9 frames", "incremental sum within 1e-3 of the closed form", CPU)
    .but("in f64; in f32 for 1.2e6 frames, and stored sums stall (H07)."),
    row("H11", "constant weights, no bias, N frames", "each selected with p = 1/N", BOTH),
    row("H12", "weights 1, 2, 3, 4", "selection frequency w_i / (sum of w)", BOTH),
    row("H13", "order permuted", "unbiased: same distribution; biased: documented recency", CPU),
    row("H14", "combine(A,combine(B,C)), combine(combine(A,B),C)", "same law, unbiased", CPU),
    row("H15", "count or age at its maximum", "saturates, never wraps to 0", BOTH),
    row("H16", "history cap 8, 32, infinite", "half-life of a step equals theory +- 5 %", CPU)
    .but("if the kernel's caller caps the sum; no setting does."),
    row("H17", "negative weight", "taken as 0, counted, warned of; w_sum never negative", BOTH)
    .but("callers cannot pass weights; invalid candidates are counted and warned of."),
    row("H18", "weight NaN or +-Inf", "taken as 0; previous reservoir survives", BOTH),
    row("H19", "stored w_sum NaN, Inf or negative", "that pixel alone as if reset, for one frame", BOTH),
    row("H20", "1 - abs(Delta E) with Delta E > 1", "clamped to 0; w_sum >= 0", BOTH),
    row("H21", "survival with w >> w_sum (1e7:1)", "no cancellation: error < 4 ulp", BOTH),
    row("H22", "integer reprojection", "only presented colors, bit for bit", BOTH)
    .but("colors that halves represent; others become the nearest half."),
    // Random numbers
    row("H23", "u32 to f32 by 2^-32", "never 1.0: `>> 8`, times 2^-24", BOTH),
    row("H24", "seed = pixel + frame", "forbidden: abs rho < 4 / sqrt N at every shift", CPU)
    .but("31x31 shifts of 128x128 pixels; over many more, chance exceeds it."),
    row("H25", "hash of (x, y, frame, purpose), 2^24 samples", "mean, variance, chi-squared, lag 1 inside CI", CPU),
    row("H26", "widths 1, 3, 4095, 4097; frame 2^32", "no period at row length; frame counter continues", BOTH),
    row("H27", "two eyes, same frame", "streams independent, or identical by option", CPU)
    .but("no such option: always independent."),
    row("H28", "CPU and GPU", "same integer stream for 1e6 (x,y,frame)", BOTH),
    row("H29", "same frame again", "same bits, any workgroup size", BOTH),
    // Color difference
    row("H30", "Delta H^2 of near-equal hues in f32", "no NaN", BOTH),
    row("H31", "two greys", "Delta E 94 = abs(Delta L) / kL; gradient finite", BOTH),
    row("H32", "Delta E 94 of (a,b) and (b,a)", "asymmetric: reference side documented", CPU),
    row("H33", "Y at 216/24389 +- 1 ulp", "continuous; slope 903.3 on both sides", BOTH),
    row("H34", "dark noise, linear sigma = 0.002", "Delta L* about 1.8 does not reject history", CPU),
    row("H35", "8-bit linear step near black", "Delta L* 3.54 must not look like change", CPU)
    .but("with an offset of 3.6."),
    row("H36", "negative linear RGB", "never NaN", BOTH),
    row("H37", "colors 1e4, 65504, 1e30", "finite Delta E", BOTH)
    .but("planned frames: of such samples at every seventh pixel, up to 11 % of the pixels are off by 10 % after 32 frames."),
    row("H38", "cube root on the GPU", "<= 4 ulp, exact at 0 and 1; no `pow`", BOTH),
    row("H39", "identical colors", "Delta E exactly 0, factor exactly 1", BOTH),
    row("H40", "vectors of Sharma et al. (2004), adapted to CIE94", "within 1e-4 of published values and f64", CPU),
    // Depth and disocclusion
    row("H41", "sky: d = 0 in reversed infinite depth", "never Inf; sky never rejects sky, always objects", BOTH),
    row("H42", "d slightly beyond 0 or 1", "clamped; finite", BOTH),
    row("H43", "half-float depth, 1 to 1e5 m", "no permanent rejection or acceptance", CPU)
    .but("farther than 65504 m is sky; with reversed halves and near = 0.1 m, depth noise rejects single frames beyond 16.4 km."),
    row("H44", "grazing plane, static camera", "never rejected up to 89.9 degrees", BOTH),
    row("H45", "camera 1 m toward a wall", "motion alone rejects no history", BOTH),
    row("H46", "1-px wire over far wall, jittered", "rejections bounded, no blinking", BOTH)
    .but("columns that jitter alternates show the candidate; with smr, others blink by less than 1e-3 of the wire's energy."),
    row("H47", "depth NaN in 1 px", "rejected there, neighbours unchanged", BOTH)
    .but("planned frames: a sample of unknown depth stands for no other pixel, so that colors up to 7 px away change for 5 frames."),
    row("H48", "near or far plane changes", "comparison unaffected, history valid", CPU)
    .but("planes are fixed per context: pass distances, or create a new context."),
    row("H49", "orthographic projection", "linear depth", CPU),
    row("H50", "two coplanar z-fighting surfaces", "ages bounded, no color outside inputs", BOTH)
    .but("smr: single pixels with a false level of detail can exceed the inputs, by a gain of up to 5."),
    // Motion and reprojection
    row("H51", "static camera, 1e3 frames", "reprojection is the identity, bit for bit", BOTH),
    row("H52", "shift by (3,-2) px", "history moves exactly; border is new", BOTH),
    row("H53", "0.5 px a frame, 200 frames", "no blur (nearest), or the stated MTF (bilinear)", BOTH)
    .but("smr misses the MTF by 0.023 of the wave, as gains cost detail."),
    row("H54", "motion NaN, Inf, +-1e9", "current sample only; no hang", BOTH),
    row("H55", "f16 motion at 0.5 uv", "drift within the quantum, 1.875 px at 3840", CPU),
    row("H56", "motion's sign, axis or scale flipped", "detected in 99 % of scenes", CPU),
    row("H57", "target 0.01 px outside the view", "rejected; last texel centre accepted", BOTH),
    row("H58", "fovea sample over a depth edge", "no bleed wider than 1 px", BOTH),
    row("H59", "zoom", "disocclusions show the current frame; ages kept", BOTH),
    row("H60", "turn of 180 degrees in 1 frame", "full reset at <= 1.1 of a frame's cost", BOTH),
    // Gaze and foveation
    row("H61", "small angles, where acos in f32 reads 0", "error < 1e-6 rad everywhere", BOTH),
    row("H62", "gaze off-centre, view of 110 degrees", "angles of rays, not screen distance", CPU),
    row("H63", "gaze off-screen, NaN or lost", "held, then centred; weights finite", BOTH),
    row("H64", "r_f = 0", "w = 1 at the gaze point alone; no 0/0", BOTH),
    row("H65", "e >= 90 degrees", "w >= 0.0013 (r_f = 2.5 degrees), above f16's least normal", BOTH),
    row("H66", "saccade of 20 degrees", "old fovea stays, decays as in theory", BOTH),
    row("H67", "microsaccades, +-0.5 degrees at 1 kHz", "effective fovea >= predicted union", CPU),
    row("H68", "latency of 0 to 150 ms", "JOD monotone", CPU)
    .but("by weighted PSNR and error in the true fovea, not JOD."),
    row("H69", "simulator: constant image, odd sizes", "constant at every LOD", BOTH),
    row("H70", "simulator: energy", "mean preserved within 1e-3", BOTH),
    row("H71", "simulator: ring boundary", "continuous; gradient jump bounded", BOTH),
    // Exposure, range, lifecycle
    row("H72", "exposure x256 in one frame", "declared: history scaled, no flash; undeclared: recovers within N frames", BOTH)
    .but("planned frames, undeclared: 16 frames for x256; for /256 up to 1.4 % of white stays for 64 frames and more."),
    row("H73", "firefly of 65504 in a dark scene", "clamped or expires in documented frames; energy accounted", BOTH),
    row("H74", "light on and off by frames", "no permanent bias", BOTH)
    .but("smr, 10-bit storage: a weak strobe leaves up to 1.5 / 1024 / (1 - accumulate) of the color, 1.5 % by default. \
        Planned frames, antialiased: up to 5 % of its light after 16 frames, 1.1 % after 64."),
    row("H75", "black and white frames by turns", "one of the two; mean over time unbiased", BOTH)
    .but("planned frames show both at a time, and the last color when the turns end: 0.8 % of the other after 16 frames."),
    row("H76", "resize, odd sizes, 0x0", "no panic; reset or resampled", BOTH),
    row("H77", "pause of 10 s; device lost", "a cut; no stale frame", BOTH),
    row("H78", "reset twice running, or at frame 0", "a fresh context, bit for bit", BOTH),
    row("H79", "fresh history full of NaN", "never visible", BOTH),
    // Path tracer and platform
    row("H80", "rays along axes and in planes of edges", "no hole in a closed sphere of 1e6 triangles", BOTH),
    row("H81", "degenerate, NaN, one or no triangles", "build and trace succeed", BOTH),
    row("H82", "origins at 1e6 m; geometry of 1e-3 m", "offset follows position; no acne or leak beyond bound", BOTH)
    .but("tested separately: at 1e6 m, adjacent floats are 0.06 m apart."),
    row("H83", "ends of all sampling ranges; furnace test", "no NaN; energy 1.000 +- CI; MIS weights sum to 1", BOTH)
    .but("sheen, brushed metal and rough glass are off by up to 0.5 %, 3.7 % and 5 % at single angles (docs/path-tracing.md)."),
    row("H84", "other drivers and APIs, fast-math", "difference <= published tolerance; self-test", GPU)
    .but("0 on software Vulkan; others must reach 60 dB (`afterimage info adapters --self-test`)."),
    // Quality
    row("H85", "analytic scenes; a box that turns into light", "smr: no 64x64 crop > 0.3 dB below foveated", CPU)
    .but("mip levels at 320x180; point-sampled blocks miss it by several dB (docs/method.md)."),
    // Masks of planned frames. Steps 2 and 4, if not stated otherwise: every position is sampled once in 16 frames, a
    // turn.
    row("H86", "gaze in step with offsets: positions never sampled", "there better than foveated; others exact after a turn", BOTH),
    row("H87", "masks of one pixel, of a corner, of all, of none", "samples bit for bit; without any, history", BOTH),
    row("H88", "reset within the order of offsets; order begun anew", "a fresh context, bit for bit; rebuilt after a turn", BOTH),
    row("H89", "borders between rates, moving gaze", "fovea and samples exact; no more error than in the periphery", BOTH),
    row("H90", "lines of 1 px in the periphery", "still: exact after a turn; gliding: no frame > 0.3 dB below foveated", BOTH),
    row("H91", "pixel of light 2 or 65504 in one frame", "gone when sampled again; at most 1.25 of its light", BOTH)
    .but("it is shown until then; a gain may exceed the samples by a quarter of their range."),
    row("H92", "20 and 200 px a frame", "no frame > 0.1 dB below foveated", BOTH)
    .but("with motion vectors; otherwise each frame is an unannounced cut (H93)."),
    row("H93", "cuts in each frame, announced or not; one after a turn", "announced: foveated frame; unannounced: close, no ghost", BOTH)
    .but("unannounced cuts without vectors and change of depth show a ghost: up to 3.7 dB below foveated if in each frame; after one, none."),
    row("H95", "NaN or infinity in a sample of a coarse mask", "never shown; complete history unchanged, else two steps at most", BOTH),
    row("H96", "masks that stand still; places three times each", "no worse than foveated; rebuilt after three turns", BOTH),
    row("H97", "samples beside the claimed place, or one frame late", "at most 3.1 dB below foveated (still), 1 dB (gliding)", BOTH),
    row("H98", "exposure steps, trust 0, two views, lost gaze, new foveations", "detail within 1 %; views independent; never below foveated", BOTH),
    row("H103", "recorded frames that never run, or out of order", "as if only what ran were recorded, with a reset", GPU),
    row("H104", "camera 1e6 m away; oblique near plane; mirrors", "right, or refused by name", CPU),
    row("H105", "vectors for no pixel, for objects, without camera", "within 1e-3 px; 0 for a still camera", BOTH),
    row("H106", "colors times 2^-10 to 2^12, without or with their exposure; shadow without vectors", "picture times it; at most 6 % of the light left behind", BOTH)
    .but("without an exposure smr alone, on whole frames without noise."),
    row("H107", "plan of quads under any needs", "budget never exceeded; every quad shaded in its period", CPU),
    row("H108", "other quads shaded than planned", "only planned, finite pixels count", CPU),
    row(
        "H109",
        "quads: edges of shadow, steps and fades of light",
        "under a quarter left after 16 frames (a quarter of the pixels), 48 (a tenth)",
        BOTH,
    ),
    row("H110", "quads: lamps and signs go on or off on a wall", "wall unchanged from the next frame on", BOTH),
    row("H111", "quads: still stripes of 1.05 and 2.1 px, jittered", "changes by at most 0.1 a frame of 0.8", BOTH),
    row("H112", "quads: a still, textured wall, jittered", "55.5 dB at a quarter of the pixels, 51.5 at a tenth", BOTH),
    row("H113", "quads: squares that slide over a wall, at its depth", "at most 0.4 px a row of them left, 8 frames", BOTH),
    row("H114", "quads: two lights whose shadows turn", "old light in at most 1 % of the pixels", BOTH),
];
