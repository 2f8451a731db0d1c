//! Devices that a context fits on only just, or not; outputs in a texture that is read, too.

use super::rig::{make_texture, noise};
use super::sparse;
use crate::surfaces_hard;
use afterimage::gpu::{Afterimage, DebugTarget, Frame, Region, Target, Textures};
use afterimage::wgpu::{self, Device, Limits, TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, CreateError, DebugView, Filter, Foveation, FrameError, Gaze, MethodKind, Settings, ViewFrame,
    ViewGeometry,
};

const FORMAT: TextureFormat = TextureFormat::Rgba32Float;
const READ_AND_WRITE: TextureUsages = TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING);

/// A device that computes nothing, with these limits, and its queue, without which it makes no encoders.
fn noop(required_limits: Limits) -> (Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor { required_limits, ..Default::default() })
}

fn all_settings() -> Vec<Settings> {
    let kinds = [MethodKind::None, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taa, MethodKind::Taau];
    let sparse_frames = kinds.map(sparse::settings);
    let by_quads =
        kinds.map(|kind| Settings { method: kind.into(), foveation: Foveation::quads(), ..Settings::default() });
    kinds
        .map(surfaces_hard::settings)
        .into_iter()
        .chain([Settings::traced()])
        .chain(sparse_frames)
        .chain(by_quads)
        .collect()
}

fn described(size: [u32; 2], settings: Settings) -> ContextDesc {
    ContextDesc { settings, view_count: 2, ..ContextDesc::new(size) }
}

