//! Rasterised frames leak nothing. Alone in its file, for a process of its own.

#[path = "common/roomy.rs"]
mod roomy;

use afterimage_lab::source::{RasterSource, ReadLimits, SceneOptions};

/// Seven times a frame its pipelines change; where Mesa 22.3 compiles one anew each time, that is 13 MiB a frame.
#[test]
fn forty_frames_of_many_materials_leak_nothing() {
    let Some(device) = roomy::roomy_device() else { return };
    let options = SceneOptions { size: Some([64, 36]), ..Default::default() };
    let limits = ReadLimits::default();
    let mut source = RasterSource::open("builtin:cubes", &limits, &options, None, device.clone()).unwrap();
    let mut resident = vec![];
    for index in 0..40 {
        source.draw(index);
        device.wait();
        if index % 10 == 9 {
            resident.extend(afterimage_testing::resident::resident_mib());
        }
    }
    println!("resident after 10, 20, 30 and 40 frames: {resident:.1?} MiB");
    let growth = afterimage_testing::resident::least_growth_mib(&resident);
    assert!(resident.is_empty() || growth < 2.0, "{growth} MiB");
}
