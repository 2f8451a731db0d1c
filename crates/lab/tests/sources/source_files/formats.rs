//! Every supported kind of file, written here pixel by pixel and read back.

use super::{ALL, Extras, folder_of, limits, picture, srgb, temporary, vectors};
use afterimage::Image;
use afterimage_lab::source::exr_file::{ColorFormat, ExrHeader, FrameToWrite, Vectors, write};
use afterimage_lab::source::{FrameSource, SceneOptions, SequenceSource, StillSource, open};
use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use image::{DynamicImage, ImageBuffer, Luma, LumaA, Rgb, Rgba};
use std::path::Path;

fn still(path: &Path) -> afterimage_lab::frame::SourceFrame {
    let mut source = open(path.to_str().unwrap(), &limits(), &SceneOptions::default()).unwrap();
    assert!(source.info().still);
    assert_eq!(source.info().frames, Some(1));
    let first = source.frame(0).unwrap();
    let later = source.frame(1000).unwrap();
    assert_eq!(first.color, later.color);
    assert!(first.cut && !later.cut && first.motion.is_none());
    first
}

#[test]
fn png_is_decoded_exactly() {
    let (_folder, path) = temporary("a.PNG");
    let rgb8 = ImageBuffer::from_fn(256, 3, |x, y| Rgb([x as u8, 255 - x as u8, (y * 100) as u8]));
    DynamicImage::ImageRgb8(rgb8).save_with_format(&path, image::ImageFormat::Png).unwrap();
    let frame = still(&path);
    for x in 0..256usize {
        let e = [x as f64, 255.0 - x as f64, 100.0].map(|v| srgb(v / 255.0));
        assert_eq!(frame.color.at(x, 1), e);
    }

    for alpha in [65535, 3] {
        let rgba16 =
            ImageBuffer::from_fn(64, 64, |x, y| Rgba([(x * 1000) as u16, (y * 1000 + 7) as u16, 65535, alpha]));
        DynamicImage::ImageRgba16(rgba16).save_with_format(&path, image::ImageFormat::Png).unwrap();
        let frame = still(&path);
        let e = [5000.0, 9007.0, 65535.0].map(|v: f64| srgb(v / 65535.0) * (f32::from(alpha) / 65535.0));
        assert_eq!(frame.color.at(5, 9), e);
    }
}

#[test]
fn grey_counts_for_all_channels_and_transparent_pixels_are_over_black() {
    let (_folder, path) = temporary("a.png");
    let images = [
        DynamicImage::ImageLuma8(ImageBuffer::from_pixel(2, 2, Luma([128]))),
        DynamicImage::ImageLumaA8(ImageBuffer::from_pixel(2, 2, LumaA([128, 255]))),
        DynamicImage::ImageLuma16(ImageBuffer::from_pixel(2, 2, Luma([128 * 257]))),
    ];
    for image in images {
        image.save(&path).unwrap();
        let e = srgb(128.0 / 255.0);
        assert_eq!(still(&path).color.at(1, 1), [e; 3]);
    }
    DynamicImage::ImageLumaA8(ImageBuffer::from_pixel(2, 2, LumaA([128, 51]))).save(&path).unwrap();
    let source = StillSource::open(&path, &limits()).unwrap();
    assert!(source.warnings()[0].contains("over black"), "{:?}", source.warnings());
    assert_eq!(still(&path).color.at(1, 1), [srgb(128.0 / 255.0) * 0.2; 3]);
}

