//! Jitter from a jittered projection, and the signs that engines' own numbers have.

use super::geometry::off_axis;
use afterimage::internal::ViewFrame;
use afterimage::{Gaze, ViewGeometry};
use afterimage_testing::Draws;
use glam::{Mat4, Vec3};

const SIZE: [u32; 2] = [1600, 900];

fn view(clip_from_view: Mat4) -> ViewFrame {
    let geometry = ViewGeometry::from_projection(SIZE, clip_from_view.to_cols_array_2d()).unwrap();
    ViewFrame::new(geometry, Gaze::Lost)
}

/// Pixel at which a matrix draws a point, y down, in doubles.
fn drawn(clip_from_view: Mat4, point: Vec3) -> [f64; 2] {
    let clip = clip_from_view.as_dmat4() * point.as_dvec3().extend(1.0);
    let ndc = clip / clip.w;
    [(ndc.x + 1.0) * 0.5 * f64::from(SIZE[0]), (1.0 - ndc.y) * 0.5 * f64::from(SIZE[1])]
}

/// The recipes of docs/integration.md: an engine's jitter, what it does to the projection, and the signs of the table.
type Recipe = (&'static str, fn(Mat4, [f32; 2]) -> Mat4, [f32; 2]);

fn moved_clip_space(projection: Mat4, x: f32, y: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(2.0 * x / SIZE[0] as f32, 2.0 * y / SIZE[1] as f32, 0.0)) * projection
}

fn third_column(mut projection: Mat4, x: f32, y: f32) -> Mat4 {
    projection.z_axis.x += 2.0 * x / SIZE[0] as f32;
    projection.z_axis.y += 2.0 * y / SIZE[1] as f32;
    projection
}

const RECIPES: [Recipe; 4] = [
    ("Bevy", |projection, [x, y]| third_column(projection, x, -y), [-1.0, -1.0]),
    ("FSR2", |projection, [x, y]| moved_clip_space(projection, x, -y), [1.0, 1.0]),
    // Unreal looks along +z: its third row is the negative of this third column.
    ("Unreal", |projection, [x, y]| third_column(projection, -x, y), [1.0, 1.0]),
    ("Unity", |projection, [x, y]| moved_clip_space(projection, x, y), [1.0, -1.0]),
];

#[test]
fn a_jittered_projection_has_the_jitter_that_it_draws_with() {
    let mut draws = Draws::new("jitter");
    let mut worst = 0.0_f64;
    for i in 0..400 {
        let (engine, jitters, signs) = RECIPES[i % RECIPES.len()];
        let mut tangent = || draws.range(0.4, 1.4);
        let plain = off_axis([-tangent(), tangent()], [-tangent(), tangent()]);
        let own = [draws.range(-0.5, 0.5), draws.range(-0.5, 0.5)];
        let jittered = jitters(plain, own);
        let found = view(plain).jittered(jittered.to_cols_array_2d()).unwrap().jitter_px;
        let point = Vec3::new(draws.range(-1.0, 1.0), draws.range(-1.0, 1.0), draws.range(-5.0, -2.0));
        let (with, without) = (drawn(jittered, point), drawn(plain, point));
        for axis in 0..2 {
            let error = (f64::from(found[axis]) - (with[axis] - without[axis])).abs();
            worst = worst.max(error);
            assert!(error < 1e-3, "{engine}: {found:?}, drawn {without:?} and {with:?}");
            let by_table = signs[axis] * own[axis];
            assert!((found[axis] - by_table).abs() < 1e-3, "{engine}: {found:?} from {own:?}");
        }
    }
    println!("largest error: {worst:.1e} pixels");
}

#[test]
fn what_is_no_jitter_is_refused() {
    let plain = off_axis([-1.0, 1.0], [-0.6, 0.6]);
    let wider = off_axis([-1.1, 1.1], [-0.6, 0.6]);
    let other_eye = off_axis([-1.2, 0.8], [-0.6, 0.6]);
    for (matrix, setting) in [
        (wider, "jittered_clip_from_view"),
        (other_eye, "jittered_clip_from_view"),
        (Mat4::IDENTITY, "clip_from_view"),
        (Mat4::NAN, "clip_from_view"),
    ] {
        assert_eq!(view(plain).jittered(matrix.to_cols_array_2d()).unwrap_err().setting, setting);
    }
}
