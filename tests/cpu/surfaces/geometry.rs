//! Gaze that moves: hard case H67 for smr.

use super::rig::*;
use afterimage_testing::holds;

#[test]
fn h67_microsaccades_enlarge_what_is_shown_sharp() {
    const WIDE: [u32; 2] = [240, 120];
    // Levels are stored in sevenths: those finer than one and a half sevenths are stored as 0 or 1.
    const SHARP: f32 = 1.5 / 7.0;
    let settings = settings(MethodKind::Smr);
    let view = ViewGeometry::flat(WIDE, 40.0).unwrap();
    let px_per_deg = 240.0 / (2.0 * 20.0_f32.to_radians().tan()) * 1.0_f32.to_radians();
    let picture = LowPass::new(&noise(WIDE, "h67"), 3);
    let mut draws = Draws::new("microsaccades");
    // 1000 gazes a second within half a degree, of which a frame at 90 Hz sees the last.
    let stream: Vec<f32> = (0..500).map(|_| 119.5 + draws.range(-0.5, 0.5) * px_per_deg).collect();
    let gazes: Vec<[f32; 2]> = (0..45).map(|frame| [stream[(frame as f64 * 1000.0 / 90.0) as usize], 59.5]).collect();
    let sharp_after = |gazes: &[[f32; 2]]| {
        let mut post = context_of(WIDE, settings);
        let frame = |(index, &gaze)| {
            let lods = settings.foveation.lod_map(&view, gaze);
            post.step(index, &View { lod: Some(lods.clone()), ..sharp(picture.render(&lods)) })
        };
        let last = (0..).zip(gazes).map(frame).last().unwrap();
        last.surfaces().iter().filter(|s| s.lod < SHARP).count()
    };
    let (moving, still) = (sharp_after(&gazes), sharp_after(&[[119.5, 59.5]; 3]));
    // Predicted: pixels within the radius of that level of any frame's gaze, by angles in f64.
    let ray = |x: f64, y: f64| {
        let scale = 20_f64.to_radians().tan() / 120.0;
        glam::DVec3::new((x - 119.5) * scale, (y - 59.5) * scale, 1.0)
    };
    let radius_deg = 2.5
        + f64::from(SHARP) / f64::from(settings.foveation.rate_mid).log2() * f64::from(settings.foveation.blend_deg);
    let seen = |x: u32, y: u32, gaze: &[f32; 2]| {
        let (r, g) = (ray(x.into(), y.into()), ray(gaze[0].into(), gaze[1].into()));
        r.cross(g).length().atan2(r.dot(g)).to_degrees() < radius_deg
    };
    let union =
        |gazes: &[[f32; 2]]| (0..240 * 120_u32).filter(|i| gazes.iter().any(|g| seen(i % 240, i / 240, g))).count();
    let (predicted, predicted_still) = (union(&gazes), union(&[[119.5, 59.5]]));
    assert!(
        moving >= predicted && still >= predicted_still && moving as f64 > 1.1 * still as f64,
        "{moving} px sharp, {predicted} predicted; still {still}, {predicted_still}"
    );
    holds!(
        "H67",
        Cpu,
        "smr, 45 frames at 90 Hz: {moving} px sharp, union of the foveas {predicted}; without movement {still}"
    );
}
