//! Evidence on a frame: its description, and the words of its tiles, which an executor computes.

use crate::context::ContextDesc;
use crate::convention::MotionUnit;
use crate::foveation::FoveationKind;
use crate::kernel::depth::DisparityMap;
use crate::kernel::doctor::{DEPTH, DEPTHS, HYPOTHESES, MOTION, TILE_PX, WORDS};
use crate::uniforms::{CameraUniforms, ViewState, ViewUniforms};
use crate::view::ViewFrame;

/// Largest number of tiles along an axis.
const MAX_TILES: u32 = 32;

/// A tile to examine: the pixel of its first corner, and the level of the lattice on which frames are compared there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tile {
    pub origin_px: [u32; 2],
    /// In texels of two pixels.
    pub lattice_level: u32,
    /// Whether frames can be compared here: their levels of detail are alike.
    pub is_comparable: bool,
}

/// What is known, of surfaces that stand still in the world, of their motion on the screen: by their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StillSurfaces {
    /// Rays of this frame's pixels.
    pub ray_scale: [f32; 2],
    pub ray_offset: [f32; 2],
    /// From stored depths.
    pub disparity: DisparityMap,
    pub camera: CameraUniforms,
    /// Jitter of the previous frame less that of this one.
    pub jitter_px: [f32; 2],
}

impl StillSurfaces {
    /// `None` if the camera's motion is not known. `state`: the view's state after this frame.
    pub fn new(desc: &ContextDesc, view: &ViewFrame, state: &ViewState) -> Option<Self> {
        let camera = CameraUniforms::new(desc, view, state);
        let ViewUniforms { ray_scale, ray_offset, .. } = ViewUniforms::new(desc, view, state, 0, 0);
        (camera.is_known != 0).then(|| Self {
            ray_scale,
            ray_offset,
            disparity: view.depth_convention(desc).disparity_map(),
            camera,
            jitter_px: [0, 1].map(|i| state.previous_jitter_px[i] - state.jitter_px[i]),
        })
    }
}

/// The caller's description of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Description {
    pub view: ViewFrame,
    /// Gaze that the foveation uses.
    pub gaze_px: [f32; 2],
    /// Whether the gaze is known in this frame.
    pub has_gaze: bool,
    pub has_depth: bool,
    pub has_vectors: bool,
    /// Whether there are vectors, and all contain the camera's motion.
    pub has_motion: bool,
    /// What the camera's motion must look like, if that and the depths are known.
    pub still: Option<StillSurfaces>,
    pub has_lod: bool,
    /// Whether the doctor also saw the previous frame, without a cut between the two.
    pub has_past: bool,
    pub tiles: Vec<Tile>,
}

/// A frame and its evidence.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Observation {
    pub now: Description,
    /// Jitter of the frame before, if it was seen.
    pub past_jitter_px: Option<[f32; 2]>,
    /// Words of the tiles, one after the other.
    pub words: Vec<u32>,
}

impl Observation {
    /// Tiles and their words.
    pub fn tiles(&self) -> impl Iterator<Item = (&Tile, Evidence<'_>)> {
        self.now.tiles.iter().zip(self.words.chunks_exact(WORDS as usize).map(Evidence))
    }
}

/// Words of a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evidence<'a>(pub &'a [u32]);

impl Evidence<'_> {
    pub fn word(&self, word: u32) -> u32 {
        self.0[word as usize]
    }

    /// Sum that the kernel stored as a fixed-point number.
    pub fn sum(&self, word: u32) -> f64 {
        f64::from(self.word(word)) / 1_048_576.0
    }

    fn float(&self, word: u32) -> f32 {
        f32::from_bits(self.word(word))
    }

    /// Stored depths: middle, left, right, above, below.
    pub fn depths(&self) -> [f32; DEPTHS as usize] {
        std::array::from_fn(|i| self.float(DEPTH + i as u32))
    }

    /// Stored motion vector in the middle.
    pub fn motion(&self) -> [f32; 2] {
        [self.float(MOTION), self.float(MOTION + 1)]
    }
}

