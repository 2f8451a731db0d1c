//! Every part that can be left out of the passes is there, and leaving it out changes what is shown.

use afterimage::wgpu::naga;
use afterimage::{Foveation, Image, MethodKind, Settings, ViewGeometry};
use afterimage_lab::device::{Backend, Headless};
use afterimage_lab::pipeline::ablation::{PARTS, Part};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::source::{AnalyticSource, FrameSource};

const SIZE: [u32; 2] = [96, 64];
const FRAMES: u64 = 8;

/// Output of a run on an image that moves sideways, with poisoned pixels in every frame.
fn shown(backend: &Backend, run: RunKind) -> Vec<Image<[f32; 3]>> {
    let mut source = AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap();
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let foveation = Foveation { rate_mid: 2, rate_far: 4, ..Foveation::default() };
    let mut pipeline = Pipeline::new(geometry, foveation, &[run], false, &[], backend).unwrap().with_poison(0.01);
    (0..FRAMES)
        .map(|index| {
            let gaze = [20.0 + 8.0 * index as f32, 32.0];
            let frame = source.render(&pipeline.request(index, Some(gaze))).unwrap();
            pipeline.step(&frame).unwrap().outputs.remove(0).image
        })
        .collect()
}

fn bits(frames: &[Image<[f32; 3]>]) -> Vec<[u32; 3]> {
    frames.iter().flat_map(|frame| frame.pixels().iter().map(|c| c.map(f32::to_bits))).collect()
}

#[test]
fn parts_are_in_the_passes_and_their_texts_without_them_are_valid() {
    for part in PARTS {
        assert_eq!(Part::find(part.name), Some(part));
        for &method in part.methods {
            let source = part.shader_without(method);
            let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}: {e}", part.name));
            let flags = naga::valid::ValidationFlags::all();
            naga::valid::Validator::new(flags, naga::valid::Capabilities::all()).validate(&module).unwrap();
        }
    }
}

#[test]
fn leaving_a_part_out_changes_what_is_shown() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let backend = Backend::Gpu(Headless::find(true).expect("there is an adapter"));
    for method in [MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau] {
        let settings = Settings { method: method.into(), ..Settings::default() };
        let whole = shown(&backend, RunKind::PostProcess(settings));
        let broken = |frames: &[Image<[f32; 3]>]| {
            let pixels = frames.iter().flat_map(|f| f.pixels());
            pixels.filter(|c| !c.iter().all(|v| v.is_finite())).count()
        };
        assert_eq!(broken(&whole), 0, "{method:?}");
        for part in PARTS.iter().filter(|part| part.methods.contains(&method)) {
            let without = shown(&backend, RunKind::Without(settings, part));
            let differ = bits(&whole).iter().zip(bits(&without)).filter(|(a, b)| **a != *b).count();
            println!("{method:?} without {}: {differ} pixels differ, {} are broken", part.name, broken(&without));
            assert!(differ > 0, "{method:?} without {}", part.name);
        }
    }
}

#[test]
fn parts_cannot_be_left_out_on_the_cpu() {
    let run = RunKind::Without(Settings::default(), &PARTS[0]);
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let error = Pipeline::new(geometry, Foveation::default(), &[run], false, &[], &Backend::Cpu).err().unwrap();
    assert!(error.to_string().contains("expected a device"), "{error}");
}
