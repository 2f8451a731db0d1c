//! The context for full-size frames with levels of detail: the full context's frames, without planned ones.

use super::*;
use afterimage::levels;
use afterimage_testing::gpu::{device, write_layer};

const SIZE: [u32; 2] = [40, 30];

/// Frames through this context, and through the full one. `settings`: of each.
fn shown(settings: [Settings; 2]) -> Option<[Vec<Vec<u32>>; 2]> {
    let (device, queue) = device()?;
    let [desc, other] = settings.map(|settings| ContextDesc { settings, ..ContextDesc::new(SIZE) });
    let texture = |usage| make_texture(&device, &desc, TextureFormat::Rgba32Float, usage);
    let color = texture(TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let output = texture(TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);
    let mut post = levels::Afterimage::new(&device, &desc, output.format()).unwrap();
    let mut full = Afterimage::new(&device, &other, output.format()).unwrap();
    let mut all = [vec![], vec![]];
    for index in 0..6 {
        let colors = noise(SIZE, &format!("levels {}", index / 3));
        let colors: Vec<[f32; 4]> = colors.pixels().iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
        write_layer(&queue, &color, 0, bytemuck::cast_slice(&colors));
        let gaze = Gaze::At { px: [6.0 * index as f32, 12.0] };
        let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0).unwrap(), gaze)];
        let frame = levels::Frame::new(&color, &views, index);
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&mut encoder, &frame, &output).unwrap();
        queue.submit([encoder.finish()]);
        all[0].push(read_texture(&device, &queue, &output));
        let mut encoder = device.create_command_encoder(&Default::default());
        full.record(&device, &mut encoder, &frame, &output).unwrap();
        queue.submit([encoder.finish()]);
        all[1].push(read_texture(&device, &queue, &output));
    }
    Some(all)
}

#[test]
fn frames_are_those_of_the_full_context() {
    let presets = [Settings::steady(), Settings::paper(), Settings::weighted()];
    let taa = Settings { method: Method::Taa, ..Settings::default() };
    let foveation = Foveation { filter: Filter::Block, rate_far: 4, rate_mid: 2, ..Foveation::default() };
    for settings in presets.into_iter().chain([taa, Settings { foveation, ..Settings::default() }]) {
        let Some([found, expected]) = shown([settings; 2]) else { return };
        assert!(found == expected, "{settings:?}");
    }
}

#[test]
fn another_foveation_is_caught() {
    let foveation = Foveation { fovea_deg: 15.0, ..Foveation::default() };
    let Some([found, expected]) = shown([Settings::default(), Settings { foveation, ..Settings::default() }]) else {
        return;
    };
    assert!(found != expected);
}

#[test]
fn planned_frames_are_refused_and_named() {
    let Some((device, _queue)) = device() else { return };
    let desc = ContextDesc { settings: Settings::screen(), ..ContextDesc::new(SIZE) };
    let error = levels::Afterimage::new(&device, &desc, TextureFormat::Rgba16Float).unwrap_err().to_string();
    assert!(error.starts_with("foveation.filter is quads: expected mip, gauss, block or off"), "{error}");
    let mut post = levels::Afterimage::new(&device, &ContextDesc::new(SIZE), TextureFormat::Rgba16Float).unwrap();
    let error = post.set_settings(Settings::screen()).unwrap_err().to_string();
    assert!(error.contains("afterimage::Afterimage") && !error.contains('\n'), "{error}");
    assert_eq!(post.desc().settings, Settings::default());
}
