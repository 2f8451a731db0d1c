//! Reconstruction of sparse frames from history that keeps samples in their places (smr). Its mathematics is in
//! `src/kernel/{kept,sparse}.rs`.
//!
//! Three loops. The first compares each sample of a lattice of step 2 and more with history at its pixel. The second
//! estimates gain and fit for each of these samples, from its own comparison and from the comparisons of its eight
//! neighbours. The third interpolates gain, fit and samples for each pixel, reads the four stored samples around the
//! pixel's previous position, and blends.

mod antialias;
mod plan;

pub(super) use plan::plan;

use super::inputs::{Inputs, Previous};
use super::surface_pass::{Pixel, ProcessPixel, Targets, for_pixels};
use super::{Frame, Pass};
use crate::frame::ContextDesc;
use crate::image::Image;
use crate::kernel::antialias::{DOUBTFUL, Mean, is_of_surfaces, mean_of, scattered_error, stored_lod};
use crate::kernel::approx;
use crate::kernel::color::luma;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::depth::{INVALID_DISPARITY, same_surface};
use crate::kernel::kept::{
    Around, EXACT_PX, INVERSE_MEAN_REACH, INVERSE_REACH, Interpolated, Kept, add_kept, code_word, interpolate,
    is_empty, pack_color, pack_color_by, pack_kept, stands_in, unpack_color, unpack_full, unpack_kept,
};
use crate::kernel::lattice::point_weight;
use crate::kernel::matched::root_difference;
use crate::kernel::noise::{
    Noise, NoiseSum, add_noise, expected_noise, expose_noise, mean_noise, pack_noise, unpack_noise,
};
use crate::kernel::pack::{half_bits, half_value};
use crate::kernel::reproject::Verdict;
use crate::kernel::resample::{codes_between, has_code, tap_codes, tap_codes_between};
use crate::kernel::rng;
use crate::kernel::sanitize;
use crate::kernel::sparse::{
    Light, Lit, Observation, Reconstruction, accumulate, add_light, agreement, candidate_level, errors_left,
    expected_error, fit, lod_confidence, mean_error, mean_fit, neighbour_weight, noisy_lod_confidence, own_fit,
    own_light, pack_lit, reconstruct, relight, unpack_lit,
};
use crate::kernel::wrs::expose;
use crate::parallel::collect;
use crate::stats::FrameStats;
use crate::uniforms::{LatticeUniforms, ViewLattices};
use glam::{Vec2, Vec3};

/// Relative difference of disparity within which neighbouring samples share an estimate of light.
const LIGHT_RELATIVE: f32 = 0.1;
/// Relative difference of disparity within which a sample is interpolated for a pixel.
const SAMPLE_RELATIVE: f32 = 0.05;
/// Weight of a sample of another surface. It is so small that such a sample counts only where no sample near the pixel
/// shows the pixel's own surface.
const OTHER_SURFACE: f32 = 1e-3;
/// Factor on the weight of a sample's gain and fit if they come from its neighbours only, because the sample itself was
/// not compared with history.
const BY_NEIGHBOURS: f32 = 1e-3;
/// Least weight of one of the four samples around a pixel.
const LEAST_SHARE: f32 = 1e-4;

/// Noise of candidates without a noise input.
const NO_NOISE: Noise = Noise { samples: 1.0, variance: 0.0 };

/// Packed results for the samples of a lattice, row by row.
type Samples = Vec<[u32; 2]>;

/// Inputs, history and lattices of one view of a frame.
struct View<'a> {
    inputs: Inputs<'a>,
    words: &'a [[u32; 2]],
    /// Packed noise of the stored samples; empty unless candidates are noisy.
    noise: &'a [u32],
    lattices: ViewLattices,
    accumulate: f32,
    relights: bool,
    /// Whether frames are jittered and history stores means of samples.
    antialiases: bool,
    /// Low word of the frame counter.
    frame_low: u32,
    /// Samples of repaired pixels, and the mask of these pixels.
    repaired: Option<(&'a Image<[f32; 3]>, &'a Image<bool>)>,
}

