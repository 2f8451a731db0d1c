//! Motion vectors as engines write them: each engine's formula, for a point that moves under a moving camera.

use afterimage::{MotionConvention, MotionDirection};
use afterimage_testing::Draws;
use glam::camera::rh::proj::directx;
use glam::camera::rh::view::look_to_mat4;
use glam::{Vec2, Vec3, Vec4};

const SIZE: [u32; 2] = [1920, 1080];

/// Clip positions of a point now and in the previous frame.
fn clips(draws: &mut Draws) -> [Vec4; 2] {
    let projection = directx::perspective_infinite_reverse(1.1, 16.0 / 9.0, 0.1);
    let mut number = |low, high| draws.range(low, high);
    let mut point = Vec3::new(number(-3.0, 3.0), number(-2.0, 2.0), number(-12.0, -4.0));
    [0, 1].map(|_| {
        let eye = Vec3::new(number(-0.2, 0.2), number(-0.2, 0.2), number(-0.2, 0.2));
        let view = look_to_mat4(eye, Vec3::new(number(-0.1, 0.1), number(-0.1, 0.1), -1.0), Vec3::Y);
        point += Vec3::new(number(-0.1, 0.1), number(-0.1, 0.1), 0.0);
        projection * view * point.extend(1.0)
    })
}

/// Position in pixels, y down, of a clip position with y up.
fn pixel(clip: Vec4) -> Vec2 {
    let ndc = clip.truncate().truncate() / clip.w;
    Vec2::new(0.5 * ndc.x + 0.5, 0.5 - 0.5 * ndc.y) * Vec2::new(SIZE[0] as f32, SIZE[1] as f32)
}

/// What each engine's shader writes for clip positions now and before.
fn written(convention: &str, now: Vec4, before: Vec4) -> Vec2 {
    let (ndc, ndc_before) = (now.truncate().truncate() / now.w, before.truncate().truncate() / before.w);
    match convention {
        // bevy_pbr, prepass.wgsl: (clip - previous) * vec2(0.5, -0.5), after the division by w.
        "BEVY" => (ndc - ndc_before) * Vec2::new(0.5, -0.5),
        // Difference of (ndc + 1) / 2, with y flipped in both where textures start at the top.
        "UNITY" => {
            let uv = |p: Vec2| Vec2::new((p.x + 1.0) / 2.0, 1.0 - (p.y + 1.0) / 2.0);
            uv(ndc) - uv(ndc_before)
        }
        // Calculate3DVelocity: ScreenPos - PrevScreenPos.
        "UNREAL" => ndc - ndc_before,
        // Pixels, from this frame's position to the previous one's.
        "FSR2" => pixel(before) - pixel(now),
        // Vector pass, channels X and Y: from this frame's position to the previous one's in pixels, y up.
        "BLENDER" => (pixel(before) - pixel(now)) * Vec2::new(1.0, -1.0),
        other => panic!("{other}"),
    }
}

#[test]
fn each_engines_vectors_lead_to_the_previous_position() {
    let conventions = [
        ("BEVY", MotionConvention::BEVY),
        ("UNITY", MotionConvention::UNITY),
        ("UNREAL", MotionConvention::UNREAL),
        ("FSR2", MotionConvention::FSR2),
        ("BLENDER", MotionConvention::BLENDER),
    ];
    let mut draws = Draws::new("engines");
    for _ in 0..200 {
        let [before, now] = clips(&mut draws);
        let moved = pixel(before) - pixel(now);
        for (name, convention) in conventions {
            let vector = written(name, now, before);
            let converted = vector * Vec2::from(convention.to_internal(SIZE));
            assert!((converted - moved).length() < 2e-3, "{name}: {converted} instead of {moved}");
            // The planted error: the other direction.
            let direction = match convention.direction {
                MotionDirection::PreviousMinusCurrent => MotionDirection::CurrentMinusPrevious,
                MotionDirection::CurrentMinusPrevious => MotionDirection::PreviousMinusCurrent,
            };
            let wrong = vector * Vec2::from(MotionConvention { direction, ..convention }.to_internal(SIZE));
            assert!((wrong - moved).length() > moved.length(), "{name}");
        }
    }
}
