//! A device that is lost in mid-stream: an error that says so, from every part of the tool that computes on one, and no
//! panic; a new device goes on. The drop-in itself is in `tests/gpu/pass/lifecycle.rs`. Hard case H77.

use afterimage::FrameError;
use afterimage::internal::{Foveation, Settings};
use afterimage::wgpu;
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{AnalyticSource, FrameSource, RasterSource, ReadLimits, SceneOptions};
use afterimage_testing::holds;
use std::sync::Arc;

const OPTIONS: SceneOptions = SceneOptions { size: Some([32, 24]), hfov_deg: None, fps: None };

fn device() -> Option<Arc<Headless>> {
    Some(Headless::on(afterimage_testing::gpu::adapter()?, wgpu::Limits::default()).unwrap())
}

#[test]
fn a_lost_device_is_an_error_and_a_new_one_goes_on() {
    let Some(lost) = device() else { return };
    let mut source = AnalyticSource::new("lateral", [64, 36], 70.0, 60.0).unwrap();
    let pipeline = |device: &Arc<Headless>, geometry| {
        let (foveation, kinds) = (Foveation::default(), [RunKind::PostProcess(Settings::default())]);
        Pipeline::new(geometry, foveation, &kinds, false, &[], &Backend::Gpu(device.clone())).unwrap()
    };
    let mut first = pipeline(&lost, *source.view());
    for index in 0..3 {
        let frame = source.render(&first.request(index, Some([30.0, 18.0]))).unwrap();
        first.step(&frame).unwrap();
    }
    lost.check().unwrap();
    lost.device.destroy();
    for index in 3..5 {
        let frame = source.render(&first.request(index, None)).unwrap();
        let error = first.step(&frame).map(|_| ()).unwrap_err();
        assert_eq!(error, FrameError::DeviceLost);
    }
    assert_eq!(lost.check(), Err(FrameError::DeviceLost));

    // A new device shows what one shows that never had another: no frame of the past.
    let [again, other] = [(); 2].map(|()| {
        let mut pipeline = pipeline(&device().unwrap(), *source.view());
        let frame = source.render(&pipeline.request(5, Some([30.0, 18.0]))).unwrap();
        pipeline.step(&frame).unwrap().outputs[0].image.pixels().to_vec()
    });
    assert_eq!(again, other);
    let lost = "a device lost after 3 frames: FrameError::DeviceLost in each frame after";
    holds!("H77", Tool, "{lost}; a new one starts afresh");
}

#[test]
fn a_source_says_that_its_device_was_lost() {
    let Some(lost) = device() else { return };
    let limits = ReadLimits::default();
    let mut source = RasterSource::open("builtin:cubes", &limits, &OPTIONS, None, lost.clone()).unwrap();
    let frame = source.frame(0).unwrap();
    assert!(frame.color.pixels().iter().any(|c| c[0] > 0.0));
    lost.device.destroy();
    let said = source.frame(1).map(|_| ()).unwrap_err().to_string();
    assert!(said.starts_with("builtin:cubes: the graphics device was lost"), "{said}");
}
