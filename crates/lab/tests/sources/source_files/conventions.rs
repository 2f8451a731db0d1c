//! What files leave to their readers: orientation, gamma, windows, and which layer is the picture.

use super::{ALL, folder_of, limits, patch, save, srgb, temporary};
use crate::hostile::crc32;
use afterimage_lab::source::{FrameSource, StillSource};
use exr::prelude::*;
use image::{DynamicImage, ImageBuffer, Rgb};
use std::path::Path;

fn color(path: &Path) -> afterimage::Image<[f32; 3]> {
    StillSource::open(path, &limits()).unwrap().frame(0).unwrap().color
}

/// A tag of EXIF: turned by 90 degrees, as phones write it.
#[test]
fn photographs_are_upright() {
    let (_folder, path) = temporary("a.jpg");
    let halves = ImageBuffer::from_fn(32, 16, |x, _| if x < 16 { Rgb([250_u8, 0, 0]) } else { Rgb([0, 0, 250]) });
    DynamicImage::ImageRgb8(halves).save(&path).unwrap();
    let plain = std::fs::read(&path).unwrap();
    assert_eq!(color(&path).size(), [32, 16]);
    // APP1 with an orientation (0x0112, a short) of 6: the first row is at the right.
    let exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
    let app1 = [0xff, 0xe1, 0, (exif.len() + 2) as u8];
    std::fs::write(&path, [&plain[..2], &app1, exif, &plain[2..]].concat()).unwrap();
    let turned = color(&path);
    assert_eq!(turned.size(), [16, 32]);
    let is_red = |x, y| turned.at(x, y)[0] > 0.5;
    assert!(is_red(8, 2) && !is_red(8, 30), "red was left and is on top");
}

#[test]
fn the_gamma_of_a_png_counts_unless_it_says_srgb() {
    let (_folder, path) = temporary("a.png");
    DynamicImage::ImageRgb8(ImageBuffer::from_pixel(2, 2, Rgb([128; 3]))).save(&path).unwrap();
    let plain = std::fs::read(&path).unwrap();
    let chunk = |name: &[u8; 4], data: &[u8]| {
        let checked = [&name[..], data].concat();
        [&(data.len() as u32).to_be_bytes()[..], &checked, &crc32(&checked).to_be_bytes()].concat()
    };
    let with = |chunks: &[u8]| {
        std::fs::write(&path, [&plain[..33], chunks, &plain[33..]].concat()).unwrap();
        color(&path).at(0, 0)[0]
    };
    let gamma = |gamma: u32| chunk(b"gAMA", &gamma.to_be_bytes());
    let value = 128.0 / 255.0;
    assert_eq!(with(&gamma(45_455)), srgb(value), "that of sRGB");
    assert!((with(&gamma(100_000)) - value as f32).abs() < 1e-6, "linear");
    assert_eq!(with(&[chunk(b"sRGB", &[0]), gamma(100_000)].concat()), srgb(value));
}

/// Data windows larger and smaller than the display window.
#[test]
fn overscan_is_cut_and_what_is_not_stored_is_black() {
    let folder = folder_of(1, [8, 4], ALL);
    let path = folder.path().join("frame_0000.exr");
    let whole = StillSource::open(&path, &limits()).unwrap().frame(0).unwrap().color;
    let mut bytes = std::fs::read(&path).unwrap();
    for (values, expected) in [([2, 1, 6, 3], "overscan"), ([-1, -2, 4, 5], "black")] {
        patch(&mut bytes, "displayWindow", "box2i", &values);
        std::fs::write(&path, &bytes).unwrap();
        let mut source = StillSource::open(&path, &limits()).unwrap();
        assert!(source.warnings().iter().any(|line| line.contains(expected)), "{:?}", source.warnings());
        let frame = source.frame(0).unwrap();
        assert_eq!(frame.color.size(), [values[2] - values[0] + 1, values[3] - values[1] + 1].map(|n| n as u32));
        for (y, x) in (0..frame.color.size()[1]).flat_map(|y| (0..frame.color.size()[0]).map(move |x| (y, x))) {
            let [u, v] = [x as i32 + values[0], y as i32 + values[1]];
            let is_stored = (0..8).contains(&u) && (0..4).contains(&v);
            let expected = if is_stored { whole.at(u as usize, v as usize) } else { [0.0; 3] };
            assert_eq!(frame.color.at(x as usize, y as usize), expected, "{x}, {y}");
            assert_eq!(frame.depth.as_ref().unwrap().at(x as usize, y as usize).is_finite(), is_stored);
        }
    }
}

/// Layers by rank, not by order: of Blender, of renderers' files with several parts, of stereo pictures.
#[test]
fn the_picture_is_told_from_other_layers() {
    let (_folder, path) = temporary("a.exr");
    let flat = |value: f32| FlatSamples::F32(vec![value; 16]);
    let read = |layers: &[&str]| {
        let channels = layers.iter().enumerate().flat_map(|(i, layer)| {
            let name = move |c: &str| if layer.is_empty() { c.to_owned() } else { format!("{layer}.{c}") };
            ["R", "G", "B"].map(|c| AnyChannel::new(name(c).as_str(), flat((i + 1) as f32)))
        });
        save(&path, (4, 4), Encoding::FAST_LOSSLESS, channels.collect());
        let mut source = StillSource::open(&path, &limits()).unwrap();
        let layer = layers[source.frame(0).unwrap().color.at(0, 0)[0] as usize - 1].to_owned();
        (layer, source.warnings().join("; "), source.contents().join("; "))
    };
    let cases: [(&[&str], &str, &str); 9] = [
        (&["Albedo", "Image", "Normal"], "Image", ""),
        (&["albedo", "color"], "color", ""),
        (&["AO", "View.Combined.left", "View.Combined.right"], "View.Combined.left", "two views"),
        (&["diffuse", ""], "", ""),
        (&["beauty", "chaos"], "beauty", ""),
        (&["chaos", "specular"], "chaos", ""),
        (&["take1", "take2"], "take1", "several layers"),
        (&["albedo", "depth_rgb"], "albedo", "several layers"),
        (&["Noisy Image", "albedo"], "albedo", "no layer is named"),
    ];
    for (layers, expected, warning) in cases {
        let (layer, warnings, contents) = read(layers);
        assert_eq!(layer, expected, "{layers:?}");
        assert!(warnings.contains(warning) && warnings.is_empty() == warning.is_empty(), "{layers:?}: {warnings}");
        assert!(contents.contains("channels read") && contents.contains("left out"), "{contents}");
    }
}
