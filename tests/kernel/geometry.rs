//! View geometry and camera motion from an engine's matrices, and gazes in every form.

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Reset, ViewFrame};
use afterimage::{DepthConvention, FrameStats, Gaze, Image, Verdict, ViewGeometry};
use afterimage_testing::Draws;
use glam::camera::rh::proj::{directx, opengl};
use glam::camera::rh::view::look_to_mat4;
use glam::{DMat4, DVec3, Mat4, Quat, Vec3, Vec4};

const SIZE: [u32; 2] = [1600, 900];

/// Projections of one field of view, with every depth range.
fn projections(fov_y: f32, aspect: f32) -> [Mat4; 5] {
    [
        directx::perspective(fov_y, aspect, 0.1, 100.0),
        opengl::perspective(fov_y, aspect, 0.1, 100.0),
        directx::perspective_infinite(fov_y, aspect, 0.1),
        directx::perspective_infinite_reverse(fov_y, aspect, 0.1),
        // Reversed and finite: near and far swapped.
        directx::perspective(fov_y, aspect, 100.0, 0.1),
    ]
}

/// Off-axis projection of a headset's eye, from tangents; y up.
pub fn off_axis([left, right]: [f32; 2], [down, up]: [f32; 2]) -> Mat4 {
    let (width, height) = (right - left, up - down);
    Mat4::from_cols(
        Vec4::new(2.0 / width, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / height, 0.0, 0.0),
        Vec4::new((right + left) / width, (up + down) / height, 0.0, -1.0),
        Vec4::new(0.0, 0.0, 0.05, 0.0),
    )
}

/// A first frame of a grey view through the CPU, with a depth or without.
fn shown(desc: &ContextDesc, view: ViewFrame, depth: Option<f32>, reset: Reset) -> Result<FrameStats, String> {
    let (color, depth) = (Image::filled(desc.size_px, [0.5; 3]), depth.map(|z| Image::filled(desc.size_px, z)));
    let (colors, depths, views) = ([&color], depth.as_ref().map(|depth| [depth]), [view]);
    let frame = Frame { depth: depths.as_ref().map(|d| &d[..]), reset, ..Frame::new(&colors, &views, 0) };
    let mut post = CpuAfterimage::new(desc).unwrap();
    post.process(&frame, &mut [color.clone()]).map_err(|error| error.to_string())
}

fn assert_same(a: ViewGeometry, b: ViewGeometry) {
    for px in [[0.0, 0.0], [1599.0, 899.0], [300.0, 700.0]] {
        let (a, b) = (a.ray(px), b.ray(px));
        assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-5), "{a:?}, {b:?}");
    }
}

#[test]
fn a_projection_has_the_geometry_of_its_angles() {
    let hfov = 80.0_f32;
    let fov_y = 2.0 * ((0.5 * hfov.to_radians()).tan() * 900.0 / 1600.0).atan();
    let flat = ViewGeometry::flat(SIZE, hfov).unwrap();
    for matrix in projections(fov_y, 16.0 / 9.0) {
        assert_same(ViewGeometry::from_projection(SIZE, matrix.to_cols_array_2d()).unwrap(), flat);
    }
    let eye = off_axis([-1.2, 0.9], [-1.0, 1.1]).to_cols_array_2d();
    // y is down here: the top edge is -1.1.
    assert_same(
        ViewGeometry::from_projection(SIZE, eye).unwrap(),
        ViewGeometry::off_axis(SIZE, [-1.2, 0.9], [-1.1, 1.0]).unwrap(),
    );
}