#[test]
fn required_limits_suffice_and_none_may_be_lower() {
    type Lower = (&'static str, fn(&mut Limits) -> &mut u32);
    let lower: [Lower; 4] = [
        ("max_texture_dimension_2d", |limits| &mut limits.max_texture_dimension_2d),
        ("max_texture_array_layers", |limits| &mut limits.max_texture_array_layers),
        ("max_storage_textures_per_shader_stage", |limits| &mut limits.max_storage_textures_per_shader_stage),
        ("max_storage_buffers_per_shader_stage", |limits| &mut limits.max_storage_buffers_per_shader_stage),
    ];
    for settings in all_settings() {
        for size in [[1, 1], [5000, 2]] {
            let desc = described(size, settings);
            let needed = Afterimage::required_limits(&desc);
            assert!(needed.check_limits(&Limits { max_texture_dimension_2d: 8192, ..Limits::default() }));
            assert!(needed.max_texture_dimension_2d <= size[0].max(size[1]).max(512), "{size:?}: {settings:?}");
            let made = |limits: Limits| {
                let (device, _) = noop(limits);
                afterimage_testing::gpu::validated(&device, "new", || {
                    Afterimage::new(&device, &desc, FORMAT).map(|_| ())
                })
            };
            assert_eq!(made(needed.clone()), Ok(()));
            for (limit, of) in lower {
                let mut limits = needed.clone();
                *of(&mut limits) -= 1;
                let error = made(limits).unwrap_err();
                let CreateError::Limit { limit: named, found, needed } = error else { panic!("{error}") };
                assert_eq!((named, found + 1), (limit, needed));
            }
        }
    }
}

/// Every pass, on a device with no more than it needs: wgpu's validation has no objection.
#[test]
fn every_method_runs_on_the_smallest_device() {
    for settings in all_settings() {
        let size = [70, 41];
        let desc = described(size, settings);
        let limits = Afterimage::required_limits(&desc);
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let Some((device, queue)) = afterimage_testing::gpu::device_with(&descriptor) else { return };
        let texture = |format, usage| make_texture(&device, &desc, format, usage | TextureUsages::COPY_DST);
        let read = TextureUsages::TEXTURE_BINDING;
        let color = texture(FORMAT, read);
        let noise_texture = texture(TextureFormat::Rg32Float, read);
        let output = texture(FORMAT, TextureUsages::STORAGE_BINDING);
        let texels: Vec<f32> = noise(size, "small").pixels().iter().flat_map(|c| [c[0], c[1], c[2], 1.0]).collect();
        for layer in 0..2 {
            afterimage_testing::gpu::write_layer(&queue, &color, layer, bytemuck::cast_slice(&texels));
        }
        let geometry = ViewGeometry::flat(size, 70.0).unwrap();
        let is_sparse = settings.foveation.filter == Filter::Sparse;
        afterimage_testing::gpu::validated(&device, "frames", || {
            let mut post = Afterimage::new(&device, &desc, FORMAT).unwrap();
            for index in 0..3 {
                let mut view = ViewFrame::new(geometry, Gaze::At { px: [20.0, 20.0] });
                view.lattices = is_sparse.then(|| settings.foveation.lattices(&geometry, [20.0, 20.0], index));
                let views = [view; 2];
                let frame = Frame {
                    noise: settings.noisy.then_some((&noise_texture).into()),
                    ..Frame::new(&color, &views, index)
                };
                let mut encoder = device.create_command_encoder(&Default::default());
                if settings.foveation.filter == Filter::Quads {
                    post.plan(&device, &mut encoder, &frame).unwrap();
                }
                post.record(&device, &mut encoder, &frame, &output).unwrap();
                queue.submit([encoder.finish()]);
            }
        });
    }
}

#[test]
fn sizes_beyond_the_device_are_refused_and_change_nothing() {
    let (device, _queue) = noop(Limits::downlevel_defaults());
    let large = Afterimage::new(&device, &ContextDesc::new([2049, 4]), FORMAT).unwrap_err();
    assert_eq!(large, CreateError::Limit { limit: "max_texture_dimension_2d", found: 2048, needed: 2049 });
    let mut post = Afterimage::new(&device, &ContextDesc::new([64, 64]), FORMAT).unwrap();
    afterimage_testing::gpu::validated(&device, "resize", || {
        for size in [[2049, 8], [8, 4096]] {
            let error = post.resize(&device, size).unwrap_err();
            assert_eq!(error, FrameError::Extent { size, max: 2048 });
            assert!(error.to_string().ends_with("expected at most 2048 pixels a side"), "{error}");
            let mut encoder = device.create_command_encoder(&Default::default());
            assert_eq!(post.resize_keeping_history(&device, &mut encoder, size), Err(error));
        }
        assert_eq!(post.desc().size_px, [64, 64]);
        post.resize(&device, [2048, 8]).unwrap();
    });
}

#[test]
fn a_texture_that_is_read_is_no_output() {
    let required_limits = Limits { max_storage_textures_per_shader_stage: 5, ..Limits::default() };
    let Some((device, queue)) =
        afterimage_testing::gpu::device_with(&wgpu::DeviceDescriptor { required_limits, ..Default::default() })
    else {
        return;
    };
    let desc = ContextDesc::new([16, 16]);
    let views = [ViewFrame::new(ViewGeometry::flat(desc.size_px, 70.0).unwrap(), Gaze::Lost)];
    let mut post = Afterimage::new(&device, &desc, FORMAT).unwrap();
    let whole = |format| make_texture(&device, &desc, format, READ_AND_WRITE);
    let (color, depth, output) = (whole(FORMAT), whole(TextureFormat::R32Float), whole(FORMAT));
    let debug = whole(TextureFormat::Rgba16Float);
    let layered = ContextDesc { view_count: 2, ..ContextDesc::new([64, 16]) };
    let [atlas, half_atlas] =
        [FORMAT, TextureFormat::Rgba16Float].map(|format| make_texture(&device, &layered, format, READ_AND_WRITE));
    let region = |texture, x, layer| [Region { layer, ..Region::new(texture, [x, 0]) }];
    let (left, right, behind) = (region(&atlas, 0, 0), region(&atlas, 32, 0), region(&atlas, 0, 1));
    let [left, right, behind] = [&left, &right, &behind].map(|regions| Textures::Regions(regions));
    let half_region = region(&half_atlas, 0, 0);
    let mut recorded = |frame: Frame<'_>, target: Target<'_>| {
        afterimage_testing::gpu::validated(&device, "record", || {
            let mut encoder = device.create_command_encoder(&Default::default());
            let result = post.record(&device, &mut encoder, &frame, target).map(|_| ());
            queue.submit([encoder.finish()]);
            result
        })
    };
    let frame = Frame::new(&color, &views, 0);
    let beside = |output| Some(DebugTarget { view: DebugView::Age, output });
    let trusting = Frame { trust: Some((&output).into()), ..frame };
    let refused = [
        (frame, Target::new(&color), "output", "color"),
        (trusting, Target::new(&output), "output", "trust"),
        (Frame::new(left, &views, 0), Target::new(right), "output", "color"),
        (
            Frame { depth: Some(Textures::Regions(&half_region)), ..frame },
            Target { debug: beside(Textures::Regions(&half_region)), ..Target::new(&output) },
            "debug view",
            "depth",
        ),
    ];
    for (frame, target, written, read) in refused {
        let error = recorded(frame, target).unwrap_err().to_string();
        assert!(
            error.starts_with(written) && error.contains(&format!("also the texture of {read}: expected")),
            "{error}"
        );
    }
    // Another layer of the texture, and textures of their own.
    recorded(Frame::new(left, &views, 0), Target::new(behind)).unwrap();
    let own = Frame { depth: Some((&depth).into()), ..frame };
    recorded(own, Target { debug: beside((&debug).into()), ..Target::new(&output) }).unwrap();
}
