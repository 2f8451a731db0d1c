//! Reactive masks: the inverse of trust masks, in the passes of whole and of sparse frames.

use super::rig::{Rig, View};
use super::sparse::all_caught_in_samples;
use super::sparse_hard::held;
use crate::images::noise;
use crate::reactive::reactive_is_the_inverse_of_trust;
use crate::sparse_hard::{SIZE, Shot, foveation, smr, waves};
use afterimage::shader::SHADERS;
use afterimage::{ContextDesc, Image, MethodKind, Reset, Settings};
use afterimage_testing::planted::all_caught;

#[test]
fn reactive_masks_are_the_inverse_of_trust() {
    let Some(figure) = held(reactive_is_the_inverse_of_trust) else { return };
    println!("{figure}");
}

#[test]
fn a_frame_with_both_masks_is_refused() {
    let settings = Settings::steady();
    let Some(mut rig) = Rig::new(ContextDesc::new(SIZE), settings) else { return };
    let mask = || Some(Image::filled(SIZE, 0.5));
    let view = View { trust: mask(), reactive: mask(), ..View::still(Image::filled(SIZE, [0.5; 3]), [0.0; 2]) };
    let error = rig.refusal(&view);
    assert_eq!(error, "reactive of view 0 is given: expected None, because trust is given, and is 1 minus this mask");
    for view in [View { trust: None, ..view.clone() }, View { reactive: None, ..view }] {
        rig.both(0, Reset::None, &[view]);
    }
}

#[test]
fn a_wrong_reactive_mask_is_caught() {
    let planted = [
        ("return 1.0 - textureLoad(reactive_in", "return textureLoad(reactive_in"),
        ("texel_of(px, view, REACTIVE_IN)", "texel_of(px.yx, view, REACTIVE_IN)"),
    ];
    let mask = Some(Image::from_fn(SIZE, |[x, y]| ((x * 7 + y * 3) % 300) as f32 / 256.0));
    let masked = |shot: Shot| vec![View { reactive: mask.clone(), ..shot.view }];
    let shot = |index| Shot::foveated(waves(SIZE, [0.4 * index as f32, 0.0]), &foveation(), [30.0, 25.0], index);
    let sparse = smr(SIZE);
    all_caught_in_samples(sparse, sparse.settings, 4, &planted, |index, _| masked(shot(index).moving([0.4, 0.0])));
    let whole = |index: u64| View {
        reactive: mask.clone(),
        ..View::still(noise(SIZE, &format!("reactive {index}")), [30.0, 25.0])
    };
    all_caught(&[SHADERS.compose("taa_pass").source], &planted, |[source]| {
        let settings = Settings { method: MethodKind::Taa.into(), ..Settings::default() };
        let mut rig = Rig::with_shader(ContextDesc::new(SIZE), settings, source)?;
        Some((0..3).any(|index| rig.differs(index, Reset::None, &[whole(index)])))
    });
}