#[test]
fn four_angles_have_the_geometry_of_their_tangents() {
    let angles = [-0.876_f32, 0.733, 0.785, -0.82];
    let [left, right, up, down] = angles.map(f32::tan);
    let expected = ViewGeometry::from_projection(SIZE, off_axis([left, right], [down, up]).to_cols_array_2d()).unwrap();
    assert_same(ViewGeometry::from_angles(SIZE, angles).unwrap(), expected);
    for (wrong, i) in [(1.6, 0), (-1.6, 1), (f32::NAN, 2), (f32::INFINITY, 3), (0.733, 0), (-0.9, 2)] {
        let mut angles = angles;
        angles[i] = wrong;
        let error = ViewGeometry::from_angles(SIZE, angles).unwrap_err();
        assert!(error.to_string().contains("within 90 degrees"), "{angles:?}: {error}");
    }
}

#[test]
fn an_octagon_holds_what_the_lens_shows_and_little_more() {
    use afterimage::kernel::lens::is_visible;
    let geometry = ViewGeometry::from_angles(SIZE, [-0.876, 0.733, 0.785, -0.82]).unwrap();
    // A round lens; y up.
    let (middle, radius) = ([-0.15_f32, 0.03], 1.0_f32);
    let outline = (0..64).map(|i| {
        let (sin, cos) = (i as f32 / 64.0 * std::f32::consts::TAU).sin_cos();
        [middle[0] + radius * cos, middle[1] + radius * sin]
    });
    let [lowest, highest] = geometry.visible_px(outline).unwrap();
    let (mut shown, mut kept) = (0, 0);
    for i in 0..SIZE[0] * SIZE[1] {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let [u, v, _] = geometry.ray([x as f32, y as f32]);
        let is_kept = is_visible(x, y, lowest.into(), highest.into());
        kept += u32::from(is_kept);
        // 64 points lie 0.1 % inside the circle between them.
        if (u - middle[0]).hypot(-v - middle[1]) < 0.998 * radius {
            shown += 1;
            assert!(is_kept, "({x}, {y}) is seen");
        }
    }
    assert!(
        kept < SIZE[0] * SIZE[1] - 100_000 && f64::from(kept) < 1.12 * f64::from(shown),
        "{shown} pixels are seen, {kept} kept, of {}",
        SIZE[0] * SIZE[1]
    );
    assert_eq!(geometry.visible_px([]), None);
    assert_eq!(geometry.visible_px([[0.0, 0.0], [f32::NAN, 0.0]]), None);
    assert_eq!(geometry.visible_px([[f32::MAX, 0.0]]), None);
}

#[test]
fn poses_give_the_motion_of_their_matrices() {
    let mut draws = Draws::new("poses");
    let eye = off_axis([-1.2, 0.9], [-1.0, 1.1]);
    let geometry = ViewGeometry::from_projection(SIZE, eye.to_cols_array_2d()).unwrap();
    let view = ViewFrame::new(geometry, Gaze::Lost);
    for _ in 0..50 {
        let mut pose = |around: Vec3, radians: f32| {
            let mut number = |reach: f32| draws.range(-reach, reach);
            let turn = Vec3::new(number(radians), number(radians), number(radians));
            let place = around + Vec3::new(number(0.1), number(0.1), number(0.1));
            Mat4::from_rotation_translation(Quat::from_scaled_axis(turn), place)
        };
        let (now, before) = (pose(Vec3::new(3.0, 1.6, -2.0), 1.0), pose(Vec3::new(3.0, 1.6, -2.0), 1.0));
        let clip = |pose: Mat4| (eye * pose.inverse()).to_cols_array_2d();
        let expected = view.moved(eye.to_cols_array_2d(), clip(now), clip(before)).unwrap();
        let found = view.posed(now.to_cols_array_2d(), before.to_cols_array_2d()).unwrap();
        let (expected, found) = (expected.previous_from_current.unwrap(), found.previous_from_current.unwrap());
        for (a, b) in expected.iter().flatten().zip(found.iter().flatten()) {
            assert!((a - b).abs() < 2e-5, "{expected:?}, {found:?}");
        }
    }
    let good = Mat4::from_rotation_y(0.3).to_cols_array_2d();
    let scaled = Mat4::from_scale(Vec3::splat(1.1)).to_cols_array_2d();
    let mirrored = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)).to_cols_array_2d();
    let by_rows = Mat4::from_translation(Vec3::X).transpose().to_cols_array_2d();
    for bad in [scaled, mirrored, by_rows, Mat4::NAN.to_cols_array_2d(), [[0.0; 4]; 4]] {
        assert_eq!(view.posed(bad, good).unwrap_err().setting, "world_from_view");
        let error = view.posed(good, bad).unwrap_err();
        assert_eq!(error.setting, "previous_world_from_view");
        assert!(error.expected.contains("a rotation and a translation"), "{error}");
    }
    assert!(view.posed(mirrored, mirrored).unwrap_err().expected.contains("mirror"));
    assert!(view.posed(by_rows, by_rows).unwrap_err().expected.contains("transpose"));
    assert!(view.posed(scaled, scaled).unwrap_err().expected.contains("without scale"));
}

