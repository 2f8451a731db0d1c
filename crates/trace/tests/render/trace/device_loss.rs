//! A device that is lost in mid-stream: an error that says so, and no panic.

use crate::roomy::roomy_device;
use afterimage_lab::device::Backend;
use afterimage_lab::source::{FrameSource, ReadLimits, SceneOptions};
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::{TracedSamples, TracedSource};

const OPTIONS: SceneOptions = SceneOptions { size: Some([32, 24]), hfov_deg: None, fps: None };

#[test]
fn a_source_says_that_its_device_was_lost() {
    let Some(lost) = roomy_device() else { return };
    let (settings, limits) = (TraceSettings::default(), ReadLimits::default());
    let samples = TracedSamples { foveated: None, samples: 1, full_rate_samples: 1 };
    let backend = Backend::Gpu(lost.clone());
    let source = TracedSource::open("builtin:cubes", &limits, &OPTIONS, Some("orbit"), &backend, settings, samples);
    let mut source = source.unwrap();
    let frame = source.frame(0).unwrap();
    assert!(frame.color.pixels().iter().any(|c| c[0] > 0.0));
    lost.device.destroy();
    let said = source.frame(1).map(|_| ()).unwrap_err().to_string();
    assert!(said.contains("the graphics device was lost") && said.contains("on the CPU"), "{said}");
}