/// A browser, a camera or a chat may name a file as it likes.
#[test]
fn a_file_with_another_ending_is_read_by_its_first_bytes() {
    let (folder, exr) = temporary("a.exr");
    write(&exr, &FrameToWrite::color(&picture([37, 19]))).unwrap();
    let flat = DynamicImage::ImageRgb8(ImageBuffer::from_pixel(16, 8, Rgb([200, 100, 50])));
    let [png, jpeg] = ["a.png", "a.jpeg"].map(|name| folder.path().join(name));
    flat.save(&png).unwrap();
    flat.save(&jpeg).unwrap();
    let read = still(&jpeg).color;
    assert_eq!(read.size(), [16, 8]);
    for (found, wanted) in read.at(8, 4).iter().zip([200.0, 100.0, 50.0]) {
        assert!((found - srgb(wanted / 255.0)).abs() < 0.02);
    }
    for path in [exr, png, jpeg] {
        let read = still(&path).color;
        for name in ["download", "a.dat", "a.exr.part", "a.42"] {
            let other = folder.path().join(name);
            std::fs::copy(&path, &other).unwrap();
            assert!(still(&other).color == read, "{path:?} as {name}");
        }
    }
    // A known ending is believed, so that the message names what was meant.
    let broken = folder.path().join("b.png");
    std::fs::copy(folder.path().join("a.exr"), &broken).unwrap();
    for (name, expected) in [("b.png", "neither a PNG nor a JPEG"), ("text.dat", "not supported"), ("none", "exist")] {
        std::fs::write(folder.path().join("text.dat"), "words").unwrap();
        let path = folder.path().join(name);
        let error = open(path.to_str().unwrap(), &limits(), &SceneOptions::default()).err().unwrap().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn what_is_written_is_read_back() {
    let (folder, path) = temporary("f.exr");
    let size = [37, 19];
    let color = picture(size).map(|c| c.map(|v| v * 1.001));
    let depth = Image::from_fn(size, |[x, y]| 0.1 + (x * y) as f32);
    let (motion, to_next) = (vectors(size, 0.3), vectors(size, -7.0));
    let frame = FrameToWrite { depth: Some(&depth), motion: Some(&motion), ..FrameToWrite::color(&color) };
    let frame = FrameToWrite { format: ColorFormat::Float, motion_to_next: Some(&to_next), ..frame };
    write(&path, &frame).unwrap();
    let header = ExrHeader::open(&path, &limits()).unwrap();
    let read = header.read(Vectors::ToPrevious).unwrap();
    assert_eq!(read.color, color);
    assert_eq!(read.depth.as_ref(), Some(&depth));
    assert_eq!(read.motion.as_ref(), Some(&motion));
    assert_eq!(header.read(Vectors::ToNext).unwrap().motion.as_ref(), Some(&to_next));
    assert!(header.read(Vectors::Skip).unwrap().motion.is_none());

    let first = std::fs::read(&path).unwrap();
    write(&path, &frame).unwrap();
    assert_eq!(first, std::fs::read(&path).unwrap(), "not reproducible");
    let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(files.len(), 1, "a temporary file was left behind");
}

#[test]
fn half_output_clamps_and_a_failed_write_leaves_the_old_file() {
    let (folder, path) = temporary("f.exr");
    let color = Image::filled([3, 2], [1e9f32, -1e9, f32::INFINITY]);
    write(&path, &FrameToWrite::color(&color)).unwrap();
    let read = still(&path);
    assert_eq!(read.color.at(0, 0), [65504.0, -65504.0, 65504.0]);
    assert_eq!(read.nonfinite, 0);

    let depth = Image::filled([3, 3], 1.0f32);
    let frame = FrameToWrite { depth: Some(&depth), ..FrameToWrite::color(&color) };
    let e = write(&path, &frame).unwrap_err().to_string();
    assert!(e.contains("size"), "{e}");
    assert_eq!(still(&path).color, read.color);
    let nowhere = folder.path().join("none/f.exr");
    let e = write(&nowhere, &FrameToWrite::color(&color)).unwrap_err();
    assert_eq!(e.kind(), std::io::ErrorKind::NotFound, "{e}");
}

#[test]
fn broken_numbers_are_counted_or_marked() {
    let folder = tempfile::tempdir().unwrap();
    let size = [4, 2];
    let mut color = picture(size);
    color.pixels_mut()[1][2] = f32::NAN;
    color.pixels_mut()[5][0] = f32::NEG_INFINITY;
    color.pixels_mut()[5][1] = f32::NAN;
    let values = [0.0, -1.0, f32::NAN, f32::INFINITY, 1e10, 2.0, 1e-30, -0.0];
    let depth = Image::from_pixels(size, values.to_vec()).unwrap();
    let mut motion = vectors(size, 0.0);
    motion.pixels_mut()[3] = [f32::NAN, 1.0];
    let frame = FrameToWrite { depth: Some(&depth), motion: Some(&motion), ..FrameToWrite::color(&color) };
    let frame = FrameToWrite { format: ColorFormat::Float, ..frame };
    for i in 0..2 {
        write(&folder.path().join(format!("{i}.exr")), &frame).unwrap();
    }
    let mut source = SequenceSource::open(folder.path(), &limits()).unwrap();
    let frame = source.frame(1).unwrap();
    assert_eq!(frame.nonfinite, 2);
    assert_eq!([(1, 0), (1, 1), (2, 1)].map(|(x, y)| frame.color.at(x, y)), [[0.0; 3], [0.0; 3], color.at(2, 1)]);
    let read = frame.depth.unwrap();
    let marked: Vec<bool> = read.pixels().iter().map(|z| z.is_nan()).collect();
    assert_eq!(marked, [true, true, true, false, false, false, false, true]);
    assert!(frame.motion.unwrap().at(3, 0)[0].is_nan());
}

fn channel(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel::new(name, samples)
}

fn ramp(n: usize, scale: f32) -> FlatSamples {
    FlatSamples::F32((0..n).map(|i| i as f32 * scale).collect())
}

#[test]
fn several_parts_and_grey() {
    let (_folder, path) = temporary("f.exr");
    let (w, h) = (9usize, 5usize);
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::UNCOMPRESSED };
    let part = |name: &str, channels: Vec<AnyChannel<FlatSamples>>| {
        let channels = AnyChannels::sort(SmallVec::from_vec(channels));
        Layer::new((w, h), LayerAttributes::named(name), encoding, channels)
    };
    let n = w * h;
    let parts = vec![
        part("v.Noisy Image", ["R", "G", "B"].map(|c| channel(c, ramp(n, 9.0))).into()),
        part("v.Depth", vec![channel("Z", ramp(n, 3.0))]),
        part("v.Vector", ["X", "Y", "Z", "W"].map(|c| channel(c, ramp(n, 4.0))).into()),
        part("v.Combined", ["R", "G", "B"].map(|c| channel(c, ramp(n, 1.0))).into()),
    ];
    let attributes = ImageAttributes::new(attribute::IntegerBounds::from_dimensions((w, h)));
    exr::prelude::Image::from_layers(attributes, parts).write().to_file(&path).unwrap();
    let header = ExrHeader::open(&path, &limits()).unwrap();
    let frame = header.read(Vectors::ToNext).unwrap();
    assert_eq!(frame.color.at(2, 1), [11.0; 3]);
    assert_eq!(frame.depth.unwrap().at(2, 1), 33.0);
    assert_eq!(frame.motion.unwrap().at(2, 1), [-44.0, 44.0]);
    let before = header.read(Vectors::ToPrevious).unwrap().motion.unwrap();
    assert_eq!(before.at(2, 1), [44.0, -44.0]);

    let grey = part("", vec![channel("Y", ramp(n, 1.0))]);
    exr::prelude::Image::from_layer(grey).write().to_file(&path).unwrap();
    assert_eq!(still(&path).color.at(3, 2), [21.0; 3]);
}

#[test]
fn plain_vectors_are_taken_as_they_are_and_turn_round() {
    let folder = folder_of(3, [8, 4], ALL);
    let mut source = SequenceSource::open(folder.path(), &limits()).unwrap();
    for (index, offset) in [(1, 1.0), (2, 1.0), (3, 3.0), (4, 3.0), (5, 1.0)] {
        assert_eq!(source.frame(index).unwrap().motion, Some(vectors([8, 4], offset)));
    }
    assert_eq!(source.info().fps, None);
    assert!(source.frame(1).unwrap().previous_from_current.is_none());
}

#[test]
fn one_frame_in_a_folder_is_a_still_and_depth_is_optional() {
    let extras = Extras { depth: false, ..ALL };
    let folder = folder_of(1, [8, 4], extras);
    let name = folder.path().to_str().unwrap();
    std::fs::write(folder.path().join(".frame_0001.exr"), b"hidden").unwrap();
    let cameras = r#"{"fps": 24, "horizontal_fov_deg": 50.5, "width": 8, "height": 4}"#;
    std::fs::write(folder.path().join("cameras.json"), cameras).unwrap();
    let mut source = open(name, &limits(), &SceneOptions::default()).unwrap();
    let frame = source.frame(7).unwrap();
    assert!(frame.depth.is_none() && frame.motion.is_none());
    let info = source.info();
    assert!(info.still && info.name == name);
    assert_eq!((info.fps, info.hfov_deg), (Some(24.0), Some(50.5)));
    let file = folder.path().join("frame_0000.exr");
    let alone = StillSource::open(&file, &limits()).unwrap();
    assert_eq!(alone.info().hfov_deg, Some(50.5));
}

/// A still of one color, with these attributes.
fn with_attributes(path: &Path, color: [f32; 3], change: impl FnOnce(&mut Header)) {
    let channel = |(name, v): (&str, f32)| AnyChannel::new(name, FlatSamples::F32(vec![v; 8 * 4]));
    let channels = ["B", "G", "R"].into_iter().zip([color[2], color[1], color[0]]).map(channel).collect();
    let layer = Layer::new((8, 4), LayerAttributes::default(), Encoding::UNCOMPRESSED, AnyChannels { list: channels });
    let mut image = exr::prelude::Image::from_layer(layer);
    let mut header = Header::new("".into(), (8, 4), SmallVec::new());
    change(&mut header);
    image.attributes = ImageAttributes { display_window: image.attributes.display_window, ..header.shared_attributes };
    image.layer_data.attributes = header.own_attributes;
    image.write().to_file(path).unwrap();
}

type Header = exr::meta::header::Header;

#[test]
fn colors_of_other_primaries_become_those_of_rec_709() {
    let (_folder, path) = temporary("a.exr");
    let stated = |values: [[f32; 2]; 4]| {
        let [red, green, blue, white] = values.map(|v| Vec2(v[0], v[1]));
        Chromaticities { red, green, blue, white }
    };
    let ap1 = stated([[0.713, 0.293], [0.165, 0.83], [0.128, 0.044], [0.32168, 0.33767]]);
    let rec_709 = stated([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]);
    let read = |color, change: &dyn Fn(&mut Header)| {
        with_attributes(&path, color, change);
        let header = ExrHeader::open(&path, &limits()).unwrap();
        (header.read(Vectors::Skip).unwrap().color.at(3, 2), header.warnings().join(" "))
    };
    let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3);
    let color = [0.2, 0.5, 0.1];
    // The matrix that the ACES project publishes for ACEScg to linear Rec. 709.
    let converted = [
        1.7051 * 0.2 - 0.6218 * 0.5 - 0.0833 * 0.1,
        -0.1303 * 0.2 + 1.1408 * 0.5 - 0.0105 * 0.1,
        -0.0240 * 0.2 - 0.1290 * 0.5 + 1.1530 * 0.1,
    ];
    let by_chromaticities = read(color, &|header| header.shared_attributes.chromaticities = Some(ap1));
    let by_name = read(color, &|header| {
        header.own_attributes.other.insert("colorInteropID".into(), AttributeValue::Text("lin_ap1_scene".into()));
    });
    for (found, warning) in [by_chromaticities, by_name] {
        assert!(close(found, converted) && warning.contains("ACEScg") && warning.contains("Rec. 709"), "{found:?}");
    }
    for chromaticities in [Some(rec_709), None] {
        let (found, warning) = read(color, &|header| header.shared_attributes.chromaticities = chromaticities);
        assert_eq!((found, warning.as_str()), (color, ""));
    }
    // Out of Rec. 709's gamut, no color is negative; white is white.
    let (green, _) = read([0.0, 1.0, 0.0], &|header| header.shared_attributes.chromaticities = Some(ap1));
    assert!(green.iter().all(|v| *v >= 0.0) && green[1] > 1.0, "{green:?}");
    let (white, _) = read([0.7; 3], &|header| header.shared_attributes.chromaticities = Some(ap1));
    assert!(close(white, [0.7; 3]), "{white:?}");
}