#[test]
fn one_ray_is_seen_by_both_eyes_where_the_point_is() {
    let mut draws = Draws::new("one ray");
    for _ in 0..200 {
        let mut number = |reach: f32| draws.range(-reach, reach);
        let turn = Quat::from_scaled_axis(Vec3::new(number(1.0), number(1.0), number(1.0)));
        let head = Mat4::from_rotation_translation(turn, Vec3::new(number(5.0), number(2.0), number(5.0)));
        let direction = Vec3::new(number(0.5), number(0.5), -1.0).normalize();
        let (origin, direction) = (head.transform_point3(Vec3::ZERO), head.transform_vector3(direction));
        let distance = 0.3 + number(0.25).abs() * 20.0;
        let point = origin + distance * direction;
        for side in [-0.032, 0.032] {
            let pose = head * Mat4::from_translation(Vec3::new(side, 0.0, 0.0));
            let geometry = ViewGeometry::from_angles(SIZE, [-0.876, 0.733, 0.785, -0.82]).unwrap();
            // A direction of any length.
            let ray = (3.0 * direction).into();
            let gaze = Gaze::on_ray(origin.into(), ray, distance, pose.to_cols_array_2d()).resolve(None, &geometry);
            let seen = pose.inverse().transform_point3(point) * Vec3::new(1.0, -1.0, -1.0);
            let expected = geometry.project(seen.into()).unwrap();
            assert!((0..2).all(|i| (gaze[i] - expected[i]).abs() < 0.05), "{gaze:?} instead of {expected:?}");
            // The planted error: the gaze of an eye that sits between both.
            let middle = head.inverse().transform_point3(point) * Vec3::new(1.0, -1.0, -1.0);
            assert!((geometry.project(middle.into()).unwrap()[0] - expected[0]).abs() > 1.0);
        }
    }
    let pose = Mat4::IDENTITY.to_cols_array_2d();
    let lost = |origin, direction, distance, pose| Gaze::on_ray(origin, direction, distance, pose) == Gaze::Lost;
    let ahead = [0.0, 0.0, -1.0];
    assert!(lost([f32::NAN, 0.0, 0.0], ahead, 1.0, pose));
    assert!(lost([0.0; 3], [0.0; 3], 1.0, pose) && lost([0.0; 3], [0.0; 3], f32::INFINITY, pose));
    assert!(lost([0.0; 3], [f32::INFINITY, 0.0, 0.0], 1.0, pose));
    assert!(lost([0.0; 3], ahead, f32::NAN, pose) && lost([0.0; 3], ahead, -1.0, pose));
    assert!(lost([0.0; 3], ahead, 1.0, [[0.0; 4]; 4]));
    let flipped = Gaze::on_ray([0.0; 3], [0.2, 0.1, -1.0], f32::INFINITY, pose);
    assert!(matches!(flipped, Gaze::Direction { view: [x, y, z] } if x > 0.0 && y < 0.0 && z > 0.0), "{flipped:?}");
}

