#![cfg(feature = "lab")]
//! Analytic scenes.

use afterimage::source::FrameSource;
use afterimage::source::analytic::AnalyticSource;

#[test]
#[ignore = "writes pictures to look at"]
fn write_pictures() {
    std::fs::create_dir_all("/tmp/analytic").unwrap();
    for name in AnalyticSource::names() {
        for size in [[640, 360], [1280, 720]] {
            let mut source = AnalyticSource::new(name, size, 70.0, 60.0).unwrap();
            for index in [0, 40] {
                let start = std::time::Instant::now();
                let frame = source.frame(index).unwrap();
                println!("{name} {size:?} {index}: {:?}", start.elapsed());
                let bytes: Vec<u8> = frame
                    .color
                    .pixels()
                    .iter()
                    .flatten()
                    .map(|&c| {
                        let c = c.clamp(0.0, 1.0);
                        let s = if c <= 0.003_130_8 {
                            12.92 * c
                        } else {
                            1.055 * c.powf(1.0 / 2.4) - 0.055
                        };
                        (s * 255.0 + 0.5) as u8
                    })
                    .collect();
                image::save_buffer(
                    format!("/tmp/analytic/{name}_{}_{index}.png", size[0]),
                    &bytes,
                    size[0],
                    size[1],
                    image::ColorType::Rgb8,
                )
                .unwrap();
            }
        }
    }
}
