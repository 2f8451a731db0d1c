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
pub const ROWS: [Row; 104] = [
    // Reservoir arithmetic
    row(
        "H01",
        "R1 empty (w_sum=0), R2 w>0, draw = 0 exactly",
        "R2 chosen (Alg. 2 with `<=` chooses the empty one; ~0.49 px/frame at 4K with 24-bit draws)",
        BOTH,
    ),
    row("H02", "R1 empty, R2 w=0", "result is R2's color with w_sum 0; no NaN; not black; no 0/0", BOTH),
    row("H03", "w_new = 0 for 1e5 frames on valid history", "history unchanged, w_sum unchanged", BOTH),
    row(
        "H04",
        "w_sum and w both denormal (1e-40)",
        "selection frequency still w/(w_sum+w) +- CI or treated as 0 consistently on flush-to-zero hardware",
        BOTH,
    ),
    row("H05", "w_sum = 65504 in half storage, w = 1", "no Inf; saturates; documented selection floor", BOTH).but(
        "weight sums are not stored as halves, but with 16 significant bits up to 2^100: a plain sum of \
         ones grows to 65536, where the replacement probability is 1/65537 per frame.",
    ),
    row(
        "H06",
        "plain A-Chao, f16 w_sum, w=1",
        "sum stalls at 2048: storage must be f32 or capped below the stall",
        BOTH,
    )
    .but("stored with 16 significant bits, a plain sum of ones stalls at 65536 instead."),
    row(
        "H07",
        "biased recurrence, f16, constant w=1",
        "stalls at 32.8 after 574 frames; with cap, replacement probability >= stated floor",
        BOTH,
    )
    .but(
        "there is no cap. Stored sums stall between 256 and 363 times the weight, which keeps the stated \
         floor of 1/364.",
    ),
    row("H08", "same in f32, 1e6 frames", "s = 1412.7 +- 0.5 (sqrt(2n) = 1414.2); compare to f64", BOTH).but(
        "holds for the arithmetic. As stored between frames, the sum stalls between 256 and 363 times the weight \
         (H07).",
    ),
    row("H09", "biased, w=0.05, f16", "stall at 2.83 after 1401 frames; scale invariance: s(w)/w equal for all w", CPU)
        .but(
            "holds for the arithmetic: exactly for powers of two, to 3e-5 for other weights. The stored sum stalls \
         at 256 to 363 times the weight, depending on the mantissa.",
        ),
    row(
        "H10",
        "1e9 simulated frames via closed form",
        "no drift > 1e-3 relative between incremental and closed form",
        CPU,
    )
    .but(
        "holds in f64. In f32 the sum stays within 1e-3 for 1.2e6 frames and stalls at 4096 times the weight; \
         stored, it stalls earlier (H07).",
    ),
    row(
        "H11",
        "constant weights, no bias, N frames",
        "each frame selected with p=1/N: chi-squared at alpha=1e-4 on 1e7 trials",
        BOTH,
    ),
    row(
        "H12",
        "weights 1,2,3,4",
        "selection frequency w_i / (sum of w), exact CPU f64 enumeration vs GPU histogram",
        BOTH,
    ),
    row(
        "H13",
        "order permuted",
        "unbiased mode: same distribution; biased mode: recency order documented and tested",
        CPU,
    ),
    row("H14", "combine(A,combine(B,C)) vs combine(combine(A,B),C)", "same law in unbiased mode", CPU),
    row("H15", "m-count/age at u16 or u8 max", "saturates, never wraps to 0", BOTH),
    row("H16", "cap M: history cap = 8, 32, infinite", "step response half-life equals theory +- 5 %", CPU).but(
        "no setting caps the history. The kernel's step response agrees with theory if its caller caps the \
         sum.",
    ),
    row("H17", "weight negative (bad caller)", "treated as 0, counted, debug warning; never negative w_sum", BOTH).but(
        "callers cannot pass weights: they follow from the gaze, and an invalid candidate gets weight 0. \
         Invalid candidates are counted and reported as a warning; the kernel treats a negative weight as 0 \
         silently.",
    ),
    row("H18", "weight NaN / +-Inf", "treated as 0; sample dropped; previous reservoir survives", BOTH),
    row(
        "H19",
        "stored w_sum is NaN/Inf/negative (corrupt history)",
        "one-frame recovery: as if reset for that pixel only",
        BOTH,
    ),
    row(
        "H20",
        "(1-abs Delta E) with Delta E>1",
        "clamp to 0; w_sum >= 0 always (Delta E 94 up to 150 in sRGB, 276 for L*=276 HDR)",
        BOTH,
    ),
    row(
        "H21",
        "survive factor with w >> w_sum (1e7:1)",
        "1-w/(w_sum+w) must not cancel: compute w_sum/(w_sum+w) directly; relative error < 4 ulp",
        BOTH,
    ),
    row(
        "H22",
        "saved sample color vs weight pair",
        "color always one of the presented inputs bit-exactly when reprojection is integer (no invented colors)",
        BOTH,
    )
    .but(
        "samples are stored as halves: bit-exact for colors that halves represent, else the nearest \
         half.",
    ),
    // Random numbers
    row(
        "H23",
        "u32 -> f32 by x2^-32",
        "never 1.0 (top 128 values round to 1.0: 0.25 px/frame at 4K); use >>8 * 2^-24",
        BOTH,
    ),
    row(
        "H24",
        "seed = pixel + frame",
        "forbidden: frame t+1 shows frame t shifted; cross-correlation at every shift abs rho < 4/sqrt N",
        CPU,
    )
    .but("over 31 x 31 shifts of a 128 x 128 picture. Over many more shifts, chance alone exceeds 4 / sqrt N."),
    row(
        "H25",
        "(x,y,frame,purpose) hash, 2^24 samples",
        "mean, variance, chi-squared, lag-1 in x, y, t, diagonal all inside CI",
        CPU,
    ),
    row(
        "H26",
        "width 1, 3, 4095, 4097; index > 2^32 pixels * frames",
        "no period at row length; 64-bit-safe frame counter wrap at 2^32 frames continues without reset",
        BOTH,
    ),
    row(
        "H27",
        "two eyes, same frame",
        "streams independent, or *identical* when the option for binocular agreement is on",
        CPU,
    )
    .but("there is no option for binocular agreement: two views always use independent numbers."),
    row("H28", "CPU vs GPU", "bit-identical integer stream for 1e6 (x,y,f)", BOTH),
    row("H29", "same frame re-run", "bit-identical output (determinism), any workgroup size", BOTH),
    // Color difference
    row(
        "H30",
        "Delta H^2 for near-equal hues in f32",
        "max(0, x) before sqrt: negative in 49 % of same-hue pairs",
        BOTH,
    ),
    row("H31", "C*=0 both (greys)", "Delta E 94 = abs Delta L/kL; no division by C*; gradient finite", BOTH),
    row(
        "H32",
        "Delta E 94(a,b) vs (b,a)",
        "asymmetric up to 6.7x: reference side fixed and documented, or symmetrised with sqrt(C1 * C2)",
        CPU,
    ),
    row("H33", "Y at 216/24389 +- 1 ulp", "continuous; slope 903.3 on both sides", BOTH),
    row(
        "H34",
        "dark noise sigma=0.002 linear",
        "Delta L* about 1.8: the gate must not reject history; noise floor parameter tested",
        CPU,
    ),
    row("H35", "8-bit linear step 1/255 near black", "Delta L* 3.54: quantised sources must not look like change", CPU)
        .but(
            "the gate of the paper, without an offset, closes by 3.5 % at such a step, and by 0.5 % at a step \
         of 8-bit sRGB. With an offset of 3.6 it stays open.",
        ),
    row("H36", "negative linear RGB (wide gamut, filter lobes)", "signed cbrt or clamp; never NaN", BOTH),
    row("H37", "HDR 1e4 nits, 65504, 1e30", "finite Delta E; normalisation by adapted white or saturating map", BOTH),
    row(
        "H38",
        "cbrt via exp2(log2(x)/3) on GPU",
        "<= 4 ulp vs f64, exact at 0 and 1; `pow` of 0 or negative never called",
        BOTH,
    ),
    row("H39", "identical colors", "Delta E exactly 0 -> factor exactly 1", BOTH),
    row(
        "H40",
        "triangle/identity vectors from Sharma et al. (2004) set adapted to CIE94",
        "match published/CPU f64 within 1e-4",
        CPU,
    ),
    // Depth and disocclusion
    row(
        "H41",
        "reversed-Z infinite far, d=0 (sky)",
        "linearise gives \"far\" flag, not Inf; sky-sky never rejects history, sky-object always does",
        BOTH,
    ),
    row("H42", "d=1 (near), d slightly >1 or <0 from precision", "clamped; finite", BOTH),
    row(
        "H43",
        "half-float depth, z 1 to 1e5",
        "compared in stored encoding; step at 100 m is 6 cm, at 1 km 0.5 m; no permanent rejection or acceptance",
        CPU,
    )
    .but("Linear halves end at 65504 m: farther surfaces count as sky. With near = 0.1 m, one step of a reversed half exceeds the tolerance beyond 16.4 km, where depth noise rejects history for single frames."),
    row(
        "H44",
        "grazing plane",
        "slope-scaled threshold: a static camera never rejects history at any angle <= 89.9 degrees",
        BOTH,
    ),
    row("H45", "camera dolly 1 m toward wall", "expected-depth prediction used; pure motion does not reject history", BOTH),
    row("H46", "1-px wire over far wall, jittered", "energy of history rejections bounded, no alternate-frame blinking", BOTH)
    .but("If jitter moves the wire between two columns, each of the two shows another surface in every frame. They show the candidate, so they alternate as much as the input. All other columns are constant with wrs, and blink by less than 1e-3 of the wire's energy with smr."),
    row("H47", "depth NaN in 1 px", "history of that px rejected; neighbours unchanged", BOTH),
    row("H48", "near/far plane changes between frames", "linear compare unaffected", CPU)
    .but("Near and far planes are fixed per context: engines that change them pass distances, or create a new context. Stored depth does not depend on the planes, so history stays valid if they change."),
    row("H49", "orthographic projection", "linear depth path used", CPU),
    row("H50", "two coplanar z-fighting surfaces", "bounded age oscillation, no color outside inputs", BOTH)
    .but("smr relights history by a gain of 1/5 to 5. Frames that are low-passed according to their level of detail show no color outside the inputs; single pixels with a false coarse level of detail can exceed them up to the gain. Its bound is S5: between the candidate and the history at that gain."),
    // Motion and reprojection
    row("H51", "static camera, 1e3 frames, any scene", "reprojection is the identity bit-exactly (nearest)", BOTH),
    row("H52", "integer pixel shift (3,-2)", "history moves exactly; border ring flagged new", BOTH),
    row(
        "H53",
        "sub-pixel shift 0.5 px/frame x 200",
        "no cumulative blur (nearest) or blur bounded by stated MTF (bilinear); never bilinear-blend `w_sum` and color from different samples",
        BOTH,
    )
    .but("smr misses the MTF by 0.023 of the wave: where the phases of two low-passes differ, some of the difference is taken for a change of light, and a gain costs detail."),
    row("H54", "MV NaN/Inf/+-1e9", "treated as invalid -> current sample only; no hang", BOTH),
    row(
        "H55",
        "MV of f16 storage at 0.5 uv",
        "quantum is 1.875 px at 3840: drift bound reported; recommend pixels in f16 only below 1024 px (0.5 px)",
        CPU,
    ),
    row(
        "H56",
        "sign/axis/scale flipped",
        "detector reports the right convention on 99 % of random textured scenes",
        CPU,
    ),
    row("H57", "target 0.01 px outside the view", "rejected; target exactly on the last texel centre accepted", BOTH),
    row(
        "H58",
        "fovea sample reprojected over a depth edge",
        "nearest-depth MV dilation optional; no bleed wider than 1 px",
        BOTH,
    ),
    row("H59", "zoom (divergent field)", "disoccluded pixels filled by the current frame; duplicates allowed, ages kept", BOTH),
    row("H60", "full 180 degrees turn in 1 frame", "full reset, cost no higher than normal frame x1.1", BOTH),
    // Gaze and foveation
    row(
        "H61",
        "eccentricity by acos(dot) f32",
        "0.0057 degrees reads 0, 0.0172 degrees reads 0.0198 degrees: atan2 of cross and dot product, error < 1e-6 rad everywhere",
        BOTH,
    ),
    row(
        "H62",
        "gaze off-centre, wide FOV 110 degrees",
        "per-pixel angle from ray directions, not screen distance",
        CPU,
    ),
    row("H63", "gaze off-screen / NaN / both eyes lost", "hold, then widen or centre by policy; weights finite", BOTH),
    row("H64", "r_f = 0", "Watson normalised at 0: w=1 only at the gaze point; no 0/0", BOTH),
    row(
        "H65",
        "e = 90 degrees+",
        "w >= documented floor (w(90 degrees)=0.0013 for r_f=2.5 degrees); sum of weights never underflows f16 (min normal 6.1e-5)",
        BOTH,
    ),
    row(
        "H66",
        "gaze saccade 20 degrees between frames",
        "old fovea keeps its samples, with decay per theory",
        BOTH,
    ),
    row(
        "H67",
        "microsaccade stream +-0.5 degrees 1 kHz, frame 90 Hz",
        "effective fovea area grows >= predicted union area",
        CPU,
    ),
    row("H68", "latency injected 0-150 ms", "JOD curve monotone; report per latency", CPU)
    .but("JOD needs FovVideoVDP, which is not a dependency of this project. Instead, the eccentricity-weighted PSNR and the error in the true fovea are monotone over latency."),
    row(
        "H69",
        "mip simulator, constant image",
        "output constant at every LOD, incl. odd sizes (1x1, 17x1, 4097x3)",
        BOTH,
    ),
    row("H70", "mip simulator energy", "mean preserved <= 1e-3 over full frame", BOTH),
    row("H71", "ring boundary", "C0 blend; gradient jump below stated bound", BOTH),
    // Exposure, range, lifecycle
    row(
        "H72",
        "exposure x256 in one frame, ratio supplied",
        "no history rejection, no flash: history scaled; ratio absent -> gate reacts, recovers <= N frames",
        BOTH,
    ),
    row(
        "H73",
        "single firefly 65504 in dark scene",
        "clamped or expires within documented frames; mean energy change accounted",
        BOTH,
    ),
    row("H74", "strobing light 1 frame on/off", "no permanent bias", BOTH)
    .but("smr accumulates history of the same level of detail in 10-bit storage: the residue of a weak strobe stalls at up to 1.5 / 1024 / (1 - accumulate) of the color, 1.5 % by default. wrs and taa leave no residue."),
    row("H75", "alternating black/white frames", "output is one of the two, mean over time unbiased", BOTH),
    row("H76", "resize, odd to even, DPI change, 0x0 minimise", "no panic; reset or resample; bounds valid", BOTH),
    row("H77", "pause 10 s then resume; device lost", "treated as cut; no stale image for even one frame", BOTH),
    row("H78", "reset flag two frames running; reset at frame 0", "identical to fresh context, bit for bit", BOTH),
    row("H79", "freshly allocated history filled with NaN", "never visible", BOTH),
    // Path tracer and platform
    row(
        "H80",
        "ray along axis, direction component +-0, in-plane with box/triangle edge",
        "watertight: no holes in a closed 1e6-triangle sphere; no NaN slab",
        BOTH,
    ),
    row("H81", "degenerate/zero-area/NaN triangles, 1-triangle scene, empty scene", "build and trace succeed", BOTH),
    row(
        "H82",
        "origins at 1e6 m, geometry 1e-3 m; self-intersection",
        "offset scaled by position magnitude; no acne/leak beyond bound",
        BOTH,
    )
    .but("at 1e6 m, adjacent floats are 0.06 m apart, so geometry of 1e-3 m cannot exist there: the two are tested separately."),
    row(
        "H83",
        "sampling r=0, r->1, grazing cos theta=1e-7, roughness 0 and 1, pdf->0, albedo=1 (furnace test)",
        "no NaN; energy 1.000 +- CI; MIS weights sum to 1",
        BOTH,
    )
    .but("albedo tables of sheen, brushed metal and rough glass are off by up to 0.5 %, 3.7 % and 5 % at single angles (docs/path-tracing.md); all other lobes keep 1.000."),
    row(
        "H84",
        "same scene, Vulkan/Metal/DX12/GL, fast-math on/off",
        "difference <= published tolerance; start-up self-test prints NaN/denormal/twoSum behaviour",
        GPU,
    )
    .but("software Vulkan rounds as the CPU does, so the tolerance is 0 there; adapters that fuse or round otherwise must reach 60 dB against the CPU, which `afterimage info adapters --self-test` measures (an H100: docs/performance.md)."),
    // Quality
    row(
        "H85",
        "textured box that turns out of near-black shadow into light, and the other analytic scenes",
        "smr: no crop of 64x64 px more than 0.3 dB below the foveated frame after frame 2",
        CPU,
    )
    .but("holds for mip levels at rates 2/4 and 4/8 at 320x180. The box at 8/16 misses it by up to 0.5 dB, point-sampled blocks by several dB; docs/method.md has the crops and their causes."),
    // Sparse frames. Steps 2 and 4, if not stated otherwise: every position is sampled once in 16 frames, a turn.
    row(
        "H86",
        "a gaze that jumps in step with the order of offsets, so that positions are never sampled",
        "finite; better than the foveated frame at those positions and in all frames; all other positions exact after a turn",
        BOTH,
    ),
    row(
        "H87",
        "steps larger than the view, lattices of one pixel, off the view, without samples, empty; views of one pixel",
        "finite; samples are shown bit for bit; lattices off the view change nothing; without samples history is shown; empty ones are refused",
        BOTH,
    ),
    row(
        "H88",
        "reset in the middle of the order of offsets; order begun anew without a reset",
        "bit for bit a fresh context; rebuilt after a turn",
        BOTH,
    ),
    row(
        "H89",
        "borders between rates, gaze in motion",
        "fovea is the candidate bit for bit; what was sampled is exact across borders; gliding: less error at borders than in the periphery",
        BOTH,
    ),
    row(
        "H90",
        "lines of one pixel in the periphery",
        "still: exact after a turn; gliding: better than foveated, and no frame by more than 0.3 dB worse",
        BOTH,
    ),
    row(
        "H91",
        "a pixel of light 2 or 65504 in one frame, in which it is sampled, in a picture below 0.8",
        "gone when its pixel is sampled again; never more than 1.25 of its light",
        BOTH,
    )
    .but("until then it is shown at its pixel, since nothing says that it has gone; pixels nearer than a step show its interpolated light, less in each frame. A gain may exceed the samples by a quarter of their range."),
    row(
        "H92",
        "everything moves by 20 and by 200 px a frame",
        "finite; no frame more than 0.1 dB worse than the foveated frame",
        BOTH,
    )
    .but("with motion vectors. Without them each frame is an unannounced cut (H93)."),
    row(
        "H93",
        "cut in each frame, with and without a reset; one unannounced cut after a turn",
        "with a reset or a change of depth: the foveated frame; unannounced: close to it, no ghost",
        BOTH,
    )
    .but("cuts without reset, vectors and change of depth show a ghost: up to 3.5 dB below the foveated frame if in each frame, because samples of the first turn meet history that is too coarse to be compared with. After one such cut 2.3 dB in its frame and less than 0.4 dB after it; the picture is rebuilt slowly, as gains of relighting fade."),
    row(
        "H94",
        "depth and motion at samples only, across silhouettes that move",
        "finite; better than the foveated frame within 4 px of silhouettes and elsewhere",
        BOTH,
    ),
    row(
        "H95",
        "NaN or infinity in a sample of a coarse lattice, or in the only one of the view",
        "never shown; with complete history no pixel changes; otherwise pixels nearer than two steps, until it is sampled again",
        BOTH,
    ),
    row(
        "H96",
        "lattices that stand still; offsets shown three times each",
        "no worse than foveated, constant on a still picture; moving pictures better; rebuilt after three turns",
        BOTH,
    ),
    row(
        "H97",
        "samples one pixel beside the claimed place, by turns on both sides, mirrored in their block, one frame late",
        "finite; at most 3.1 dB below the same frames foveated (still), 1 dB (gliding)",
        BOTH,
    ),
    row(
        "H98",
        "declared exposure steps of 256 and 4, trust 0, two views, lost and invalid gaze, another foveation in each frame",
        "detail kept within 1 %; the candidate; as each view alone and as with any gaze, bit for bit; never worse than foveated",
        BOTH,
    ),
    row(
        "H103",
        "recorded frames, resizes and cuts that never run (dropped encoders), alone and in a row, or run out of order",
        "as if only what ran had been recorded, with a reset after what did not, bit for bit; zeroed history is empty",
        GPU,
    ),
    row(
        "H104",
        "camera 1e6 m from the origin; oblique near plane; mirrored view",
        "right, or refused with the right reason",
        CPU,
    ),
    row(
        "H105",
        "vectors for no pixel, for objects alone, or without the camera's motion; camera turns, moves, zooms; sky; jitter",
        "within 1e-3 px of the definition; exactly 0 for a still camera",
        BOTH,
    ),
    row(
        "H106",
        "colors times a constant, from 2^-10 to 2^12; a shadow that moves without vectors in a dark frame",
        "decisions as without it, the picture times it: powers of two bit for bit; at most 6 % of the light left behind",
        BOTH,
    )
    .but(
        "smr, on frames that are neither sparse nor noisy. wrs, sparse frames and noise compare colors by constants for white at about 1.",
    ),
    row(
        "H107",
        "plan of quads under any needs: none, flickering light, one corner, depth that is no number, no trust",
        "budget never exceeded; every quad shaded within the pattern's period; a settled still asks for the pattern alone",
        CPU,
    ),
    row(
        "H108",
        "the renderer shades fewer quads than planned, or more, or leaves its clear color between them",
        "planned and finite pixels count, all else is ignored, bit for bit",
        CPU,
    ),
];
