//! Changing light on the device: hard cases H72 to H75, and planted errors of exposures.

use super::rig::{Rig, noise_view};
use super::surfaces::held;
use crate::laws::laws;
use crate::light_hard::*;
use afterimage::internal::method_pass;
use afterimage::shader::SHADERS;
use afterimage::{ContextDesc, Exposure, Image, Reset, Settings};
use afterimage_testing::holds;
use afterimage_testing::planted::all_caught_once;

light_laws!(Gpu, held);

#[test]
fn an_exposure_that_is_missing_or_applied_twice_is_caught() {
    let (desc, settings) = (ContextDesc::new([40, 30]), Settings::traced());
    let planted = [
        ("given.xyz * frame.color_exposure", "given.xyz"),
        ("given.xyz * frame.color_exposure", "given.xyz * frame.color_exposure * frame.color_exposure"),
        ("given.x * frame.color_exposure", "given.x"),
        ("exposed * frame.inverse_exposure", "exposed"),
        ("vec4<f32>(delivered(shown), kept)", "vec4<f32>(shown, kept)"),
        ("return expose(stored, frame.exposure);", "return stored;"),
    ];
    all_caught_once(SHADERS.compose(method_pass(&settings)).source, &planted, |source| {
        let mut rig = Rig::with_shader(desc, settings, source)?;
        let differs = |index: u64| {
            rig.exposure = Exposure::Scene { exposure: [3.0, 0.7][index as usize % 2] };
            let noise = Some(Image::filled(desc.size_px, [0.05, 2.0]));
            let views = [noise_view(&format!("exposed {index}"), &desc).with(|view| view.noise = noise)];
            let gpu = rig.on_gpu(index, Reset::None, &views);
            let (cpu, _) = rig.on_cpu(index, Reset::None, &views);
            gpu.agrees(&cpu).is_err()
        };
        Some((0..4).map(differs).filter(|&differs| differs).count() > 0)
    });
}
