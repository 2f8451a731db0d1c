//! Lattices: where the samples of a sparse foveated frame lie.

use crate::error::{FrameError, FrameValue, SettingsError};
use crate::foveation::Foveation;
use crate::geometry::ViewGeometry;
use crate::kernel::lattice::{jitter_px, offset_px};
use std::f32::consts::SQRT_2;

/// Largest position and number of samples along an axis: twice the largest side of a view.
const FARTHEST_PX: u32 = 32768;

/// Regular grid of samples, `first_px + step * (i, j)`, each of which is one pixel of the full-rate frame.
///
/// It covers the blocks of `step` x `step` pixels, aligned to the frame's corner, in which its samples lie. A renderer
/// draws it as a small view of its own: `points` pixels of resolution, for the covered rectangle, with the projection
/// shifted by `first_px % step` (`docs/integration.md`). The shift changes from frame to frame, so that every pixel is
/// sampled sooner or later: [`Foveation::lattices`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Lattice {
    /// Distance of neighbouring samples in pixels: a power of two, at most [`Foveation::MAX_RATE`]. 1: full rate.
    pub step: u32,
    /// Pixel of the top-left sample.
    pub first_px: [u32; 2],
    /// Number of samples along x and y, at least 1. Samples beyond the frame are ignored.
    pub points: [u32; 2],
    /// Texel of the top-left sample in an atlas, in which neighbouring samples are neighbouring texels. `None`: samples
    /// lie at their own pixels of images of the frame's size; the pixels between them are not read.
    pub atlas_texel: Option<[u32; 2]>,
}

impl Lattice {
    /// Lattice of the blocks that contain pixels of the rectangle from `low_px` (inclusive) to `high_px` (exclusive).
    /// `offset_px`: position of the samples in their blocks, below `step`.
    pub fn covering(step: u32, low_px: [u32; 2], high_px: [u32; 2], offset_px: [u32; 2]) -> Self {
        let first_block = low_px.map(|v| v / step);
        let points = [0, 1].map(|i| high_px[i].div_ceil(step).saturating_sub(first_block[i]).max(1));
        let first_px = [0, 1].map(|i| first_block[i] * step + offset_px[i]);
        Self { step, first_px, points, atlas_texel: None }
    }

    /// Position of the samples in their blocks, in pixels.
    pub fn offset_px(&self) -> [u32; 2] {
        self.first_px.map(|v| v % self.step)
    }

    /// First pixel, and pixel after the last, of the covered rectangle. It may extend beyond the frame.
    pub fn covered_px(&self) -> [[u32; 2]; 2] {
        let low = self.first_px.map(|v| v - v % self.step);
        [low, [0, 1].map(|i| low[i] + self.points[i] * self.step)]
    }

    /// Whether the pixel lies in the covered rectangle.
    pub fn covers(&self, px: [u32; 2]) -> bool {
        let [low, high] = self.covered_px();
        (0..2).all(|i| (low[i]..high[i]).contains(&px[i]))
    }

    /// Whether a sample lies at the pixel.
    pub fn samples(&self, px: [u32; 2]) -> bool {
        self.covers(px) && px.map(|v| v % self.step) == self.offset_px()
    }
}

/// Stack of lattices of a view, finest first: a pixel is shaded by the first one that covers it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Lattices {
    stack: [Lattice; Self::MAX],
    count: usize,
    has_geometry_at_samples: bool,
}

impl Lattices {
    /// Largest number of lattices in a stack.
    pub const MAX: usize = 4;

    /// A stack, finest first.
    ///
    /// # Errors
    /// [`SettingsError`] unless there are 1 to [`MAX`](Self::MAX) lattices of different steps in ascending order, each
    /// a power of two of at most [`Foveation::MAX_RATE`], with at least one sample, and either all or none in an atlas.
    pub fn new(lattices: &[Lattice]) -> Result<Self, SettingsError> {
        let refuse = |setting, found: String, expected: String| Err(SettingsError { setting, found, expected });
        if lattices.is_empty() || lattices.len() > Self::MAX {
            return refuse("lattices", lattices.len().to_string(), format!("1 to {}", Self::MAX));
        }
        let mut last_step = 0;
        for lattice in lattices {
            if !lattice.step.is_power_of_two() || lattice.step > Foveation::MAX_RATE || lattice.step <= last_step {
                let expected = format!("powers of two, at most {}, ascending", Foveation::MAX_RATE);
                return refuse("lattice step", lattice.step.to_string(), expected);
            }
            last_step = lattice.step;
            if lattice.points.iter().any(|n| !(1..=FARTHEST_PX).contains(n)) {
                let [x, y] = lattice.points;
                return refuse("lattice points", format!("{x} x {y}"), format!("1 to {FARTHEST_PX} along each axis"));
            }
            if lattice.first_px.iter().any(|&v| v > FARTHEST_PX) {
                let [x, y] = lattice.first_px;
                return refuse("lattice first_px", format!("({x}, {y})"), format!("at most {FARTHEST_PX}"));
            }
            if lattice.atlas_texel.is_some() != lattices[0].atlas_texel.is_some() {
                return refuse("lattice atlas_texel", "given for some lattices".into(), "all or none".into());
            }
        }
        let mut stack = [Lattice::default(); Self::MAX];
        stack[..lattices.len()].copy_from_slice(lattices);
        Ok(Self { stack, count: lattices.len(), has_geometry_at_samples: false })
    }

