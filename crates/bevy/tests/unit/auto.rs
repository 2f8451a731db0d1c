//! Times of the device, as Bevy's `RenderDiagnosticsPlugin` stores them.

use super::*;
use bevy::diagnostic::DiagnosticPath;
use std::time::Duration;

#[test]
fn the_devices_time_is_that_of_the_newest_frames_passes() {
    let (mut store, mut seen) = (DiagnosticsStore::default(), None);
    assert_eq!(device_ms(&store, &mut seen), None);
    let start = Instant::now();
    let mut measure = |frame: u64, path: &'static str, value: f64| {
        let path = DiagnosticPath::new(path);
        if store.get(&path).is_none() {
            store.add(Diagnostic::new(path.clone()));
        }
        let time = start + Duration::from_millis(frame);
        store.get_mut(&path).expect("added").add_measurement(DiagnosticMeasurement { time, value });
    };
    measure(0, "render/afterimage/elapsed_gpu", 9.0);
    measure(0, "render/opaque/elapsed_gpu", 8.0);
    // Two cameras.
    measure(1, "render/opaque/elapsed_gpu", 2.0);
    measure(1, "render/opaque/elapsed_gpu", 3.0);
    measure(1, "render/opaque/elapsed_cpu", 0.5);
    measure(1, "render/opaque/part/elapsed_gpu", 1.5);
    measure(1, "render/shadows/elapsed_gpu", 4.0);
    measure(1, "fps", 60.0);
    assert_eq!(device_ms(&store, &mut seen), Some(9.0));
    assert_eq!(device_ms(&store, &mut seen), Some(0.0));
}
