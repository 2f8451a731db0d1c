//! Sampling patterns against the numbers in their papers.

use afterimage::ViewGeometry;
use afterimage_trace::sampling::{Regions, Sampling};

/// The paper's display: 3840x2160 pixels on 70.848 x 39.852 cm, at 60 cm.
fn display() -> ViewGeometry {
    let half_width = 70.848 / 2.0 / 60.0;
    let half_height = 39.852 / 2.0 / 60.0;
    ViewGeometry::off_axis([3840, 2160], [-half_width, half_width], [-half_height, half_height]).unwrap()
}

#[test]
fn radii_are_the_papers() {
    let [fovea, middle] = Regions::default().radii_px(&display());
    // The paper rounds down to 147 and 482, from angles it rounds itself.
    assert!((fovea - 147.6).abs() < 0.2, "{fovea}");
    assert!((middle - 486.0).abs() < 0.5, "{middle}");
}

#[test]
fn ideal_samples_are_the_papers() {
    // The paper's radii instead of its angles.
    let angle = |px: f32| 2.0 * (px / 3840.0 * 70.848 / 60.0).atan().to_degrees();
    let paper = Regions { diameters_deg: [angle(147.0), angle(482.0)], ..Regions::default() };
    for (samples, millions) in [([32, 16, 8], 8.60), ([32, 8, 4], 5.39), ([32, 2, 1], 2.98)] {
        let count = Regions { samples, ..paper }.ideal_samples(&display()) * 1e-6;
        assert!((count - millions).abs() < 0.006, "{samples:?}: {count:.3} million");
    }
}

#[test]
fn samples_are_the_ideal_ones_and_those_of_borders() {
    let geometry = display();
    let center = [1919.5, 1079.5];
    for samples in [[32, 16, 8], [32, 8, 4], [32, 2, 1]] {
        let regions = Regions { samples, ..Regions::default() };
        let counts = Sampling::Regions(regions).plan(&geometry, center, 32, 0).samples();
        let (sum, ideal) = (counts.iter().sum::<u64>() as f64, regions.ideal_samples(&geometry));
        println!("{samples:?}: {counts:?}, {:.1} % above the ideal {ideal:.0}", (sum / ideal - 1.0) * 100.0);
        // The excess: blends over two blocks, and neighbours read by linear interpolation.
        assert!(sum > ideal && sum < 1.13 * ideal, "{samples:?}: {sum} of {ideal}");
    }
}
