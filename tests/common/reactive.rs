//! The law of reactive masks, which both executors hold.

use crate::any_frame::number;
use crate::mask_hard::{Make, SIZE, Shot, foveation, smr, waves};
use afterimage::internal::{ContextDesc, Foveation, Method, MethodKind, Settings};
use afterimage::{Gaze, Image};
use afterimage_testing::Draws;

/// Contexts whose passes read the mask in a way of their own: of whole frames, of single pixels, of quads.
fn contexts() -> Vec<ContextDesc> {
    let of = |method: Method, foveation| ContextDesc {
        settings: Settings { method, foveation, ..Settings::default() },
        ..smr(SIZE)
    };
    let methods = [MethodKind::Smr, MethodKind::Wrs, MethodKind::Taa, MethodKind::Taau].map(Method::from);
    let both = methods.into_iter().flat_map(|method| [Foveation::default(), foveation()].map(|f| of(method, f)));
    both.chain([of(MethodKind::Smr.into(), Foveation::quads())]).collect()
}

/// A reactive mask gives what the trust 1 minus it gives, bit for bit: values in and beyond 0 to 1, NaN and infinity.
pub fn reactive_is_the_inverse_of_trust(make: Make) -> Option<String> {
    let contexts = contexts();
    for desc in &contexts {
        let Settings { method, foveation, .. } = desc.settings;
        let [mut reactive, mut trusting, mut unmasked] = [make(*desc)?, make(*desc)?, make(*desc)?];
        let mut draws = Draws::new("reactive masks");
        let mut differ = false;
        for index in 0..4 {
            let speed_px = [0.4, -0.3];
            let full = waves(SIZE, speed_px.map(|v| v * index as f32));
            let shot = Shot::planned(full, Gaze::At { px: [30.0, 25.0] }).moving(speed_px);
            let mask = Image::from_fn(SIZE, |_| number(&mut draws, 0.1, -0.2, 1.2));
            let trust = mask.map(|r| 1.0 - r);
            let [masked, trusted] = [
                shot.clone().with(|view| view.reactive = Some(mask)),
                shot.clone().with(|view| view.trust = Some(trust)),
            ];
            let shown = reactive.one(index, &masked);
            assert_eq!(shown, trusting.one(index, &trusted), "{method:?}, {foveation:?}, frame {index}");
            differ |= shown != unmasked.one(index, &shot);
        }
        assert!(differ, "{method:?}, {foveation:?}: the mask changes nothing");
    }
    Some(format!("{} contexts", contexts.len()))
}