impl Description {
    /// Description of view `view` of a frame for a gaze at `gaze_px`, with tiles that fit the foveation that `desc`
    /// states; frames by quads are at full rate here. `past_gaze_px`: gaze of the frame before, if that was seen.
    pub fn new(desc: &ContextDesc, view: ViewFrame, gaze_px: [f32; 2], past_gaze_px: Option<[f32; 2]>) -> Self {
        let has_gaze = view.gaze.known_px(&view.geometry).is_some();
        let foveation = desc.settings.foveation;
        let lod = |center, gaze| match foveation.kind {
            FoveationKind::Quads => 0.0,
            _ => foveation.lod(foveation.region_angle_deg(&view.geometry, center, gaze)),
        };
        let tiles = origins(desc.size_px).map(|origin_px| {
            let center = origin_px.map(|o| (o + TILE_PX / 2) as f32);
            let now = lod(center, gaze_px);
            let past = past_gaze_px.map_or(now, |gaze| lod(center, gaze));
            Tile {
                origin_px,
                lattice_level: (now.max(past).ceil() as u32).max(1) - 1,
                is_comparable: (now - past).abs() <= 1.0,
            }
        });
        Self {
            view,
            gaze_px,
            has_gaze,
            has_depth: false,
            has_vectors: false,
            has_motion: false,
            still: None,
            has_lod: false,
            has_past: past_gaze_px.is_some(),
            tiles: tiles.collect(),
        }
    }
}

/// First corners of the tiles of a frame: at multiples of their side, evenly spread, all of their pixels inside.
fn origins(size_px: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let whole = size_px.map(|s| s / TILE_PX);
    let count = whole.map(|n| n.min(MAX_TILES));
    let origin = move |i: usize, at: u32| at * whole[i] / count[i] * TILE_PX;
    (0..count[1]).flat_map(move |y| (0..count[0]).map(move |x| [origin(0, x), origin(1, y)]))
}

/// Number of tiles of a frame.
#[cfg(feature = "gpu")]
pub(crate) fn tile_count(size_px: [u32; 2]) -> u32 {
    origins(size_px).count() as u32
}

/// Change of motion vectors that a hypothesis makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hypothesis {
    /// Factors, with sign, on the vector in pixels.
    pub factors: [f32; 2],
    /// Whether x and y are swapped first.
    pub swapped: bool,
    /// Unit that the vectors have, if not the stated one.
    pub unit: Option<MotionUnit>,
}

/// The hypotheses on the motion vectors of a frame. The first hypothesis is that nothing moves. The second one is that
/// the stated convention is right.
pub(crate) fn hypotheses(desc: &ContextDesc) -> [Hypothesis; HYPOTHESES as usize] {
    let [w, h] = desc.size_px.map(|s| s as f32);
    let pixels_of = |unit| match unit {
        MotionUnit::Pixels => [1.0, 1.0],
        MotionUnit::Uv => [w, h],
        MotionUnit::Ndc => [0.5 * w, 0.5 * h],
    };
    let stated = pixels_of(desc.motion.unit);
    let others = [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc].into_iter().filter(|u| *u != desc.motion.unit);
    let mut scales = vec![([1.0, 1.0], None)];
    scales.extend(others.map(|unit| {
        let [x, y] = pixels_of(unit);
        ([x / stated[0], y / stated[1]], Some(unit))
    }));
    scales.extend([([0.5, 0.5], None), ([2.0, 2.0], None)]);
    let signs = [[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];
    let mut all = vec![Hypothesis { factors: [0.0; 2], swapped: false, unit: None }];
    let scaled = scales.iter().flat_map(|s| signs.map(|sign| (*s, sign, false)));
    let swapped = signs.map(|sign| (scales[0], sign, true));
    all.extend(scaled.chain(swapped).map(|((scale, unit), sign, swapped)| Hypothesis {
        factors: [scale[0] * sign[0], scale[1] * sign[1]],
        swapped,
        unit,
    }));
    all.try_into().expect("1 + 5 * 4 + 4 hypotheses")
}

/// Maps of the hypotheses from stored vectors to texels of two pixels, as the executors use them: factors of x and y,
/// and 1 if x and y are swapped.
pub(crate) fn maps(desc: &ContextDesc) -> [[f32; 4]; HYPOTHESES as usize] {
    let [x, y] = desc.motion.to_internal(desc.size_px);
    hypotheses(desc).map(|h| {
        let swapped = if h.swapped { 1.0 } else { 0.0 };
        [0.5 * x * h.factors[0], 0.5 * y * h.factors[1], swapped, 0.0]
    })
}
