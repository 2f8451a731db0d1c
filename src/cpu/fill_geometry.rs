//! Fills depth and motion of every pixel of a sparse frame that has them at its samples only. Twin:
//! `shaders/pass/fill_geometry_pass.wgsl`.
//!
//! A pixel belongs to the surface of one of the four samples around it: the nearest sample whose motion leads to
//! history with that sample's disparity. Without such a sample, the pixel belongs to the surface of the nearest sample.
//! Disparity, which is linear over planes, and motion are interpolated between the samples of that surface.

use super::Frame;
use super::history::History;
use super::inputs::Inputs;
use crate::context::ContextDesc;
use crate::convention::{DepthConvention, MotionConvention};
use crate::image::Image;
use crate::kernel::depth::{INVALID_DISPARITY, distance_of, same_surface};
use crate::kernel::lattice::{GeometryMean, add_geometry, filled_geometry, point_weight};
use crate::kernel::resample::TAP_RELATIVE;
use crate::kernel::stored_sample::unpack_stored;
use crate::notes::NoNotes;
use crate::uniforms::{LatticeUniforms, ViewLattices};
use crate::view::ViewFrame;
use glam::{Vec2, Vec3};

/// Filled distances and motion vectors of a view, in internal conventions.
pub(super) struct Geometry {
    pub depth: Image<f32>,
    pub motion: Image<[f32; 2]>,
}

/// Depth and motion of all views, if they are given at samples only.
pub(super) fn filled(desc: &ContextDesc, frame: &Frame<'_>, history: &History) -> Option<Vec<Geometry>> {
    let mut views = vec![];
    for (i, view) in frame.views.iter().enumerate() {
        let lattices = view.lattices.as_ref().filter(|lattices| lattices.has_geometry_at_samples())?;
        let lattices = LatticeUniforms::of_view(lattices, desc.size_px);
        let inputs = Inputs::new(desc, frame, i, &history.state_after(i, frame), history.is_filled());
        let view = View { words: if inputs.reset { &[] } else { history.sparse(i) }, inputs, lattices };
        let pixels = Image::from_fn_parallel(desc.size_px, |px| view.pixel(px));
        views.push(Geometry { depth: pixels.map(|(depth, _)| depth), motion: pixels.map(|(_, motion)| motion) });
    }
    Some(views)
}

/// Calls `f` with the frame, in which the `filled` depth and motion, if any, replace those at its samples.
pub(super) fn with_filled<R>(
    filled: Option<&[Geometry]>,
    desc: &ContextDesc,
    frame: &Frame<'_>,
    f: impl FnOnce(&ContextDesc, &Frame<'_>) -> R,
) -> R {
    let Some(filled) = filled else { return f(desc, frame) };
    let depths: Vec<_> = filled.iter().map(|g| &g.depth).collect();
    let motions: Vec<_> = filled.iter().map(|g| &g.motion).collect();
    // The filled geometry is in internal conventions.
    let views: Vec<_> = frame.views.iter().map(|view| ViewFrame { depth: None, ..*view }).collect();
    let adds_camera = desc.motion.lacks_camera();
    let desc = ContextDesc { depth: DepthConvention::Linear, motion: MotionConvention::default(), ..*desc };
    let whole = frame.with_color(frame.color);
    let whole = Frame {
        depth: whole.depth.is_some().then_some(&depths[..]),
        motion: (whole.motion.is_some() || adds_camera).then_some(&motions[..]),
        views: &views,
        ..whole
    };
    f(&desc, &whole)
}

struct View<'a> {
    inputs: Inputs<'a>,
    words: &'a [[u32; 2]],
    lattices: ViewLattices,
}

/// Depth and motion at a sample, and its weight.
#[derive(Clone, Copy)]
struct Sample {
    disparity: f32,
    motion: [f32; 2],
    share: f32,
}

impl View<'_> {
    fn pixel(&self, px: [u32; 2]) -> (f32, [f32; 2]) {
        let lattice = &self.lattices[LatticeUniforms::index_at(&self.lattices, px)];
        let Some([x, y]) = lattice.around(px) else { return (distance_of(INVALID_DISPARITY), [0.0; 2]) };
        let sample = |tap: u32| {
            let (right, below) = (tap & 1, tap >> 1);
            let point = [x.points[right as usize], y.points[below as usize]];
            let [u, v] = lattice.texel_of(point);
            let share = point_weight(x.fraction, right) * point_weight(y.fraction, below);
            Sample {
                disparity: self.inputs.disparity(u, v),
                motion: self.inputs.motion_of(lattice.px_of(point), [u, v]),
                share,
            }
        };
        let ray = self.inputs.ray(px[0], px[1]);
        let mut own = sample(0);
        let mut best = -1.0;
        for tap in 0..4 {
            let s = sample(tap);
            let rank = s.share + if s.share > 0.0 && self.is_confirmed(px, ray, s) { 1.0 } else { 0.0 };
            if rank > best {
                (best, own) = (rank, s);
            }
        }
        let mut mean = GeometryMean::default();
        for tap in 0..4 {
            let s = sample(tap);
            mean = add_geometry(mean, own.disparity, s.disparity, Vec2::from(s.motion), s.share);
        }
        let filled = filled_geometry(mean, own.disparity, Vec2::from(own.motion));
        (filled.x, [filled.y, filled.z])
    }

    /// Whether history confirms that a pixel shows a sample's surface: history must have the expected disparity at the
    /// previous position.
    fn is_confirmed(&self, [x, y]: [u32; 2], ray: Vec3, s: Sample) -> bool {
        if self.words.is_empty() || !self.inputs.tests_depth() {
            return false;
        }
        let Ok([u, v]) = self.inputs.nearest(x, y, s.motion, &mut NoNotes) else { return false };
        let stored = unpack_stored(self.words[(v * self.inputs.size[0] + u) as usize]);
        let expected = self.inputs.previous_disparity(ray, s.disparity);
        stored.lod >= 0.0 && same_surface(expected, stored.disparity, TAP_RELATIVE, 0.0)
    }
}