/// The surface whose history a pixel continues.
#[derive(Clone, Copy)]
struct Surroundings {
    disparity: f32,
    motion: [f32; 2],
    /// Disparity to store with the pixel.
    stored: f32,
    /// Disparities of the farthest and the nearest surface around the pixel, if history may show any of them.
    mixed: Option<[f32; 2]>,
    /// Whether this frame's sample at the pixel may show another surface.
    is_doubtful: bool,
}

/// Where a pixel's history is.
struct Source {
    previous: Previous,
    /// Whether the nearest stored sample belongs to the surface.
    is_same: bool,
    /// Codes of the disparities that history may have.
    codes: [u32; 2],
}

/// History at a previous position.
struct Found {
    history: Interpolated,
    /// Noise of the sample to keep.
    noise: Noise,
    /// Number of samples in the texel to keep.
    samples: f32,
}

/// Runs the three loops for every view.
pub(super) fn run(pass: Pass<'_, '_>) -> FrameStats {
    let Pass { desc, history, frame, repaired, output, mut traces } = pass;
    let has_history = history.is_filled();
    let mut stats = FrameStats::default();
    for i in 0..frame.views.len() {
        let held = history.hold(i, &frame.views[i]);
        let inputs = Inputs::new(desc, frame, i, &held, has_history);
        let (past, next, next_noise) = history.split_surfaces(i);
        let mut view = View::new(desc, frame, i, inputs, past.words, past.noise);
        view.repaired = frame.repaired.map(|colors| colors[i]).zip(repaired.get(i));
        let observed = view.for_samples(|lattice, point| pack_observation(view.observe(lattice, point)));
        let lights = view.for_samples(|lattice, point| view.light(lattice, point, &observed));
        let traces = traces.as_mut().map(|t| &mut t[i]);
        let targets = Targets { surfaces: next, noise: next_noise, output: &mut output[i], traces };
        stats = stats.add(for_pixels(targets, &LitView { view: &view, lights: &lights }));
    }
    stats
}

/// A view, and the light at the samples of its lattices.
struct LitView<'a> {
    view: &'a View<'a>,
    lights: &'a [Samples],
}

impl ProcessPixel for LitView<'_> {
    #[inline(always)]
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats) -> Pixel {
        self.view.pixel(x, y, self.lights, stats)
    }
}

/// [`codes_between`] of the samples that are interpolated for a pixel with the disparity `disparity`.
#[inline(always)]
fn sample_codes(disparity: f32) -> [u32; 2] {
    codes_between(disparity, 1.0 - SAMPLE_RELATIVE, 1.0 / (1.0 - SAMPLE_RELATIVE))
}

/// Squared distance of two pixels along an axis.
#[inline(always)]
fn offset_px2(a: u32, b: u32) -> f32 {
    let offset = a as f32 - b as f32;
    offset * offset
}

/// Observation in two words: history's color, expected error and confidence as halves.
fn pack_observation(o: Option<Observation>) -> [u32; 2] {
    match o {
        Some(o) => [pack_color(o.history), half_bits(o.error) | half_bits(o.sure) << 16],
        None => [0, half_bits(-1.0)],
    }
}

impl<'a> View<'a> {
    /// View `index` of a frame with its inputs, and history's samples and their noise.
    fn new(
        desc: &ContextDesc,
        frame: &Frame<'_>,
        index: usize,
        inputs: Inputs<'a>,
        words: &'a [[u32; 2]],
        noise: &'a [u32],
    ) -> Self {
        let lattices = frame.views[index].lattices.as_ref().expect("the frame was checked to have lattices");
        Self {
            inputs,
            words,
            noise,
            lattices: LatticeUniforms::of_view(lattices, desc.size_px),
            accumulate: desc.settings.method.smr().accumulate,
            relights: crate::method::smr_sparse_relights(&desc.settings),
            antialiases: crate::method::smr_sparse_antialiases(&desc.settings),
            frame_low: frame.index as u32,
            repaired: None,
        }
    }
}

