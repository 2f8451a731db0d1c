//! One walk with all methods: on the device, where frames stay, and read back for methods on the CPU.

use super::noise::noise;
use super::quad_views;
use super::rig::{FAST, psnr_db};
use crate::given::device;
use afterimage::Image;
use afterimage::internal::{Foveation, MethodKind, Settings};
use afterimage_lab::device::Backend;
use afterimage_lab::metric::encode;
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::quad_views::{Geometry, QuadViewLayout};
use afterimage_lab::source::{FrameSource, RasterSource, SceneCamera, Wanted};

/// What a step with a source fails with.
type Failure = Box<dyn std::error::Error>;

const SIZE: [u32; 2] = [158, 90];

/// `layout`: of quad views; planned frames without it.
fn both_show_the_same(
    foveation: Foveation,
    geometry: Geometry,
    layout: Option<QuadViewLayout>,
    methods: &[MethodKind],
) {
    let Some(device) = device() else { return };
    let camera = SceneCamera::choose(&noise(), Some("walk"), SIZE, None).unwrap();
    let view = *camera.geometry();
    let mut source = RasterSource::new(device.clone(), noise(), camera, None, FAST).unwrap();
    let run = |method: &MethodKind| RunKind::PostProcess(Settings { method: (*method).into(), ..Settings::default() });
    let kinds: Vec<_> = methods.iter().map(run).collect();
    let mut pipelines = [Backend::Gpu(device), Backend::Cpu].map(|backend| {
        let pipeline = Pipeline::new(view, foveation, &kinds, false, &[], &backend).unwrap();
        pipeline.with_quad_views(layout, geometry)
    });
    let mut db = [0.0; 2];
    for index in 0..4 {
        let gaze_px = [60.0 + 10.0 * index as f32, 50.0];
        let request = pipelines[0].request(index, Some(gaze_px));
        let frame = source.render(&request).unwrap();
        let [gpu, cpu] = pipelines.each_mut().map(|pipeline| {
            pipeline.step_with(&frame, &mut |request| Ok::<_, Failure>(source.shade(&frame, request)?)).unwrap()
        });
        for ((gpu, cpu), method) in gpu.outputs.iter().zip(&cpu.outputs).zip(methods) {
            assert_eq!(gpu.image, cpu.image, "{geometry:?}, {layout:?}, frame {index}, {}", method.name());
        }
        // Without a method, foveal pixels are those of the full-rate frame.
        let fovea = match (&request.wanted, layout) {
            (Wanted::QuadViews(quads), Some(QuadViewLayout::Regions)) => quads.as_slice()[0].opaque_px,
            (Wanted::QuadViews(_), Some(QuadViewLayout::Uniform { .. })) => [[0; 2]; 2],
            (Wanted::Surfaces, None) => [[0; 2]; 2],
            (wanted, _) => panic!("{layout:?}: {wanted:?}"),
        };
        let [[left, top], [right, bottom]] = fovea;
        for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x as usize, y as usize))) {
            assert_eq!(gpu.outputs[0].image.at(x, y), frame.reference.color.at(x, y), "({x}, {y})");
        }
        let last = &gpu.outputs[methods.len() - 1];
        let encoded = |image: &Image<[f32; 3]>| encode(image, 0.0);
        db = [&gpu.outputs[0], last].map(|shown| psnr_db(&encoded(&shown.image), &encoded(&frame.reference.color)));
    }
    println!("{geometry:?}, {layout:?}: none {:.2} dB, smr {:.2} dB", db[0], db[1]);
    assert!(layout.is_none() || db[0] > 15.0 && db[1] > 0.98 * db[0], "what is enlarged resembles the frame");
}

#[test]
fn methods_give_the_same_pictures_of_planned_frames_on_the_device_and_in_memory() {
    use MethodKind::{None, Smr, Taa, Taau, Wrs};
    for single_pixels in [false, true] {
        let foveation = Foveation { fovea_deg: 12.0, single_pixels, ..Foveation::quads() };
        both_show_the_same(foveation, Geometry::Full, Option::None, &[None, Taa, Taau, Wrs, Smr]);
    }
}

#[test]
fn methods_give_the_same_pictures_of_composed_frames_on_the_device_and_in_memory() {
    use MethodKind::{None, Smr, Taa, Wrs};
    for (geometry, layout) in [
        (Geometry::Full, QuadViewLayout::Regions),
        (Geometry::Samples, QuadViewLayout::Regions),
        (Geometry::Samples, QuadViewLayout::Uniform { step: 1.5 }),
    ] {
        both_show_the_same(quad_views::FOVEATION(), geometry, Some(layout), &[None, Taa, Wrs, Smr]);
    }
}
