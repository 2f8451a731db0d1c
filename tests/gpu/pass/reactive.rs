//! Reactive masks: the inverse of trust masks, in the passes of whole and of planned frames.

use super::mask_hard::run_law;
use super::*;
use crate::mask_hard::SIZE;
use crate::reactive::reactive_is_the_inverse_of_trust;

#[test]
fn reactive_masks_are_the_inverse_of_trust() {
    let Some(figure) = run_law(reactive_is_the_inverse_of_trust) else { return };
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
