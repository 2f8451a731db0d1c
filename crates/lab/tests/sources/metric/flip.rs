//! FLIP against NVIDIA's own implementation (`fixtures/flip.csv`, written by `fixtures/flip.py`) and its properties.

use afterimage::Image;
use afterimage_lab::metric::Flip;

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
