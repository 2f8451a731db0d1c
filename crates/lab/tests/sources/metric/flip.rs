//! FLIP against NVIDIA's own implementation (`fixtures/flip.csv`, written by `fixtures/flip.py`) and its properties.

use afterimage::{Image, ViewGeometry};
use afterimage_lab::metric::Flip;
use afterimage_testing::Draws;
use approx::assert_abs_diff_eq;

type Picture = Image<[f32; 3]>;

const SIZE: [u32; 2] = [96, 64];

fn picture(f: impl Fn(u32, u32) -> [u32; 3]) -> Picture {
    Image::from_fn(SIZE, |[x, y]| f(x, y).map(|v| v as f32 / 255.0))
}

fn hash(x: u32, y: u32, salt: u32) -> [u32; 3] {
    let h = x.wrapping_mul(0x9E37_79B1);
    let h = h.wrapping_add(y.wrapping_mul(0x85EB_CA77)).wrapping_add(salt.wrapping_mul(0xC2B2_AE3D));
    let h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    let h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    let h = h ^ (h >> 15);
    [h & 255, h >> 8 & 255, h >> 16 & 255]
}

fn gradient(x: u32, y: u32) -> [u32; 3] {
    [x * 255 / 95, y * 255 / 63, (x + y) * 255 / 158]
}

fn checker(x: u32, y: u32) -> [u32; 3] {
    if (x / 4 + y / 4) % 2 == 1 { [200, 60, 40] } else { [30, 120, 220] }
}

/// The image pairs of `fixtures/flip.py`.
fn pair(name: &str) -> [Picture; 2] {
    let grain = |x, y| {
        let (base, grain) = (gradient(x, y), hash(x, y, 1));
        [0, 1, 2].map(|i| (base[i] + grain[i] / 8).saturating_sub(16).min(255))
    };
    match name {
        "gradient_grain" => [picture(gradient), picture(grain)],
        "checker_shifted" => [picture(checker), picture(|x, y| checker(x + 1, y))],
        "noise_gradient" => [picture(|x, y| hash(x, y, 2)), picture(gradient)],
        "noise_noise" => [picture(|x, y| hash(x, y, 3)), picture(|x, y| hash(x, y, 4))],
        "black_white" => [picture(|_, _| [0; 3]), picture(|_, _| [255; 3])],
        "grey_lighter" => [picture(|_, _| [128; 3]), picture(|_, _| [144; 3])],
        name => panic!("{name}: no such pair"),
    }
}

fn mean(map: &Image<f32>) -> f64 {
    map.pixels().iter().map(|&v| f64::from(v)).sum::<f64>() / map.pixels().len() as f64
}

/// A line of the table: pair, pixels per degree, mean, and the map at six positions.
fn published() -> Vec<(String, f32, Vec<f64>)> {
    let table = include_str!("../../../../../fixtures/flip.csv");
    let line = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let figures = cells[2..].iter().map(|v| v.parse().unwrap()).collect();
        (cells[0].to_owned(), cells[1].parse().unwrap(), figures)
    };
    table.lines().skip(1).map(line).collect()
}

const PLACES: [(usize, usize); 6] = [(0, 0), (95, 63), (48, 32), (13, 50), (77, 9), (95, 20)];

#[test]
fn flip_is_nvidias_own() {
    let table = published();
    assert_eq!(table.len(), 18);
    let (mut of_means, mut of_maps) = (0.0_f64, 0.0_f64);
    for (name, ppd, figures) in table {
        let [reference, shown] = pair(&name);
        let map = Flip::new(ppd).map(&reference, &shown);
        let off = (mean(&map) - figures[0]).abs();
        of_means = of_means.max(off);
        assert!(off < 1e-4, "{name} at {ppd}: {} against {}", mean(&map), figures[0]);
        for ((x, y), expected) in PLACES.iter().zip(&figures[1..]) {
            let off = (f64::from(map.at(*x, *y)) - expected).abs();
            of_maps = of_maps.max(off);
            assert!(off < 1e-3, "{name} at {ppd}, ({x}, {y}): {} against {expected}", map.at(*x, *y));
        }
    }
    println!("largest differences: of means {of_means:.1e}, of the maps {of_maps:.1e}");
}