#[test]
fn matrices_that_are_no_perspective_projection_are_refused() {
    let good = directx::perspective_infinite_reverse(1.0, 1.5, 0.1);
    let refused = |matrix: Mat4| ViewGeometry::from_projection(SIZE, matrix.to_cols_array_2d()).unwrap_err().expected;
    assert!(refused(directx::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0)).contains("orthographic"));
    assert!(
        refused(glam::camera::lh::proj::directx::perspective_infinite_reverse(1.0, 1.5, 0.1)).contains("left-handed")
    );
    assert!(refused(Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * good).contains("y down"));
    assert!(refused(Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * good).contains("a mirrored projection"));
    assert!(refused(good * Mat4::from_translation(Vec3::new(0.03, 0.0, 0.0))).contains("not multiplied by a view"));
    assert!(refused(good * Mat4::from_rotation_y(0.001)).contains("not multiplied by a view"));
    assert!(refused(good.transpose()).contains("transpose this one"));
    assert!(refused(good * Mat4::from_rotation_y(0.3)).contains("not multiplied by a view"));
    assert!(refused(Mat4::NAN).contains("finite"));
    assert!(refused(Mat4::ZERO).contains("perspective"));
}

#[test]
fn camera_motion_leads_a_point_to_where_it_was() {
    let mut draws = Draws::new("camera motion");
    let mut number = |low, high| draws.range(low, high);
    for projection in projections(1.0, 16.0 / 9.0).into_iter().chain([off_axis([-1.2, 0.9], [-1.0, 1.1])]) {
        // Far from the world's origin, as in large worlds.
        let eye = Vec3::new(number(-500.0, 500.0), number(-500.0, 500.0), number(-500.0, 500.0));
        let ahead = |yaw: f32| Vec3::new(yaw.sin(), 0.1, -yaw.cos()).normalize();
        let view = |eye: Vec3, yaw: f32| look_to_mat4(eye, ahead(yaw), Vec3::Y);
        let (now, before) = (view(eye, 0.30), view(eye + Vec3::new(0.2, -0.1, 0.15), 0.27));
        let geometry = ViewGeometry::from_projection(SIZE, projection.to_cols_array_2d()).unwrap();
        let [projection, vp, previous] =
            [projection, projection * now, projection * before].map(|m| m.to_cols_array_2d());
        let moved = ViewFrame::new(geometry, Gaze::Lost).moved(projection, vp, previous).unwrap();
        let matrix = moved.previous_from_current.unwrap();
        for _ in 0..20 {
            // A point in view space, x right, y down, z forward.
            let point = [number(-2.0, 2.0), number(-2.0, 2.0), number(2.0, 20.0)];
            let world = now.inverse().transform_point3(Vec3::new(point[0], -point[1], -point[2]));
            let expected = before.transform_point3(world) * Vec3::new(1.0, -1.0, -1.0);
            let row = |i: usize| (0..3).map(|j| matrix[i][j] * point[j]).sum::<f32>() + matrix[i][3];
            let found = Vec3::new(row(0), row(1), row(2));
            assert!((found - expected).length() < 5e-3 * expected.length(), "{found} instead of {expected}");
            // The planted error: the camera did not move.
            assert!((Vec3::from(point) - expected).length() > 1e-2 * expected.length());
        }
    }
    let projection = directx::perspective_infinite_reverse(1.0, 1.5, 0.1).to_cols_array_2d();
    let view = ViewFrame::new(ViewGeometry::from_projection(SIZE, projection).unwrap(), Gaze::Lost);
    let singular = view.moved(projection, [[0.0; 4]; 4], projection).unwrap_err();
    assert_eq!(singular.setting, "clip_from_world");
    assert!(singular.expected.contains("clip_from_view times a view"), "{singular}");
    assert_eq!(view.moved(projection, projection, [[f32::NAN; 4]; 4]).unwrap_err().setting, "previous_clip_from_world");
}

