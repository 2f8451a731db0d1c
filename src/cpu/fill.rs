//! Fills every pixel of a sparse frame, for methods that read whole frames. Samples stay unchanged; pixels between them
//! are linear interpolations of the finite ones, in the unit of the color input. Twin: `shaders/pass/fill_pass.wgsl`.

use super::Frame;
use super::sparse_pass::Quads;
use crate::frame::Exposure;
use crate::image::Image;
use crate::kernel::lattice::{SampleMean, add_sample, point_weight, sample_mean};
use crate::kernel::sanitize;
use crate::uniforms::{LatticeUniforms, ViewLattices};
use glam::Vec3;

/// Filled colors of all views; empty unless the frame is sparse. `quads`: of a frame shaded by quads, one a view.
pub(super) fn filled(frame: &Frame<'_>, size_px: [u32; 2], quads: &[Quads]) -> Vec<Image<[f32; 3]>> {
    if !quads.is_empty() {
        let views = quads.iter().zip(frame.color);
        let of = |(quads, color): (&Quads, &&Image<_>)| {
            Image::from_fn_parallel(size_px, |px| quads.filled(color, frame.half_color, px, frame.exposure))
        };
        return views.map(of).collect();
    }
    let views = frame.views.iter().zip(frame.color);
    let filled = views.filter_map(|(view, color)| {
        let lattices = LatticeUniforms::of_view(view.lattices.as_ref()?, size_px);
        Some(Image::from_fn_parallel(size_px, |px| pixel(&lattices, color, px, frame.exposure)))
    });
    filled.collect()
}

fn pixel(lattices: &ViewLattices, color: &Image<[f32; 3]>, px: [u32; 2], exposure: Exposure) -> [f32; 3] {
    let lattice = &lattices[LatticeUniforms::index_at(lattices, px)];
    let Some([x, y]) = lattice.around(px) else { return [f32::NAN; 3] };
    let sample_at = |point: [u32; 2]| {
        let [x, y] = lattice.texel_of(point);
        color.at(x as usize, y as usize)
    };
    if x.fraction == 0.0 && y.fraction == 0.0 {
        return sample_at([x.points[0], y.points[0]]);
    }
    let mut mean = SampleMean::default();
    for tap in 0..4 {
        let (right, below) = (tap & 1, tap >> 1);
        let given = sample_at([x.points[right as usize], y.points[below as usize]]);
        let (sampled, usable) = sanitize::color(Vec3::from(given) * exposure.of_colors());
        let share = point_weight(x.fraction, right) * point_weight(y.fraction, below);
        mean = add_sample(mean, sampled.extend(1.0), usable, share);
    }
    if mean.weight == 0.0 {
        return [f32::NAN; 3];
    }
    (sample_mean(mean).truncate() * (1.0 / exposure.of_colors())).to_array()
}
