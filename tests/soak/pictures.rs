//! Frames of a stream: foveated pictures with planted defects.

use super::events::{Event, StreamState};
use super::rig::View;
use afterimage::internal::{Foveation, Pyramid, ViewFrame};
use afterimage::kernel::pack::{half_bits, half_value};
use afterimage::{Gaze, Image, ViewGeometry};
use std::collections::HashMap;

pub const FOVEATION: Foveation = Foveation {
    kind: afterimage::internal::FoveationKind::Mip,
    fovea_deg: 10.0,
    mid_deg: 30.0,
    blend_deg: 2.0,
    rate_mid: 4,
    rate_far: 8,
    budget: 0.0,
    single_pixels: false,
};

type Foveated = (Image<[f32; 3]>, Image<f32>);

/// Foveated once for each size, picture and gaze.
#[derive(Default)]
pub struct Pictures(HashMap<([u32; 2], u32, u32), Foveated>);

impl Pictures {
    /// The frame of a state of the stream, with an event applied. Colors are multiplied by `factor`.
    pub fn view(&mut self, size: [u32; 2], event: &Event, state: StreamState, factor: f32) -> View {
        if self.0.len() > 64 {
            self.0.clear();
        }
        let gaze_px = gaze(size, state.gaze);
        let foveated = self.0.entry((size, state.picture, state.gaze));
        let (color, lod) = foveated.or_insert_with(|| foveate(size, state.picture, gaze_px)).clone();
        let color = color.map(|c| c.map(|v| v * factor));
        let facts = ViewFrame::new(
            ViewGeometry::flat(size, 70.0).unwrap(),
            if event.is_lost { Gaze::Lost } else { Gaze::At { px: gaze_px } },
        );
        let mut view = View { lod: Some(lod), ..View::still(color, gaze_px) };
        view.facts = facts;
        if event.moves {
            let t = state.frame as f32;
            view.motion = Some(Image::filled(size, [(t * 0.37).sin() * 3.0, (t * 0.21).cos() * 2.0]));
            view.depth =
                Some(Image::from_fn(size, |[x, y]| 2.0 + 0.05 * x as f32 + if y % 9 == 0 { 4.0 } else { 0.0 }));
        }
        if event.is_broken {
            spoil(&mut view, state.frame);
        }
        view
    }
}

/// One of eight gaze positions.
fn gaze([width, height]: [u32; 2], place: u32) -> [f32; 2] {
    [(0.5 + (place % 4) as f32) * 0.25 * width as f32, (0.5 + (place / 4) as f32) * 0.5 * height as f32]
}

/// Texture, hard edges and a light, in halves.
fn foveate(size: [u32; 2], picture: u32, gaze_px: [f32; 2]) -> Foveated {
    let sharp = Image::from_fn(size, |[x, y]| {
        let stripe = if (x * (picture + 1) / 3 + y / 2) % 4 < 2 { 0.9 } else { 0.1 };
        let wave = 0.5 + 0.5 * (x as f32 * 0.11 + picture as f32).sin() * (y as f32 * 0.07).cos();
        let light = if x % 61 == 7 && y % 37 == 5 { 40.0 } else { 0.0 };
        [stripe * wave + light, wave * 0.7, stripe * 0.4 + 0.02]
    });
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    let lods = FOVEATION.lod_map(&geometry, gaze_px);
    let pyramid = Pyramid::new(sharp, FOVEATION.max_level());
    let color = FOVEATION.render(&pyramid, &lods).map(|c| c.map(|v| half_value(half_bits(v))));
    (color, lods)
}

/// Some pixels become NaN, infinite, huge or negative.
fn spoil(view: &mut View, frame: u64) {
    const BAD: [f32; 6] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 1e-42];
    let pixels = view.color.pixels().len();
    let place = |k: u64| ((frame * 7919 + k * 104_729) % pixels as u64) as usize;
    for k in 0..20 {
        let bad = BAD[(frame + k) as usize % BAD.len()];
        view.color.pixels_mut()[place(k)][k as usize % 3] = bad;
        if let Some(depth) = &mut view.depth {
            depth.pixels_mut()[place(k + 100)] = bad;
        }
        if let Some(motion) = &mut view.motion {
            motion.pixels_mut()[place(k + 200)] = [bad, 1e9];
        }
    }
}