    /// The lattices, finest first.
    pub fn as_slice(&self) -> &[Lattice] {
        &self.stack[..self.count]
    }

    /// This stack in an atlas: the lattices below each other, from texel (0, 0) on. Returns the atlas's size, too.
    pub fn in_atlas(self) -> (Self, [u32; 2]) {
        let mut stack = self;
        let mut size = [0, 0];
        for lattice in &mut stack.stack[..self.count] {
            lattice.atlas_texel = Some([0, size[1]]);
            size = [size[0].max(lattice.points[0]), size[1] + lattice.points[1]];
        }
        (stack, size)
    }

    /// This stack for frames whose depth and motion vectors are also given at the samples only, as by a renderer that
    /// draws each lattice as a small view. They lie at the same texels as the colors, in images with the layout of the
    /// color input. The pixels between samples are interpolated, which takes 12 bytes a pixel of memory. Trust masks
    /// stay at full size.
    pub fn with_geometry_at_samples(self) -> Self {
        Self { has_geometry_at_samples: true, ..self }
    }

    /// Whether depth and motion vectors are given at the samples only.
    pub fn has_geometry_at_samples(&self) -> bool {
        self.has_geometry_at_samples
    }

    /// First lattice that covers a pixel.
    pub fn at(&self, px: [u32; 2]) -> Option<&Lattice> {
        self.as_slice().iter().find(|lattice| lattice.covers(px))
    }

    /// Whether the samples lie in an atlas.
    pub(crate) fn is_atlas(&self) -> bool {
        self.stack[0].atlas_texel.is_some()
    }

    /// Checks that the lattices of an atlas lie in `input`, a texture of `size` in which the view begins at `origin`.
    pub(crate) fn check_atlas(
        &self,
        input: &'static str,
        view: usize,
        origin: [u32; 2],
        size: [u32; 2],
    ) -> Result<(), FrameError> {
        for lattice in self.as_slice() {
            let Some(texel) = lattice.atlas_texel else { continue };
            let at = [0, 1].map(|i| u64::from(origin[i]) + u64::from(texel[i]));
            if (0..2).any(|i| at[i] + u64::from(lattice.points[i]) > u64::from(size[i])) {
                let ([w, h], [x, y]) = (lattice.points, at);
                return Err(FrameError::Value {
                    value: FrameValue::Lattices,
                    view,
                    found: format!(
                        "{w}x{h} samples from texel ({x}, {y}) on in a {input} input of {}x{}",
                        size[0], size[1]
                    ),
                    expected: "an atlas inside the input",
                });
            }
        }
        Ok(())
    }

    /// Checks that the coarsest lattice covers a view of `size_px`.
    pub(crate) fn check(&self, view: usize, size_px: [u32; 2]) -> Result<(), FrameError> {
        let coarsest = self.as_slice().last().map(Lattice::covered_px);
        match coarsest {
            Some([low, high]) if low == [0, 0] && high[0] >= size_px[0] && high[1] >= size_px[1] => Ok(()),
            _ => Err(FrameError::Value {
                value: FrameValue::Lattices,
                view,
                found: "a stack whose last lattice leaves pixels uncovered".into(),
                expected: "a last, coarsest lattice that covers the whole view",
            }),
        }
    }
}

impl Foveation {
    /// Jitter of the projection in a frame for [`Smr::antialias`](crate::Smr::antialias), in pixels, each in \[-0.5,
    /// 0.5). It moves the samples within their pixels from frame to frame, so that a mean over time is a mean over the
    /// pixel's area. This also holds where a lattice samples a pixel only every 4 or 256 frames. A point at `p` without
    /// jitter is drawn at `p + jitter_px`. `index`: the frame counter of [`lattices`](Self::lattices).
    ///
    /// ```
    /// use afterimage::Foveation;
    ///
    /// assert_eq!(Foveation::jitter_px(0), [-0.5, -0.5]);
    /// assert!(Foveation::jitter_px(7).iter().all(|v| v.abs() <= 0.5));
    /// ```
    pub fn jitter_px(index: u64) -> [f32; 2] {
        jitter_px(index)
    }

