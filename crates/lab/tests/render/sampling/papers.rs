//! Sampling patterns against the numbers in their papers.

use afterimage::ViewGeometry;
use afterimage_lab::trace::sampling::{Lattice, Layers, Regions, Sampling};

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

#[test]
fn halved_radii_take_a_quarter_of_the_inner_samples() {
    let geometry = display();
    let half = Regions { radius_scale: 0.5, ..Regions::default() };
    let [a, b] = [Regions::default(), half].map(|r| r.radii_px(&geometry)[0]);
    assert!((a / b - 2.0).abs() < 1e-5);
    assert!(half.ideal_samples(&geometry) < Regions::default().ideal_samples(&geometry));
}

#[test]
fn one_sample_everywhere_is_every_pixel_once() {
    let geometry = ViewGeometry::flat([37, 23], 70.0).unwrap();
    assert_eq!(Sampling::Uniform.plan(&geometry, [5.0, 5.0], 3, 0).samples(), [37 * 23 * 3]);
}

#[test]
fn lattices_pass_through_the_gaze() {
    for step in 1..=4 {
        for gaze in [[0.0, 0.0], [100.4, 50.6], [639.0, 359.0], [-20.0, 900.0]] {
            let lattice = Lattice::through(step, gaze, [640, 360]);
            for axis in 0..2 {
                let off = (gaze[axis].round() - lattice.first_px[axis]).rem_euclid(step as f32);
                assert_eq!(off, 0.0, "step {step}, gaze {gaze:?}");
                let last = lattice.first_px[axis] + ((lattice.points[axis] - 1) * step) as f32;
                assert!(
                    lattice.first_px[axis] >= 0.0
                        && last <= [639.0, 359.0][axis]
                        && last + step as f32 > [639.0, 359.0][axis]
                );
            }
        }
    }
}

#[test]
fn a_lens_leaves_the_corners_untraced() {
    let geometry = ViewGeometry::flat([400, 400], 90.0).unwrap();
    let gaze = [199.5, 199.5];
    let screen = Sampling::Layers(Layers::default()).plan(&geometry, gaze, 4, 0).samples();
    let lens =
        Sampling::Layers(Layers { lens_deg: Some(45.0), ..Layers::default() }).plan(&geometry, gaze, 4, 0).samples();
    assert_eq!(screen[..3], lens[..3]);
    // The circle that touches the frame's edges contains pi/4 of the background's lattice; three more steps around it
    // are sampled.
    assert!(lens[3] < screen[3] * 7 / 8, "{lens:?} of {screen:?}");
}

#[test]
fn a_gaze_in_the_corner_takes_fewer_samples() {
    let geometry = ViewGeometry::flat([640, 360], 90.0).unwrap();
    for sampling in [Sampling::Regions(Regions::default()), Sampling::Layers(Layers::default())] {
        let count = |gaze| sampling.plan(&geometry, gaze, 4, 0).samples().iter().sum::<u64>();
        assert!(count([0.0, 0.0]) < count([320.0, 180.0]), "{sampling:?}");
    }
}