/// Oblique near plane of a mirror (Lengyel 2005): the row of depth is a clip plane.
fn oblique(projection: Mat4) -> Mat4 {
    let mut columns = projection.to_cols_array_2d();
    for (column, z) in columns.iter_mut().zip([0.06, 0.1, -0.16, -0.24]) {
        column[2] = z;
    }
    Mat4::from_cols_array_2d(&columns)
}

#[test]
fn h104_far_cameras_oblique_near_planes_and_mirrors_are_right_or_refused() {
    let good = directx::perspective_infinite_reverse(1.0, 1.5, 0.1);
    let geometry = |matrix: Mat4| ViewGeometry::from_projection(SIZE, matrix.to_cols_array_2d());
    // A projection that was divided out of a product in floats.
    let mut rounded = good;
    (rounded.y_axis.x, rounded.z_axis.w, rounded.w_axis.x) = (-1.9e-9, -0.999_999_94, -4.8e-7);
    assert_same(geometry(rounded).unwrap(), geometry(good).unwrap());
    assert_same(geometry(oblique(good)).unwrap(), geometry(good).unwrap());

    // 1e6 m from the origin: doubles hold the motion, floats do not (the planted error).
    let view = ViewFrame::new(geometry(good).unwrap(), Gaze::Lost);
    let at = |z: f64| DMat4::from_translation(DVec3::new(0.0, 1.6, z));
    let shift = |view: ViewFrame| view.previous_from_current.unwrap()[2][3];
    let (now, before) = (at(1e6), at(1e6 + 0.02));
    assert!((shift(view.posed(now.to_cols_array_2d(), before.to_cols_array_2d()).unwrap()) - 0.02).abs() < 1e-6);
    let floats = |pose: DMat4| pose.as_mat4().to_cols_array_2d();
    assert!((shift(view.posed(floats(now), floats(before)).unwrap()) - 0.02).abs() > 0.01);
    let projection = good.as_dmat4();
    let clip = |projection: DMat4, pose: DMat4| (projection * pose.inverse()).to_cols_array_2d();
    let moved = |projection: DMat4, before: DMat4| {
        view.moved(projection.to_cols_array_2d(), clip(projection, now), clip(projection, before))
    };
    assert!((shift(moved(projection, before).unwrap()) - 0.02).abs() < 1e-6);
    // Relative to a point near the camera, floats do.
    let near = DMat4::from_translation(DVec3::new(0.0, 0.0, -1e6));
    assert!((shift(view.posed(floats(near * now), floats(near * before)).unwrap()) - 0.02).abs() < 1e-6);
    // A gaze on a point 1 m ahead, 3 cm to the right of the eye.
    let gaze = Gaze::on_ray([0.03, 1.6, 1e6], [0.0, 0.0, -1.0], 1.0, now.to_cols_array_2d());
    assert!(matches!(gaze, Gaze::Direction { view: [x, y, z] } if (x - 0.03).abs() < 1e-6 && y == 0.0 && z == 1.0));

    // An oblique near plane and another field of view leave the motion as it is.
    let turned = before * DMat4::from_rotation_y(0.05);
    let plain = moved(projection, turned).unwrap().previous_from_current.unwrap();
    let slanted = oblique(good).as_dmat4();
    assert_eq!(moved(slanted, turned).unwrap().previous_from_current.unwrap(), plain);
    let zoomed = directx::perspective_infinite_reverse(0.7, 1.5, 0.1).as_dmat4();
    let zoom = view.moved(projection.to_cols_array_2d(), clip(projection, now), clip(zoomed, turned)).unwrap();
    let differences = zoom.previous_from_current.unwrap().into_iter().flatten().zip(plain.into_iter().flatten());
    assert!(differences.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
    // A camera that stands still, whatever its matrices round to.
    assert_eq!(moved(projection, now).unwrap().previous_from_current.unwrap(), Mat4::IDENTITY.to_cols_array_2d());

    // A mirror in the plane x = 0: what is drawn moves as in the mirrored view.
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let through = |before: DMat4| {
        let clips = [now, before].map(|pose| (projection * pose.inverse() * mirror).to_cols_array_2d());
        view.moved(projection.to_cols_array_2d(), clips[0], clips[1])
    };
    assert_eq!(through(turned).unwrap().previous_from_current.unwrap(), plain);
    let cut = view.moved(projection.to_cols_array_2d(), clip(projection, now), clip(projection, mirror * turned));
    assert!(cut.unwrap_err().to_string().contains("both views mirrored or neither"));

    // Depth buffers of an oblique projection are refused, distances are not.
    let size = [8, 6];
    let geometry = ViewGeometry::from_projection(size, oblique(good).to_cols_array_2d()).unwrap();
    let process = |depth_convention| {
        let view = ViewFrame { depth: Some(depth_convention), ..ViewFrame::new(geometry, Gaze::Lost) };
        shown(&ContextDesc::new(size), view, Some(0.5), Reset::None)
    };
    let error = process(DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }).unwrap_err();
    assert!(
        error.starts_with("depth convention of view 0 is Reversed") && error.contains("oblique near plane"),
        "{error}"
    );
    process(DepthConvention::Linear).unwrap();
    afterimage_testing::holds!(
        "H104",
        Cpu,
        "1e6 m away 0.02 m are 0.02 m in f64, and in f32 relative to a near point; oblique planes and mirrors right, \
         their depth buffers and mirrored poses refused by name"
    );
}