    /// Lattices of a sparse frame with this foveation: rectangles around the regions. The sample positions visit every
    /// pixel of a block once in `step * step` frames, and are evenly spread after any number of frames. `index`: frame
    /// counter.
    ///
    /// Regions outside the view, and regions of 0 degrees, are left out. A region is also left out of frames in which
    /// all of its samples would lie beyond the view's edge; this happens if the region covers only the last blocks at
    /// the edge. A step larger than the view has its sample inside the view.
    pub fn lattices(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], index: u64) -> Lattices {
        let size = geometry.size_px();
        let covering = |step, low, high| {
            let offset = offset_px(index, step);
            Lattice::covering(step, low, high, [0, 1].map(|i| offset[i] % size[i]))
        };
        let mut stack = vec![];
        for (step, radius_deg) in self.regions() {
            let [low, high] = self.region_px(geometry, gaze_px, radius_deg);
            if low[0] < high[0] && low[1] < high[1] && stack.iter().all(|l: &Lattice| l.step < step) {
                let lattice: Lattice = covering(step, low, high);
                stack.extend((0..2).all(|i| lattice.first_px[i] < size[i]).then_some(lattice));
            }
        }
        stack.push(covering(self.rate_far, [0, 0], size));
        Lattices::new(&stack).expect("steps ascend, and each lattice has a sample")
    }

    /// Size in texels that holds the atlas ([`Lattices::in_atlas`]) of every frame of a view: the largest over all
    /// frames and over all gaze positions, inside and outside the view. It exceeds the size for a gaze in the middle,
    /// because flat views magnify the regions at their edges. Renderers allocate color, depth and motion of this size
    /// once. The call takes about ten milliseconds.
    ///
    /// ```
    /// use afterimage::{Filter, Foveation, ViewGeometry};
    ///
    /// let eye = ViewGeometry::from_angles([1600, 1600], [-0.785, 0.785, 0.785, -0.785])?;
    /// let foveation = Foveation {
    ///     filter: Filter::Sparse,
    ///     fovea_deg: 10.0,
    ///     mid_deg: 30.0,
    ///     rate_mid: 2,
    ///     rate_far: 4,
    ///     ..Foveation::default()
    /// };
    /// let [width, height] = foveation.max_atlas_px(&eye);
    /// let (_, [w, h]) = foveation.lattices(&eye, [1599.0, 0.0], 7).in_atlas();
    /// assert!(w <= width && h <= height && width * height < 1600 * 1600 / 3);
    /// # Ok::<(), afterimage::SettingsError>(())
    /// ```
    pub fn max_atlas_px(&self, geometry: &ViewGeometry) -> [u32; 2] {
        /// Distance of neighbouring gaze positions on the grid that is searched.
        const GRID_DEG: f32 = 0.5;
        // A gaze lies at most half a diagonal of the grid from the nearest gaze position that is tried.
        const SLACK_DEG: f32 = 0.5 * GRID_DEG * SQRT_2;
        let size = geometry.size_px();
        let whole = size.map(|n| n.div_ceil(self.rate_far));
        let (scale, offset) = geometry.scale_offset();
        let reach = (89.0 / GRID_DEG) as i32;
        let px = |axis: usize, i: i32| ((i as f32 * GRID_DEG).to_radians().tan() - offset[axis]) / scale[axis];
        let mut largest = whole;
        for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
            let gaze_px = [px(0, i), px(1, j)];
            let mut atlas = whole;
            let mut last_step = 0;
            for (step, radius_deg) in self.regions() {
                let [low, high] = self.region_px(geometry, gaze_px, radius_deg + SLACK_DEG);
                if low[0] < high[0] && low[1] < high[1] && step > last_step {
                    // A rectangle of n pixels lies in at most ceil(n / step) + 1 blocks of the frame.
                    let points = [0, 1].map(|i| ((high[i] - low[i]).div_ceil(step) + 1).min(size[i].div_ceil(step)));
                    atlas = [atlas[0].max(points[0]), atlas[1] + points[1]];
                    last_step = step;
                }
            }
            largest = [0, 1].map(|i| largest[i].max(atlas[i]));
        }
        largest
    }

    /// Steps and radii in degrees of the regions that may have lattices of their own, finest first.
    fn regions(&self) -> impl Iterator<Item = (u32, f32)> {
        let far = self.rate_far;
        [(1, self.fovea_radius_deg()), (self.rate_mid, self.mid_radius_deg())]
            .into_iter()
            .filter(move |&(step, radius_deg)| radius_deg > 0.0 && step < far)
    }
}
