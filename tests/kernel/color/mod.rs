//! CIE Lab, Delta E 94 and the gate that uses them: f32 kernels against f64; hard cases H20, H32, H34-H36 and H40.

mod difference;
mod gate;

use afterimage::kernel::wrs;
use afterimage::kernel::wrs::GateCode;
use afterimage::kernel::{color, lab};
use afterimage_testing::Draws;
use approx::assert_abs_diff_eq;
use glam::{DVec3, Vec3};

const DELTA_E: GateCode = GateCode::DeltaE94;

/// All colors of 17 sRGB codes a channel.
fn srgb_grid() -> Vec<Vec3> {
    let level = |i: u32| color::srgb_decode(i as f32 / 16.0);
    (0..17 * 17 * 17).map(|i| Vec3::new(level(i % 17), level(i / 17 % 17), level(i / 289))).collect()
}

fn lab64(c: DVec3) -> DVec3 {
    // BT.709 primaries and the white point x = 0.3127, y = 0.3290, solved in exact fractions.
    let x = 0.412_390_799_3 * c.x + 0.357_584_339_4 * c.y + 0.180_480_788_4 * c.z;
    let y = 0.212_639_005_9 * c.x + 0.715_168_678_8 * c.y + 0.072_192_315_4 * c.z;
    let z = 0.019_330_818_7 * c.x + 0.119_194_779_8 * c.y + 0.950_532_152_2 * c.z;
    let f = |t: f64| {
        if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
    };
    let (fx, fy, fz) = (f(x / 0.950_455_927_1), f(y), f(z / 1.089_057_750_8));
    DVec3::new(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz))
}

fn delta_e94_64(r: DVec3, s: DVec3) -> f64 {
    let d = r - s;
    let c1 = r.y.hypot(r.z);
    let c2 = s.y.hypot(s.z);
    let dc = c1 - c2;
    let dh2 = (d.y * d.y + d.z * d.z - dc * dc).max(0.0);
    let (sc, sh) = (1.0 + 0.045 * c1, 1.0 + 0.015 * c1);
    (d.x * d.x + (dc / sc).powi(2) + dh2 / (sh * sh)).sqrt()
}