impl View<'_> {
    /// Results of `f` for each sample of each lattice of step 2 and more.
    fn for_samples(&self, f: impl Fn(usize, [u32; 2]) -> [u32; 2] + Sync) -> Vec<Samples> {
        let of = |(index, lattice): (usize, &LatticeUniforms)| {
            let [columns, rows] = if lattice.level == 0 { [0, 0] } else { lattice.points };
            collect(columns * rows, |i| f(index, [i % columns, i / columns]))
        };
        self.lattices.iter().enumerate().map(of).collect()
    }

    /// Color of a sample, and whether it is usable.
    #[inline(always)]
    fn sampled(&self, lattice: &LatticeUniforms, point: [u32; 2]) -> (Vec3, bool) {
        let [x, y] = lattice.texel_of(point);
        sanitize::color(Vec3::from(self.inputs.color.at(x as usize, y as usize)))
    }

    /// Sample of a repaired pixel, if it is usable.
    #[inline(always)]
    fn repaired(&self, x: u32, y: u32) -> Option<Vec3> {
        let [x, y] = [x as usize, y as usize];
        let (colors, _) = self.repaired.filter(|(_, mask)| mask.at(x, y))?;
        let (color, usable) = sanitize::color(Vec3::from(colors.at(x, y)));
        usable.then_some(color)
    }

    #[inline(always)]
    fn stored_words(&self, x: i32, y: i32) -> [u32; 2] {
        let [width, height] = self.inputs.size.map(|s| s as i32);
        self.words[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
    }

    /// Noise of a stored sample, in this frame's exposure.
    #[inline(always)]
    fn stored_noise(&self, [x, y]: [i32; 2]) -> Noise {
        if !self.is_noisy() {
            return NO_NOISE;
        }
        let [width, height] = self.inputs.size.map(|s| s as i32);
        let word = self.noise[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
        expose_noise(unpack_noise(word), self.inputs.exposure)
    }

    #[inline(always)]
    fn is_noisy(&self) -> bool {
        !self.noise.is_empty()
    }

    /// Noise of the sample at a pixel.
    #[inline(always)]
    fn sample_noise(&self, [x, y]: [u32; 2]) -> Noise {
        self.inputs.noise(x, y).filter(|_| self.is_noisy()).unwrap_or(NO_NOISE)
    }

    /// Whether two disparities of this frame can belong to one surface.
    #[inline(always)]
    fn alike(&self, a: f32, b: f32, relative: f32) -> bool {
        !self.inputs.tests_depth() || same_surface(a, b, relative, 0.0)
    }

    /// Previous position of a pixel's surface, or the verdict that rejects its history.
    #[inline(always)]
    fn source(&self, [x, y]: [u32; 2], surface: &Surroundings) -> Result<Source, Verdict> {
        let mut found = 0.0;
        let (previous, is_same) = self.inputs.reprojected(x, y, surface.motion, surface.disparity, |[qx, qy]| {
            let stored = unpack_kept(self.stored_words(qx as i32, qy as i32));
            found = stored.disparity;
            [stored.lod, stored.disparity]
        })?;
        let Some(mixed) = surface.mixed else {
            return Ok(Source { previous, is_same, codes: tap_codes(previous.expected) });
        };
        let [farthest, nearest] = mixed.map(|disparity| self.inputs.expected_disparity(x, y, disparity));
        let is_same = is_same || is_of_surfaces(found, farthest, nearest);
        Ok(Source { previous, is_same, codes: tap_codes_between(farthest, nearest) })
    }

    /// History at a previous position, in this frame's exposure. At a silhouette the nearest stored sample may belong
    /// to another surface (`is_same` is false). Samples beside it then replace it if they are near enough.
    #[inline(always)]
    fn interpolated(&self, Source { previous, is_same, codes }: &Source) -> Found {
        // The place of a mean may lie anywhere around its texel's centre, so that the eight texels around the nearest
        // one also count.
        let (columns, [x, y]) = match self.antialiases {
            true => (3, previous.at.map(|v| (v + 0.5).floor() as i32 - 1)),
            false => (2, previous.at.map(|v| v.floor() as i32)),
        };
        let inverse_reach = if self.antialiases { INVERSE_MEAN_REACH } else { INVERSE_REACH };
        let mut around = Around::NOTHING;
        let mut nearest_texel = [x, y];
        let mut samples = 1.0;
        for tap in 0..columns * columns {
            let (tx, ty) = (x + tap % columns, y + tap / columns);
            let words = self.stored_words(tx, ty);
            let same = !is_empty(words) && (!self.inputs.tests_depth() || has_code(code_word(words), *codes));
            let texel_px = Vec2::new(tx as f32 - previous.at[0], ty as f32 - previous.at[1]);
            let cost = around.cost;
            let mut stored = unpack_full(words);
            let mut mean = Mean { lod: stored.lod, samples: 1.0 };
            if self.antialiases {
                mean = mean_of(stored.lod);
                stored.lod = mean.lod;
            }
            around = add_kept(around, stored, texel_px, same, inverse_reach);
            if around.cost < cost {
                (nearest_texel, samples) = ([tx, ty], mean.samples);
            }
        }
        let found = interpolate(if *is_same || stands_in(around) { around } else { Around::NOTHING });
        let exposed = |c: Vec3| expose(c, self.inputs.exposure);
        let nearest = Kept { color: exposed(found.nearest.color), ..found.nearest };
        let history = Interpolated { color: exposed(found.color), range: found.range.map(exposed), nearest, ..found };
        Found { history, noise: self.stored_noise(nearest_texel), samples }
    }

    /// Comparison of a sample with history at its pixel; `None` if either is missing.
    #[inline(always)]
    fn observe(&self, lattice: usize, point: [u32; 2]) -> Option<Observation> {
        let lattice = &self.lattices[lattice];
        let (sampled, usable) = self.sampled(lattice, point);
        let px = lattice.px_of(point);
        let surface = self.surface(px, lattice.level);
        if surface.is_doubtful {
            return Some(Observation { sampled, history: Vec3::ZERO, error: DOUBTFUL, sure: 0.0 });
        }
        let mut source = self.source(px, &surface).ok().filter(|_| usable)?;
        if self.antialiases {
            // History is read at the sample's place in its pixel.
            let [x, y] = self.inputs.uniforms.jitter_px;
            source.previous.at = [source.previous.at[0] - x, source.previous.at[1] - y];
        }
        let Found { history, noise: past, .. } = self.interpolated(&source);
        if history.lod < 0.0 {
            return None;
        }
        let moved = self.antialiases || has_moved(surface.motion, history.nearest.place_px);
        let mut error = expected_error(history.lod, history.range, moved);
        let mut sure = lod_confidence(history.lod);
        if self.is_noisy() {
            let around = luma(history.color);
            error += expected_noise(past, self.sample_noise(px), around);
            sure = noisy_lod_confidence(history.lod, past, around);
        }
        Some(Observation { sampled, history: history.color, error, sure })
    }

    /// Unpacks an observation.
    #[inline(always)]
    fn observation(&self, lattice: usize, point: [u32; 2], observed: &[Samples]) -> Option<Observation> {
        let own = &self.lattices[lattice];
        let words = observed[lattice][(point[1] * own.points[0] + point[0]) as usize];
        let error = half_value(words[1]);
        (error >= 0.0).then(|| Observation {
            sampled: self.sampled(own, point).0,
            history: unpack_color(words[0]),
            error,
            sure: half_value(words[1] >> 16),
        })
    }

    /// Whether a sample may show a surface other than its pixel's.
    #[inline(always)]
    fn is_doubtful(&self, lattice: usize, [x, y]: [u32; 2], observed: &[Samples]) -> bool {
        let words = observed[lattice][(y * self.lattices[lattice].points[0] + x) as usize];
        self.antialiases && half_value(words[1]) == DOUBTFUL
    }

    /// Gain and fit around a sample, packed ([`pack_lit`]).
    #[inline(always)]
    fn light(&self, lattice: usize, point: [u32; 2], observed: &[Samples]) -> [u32; 2] {
        let own = self.observation(lattice, point, observed);
        let grid = &self.lattices[lattice];
        let disparity_of = |point: [u32; 2]| {
            let [x, y] = grid.px_of(point);
            self.inputs.disparity(x, y)
        };
        let disparity = disparity_of(point);
        let alone = Observation { sampled: self.sampled(grid, point).0, history: Vec3::ZERO, error: 0.0, sure: 0.0 };
        let measure = own_light(own.unwrap_or(alone));
        let neighbours = || {
            (0..9).filter_map(|tap| {
                let offset = [tap % 3 - 1, tap / 3 - 1];
                let at = [0, 1].map(|i| point[i].checked_add_signed(offset[i]).filter(|&v| v < grid.points[i]));
                let [Some(x), Some(y)] = at else { return None };
                let other = self.observation(lattice, [x, y], observed)?;
                let alike = self.alike(disparity, disparity_of([x, y]), LIGHT_RELATIVE);
                let spatial = neighbour_weight(offset);
                alike
                    .then(|| (other, own.map_or(spatial * other.sure, |_| agreement(measure, other, spatial)), spatial))
            })
        };
        let light = neighbours().fold(Light::default(), |l, (o, weight, spatial)| add_light(l, o, weight, spatial));
        // A single noisy sample does not show whether history fits.
        let judged = own.filter(|_| !self.is_noisy());
        let fit_of_own = |gain| judged.map_or(1.0, |own| own_fit(own, gain, measure.gate));
        // A sample without disparity is interpolated only where no other sample is near.
        let disparity = if self.is_doubtful(lattice, point, observed) { INVALID_DISPARITY } else { disparity };
        let unlit = Lit { gain: Vec3::ONE, fit: 1.0, own_fit: fit_of_own(Vec3::ONE), is_own: own.is_some(), disparity };
        if light.weight < 1e-6 {
            return pack_lit(unlit);
        }
        let errors =
            |gain| neighbours().fold(0.0, |sum, (o, weight, _)| sum + errors_left(o, gain, measure.gate) * weight);
        let without = errors(Vec3::ONE);
        let error = match self.antialiases {
            true => scattered_error(light, neighbours().fold(0.0, |sum, (o, weight, _)| add_scatter(sum, o, weight))),
            false => mean_error(light),
        };
        let gain = if self.relights { relight(light, error, measure.dark) } else { Vec3::ONE };
        let with_gain = if gain == Vec3::ONE { without } else { errors(gain) };
        let (gain, left) = if with_gain <= without { (gain, with_gain) } else { (Vec3::ONE, without) };
        let sure = (light.weight / light.spatial).min(1.0);
        let mut fit = fit(left / light.weight, sure);
        if self.is_noisy() {
            fit = fit.min(mean_fit(light, sure));
        }
        pack_lit(Lit { gain, fit, own_fit: fit_of_own(gain), ..unlit })
    }

    /// Processes one pixel and counts it in `stats`.
    #[inline(always)]
    fn pixel(&self, x: u32, y: u32, lights: &[Samples], stats: &mut FrameStats) -> Pixel {
        let inputs = &self.inputs;
        if !inputs.is_visible(x, y) {
            // Outside the visible area: black, without stored history.
            let (surface, noise) = (pack_kept(Kept::EMPTY), pack_noise(NO_NOISE));
            return Pixel { output: Vec3::ZERO, surface, noise, trace: PixelTrace::default() };
        }
        let disparity = inputs.disparity(x, y);
        let index = LatticeUniforms::index_at(&self.lattices, [x, y]);
        let level = self.lattices[index].level;
        let mut candidate = self.candidate(index, [x, y], disparity, lights);
        // Pixels of the full-rate lattice always have a sample of their own.
        let repaired = if level > 0 { self.repaired(x, y) } else { None };
        if let Some(color) = repaired {
            // The samples around the pixel still give gain and fit.
            let noise = self.sample_noise([x, y]);
            candidate = Candidate { color, usable: true, lod: 0.0, noise, is_own: true, ..candidate };
        }
        let is_full_rate = level == 0 || repaired.is_some();
        let surface = self.surface([x, y], level);
        let source = self.source([x, y], &surface);
        let is_final = candidate.usable && is_full_rate && !self.is_noisy() && !self.antialiases;
        let history = source.as_ref().ok().filter(|_| !is_final).map(|source| self.interpolated(source));
        let history = history.filter(|found| found.history.lod >= 0.0);
        let verdict = match &source {
            Err(verdict) => *verdict,
            Ok(Source { is_same: false, .. }) if history.is_none() => Verdict::Disoccluded,
            Ok(_) => Verdict::Valid,
        };
        inputs.count(x, y, candidate.usable, disparity, verdict, stats);

        let mut output = candidate.color;
        let mut kept = Kept {
            color: candidate.color,
            lod: if candidate.usable { candidate.lod } else { -1.0 },
            disparity: surface.stored,
            place_px: if self.antialiases && candidate.is_own { self.sample_place_px() } else { Vec2::ZERO },
        };
        let mut samples = 1.0;
        let (mut share, mut fits) = (0.0, 1.0);
        let mut noise = candidate.noise;
        if let (Ok(Source { previous, .. }), Some(found)) = (source, history) {
            let Found { history, noise: past, samples: found_samples } = found;
            if !candidate.usable {
                (output, share, noise, samples) = (history.color, 1.0, past, found_samples);
                kept = Kept { disparity: surface.stored, ..history.nearest };
            } else {
                let inputs = Reconstruction {
                    candidate: candidate.color,
                    lod: candidate.lod,
                    range: candidate.range,
                    history: history.color,
                    history_lod: history.lod,
                    nearest: history.nearest,
                    moved: has_moved([0.0; 2], history.nearest.place_px),
                    gain: candidate.gain,
                    fit: candidate.fit,
                    trust: previous.trust,
                    accumulate: self.accumulate,
                };
                let result = if self.is_noisy() {
                    let accumulated = accumulate(&inputs, past, candidate.noise);
                    noise = accumulated.noise;
                    accumulated.result
                } else if self.antialiases {
                    let averaged = self.antialiased([x, y], level, inputs, found_samples, candidate.is_own);
                    samples = averaged.samples;
                    averaged.result
                } else {
                    reconstruct(&inputs)
                };
                (output, share, fits) = (result.color, result.share, candidate.fit);
                kept = Kept { disparity: surface.stored, ..result.kept };
            }
        }
        // Means of colors may exceed the largest half.
        output = output.clamp(Vec3::splat(-sanitize::MAX_HALF), Vec3::splat(sanitize::MAX_HALF));
        stats.replaced += u64::from(verdict == Verdict::Valid && share == 0.0);
        let trace = PixelTrace {
            verdict,
            weight: approx::exp2(-candidate.lod),
            quality: approx::exp2(-kept.lod.max(0.0)),
            age: 0,
            survival: share,
            gate: fits,
            take: share == 0.0,
            motion: surface.motion,
        };
        let stored = if self.antialiases { self.packed_mean([x, y], kept, samples) } else { pack_kept(kept) };
        Pixel { output, surface: stored, noise: pack_noise(noise), trace }
    }

    /// Candidate of a pixel, and its gain and fit, from the samples around it.
    #[inline(always)]
    fn candidate(&self, index: usize, px: [u32; 2], disparity: f32, lights: &[Samples]) -> Candidate {
        let lattice = &self.lattices[index];
        let Some([x, y]) = lattice.around(px) else { return Candidate::NONE };
        let is_sample = x.fraction == 0.0 && y.fraction == 0.0;
        if lattice.level == 0 {
            let (color, usable) = self.sampled(lattice, [x.points[0], y.points[0]]);
            let noise = if usable { self.sample_noise(px) } else { NO_NOISE };
            let own = Candidate { color, usable, lod: 0.0, noise, is_own: usable, ..Candidate::NONE };
            let coarser = index + 1;
            if !self.is_noisy()
                || !usable
                || coarser == self.lattices.len()
                || self.lattices[coarser].points.contains(&0)
            {
                return own;
            }
            // The fit of history comes from the samples of the next lattice.
            return Candidate { fit: self.candidate(coarser, px, disparity, lights).fit, ..own };
        }
        let mut sums = Sums::default();
        let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::ZERO);
        let mut nearest_px2 = f32::MAX;
        let mut own = None;
        let mut noises = NoiseSum::default();
        let codes = sample_codes(disparity);
        let px2 = [(px[0], lattice.first_px[0], x.points), (px[1], lattice.first_px[1], y.points)]
            .map(|(px, first, points)| points.map(|point| offset_px2(px, first + (point << lattice.level))));
        // The pixel's own sample last, as in the shader.
        for tap in (0..4).rev() {
            let (right, below) = (tap & 1, tap >> 1);
            let point = [x.points[right as usize], y.points[below as usize]];
            let (color, usable) = self.sampled(lattice, point);
            if !usable {
                continue;
            }
            let at = lattice.px_of(point);
            let words = lights[index][(point[1] * lattice.points[0] + point[0]) as usize];
            let lit = unpack_lit(words);
            let alike = !self.inputs.tests_depth() || has_code(words[1], codes);
            let share = point_weight(x.fraction, right) * point_weight(y.fraction, below);
            let weight = share.max(LEAST_SHARE) * if alike { 1.0 } else { OTHER_SURFACE };
            sums.add(color, weight, lit);
            if self.is_noisy() {
                noises = add_noise(noises, self.sample_noise(at), weight);
            }
            (low, high) = (low.min(color), high.max(color));
            if alike {
                nearest_px2 = nearest_px2.min(px2[0][right as usize] + px2[1][below as usize]);
            }
            if is_sample && tap == 0 && (alike || !self.antialiases || disparity < 0.0) {
                own = Some((color, lit.own_fit));
            }
        }
        if sums.weight == 0.0 {
            return Candidate::NONE;
        }
        let coarsest = lattice.level as f32;
        let is_own = own.is_some();
        let (color, own_fit) = own.unwrap_or((sums.color * (1.0 / sums.weight), 1.0));
        let noise = if !self.is_noisy() {
            NO_NOISE
        } else if is_own {
            self.sample_noise(px)
        } else {
            mean_noise(noises)
        };
        Candidate {
            color,
            usable: true,
            lod: if nearest_px2 == f32::MAX { coarsest + 1.0 } else { candidate_level(nearest_px2.sqrt(), coarsest) },
            range: [low, high],
            gain: sums.gain * (1.0 / sums.valid),
            fit: (sums.fit * (1.0 / sums.valid)).min(own_fit),
            noise,
            is_own,
        }
    }
}