#[test]
fn an_orthographic_camera_moves_along_its_axis() {
    let size = [64, 64];
    let mut desc = ContextDesc::new(size);
    desc.depth = DepthConvention::Orthographic { near: 0.0, far: 100.0 };
    let rejected = |is_told: bool| {
        let mut post = CpuAfterimage::new(&desc).unwrap();
        let (color, mut shown) = (Image::filled(size, [0.5; 3]), [Image::filled(size, [0.0; 3])]);
        let mut rejected = 0;
        for index in 0..3 {
            // 10 m, and 0.3 m less in each frame.
            let depth = Image::filled(size, 0.1 - 0.003 * index as f32);
            let at = |frame: f32| Mat4::from_translation(Vec3::new(0.0, 0.0, -0.3 * frame)).to_cols_array_2d();
            let mut view = ViewFrame::new(ViewGeometry::flat(size, 60.0).unwrap(), Gaze::Lost);
            if is_told {
                view = view.posed(at(index as f32), at(index as f32 - 1.0)).unwrap();
            }
            let (colors, depths, views) = ([&color], [&depth], [view]);
            let frame = Frame { depth: Some(&depths), ..Frame::new(&colors, &views, index) };
            rejected = post.process(&frame, &mut shown).unwrap().verdicts[Verdict::Disoccluded as usize];
        }
        rejected
    };
    assert_eq!((rejected(true), rejected(false)), (0, 64 * 64));
}

#[test]
fn vectors_without_the_cameras_motion_need_depth_and_the_camera() {
    let size = [8, 6];
    let mut desc = ContextDesc::new(size);
    desc.motion.without_camera = true;
    let still = ViewFrame::new(ViewGeometry::flat(size, 70.0).unwrap(), Gaze::Lost);
    let known = ViewFrame { previous_from_current: Some(Mat4::IDENTITY.to_cols_array_2d()), ..still };
    let flat = ViewFrame { depth: Some(DepthConvention::Orthographic { near: 0.1, far: 9.0 }), ..known };
    let process = |view, depth, reset| shown(&desc, view, depth, reset);
    let refused = |view, depth| process(view, depth, Reset::None).unwrap_err();
    assert!(refused(known, None).starts_with("depth of view 0 is None: expected given"));
    assert!(refused(still, Some(0.5)).starts_with("previous_from_current of view 0 is None: expected given"));
    assert!(refused(flat, Some(0.5)).contains("rays of an orthographic view are not known"));
    process(known, Some(0.5), Reset::None).unwrap();
    process(still, None, Reset::All).unwrap();
}

