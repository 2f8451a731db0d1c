//! Properties of the filters' output on the GPU: hard cases H69, H70, H71.

use super::rig::*;
use crate::simulator_hard::*;
use afterimage::Image;

/// What a law measured; `None`, after a message, without an adapter.
fn run_law(law: fn(Foveate<'_>) -> Option<String>) -> Option<String> {
    law(&|foveation, image, gaze_px| {
        let mut rig = Rig::new(&desc(image.size(), 1, *foveation))?;
        let made = rig.on_gpu(&Scene::mono(image.clone(), gaze_px));
        let pixels = made.shown.iter().map(|c| c.map(f32::from_bits)).collect();
        Some(Image::from_pixels(image.size(), pixels).unwrap())
    })
}

simulator_laws!(Gpu, run_law);
