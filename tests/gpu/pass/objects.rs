//! Objects that a frame makes on the device: no bind groups and views while its textures are known.

use super::*;

const SIZE: [u32; 2] = [64, 48];

/// A context on a device that computes nothing, and writes down what it is asked to do.
struct Written {
    folder: tempfile::TempDir,
    bare: Bare,
    post: Afterimage,
}

impl Written {
    fn new(settings: Settings) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let trace = wgpu::Trace::Directory(folder.path().to_owned());
        let device = Device::noop(&wgpu::DeviceDescriptor { trace, ..Default::default() });
        let bare = Bare::on(device, ContextDesc { settings, ..ContextDesc::new(SIZE) });
        Self { folder, post: bare.context(TextureFormat::Rgba16Float), bare }
    }

    fn count(&self, call: &str) -> usize {
        std::fs::read_to_string(self.folder.path().join("trace.ron")).unwrap().matches(call).count()
    }

    /// Textures of a frame: color, depth, motion, and the output.
    fn textures(&self) -> [Texture; 4] {
        use TextureFormat::{R32Float, Rg16Float, Rgba16Float};
        let [color, depth, motion] = [Rgba16Float, R32Float, Rg16Float].map(|format| self.bare.input(format));
        [color, depth, motion, self.bare.output(Rgba16Float)]
    }
}

/// Bind groups, views and buffers that the last of some frames made. Frames have two sets of textures that alternate,
/// or new ones each.
fn made(settings: Settings, is_new: bool) -> [usize; 3] {
    let mut written = Written::new(settings);
    let mut sets = [(); 2].map(|()| written.textures());
    let is_planned = settings.foveation.kind == FoveationKind::Quads;
    let count =
        |written: &Written| ["CreateBindGroup(", "CreateTextureView", "CreateBuffer("].map(|call| written.count(call));
    let mut before = [0; 3];
    for index in 0..20 {
        let set = &mut sets[(index % 2) as usize];
        if is_new {
            *set = written.textures();
        }
        let [color, depth, motion, output] = &*set;
        let views = written.bare.views;
        let frame =
            Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, &views, index) };
        before = count(&written);
        if is_planned {
            written.bare.plan(&mut written.post, &frame);
        }
        written.bare.record(&mut written.post, &frame, output).unwrap();
        written.bare.device.poll(wgpu::PollType::Poll).unwrap();
    }
    let after = count(&written);
    std::array::from_fn(|i| after[i] - before[i])
}

#[test]
fn frames_of_known_textures_make_no_bind_groups_and_views() {
    let smr = Settings::default();
    let planned = Settings { foveation: Foveation::quads(), ..smr };
    for (settings, uploads) in [(smr, 1), (planned, 2)] {
        let (known, new) = (made(settings, false), made(settings, true));
        println!("bind groups, views, buffers: {known:?}; new textures: {new:?}");
        // One buffer uploads the frame's numbers, and one those of its plan.
        assert_eq!(known, [0, 0, uploads]);
        assert!(new[0] > 0 && new[1] > 0, "{new:?}");
    }
}

/// What the last 12 of 20 planned frames made, frames of `shares` in turn.
fn made_of_shares(shares: &[f32]) -> Vec<(&'static str, usize)> {
    use afterimage::{Camera, Desc, Shading};
    let written = Written::new(Settings::default());
    let [color, depth, _, output] = written.textures();
    let device = &written.bare.device;
    let mut post = afterimage::Afterimage::new(device, &Desc::new(SIZE, output.format())).unwrap();
    let clip_from_view = glam::camera::rh::proj::directx::perspective_infinite_reverse(0.9, 1.3, 0.1);
    let camera = Camera::new(clip_from_view.to_cols_array_2d(), glam::Mat4::IDENTITY.to_cols_array_2d());
    let calls = ["CreateBindGroup(", "CreateTextureView", "CreateTexture(", "CreateComputePipeline", "CreateBuffer("];
    let count = || calls.map(|call| written.count(call));
    let mut before = [0; 5];
    for index in 0..20 {
        if index == 8 {
            before = count();
        }
        post.set_shading(Shading::Everywhere { share: shares[index % shares.len()] }).unwrap();
        let mut encoder = device.create_command_encoder(&Default::default());
        let plan = post.plan(&mut encoder, &afterimage::Frame::new(&depth, camera)).unwrap();
        post.show(&mut encoder, plan, &color, &output).unwrap();
        written.bare.queue.submit([encoder.finish()]);
        device.poll(wgpu::PollType::Poll).unwrap();
    }
    let after = count();
    (0..5).map(|i| (calls[i], after[i] - before[i])).collect()
}

