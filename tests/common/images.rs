//! Images of frames, view by view, in the form of the CPU executor's inputs.

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{Foveation, FoveationKind, Pyramid, ViewFrame};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{FrameStats, Gaze, Image, ViewGeometry};
use afterimage_testing::Draws;

/// Images of one view of one frame.
#[derive(Clone)]
pub struct View {
    pub facts: ViewFrame,
    pub color: Image<[f32; 3]>,
    pub depth: Option<Image<f32>>,
    pub motion: Option<Image<[f32; 2]>>,
    pub trust: Option<Image<f32>>,
    pub reactive: Option<Image<f32>>,
    /// Level-of-detail input, if any.
    pub lod: Option<Image<f32>>,
    /// Standard errors and numbers of samples of noisy frames.
    pub noise: Option<Image<[f32; 2]>>,
    /// Of frames with albedo.
    pub albedo: Option<Image<[f32; 3]>>,
    /// Pixels that the renderer chose itself, of a planned frame.
    pub mask: Option<Image<f32>>,
    /// Colors of quads that are shaded in part, one a quad.
    pub half: Option<Image<[f32; 3]>>,
}

impl View {
    /// Without optional inputs, under 70 degrees.
    pub fn still(color: Image<[f32; 3]>, gaze_px: [f32; 2]) -> Self {
        let facts = ViewFrame::new(ViewGeometry::flat(color.size(), 70.0).unwrap(), Gaze::At { px: gaze_px });
        let (trust, reactive, albedo, mask, half) = (None, None, None, None, None);
        Self { facts, color, depth: None, motion: None, trust, reactive, lod: None, noise: None, albedo, mask, half }
    }

    /// With other images or facts.
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// What a foveating renderer delivers of a picture.
    pub fn delivered(foveation: &Foveation, full: &Image<[f32; 3]>, gaze_px: [f32; 2]) -> Self {
        let lods = foveation.lod_map(&ViewGeometry::flat(full.size(), 70.0).unwrap(), gaze_px);
        let color = foveation.render(&Pyramid::new(full.clone(), foveation.max_level()), &lods);
        Self::still(color, gaze_px)
    }

    /// With the colors of the pixels of a mask alone: of quads with one pixel in a color of half the size, of whole
    /// quads in that of the frame; NaN elsewhere.
    pub fn at_half(self, mask: &Image<bool>) -> Self {
        let size = self.color.size();
        let of_quad = |quad: [u32; 2]| {
            let of_quad = pixels([2; 2]).map(move |place| [0, 1].map(|i| 2 * quad[i] + place[i]));
            of_quad.filter(move |px| px[0] < size[0] && px[1] < size[1])
        };
        let is_whole = |quad: [u32; 2]| of_quad(quad).all(|px| pixel(mask, px));
        let half = Image::from_fn(size.map(|side| side.div_ceil(2)), |quad| {
            let mut shaded = of_quad(quad).filter(|px| pixel(mask, *px));
            let first = shaded.next().filter(|_| !is_whole(quad));
            assert!(first.is_none() || shaded.next().is_none(), "two pixels of quad {quad:?}");
            first.map_or([f32::NAN; 3], |px| pixel(&self.color, px))
        });
        let color = Image::from_fn(size, |px| match is_whole(px.map(|v| v / 2)) {
            true => pixel(&self.color, px),
            false => [f32::NAN; 3],
        });
        Self { color, half: Some(half), ..self }
    }

    /// In which everything moves by `speed_px` a frame.
    pub fn moving(self, speed_px: [f32; 2]) -> Self {
        self.with(|view| view.motion = Some(Image::filled(view.color.size(), speed_px.map(|v| -v))))
    }
}

/// Images of all views, input by input. All views have an input, or none.
pub struct Images<'a> {
    views: Vec<ViewFrame>,
    color: Vec<&'a Image<[f32; 3]>>,
    depth: Vec<&'a Image<f32>>,
    motion: Vec<&'a Image<[f32; 2]>>,
    trust: Vec<&'a Image<f32>>,
    reactive: Vec<&'a Image<f32>>,
    lod: Vec<&'a Image<f32>>,
    noise: Vec<&'a Image<[f32; 2]>>,
    albedo: Vec<&'a Image<[f32; 3]>>,
    mask: Vec<&'a Image<f32>>,
    half: Vec<&'a Image<[f32; 3]>>,
}