/// Every pixel: `python3 fixtures/flip.py FOLDER`, then
/// `FLIP_MAPS=FOLDER cargo test -p afterimage-lab --test sources -- --ignored flip_maps`.
#[test]
#[ignore = "needs maps that NVIDIA's implementation wrote"]
fn flip_maps_are_nvidias_own() {
    let folder = std::path::PathBuf::from(std::env::var_os("FLIP_MAPS").expect("FLIP_MAPS is the folder of the maps"));
    for (name, ppd, _) in published() {
        let ppd_in_name = if ppd.fract() == 0.0 { format!("{ppd:.1}") } else { ppd.to_string() };
        let bytes = std::fs::read(folder.join(format!("{name}_{ppd_in_name}.f32"))).unwrap();
        let expected = bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap()));
        let [reference, shown] = pair(&name);
        let map = Flip::new(ppd).map(&reference, &shown);
        let off = map.pixels().iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        println!("{name} at {ppd}: largest difference {off:.1e}");
        assert!(off < 1e-3);
    }
}

#[test]
fn flip_of_equal_pictures_is_0_and_of_black_and_white_alike_both_ways() {
    let flip = Flip::new(67.02);
    let [noise, gradient] = pair("noise_gradient");
    for picture in [&noise, &gradient] {
        assert!(flip.map(picture, picture).pixels().iter().all(|&v| v == 0.0));
    }
    let [black, white] = pair("black_white");
    let (there, back) = (flip.map(&black, &white), flip.map(&white, &black));
    assert_eq!(there, back);
    // HyAB is 100 here, above the knee. The largest difference is between green and blue, with L*a*b* values from
    // textbooks.
    let hunt = |[l, a, b]: [f64; 3]| [l, 0.01 * l * a, 0.01 * l * b];
    let (green, blue) = (hunt([87.737, -86.185, 83.181]), hunt([32.303, 79.197, -107.864]));
    let hyab = (green[0] - blue[0]).abs() + (green[1] - blue[1]).hypot(green[2] - blue[2]);
    let (d, largest) = (100_f64.powf(0.7), hyab.powf(0.7));
    let expected = 0.95 + (d - 0.4 * largest) / (0.6 * largest) * 0.05;
    assert_abs_diff_eq!(mean(&there), expected, epsilon = 2e-4);
    // Noise has features; their difference is symmetric.
    assert_eq!(flip.map(&noise, &gradient), flip.map(&gradient, &noise));
}

#[test]
fn flip_grows_with_the_error_and_falls_with_distance() {
    let flip = Flip::new(20.0);
    let [gradient, _] = pair("gradient_grain");
    let mut draws = Draws::new("flip");
    let grain = Image::from_fn(SIZE, |_| [0; 3].map(|_: u32| draws.range(-1.0, 1.0)));
    let with = |strength: f32| {
        let mut i = 0;
        gradient.map(|c| {
            i += 1;
            [0, 1, 2].map(|k| (c[k] + strength * grain.pixels()[i - 1][k]).clamp(0.0, 1.0))
        })
    };
    let by_strength = [0.0, 0.02, 0.05, 0.1, 0.2, 0.4].map(|s| mean(&flip.map(&gradient, &with(s))));
    println!("by strength: {by_strength:.4?}");
    assert!(by_strength.is_sorted() && by_strength[0] == 0.0 && by_strength[1] > 0.01);
    let noisy = with(0.2);
    let by_distance = [5.0, 10.0, 20.0, 40.0, 80.0].map(|ppd| mean(&Flip::new(ppd).map(&gradient, &noisy)));
    println!("by pixels a degree: {by_distance:.4?}");
    assert!(by_distance.is_sorted_by(|a, b| a > b));
}

#[test]
fn flip_of_any_size_and_distance_is_a_number() {
    for size in [[1, 1], [1, 9], [9, 1], [3, 2]] {
        let (a, b) = (Image::filled(size, [0.2, 0.5, 0.9]), Image::filled(size, [0.3; 3]));
        for ppd in [0.0, 0.3, 1.0, 1.7, 60.0, 1e9, f32::NAN] {
            let map = Flip::new(ppd).map(&a, &b);
            assert!(map.pixels().iter().all(|v| (0.0..=1.0).contains(v)), "{size:?} at {ppd}");
        }
    }
    // 640 pixels over 70 degrees are 7.98 per degree in the middle.
    let view = ViewGeometry::flat([640, 360], 70.0).unwrap();
    assert_abs_diff_eq!(Flip::for_view(&view).pixels_per_degree(), 7.98, epsilon = 5e-3);
}