#[test]
fn a_gaze_is_the_same_in_every_form() {
    let geometry = ViewGeometry::off_axis(SIZE, [-1.2, 0.9], [-1.1, 1.0]).unwrap();
    for px in [[-0.5, -0.5], [0.0, 0.0], [800.0, 450.0], [1599.5, 899.5], [1700.0, -30.0]] {
        let uv = [(px[0] + 0.5) / 1600.0, (px[1] + 0.5) / 900.0];
        let ray = geometry.ray(px).map(|v| 3.5 * v);
        for gaze in [Gaze::At { px }, Gaze::Uv { uv }, Gaze::Direction { view: ray }] {
            let found = gaze.resolve(Some([9.0, 9.0]), &geometry);
            assert!((0..2).all(|i| (found[i] - px[i]).abs() < 1e-2), "{gaze:?}: {found:?} instead of {px:?}");
        }
    }
    // Without a position the last known one is used, and before it the middle.
    let lost = [
        Gaze::Lost,
        Gaze::At { px: [f32::NAN, 3.0] },
        Gaze::Uv { uv: [0.5, f32::INFINITY] },
        Gaze::Direction { view: [0.1, 0.2, -1.0] },
        Gaze::Direction { view: [f32::NAN; 3] },
        Gaze::Uv { uv: [0.5, 0.5] }.if_confident(0.2, 0.5),
        Gaze::Uv { uv: [0.5, 0.5] }.if_confident(f32::NAN, 0.0),
    ];
    for gaze in lost {
        assert_eq!(gaze.resolve(Some([9.0, 8.0]), &geometry), [9.0, 8.0], "{gaze:?}");
        assert_eq!(gaze.resolve(None, &geometry), [799.5, 449.5], "{gaze:?}");
    }
    // Angles stay finite.
    assert_eq!(Gaze::At { px: [1e30, -1e30] }.resolve(None, &geometry), [1e6, -1e6]);
}

#[test]
fn wrong_jitters_and_depth_conventions_are_refused() {
    let size = [8, 6];
    let good = ViewFrame::new(ViewGeometry::flat(size, 70.0).unwrap(), Gaze::Lost);
    let refusal = |view| shown(&ContextDesc::new(size), view, None, Reset::None).unwrap_err();
    for jitter_px in [[f32::NAN, 0.0], [0.0, f32::INFINITY], [17.0, 0.0]] {
        let text = refusal(ViewFrame { jitter_px, ..good });
        assert!(text.starts_with("jitter_px of view 0 is (") && text.contains("at most 16 pixels"), "{text}");
    }
    for visible_px in [[[f32::NAN; 4], [1.0; 4]], [[0.0; 4], [f32::INFINITY; 4]], [[2.0; 4], [1.0; 4]]] {
        let text = refusal(ViewFrame { visible_px: Some(visible_px), ..good });
        assert!(text.starts_with("visible_px of view 0 is [") && text.contains("the lowest first"), "{text}");
    }
    let text = refusal(ViewFrame { depth: Some(DepthConvention::Reversed { near: 0.0, far: 1.0 }), ..good });
    assert!(text.starts_with("depth convention of view 0 is near 0, far 1: expected planes"), "{text}");
    let flat = Some(DepthConvention::Orthographic { near: 0.1, far: 9.0 });
    let turned = Mat4::from_rotation_y(0.01).transpose().to_cols_array_2d();
    let text = refusal(ViewFrame { depth: flat, previous_from_current: Some(turned), ..good });
    assert!(text.contains("a camera that turns away") && text.contains("orthographic depth"), "{text}");
}
