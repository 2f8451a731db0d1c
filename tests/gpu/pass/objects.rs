//! Objects that a frame makes on the device: no bind groups and views while its textures are known.

use super::rig::make_texture;
use afterimage::gpu::{Afterimage, Frame, Prime};
use afterimage::wgpu::{self, Device, Texture, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, Filter, Foveation, Gaze, Settings, ViewFrame, ViewGeometry};

const SIZE: [u32; 2] = [64, 48];

/// Textures of a frame: color, depth, motion, and the output.
fn textures(device: &Device) -> [Texture; 4] {
    use TextureFormat::{R32Float, Rg16Float, Rgba16Float};
    let texture = |format, usage| make_texture(device, &ContextDesc::new(SIZE), format, usage);
    let [color, depth, motion] =
        [Rgba16Float, R32Float, Rg16Float].map(|format| texture(format, TextureUsages::TEXTURE_BINDING));
    [color, depth, motion, texture(Rgba16Float, TextureUsages::STORAGE_BINDING)]
}

/// Bind groups, views and buffers that the last of some frames made. Frames have two sets of textures that alternate,
/// or new ones each.
fn made(settings: Settings, is_new: bool) -> [usize; 3] {
    let folder = tempfile::tempdir().unwrap();
    let trace = wgpu::Trace::Directory(folder.path().to_owned());
    let (device, queue) = Device::noop(&wgpu::DeviceDescriptor { trace, ..Default::default() });
    let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
    let mut sets = [(); 2].map(|()| textures(&device));
    let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
    let gaze_px = [32.0, 24.0];
    let is_sparse = settings.foveation.filter == Filter::Sparse;
    let count = || {
        let trace = std::fs::read_to_string(folder.path().join("trace.ron")).unwrap();
        ["CreateBindGroup(", "CreateTextureView", "CreateBuffer("].map(|call| trace.matches(call).count())
    };
    let mut before = [0; 3];
    for index in 0..20 {
        let set = &mut sets[(index % 2) as usize];
        if is_new {
            *set = textures(&device);
        }
        let [color, depth, motion, output] = &*set;
        let views = [ViewFrame {
            lattices: is_sparse.then(|| settings.foveation.lattices(&geometry, gaze_px, index)),
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        }];
        let frame =
            Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, &views, index) };
        before = count();
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&device, &mut encoder, &frame, output).unwrap();
        queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::Poll).unwrap();
    }
    let after = count();
    std::array::from_fn(|i| after[i] - before[i])
}

#[test]
fn frames_of_known_textures_make_no_bind_groups_and_views() {
    let smr = Settings::default();
    let sparse = Foveation { filter: Filter::Sparse, ..Foveation::default() };
    for settings in [smr, Settings { foveation: sparse, ..smr }] {
        let (known, new) = (made(settings, false), made(settings, true));
        println!("bind groups, views, buffers: {known:?}; new textures: {new:?}");
        // One buffer uploads the frame's numbers.
        assert_eq!(known, [0, 0, 1]);
        assert!(new[0] > 0 && new[1] > 0, "{new:?}");
    }
}

/// Render pipelines of `prime` that exist before its first frame, and after it.
fn pipelines_of_prime(is_prewarmed: bool) -> [usize; 2] {
    let folder = tempfile::tempdir().unwrap();
    let trace = wgpu::Trace::Directory(folder.path().to_owned());
    let (device, _queue) = Device::noop(&wgpu::DeviceDescriptor { trace, ..Default::default() });
    let settings = Settings { foveation: Foveation::quads(), ..Settings::default() };
    let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
    let mut post = Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap();
    let [color, depth, motion, _] = textures(&device);
    let target = make_texture(&device, &desc, TextureFormat::Depth32Float, TextureUsages::RENDER_ATTACHMENT);
    let target = target.create_view(&Default::default());
    let prime = Prime { target: &target, origin_px: [0, 0], near_depth: 1.0, stencil: None };
    let count = || {
        std::fs::read_to_string(folder.path().join("trace.ron")).unwrap().matches("CreateGeneralRenderPipeline").count()
    };
    if is_prewarmed {
        post.prewarm_prime(&device, &prime).unwrap();
    }
    let before = count();
    let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0).unwrap(), Gaze::At { px: [32.0, 24.0] })];
    let frame = Frame { depth: Some((&depth).into()), motion: Some((&motion).into()), ..Frame::new(&color, &views, 0) };
    let mut encoder = device.create_command_encoder(&Default::default());
    post.plan(&device, &mut encoder, &frame).unwrap();
    post.prime(&device, &mut encoder, 0, &prime).unwrap();
    [before, count()]
}

#[test]
fn a_prewarmed_prime_compiles_nothing_in_its_first_frame() {
    assert_eq!(pipelines_of_prime(true), [1, 1]);
    assert_eq!(pipelines_of_prime(false), [0, 1]);
}
