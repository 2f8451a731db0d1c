//! The context for full-size frames with levels of detail: the full context's frames, without planned ones.

use super::*;
use afterimage::levels::{self, Desc};
use afterimage_testing::gpu::{device, write_layer};

const SIZE: [u32; 2] = [40, 30];

/// Frames through this context, and through the full one.
fn shown(settings: levels::Settings, other: Settings) -> Option<[Vec<Vec<u32>>; 2]> {
    let (device, queue) = device()?;
    let desc = ContextDesc { settings: other, ..ContextDesc::new(SIZE) };
    let texture = |usage| make_texture(&device, &desc, TextureFormat::Rgba32Float, usage);
    let color = texture(TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let output = texture(TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);
    let mut post = levels::Afterimage::new(&device, &Desc { settings, ..Desc::new(SIZE, output.format()) }).unwrap();
    let mut full = Afterimage::new(&device, &desc, output.format()).unwrap();
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
    let default = Settings::default();
    let smr = Smr { accumulate: 0.5, tolerance: 2.0, relight: false, antialias: false };
    let own_smr = levels::Smr { accumulate: 0.5, tolerance: 2.0, relight: false };
    let block = Foveation { kind: FoveationKind::Block, rate_far: 4, rate_mid: 2, ..Foveation::default() };
    let own = levels::Foveation { filter: levels::Filter::Block, rate_far: 4, rate_mid: 2, ..Default::default() };
    let own_default = levels::Settings::default();
    let cases = [
        (own_default, default),
        (levels::Settings::steady(), Settings::steady()),
        (levels::Settings::responsive(), Settings::responsive()),
        (levels::Settings::paper(), Settings::paper()),
        (levels::Settings::weighted(), Settings::weighted()),
        (
            levels::Settings { method: levels::Method::None, ..own_default },
            Settings { method: Method::None, ..default },
        ),
        (levels::Settings { method: levels::Method::Taa, ..own_default }, Settings { method: Method::Taa, ..default }),
        (
            levels::Settings { method: levels::Method::Smr(own_smr), ..own_default },
            Settings { method: Method::Smr(smr), ..default },
        ),
        (
            levels::Settings { foveation: own, seed: 7, ..levels::Settings::paper() },
            Settings { foveation: block, seed: 7, ..Settings::paper() },
        ),
    ];
    for (settings, other) in cases {
        let Some([found, expected]) = shown(settings, other) else { return };
        assert!(found == expected, "{settings:?}");
    }
}

#[test]
fn another_foveation_is_caught() {
    let foveation = levels::Foveation { fovea_deg: 15.0, ..Default::default() };
    let settings = levels::Settings { foveation, ..Default::default() };
    let Some([found, expected]) = shown(settings, Settings::default()) else { return };
    assert!(found != expected);
}

#[test]
fn filters_have_the_levels_of_the_passes() {
    let filters = [
        (levels::Filter::Mip, FoveationKind::Mip),
        (levels::Filter::Gauss, FoveationKind::Gauss),
        (levels::Filter::Block, FoveationKind::Block),
        (levels::Filter::Off, FoveationKind::Off),
    ];
    for (own, filter) in filters {
        let own = levels::Foveation { filter: own, ..Default::default() };
        let foveation = Foveation { kind: filter, ..Foveation::default() };
        for e_deg in [0.0, 2.9, 5.0, 8.1, 30.0, 90.0] {
            assert_eq!(own.lod(e_deg).to_bits(), foveation.lod(e_deg).to_bits(), "{own:?} at {e_deg} degrees");
        }
    }
}

#[test]
fn settings_and_sizes_out_of_range_change_nothing() {
    let Some((device, _queue)) = device() else { return };
    let desc = Desc::new(SIZE, TextureFormat::Rgba16Float);
    let mut post = levels::Afterimage::new(&device, &desc).unwrap();
    let foveation = levels::Foveation { rate_far: 3, ..Default::default() };
    let error = post.set_settings(levels::Settings { foveation, ..Default::default() }).unwrap_err().to_string();
    assert!(error.contains("rate_far") && !error.contains('\n'), "{error}");
    post.resize([0, 30]).unwrap_err();
    assert_eq!(*post.desc(), desc);
    post.resize([20, 10]).unwrap();
    assert_eq!(post.desc().size_px, [20, 10]);
}
