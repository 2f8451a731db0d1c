//! Resampling to one gaze point per frame: the held sample, and its frame position.

use super::{VIEW_PX, any_samples, at, parse, path_of, screen, view};
use afterimage::ViewGeometry;
use afterimage_lab::scanpath::*;
use proptest::prelude::*;

/// Any float, with the largest and the non-finite ones frequent.
fn wild() -> impl Strategy<Value = f32> {
    prop_oneof![any::<f32>(), Just(f32::MAX), Just(f32::MIN), Just(f32::NAN), Just(f32::INFINITY)]
}

/// Both mappings, reimplemented for `view()` and `screen(true)`, with a pinhole of the frame's focal length.
fn mapped(px: [f32; 2], map: GazeMap) -> [f32; 2] {
    let (x, y) = (f64::from(px[0]), f64::from(px[1]));
    let focal = 320.0 / 35f64.to_radians().tan();
    let out = match map {
        GazeMap::Fit => [x * 640.0 / 1024.0 - 0.5, y * 360.0 / 768.0 - 0.5],
        GazeMap::Angle => [
            320.0 - 0.5 + focal * (x - 512.0) * (38.0 / 1024.0) / 67.0,
            180.0 - 0.5 + focal * (y - 384.0) * (30.0 / 768.0) / 67.0,
        ],
    };
    out.map(|v| v as f32)
}

proptest! {
    #![proptest_config(afterimage_testing::property("gaze of frames", 256))]

    /// H63, against an oracle that searches all samples linearly.
    #[test]
    fn each_frame_holds_the_last_valid_sample(
        samples in any_samples(), start in 0.0f64..1.0, fps in 5.0f64..500.0, fit in any::<bool>(),
    ) {
        let Ok(path) = path_of(samples.clone()) else { return Ok(()) };
        let start_s = start * path.duration_s();
        let map = if fit { GazeMap::Fit } else { GazeMap::Angle };
        let gaze = FrameGaze::new(&path, &view(), map, start_s, fps).unwrap();
        // The last frame is within the recording, the next one is not.
        let last_s = start_s + (gaze.frames() - 1) as f64 / fps;
        prop_assert!(last_s <= path.duration_s() + 1e-9 && last_s + 1.0 / fps > path.duration_s());
        for i in 0..gaze.frames() + 3 {
            let now = samples[0].t_s + start_s + i as f64 / fps;
            let mut valid = samples.iter().filter_map(|sample| Some((sample.t_s, mapped(sample.px?, map))));
            match (gaze.px(i), valid.rfind(|(t_s, _)| *t_s <= now + 1e-9)) {
                (Some(a), Some((t_s, b))) => {
                    prop_assert!((0..2).all(|k| (a[k] - b[k]).abs() < 2e-3), "{:?} {:?}", a, b);
                    prop_assert!((gaze.age_s(i).unwrap() - (now - t_s).max(0.0)).abs() < 1e-9);
                }
                (a, held) => prop_assert!(a.is_none() && held.is_none(), "{a:?} {held:?}"),
            }
        }
    }

    #[test]
    fn the_angle_map_keeps_angles_and_directions(x in -2e3f32..3e3, y in -2e3f32..3e3, hfov in 20f32..120.0) {
        let view = ViewGeometry::flat(VIEW_PX, hfov).unwrap();
        let path = path_of(vec![at(0.0, [x, y])]).unwrap();
        let px = FrameGaze::new(&path, &view, GazeMap::Angle, 0.0, 60.0).unwrap().px(0).unwrap();
        let on_screen = [(f64::from(x) - 512.0) * 38.0 / 1024.0 / 67.0, (f64::from(y) - 384.0) * 30.0 / 768.0 / 67.0];
        let ray = glam::DVec3::from(view.ray(px).map(f64::from));
        let angle = |x: f64, y: f64| x.hypot(y).atan().to_degrees();
        prop_assert!((angle(ray.x, ray.y) - angle(on_screen[0], on_screen[1])).abs() < 1e-4);
        // The direction agrees too: tangents are compared by component.
        prop_assert!((ray.x - on_screen[0]).abs() < 2e-6 && (ray.y - on_screen[1]).abs() < 2e-6);
    }

    /// H63: coordinates of any size map to finite positions or count as lost.
    #[test]
    fn wild_coordinates_never_become_non_finite(x in wild(), y in wild(), fit in any::<bool>()) {
        let path = path_of(vec![at(0.0, [3.0, 4.0]), at(0.1, [x, y])]).unwrap();
        let finite = x.is_finite() && y.is_finite();
        prop_assert_eq!(path.lost(), usize::from(!finite));
        let map = if fit { GazeMap::Fit } else { GazeMap::Angle };
        // A view with so small a pixel angle that the largest floats overflow.
        let view = ViewGeometry::flat([15_360, 8_640], 5.0).unwrap();
        let gaze = FrameGaze::new(&path, &view, map, 0.0, 10.0).unwrap();
        prop_assert!((0..4).all(|i| gaze.px(i).unwrap().iter().all(|v| v.is_finite())));
        if !finite {
            prop_assert_eq!(gaze.px(1), gaze.px(0));
        }
    }
}

#[test]
fn impossible_time_windows_and_maps_are_refused() {
    let path = parse("0,1,2,1\n2.0,1,2,1\n").unwrap();
    let make =
        |path: &Scanpath, map, start, fps| FrameGaze::new(path, &view(), map, start, fps).map_err(|e| e.to_string());
    assert_eq!(make(&path, GazeMap::Fit, 2.0, 60.0).unwrap().frames(), 1);
    assert_eq!(make(&path, GazeMap::Fit, 0.0, 60.0).unwrap().frames(), 121);
    for start in [2.1, -0.1, f64::NAN, f64::INFINITY] {
        let error = make(&path, GazeMap::Fit, start, 60.0).unwrap_err();
        assert!(error.contains("expected 0 to 2 s"), "{error}");
    }
    for fps in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(make(&path, GazeMap::Fit, 0.0, fps).unwrap_err().starts_with("fps: "));
    }
    let samples = vec![at(0.0, [1.0, 2.0])];
    let unknown = Scanpath::new("u.csv", screen(false), About::default(), samples).unwrap();
    assert_eq!(GazeMap::default_for(unknown.screen()), GazeMap::Fit);
    assert_eq!(GazeMap::default_for(path.screen()), GazeMap::Angle);
    let error = make(&unknown, GazeMap::Angle, 0.0, 60.0).unwrap_err();
    assert!(error.starts_with("u.csv: ") && error.contains("use the gaze map `fit`"), "{error}");
}