impl<'a> Images<'a> {
    pub fn of(views: impl IntoIterator<Item = &'a View>) -> Self {
        let views: Vec<&View> = views.into_iter().collect();
        Self {
            views: views.iter().map(|v| v.facts).collect(),
            color: views.iter().map(|v| &v.color).collect(),
            depth: views.iter().filter_map(|v| v.depth.as_ref()).collect(),
            motion: views.iter().filter_map(|v| v.motion.as_ref()).collect(),
            trust: views.iter().filter_map(|v| v.trust.as_ref()).collect(),
            reactive: views.iter().filter_map(|v| v.reactive.as_ref()).collect(),
            lod: views.iter().filter_map(|v| v.lod.as_ref()).collect(),
            noise: views.iter().filter_map(|v| v.noise.as_ref()).collect(),
            albedo: views.iter().filter_map(|v| v.albedo.as_ref()).collect(),
            mask: views.iter().filter_map(|v| v.mask.as_ref()).collect(),
            half: views.iter().filter_map(|v| v.half.as_ref()).collect(),
        }
    }

    pub fn frame(&self, index: u64) -> Frame<'_> {
        Frame {
            depth: given(&self.depth),
            motion: given(&self.motion),
            trust: given(&self.trust),
            reactive: given(&self.reactive),
            lod: given(&self.lod),
            noise: given(&self.noise),
            albedo: given(&self.albedo),
            mask: given(&self.mask),
            half: given(&self.half),
            ..Frame::new(&self.color, &self.views, index)
        }
    }
}

fn given<T>(images: &[T]) -> Option<&[T]> {
    (!images.is_empty()).then_some(images)
}

/// Plans a frame that is shaded by quads: the masks, or those that the frame has itself.
pub fn planned(post: &mut CpuAfterimage, frame: &Frame<'_>) -> Vec<Image<bool>> {
    match post.desc().settings.foveation.kind {
        FoveationKind::Quads if frame.mask.is_some() => {
            frame.mask.into_iter().flatten().map(|mask| mask.map(|chosen| chosen > 0.5)).collect()
        }
        FoveationKind::Quads => post.plan(frame).unwrap().to_vec(),
        _ => vec![],
    }
}

/// Outputs, decisions and counters of a frame.
pub type Traced = (Vec<Image<[f32; 3]>>, Vec<Image<PixelTrace>>, FrameStats);

/// The same with output alphas.
pub type TracedAlpha = (Vec<Image<[f32; 3]>>, Vec<Image<PixelTrace>>, FrameStats, Vec<Image<f32>>);

/// Processes a frame.
pub fn traced(post: &mut CpuAfterimage, frame: &Frame<'_>) -> Traced {
    let size = post.desc().size_px;
    let mut shown = vec![Image::filled(size, [f32::NAN; 3]); frame.views.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); frame.views.len()];
    let stats = post.process_traced(frame, &mut shown, &mut trace).unwrap();
    (shown, trace, stats)
}

/// Outputs, decisions, counters and output alphas of a planned frame of smr. `alpha`: of its colors, one image a view.
pub fn traced_alpha(post: &mut CpuAfterimage, frame: &Frame<'_>, alpha: &[Image<f32>]) -> TracedAlpha {
    let size = post.desc().size_px;
    let mut shown = vec![Image::filled(size, [f32::NAN; 3]); frame.views.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); frame.views.len()];
    let mut shown_alpha = vec![Image::filled(size, f32::NAN); frame.views.len()];
    let given: Vec<_> = alpha.iter().collect();
    let stats = post.process_alpha(frame, &given, &mut shown, &mut shown_alpha, Some(&mut trace)).unwrap();
    (shown, trace, stats, shown_alpha)
}

/// The value at a pixel.
pub fn pixel<T: Copy>(image: &Image<T>, [x, y]: [u32; 2]) -> T {
    image.at(x as usize, y as usize)
}

/// Pixels of a picture, row by row.
pub fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Colors times a factor.
pub fn times(color: &Image<[f32; 3]>, factor: f32) -> Image<[f32; 3]> {
    color.map(|c| c.map(|v| v * factor))
}

/// The largest channel.
pub fn peak(color: &Image<[f32; 3]>) -> f32 {
    color.pixels().iter().flatten().fold(0.0, |m, &v| m.max(v))
}

/// The largest relative difference.
pub fn off(shown: &Image<[f32; 3]>, expected: &Image<[f32; 3]>) -> f32 {
    let pairs = shown.pixels().iter().flatten().zip(expected.pixels().iter().flatten());
    pairs.fold(0.0, |w, (a, b)| w.max((a - b).abs() / b))
}

/// Colors that halves hold exactly, different at every pixel.
pub fn noise(size: [u32; 2], name: &str) -> Image<[f32; 3]> {
    let mut draws = Draws::new(name);
    Image::from_fn(size, |_| [0; 3].map(|_| (draws.bits() % 1024) as f32 / 1024.0))
}

/// Packed reservoirs, or packed surfaces and their noise (0 without noise).
pub fn held_words(cpu: &CpuAfterimage) -> Vec<[u32; 3]> {
    let history = cpu.history();
    let noise = history.noise().iter().copied().chain(std::iter::repeat(0));
    let surfaces = history.surfaces().iter().zip(noise).map(|(s, n)| [s[0], s[1], n]);
    history.words().iter().copied().chain(surfaces).collect()
}
