//! Devices that a context fits on only just, or not; outputs in a texture that is read, too.

use super::*;
use crate::surfaces_hard;

const FORMAT: TextureFormat = TextureFormat::Rgba32Float;
pub(super) const READ_AND_WRITE: TextureUsages = TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING);

/// A device that computes nothing, with these limits, and its queue, without which it makes no encoders.
fn noop(required_limits: Limits) -> (Device, Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor { required_limits, ..Default::default() })
}

fn all_settings() -> Vec<Settings> {
    let kinds = MethodKind::ALL;
    let by_quads =
        kinds.map(|kind| Settings { method: kind.into(), foveation: Foveation::quads(), ..Settings::default() });
    let all = [kinds.map(surfaces_hard::settings), kinds.map(sparse::settings), by_quads];
    let noisy = Settings { foveation: Foveation::quads(), ..Settings::traced() };
    all.concat().into_iter().chain([Settings::traced(), noisy]).collect()
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
        for size in [[2, 1], [5000, 2]] {
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
        let Some(device) = afterimage_testing::gpu::device_with(&descriptor) else { return };
        let bare = Bare::on(device, desc);
        let texels: Vec<_> = noise(size, "small").pixels().iter().map(|c| [c[0], c[1], c[2], 1.0]).collect();
        let (color, output) = (bare.filled(FORMAT, &texels), bare.output(FORMAT));
        let noise_texture = bare.input(TextureFormat::Rg32Float);
        let mut post = bare.context(FORMAT);
        for index in 0..3 {
            let [view] = bare.views;
            let views = [view; 2];
            let noise = settings.noisy.then_some((&noise_texture).into());
            let frame = Frame { noise, ..Frame::new(&color, &views, index) };
            if settings.foveation.kind == FoveationKind::Quads {
                bare.plan(&mut post, &frame);
            }
            bare.record(&mut post, &frame, &output).unwrap();
        }
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

/// The list of the quads of a large view exceeds WebGPU's default for buffers that shaders bind, although its textures
/// are allowed.
#[test]
fn lists_beyond_the_device_are_refused_and_change_nothing() {
    let (device, _queue) = noop(Limits { max_texture_dimension_2d: 16384, ..Limits::default() });
    let (small, large) = ([64, 64], [16384, 8194]);
    let quads = Settings { foveation: Foveation::uniform(0.25), ..Settings::default() };
    let context =
        |size, settings| Afterimage::new(&device, &ContextDesc { settings, ..ContextDesc::new(size) }, FORMAT);
    let needed = 32 + 4 * 8192 * 4097;
    let (limit, found) = ("max_storage_buffer_binding_size", 128 << 20);
    assert_eq!(context(large, quads).unwrap_err(), CreateError::Limit { limit, found, needed });
    afterimage_testing::gpu::validated(&device, "resize and set_settings", || {
        let mut post = context(small, quads).unwrap();
        let mask = post.quad_mask().cloned();
        let mut encoder = device.create_command_encoder(&Default::default());
        let error = post.resize(&device, large).unwrap_err();
        assert_eq!(error, FrameError::Limit { size: large, limit, found, needed });
        let text = format!(
            "the device's {limit} is {found}: expected at least {needed} for a size of 16384x8194; request the device with Afterimage::required_limits()"
        );
        assert_eq!(error.to_string(), text);
        assert_eq!(post.resize_keeping_history(&device, &mut encoder, large), Err(error));
        assert_eq!((post.desc().size_px, post.quad_mask()), (small, mask.as_ref()));
        // Without quads the size is allowed; then with them the settings are not.
        let whole = Settings { method: Method::None, ..Settings::default() };
        post.set_settings(&device, whole).unwrap();
        post.resize(&device, large).unwrap();
        let error = post.set_settings(&device, quads).unwrap_err().to_string();
        let text = format!(
            "{limit} is {found}: expected at least {needed} for these settings at 16384x8194; request the device with Afterimage::required_limits()"
        );
        assert_eq!(error, text);
        assert_eq!((post.desc().settings, post.quad_mask()), (whole, None));
        post.resize(&device, small).unwrap();
        post.set_settings(&device, quads).unwrap();
    });
}

#[test]
fn a_texture_that_is_read_is_no_output() {
    let Some(device) = rig::device_of_five_outputs() else { return };
    let bare = Bare::on(device, ContextDesc::new([16, 16]));
    let views = bare.views;
    let mut post = bare.context(FORMAT);
    let [color, depth, output, debug] = [FORMAT, TextureFormat::R32Float, FORMAT, TextureFormat::Rgba16Float]
        .map(|format| bare.texture(format, READ_AND_WRITE));
    let layered = ContextDesc { view_count: 2, ..ContextDesc::new([64, 16]) };
    let [atlas, half_atlas] =
        [FORMAT, TextureFormat::Rgba16Float].map(|format| make_texture(&bare.device, &layered, format, READ_AND_WRITE));
    let region = |texture, x, layer| [Region { layer, ..Region::new(texture, [x, 0]) }];
    let (left, right, behind) = (region(&atlas, 0, 0), region(&atlas, 32, 0), region(&atlas, 0, 1));
    let [left, right, behind] = [&left, &right, &behind].map(|regions| Textures::Regions(regions));
    let half_region = region(&half_atlas, 0, 0);
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
        let error = bare.refusal(&mut post, &frame, target);
        let expected = format!("also the texture of {read}: expected");
        assert!(error.starts_with(written) && error.contains(&expected), "{error}");
    }
    // Another layer of the texture, and textures of their own.
    bare.record(&mut post, &Frame::new(left, &views, 0), behind).unwrap();
    let own = Frame { depth: Some((&depth).into()), ..frame };
    bare.record(&mut post, &own, Target { debug: beside((&debug).into()), ..Target::new(&output) }).unwrap();
}