#[test]
fn a_share_that_changes_in_every_frame_makes_no_objects() {
    let [constant, changing] = [&[0.25][..], &[0.05, 0.4, 0.12, 0.5, 0.2, 0.08, 0.3]].map(made_of_shares);
    println!("{changing:?}");
    assert_eq!(changing, constant);
    // Two buffers a frame upload numbers.
    assert_eq!(changing.iter().map(|(_, made)| made).collect::<Vec<_>>(), [&0, &0, &0, &0, &24]);
}

/// Compute pipelines that the first two planned frames compiled.
fn compiled_by_planned_frames(is_prewarmed: bool) -> usize {
    use afterimage::{Camera, Desc};
    let written = Written::new(Settings::default());
    let [color, depth, _, output] = written.textures();
    let device = &written.bare.device;
    let mut post = afterimage::Afterimage::new(device, &Desc::new(SIZE, output.format())).unwrap();
    let clip_from_view = glam::camera::rh::proj::directx::perspective_infinite_reverse(0.9, 1.3, 0.1);
    let camera = Camera::new(clip_from_view.to_cols_array_2d(), glam::Mat4::IDENTITY.to_cols_array_2d());
    let frame = afterimage::Frame::new(&depth, camera);
    if is_prewarmed {
        post.prewarm(&frame, &color, &output).unwrap();
    }
    let before = written.count("CreateComputePipeline");
    for _ in 0..2 {
        let mut encoder = device.create_command_encoder(&Default::default());
        let plan = post.plan(&mut encoder, &frame).unwrap();
        post.show(&mut encoder, plan, &color, &output).unwrap();
        written.bare.queue.submit([encoder.finish()]);
    }
    written.count("CreateComputePipeline") - before
}

#[test]
fn prewarmed_planned_frames_compile_nothing() {
    assert!(compiled_by_planned_frames(false) > 0);
    assert_eq!(compiled_by_planned_frames(true), 0);
}

/// Render pipelines of `prime` that exist before its first frame, and after it.
fn pipelines_of_prime(is_prewarmed: bool) -> [usize; 2] {
    let mut written = Written::new(Settings { foveation: Foveation::quads(), ..Settings::default() });
    let [color, depth, motion, _] = written.textures();
    let target = written.bare.texture(TextureFormat::Depth32Float, TextureUsages::RENDER_ATTACHMENT);
    let target = target.create_view(&Default::default());
    let prime = Prime { target: &target, origin_px: [0, 0], near_depth: 1.0, stencil: None, is_half: false };
    let (device, views) = (written.bare.device.clone(), written.bare.views);
    if is_prewarmed {
        written.post.prewarm_prime(&device, &prime).unwrap();
    }
    let before = written.count("CreateGeneralRenderPipeline");
    let frame = Frame { depth: Some((&depth).into()), motion: Some((&motion).into()), ..Frame::new(&color, &views, 0) };
    written.bare.plan(&mut written.post, &frame);
    let mut encoder = device.create_command_encoder(&Default::default());
    written.post.prime(&device, &mut encoder, 0, &prime).unwrap();
    [before, written.count("CreateGeneralRenderPipeline")]
}

#[test]
fn a_prewarmed_prime_compiles_nothing_in_its_first_frame() {
    assert_eq!(pipelines_of_prime(true), [1, 1]);
    assert_eq!(pipelines_of_prime(false), [0, 1]);
}