/// Weighted sum of squared differences between samples and history, with one more sample added.
#[inline(always)]
fn add_scatter(sum: f32, o: Observation, weight: f32) -> f32 {
    let difference = root_difference(o.sampled, o.history).min(1e6);
    sum + (difference * difference) * weight
}

/// Whether history has moved since its samples were shaded, by more than the resolution of their stored places.
#[inline(always)]
fn has_moved(motion: [f32; 2], place_px: Vec2) -> bool {
    let farthest = |x: f32, y: f32| x.abs().max(y.abs()) > EXACT_PX;
    farthest(motion[0], motion[1]) || farthest(place_px.x, place_px.y)
}

/// Candidate of a pixel.
struct Candidate {
    color: Vec3,
    usable: bool,
    lod: f32,
    /// Smallest and largest color of the samples around the pixel.
    range: [Vec3; 2],
    gain: Vec3,
    fit: f32,
    noise: Noise,
    /// Whether the candidate is this pixel's own sample.
    is_own: bool,
}

impl Candidate {
    const NONE: Self = Self {
        color: Vec3::ZERO,
        usable: false,
        lod: 0.0,
        range: [Vec3::ZERO; 2],
        gain: Vec3::ONE,
        fit: 1.0,
        noise: NO_NOISE,
        is_own: false,
    };
}

/// Sums over the samples around a pixel.
#[derive(Default)]
struct Sums {
    color: Vec3,
    weight: f32,
    gain: Vec3,
    fit: f32,
    valid: f32,
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, color: Vec3, weight: f32, lit: Lit) {
        let known = weight * if lit.is_own { 1.0 } else { BY_NEIGHBOURS };
        self.color += color * weight;
        self.weight += weight;
        self.gain += lit.gain * known;
        self.fit += lit.fit * known;
        self.valid += known;
    }
}
