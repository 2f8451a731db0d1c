//! Small frames and histories of arbitrary bit patterns on the device: equal to the CPU in every bit where it has the
//! same history, finite for any history, valid again after a frame, and without effect of one view on another.

use super::*;
use crate::any_frame::{SIZE, all_settings, any_frame};
use afterimage::kernel::surface::unpack_surface;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::RefCell;

fn view(frame: View, settings: &Settings) -> View {
    View { noise: frame.noise.filter(|_| settings.noisy), ..frame }
}

fn stereo() -> ContextDesc {
    ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) }
}

/// Runs `check` over cases; contexts are made once and reset.
fn cases(name: &str, count: u32, mut check: impl FnMut(&mut Draws, f32) -> Result<(), TestCaseError>) {
    let strategy = (any::<u64>(), prop::sample::select(vec![0.02_f32, 0.3, 1.0]));
    let check = RefCell::new(&mut check);
    TestRunner::new(afterimage_testing::property(name, count))
        .run(&strategy, |(seed, wild)| (check.borrow_mut())(&mut Draws::new(&seed.to_string()), wild))
        .unwrap();
}

#[test]
fn any_bits_agree_bit_for_bit_and_are_finite() {
    for settings in all_settings() {
        let Some(mut rig) = Rig::new(stereo(), settings) else { return };
        cases("whole pass on the device", 8, |draws, wild| {
            for index in 0..3 {
                let views = [0; 2].map(|_| view(any_frame(draws, wild), &settings));
                let reset = if index == 0 { Reset::All } else { Reset::None };
                let (made, _) = rig.both(index, reset, &views);
                prop_assert!(made.shown.iter().flatten().all(|&v| f32::from_bits(v).abs() <= 65504.0));
            }
            Ok(())
        });
    }
}

#[test]
fn a_history_of_any_bits_shows_numbers_and_heals_in_a_frame() {
    for settings in all_settings().into_iter().filter(|s| s.method != Method::None) {
        let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
        cases("any history", 8, |draws, _| {
            let mut frame = || view(any_frame(draws, 0.0), &settings);
            let frames = [0; 3].map(|_| frame());
            rig.on_gpu(0, Reset::All, &frames[..1]);
            for texture in rig.gpu.history_textures() {
                let words = (texture.width() * texture.height() * texture.format().block_copy_size(None).unwrap()) / 4;
                let random: Vec<u32> = (0..words).map(|_| draws.bits()).collect();
                afterimage_testing::gpu::write_layer(&rig.queue, &texture, 0, bytemuck::cast_slice(&random));
                for level in 1..texture.mip_level_count() {
                    afterimage_testing::gpu::fill_level(&rig.queue, &texture, level, draws.bits() as u8);
                }
            }
            for (index, frame) in frames[1..].iter().enumerate() {
                let made = rig.on_gpu(1 + index as u64, Reset::None, std::slice::from_ref(frame));
                let is_half = |&v: &u32| f32::from_bits(v).abs() <= 65504.0;
                prop_assert!(made.shown.iter().flatten().all(is_half), "{:?}", settings);
                // Every pixel holds a sample again.
                let healed = made.words.iter().all(|&w| match settings.method {
                    Method::Wrs(_) => stored_reservoir::unpack(w).w_sum > 0.0,
                    _ => unpack_surface([w[0], w[1]]).lod >= 0.0,
                });
                prop_assert!(healed, "{:?}, frame {}", settings, index);
            }
            Ok(())
        });
    }
}
