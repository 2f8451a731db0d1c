//! Presets.

use super::*;

#[test]
fn presets_are_the_measured_ones() {
    for (foveated, measured) in [
        (Foveated::default(), Settings::screen()),
        (Foveated::screen(), Settings::screen()),
        (Foveated::headset(), Settings::headset()),
        (Foveated::uniform(0.25), Settings { foveation: Foveation::uniform(0.25), ..Settings::screen() }),
    ] {
        assert_eq!(Afterimage::default().settings(&foveated), measured);
    }
}