#[test]
fn pixel_aspect_is_doubted_and_a_sequence_has_its_frame_rate() {
    let (folder, path) = temporary("f_0001.exr");
    with_attributes(&path, [0.5; 3], |header| header.shared_attributes.pixel_aspect = 2.0);
    let wide = StillSource::open(&path, &limits()).unwrap();
    assert!(wide.warnings()[0].contains("2 times as wide") && wide.warnings().len() == 1, "{:?}", wide.warnings());
    with_attributes(&path, [0.5; 3], |header| header.shared_attributes.pixel_aspect = 1.0);
    assert_eq!(StillSource::open(&path, &limits()).unwrap().warnings(), [""; 0]);
    let fps = |rate: Option<(i32, u32)>, cameras: &str| {
        for i in 1..=2 {
            let path = folder.path().join(format!("f_{i:04}.exr"));
            let vectors = [("motion.X", 0.0), ("motion.Y", 0.0)].map(|(name, v)| (name, vec![v; 4]));
            let colors = ["B", "G", "R"].map(|name| (name, vec![0.5f32; 4]));
            let channel = |(name, values)| AnyChannel::new(name, FlatSamples::F32(values));
            let list = colors.into_iter().chain(vectors).map(channel).collect();
            let attributes = LayerAttributes { frames_per_second: rate, ..LayerAttributes::default() };
            let layer = Layer::new((2, 2), attributes, Encoding::UNCOMPRESSED, AnyChannels { list });
            exr::prelude::Image::from_layer(layer).write().to_file(path).unwrap();
        }
        let json = folder.path().join("cameras.json");
        if cameras.is_empty() {
            drop(std::fs::remove_file(json))
        } else {
            std::fs::write(json, cameras).unwrap()
        }
        SequenceSource::open(folder.path(), &limits()).unwrap().info().fps
    };
    assert_eq!(fps(Some((24000, 1001)), ""), Some((24000.0 / 1001.0) as f32));
    // What no camera runs at is none.
    assert_eq!([fps(None, ""), fps(Some((25, 0)), ""), fps(Some((-25, 1)), "")], [None; 3]);
    assert_eq!(fps(Some((25, 1)), r#"{"fps": 48}"#), Some(48.0));
}

#[test]
fn a_compression_newer_than_the_decoder_is_named() {
    let (_folder, path) = temporary("a.exr");
    write(&path, &FrameToWrite::color(&picture([8, 4]))).unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let attribute = b"compression\0compression\0\x01\0\0\0";
    let at = bytes.windows(attribute.len()).position(|window| window == attribute).unwrap() + attribute.len();
    for (code, expected) in [(13, "not supported (number 13"), (12, "number 12")] {
        bytes[at] = code;
        std::fs::write(&path, &bytes).unwrap();
        let error = ExrHeader::open(&path, &limits()).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("write it with ZIP"), "{error}");
    }
    // Other damage is no compression.
    bytes[at] = 3;
    bytes.truncate(at + 20);
    std::fs::write(&path, &bytes).unwrap();
    let error = ExrHeader::open(&path, &limits()).unwrap_err().to_string();
    assert!(!error.contains("compression"), "{error}");
}
