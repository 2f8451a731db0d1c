//! CPU time of JOD a frame: `cargo research jod-cost [THREADS]`, ten seconds.
//! Prints the time of a frame with one test, which includes preparing the reference, and that of each further test.

use crate::error::AnyError;
use afterimage::{Image, ViewGeometry};
use afterimage_eval::clock::Stopwatch;
use afterimage_metric::{Display, ReferenceVideo, TestVideo, Viewing};
use afterimage_program::say;
use clap::Args;

const FRAMES: usize = 40;

/// CPU time of JOD a frame
#[derive(Args, Clone, Debug)]
pub struct JodCostArgs {
    /// Threads; default: one a core
    pub threads: Option<usize>,
}

pub fn bench(args: &JodCostArgs) -> Result<(), AnyError> {
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    say!("| size, fps | CPU ms a frame, one test | each further test | resident memory, most so far |");
    say!("|---|---|---|---|");
    for (size, fps) in [([640, 360], 60.0), ([1920, 1080], 60.0), ([1920, 1080], 90.0)] {
        let geometry = ViewGeometry::flat(size, 70.0)?;
        let mut reference = ReferenceVideo::new(Viewing { geometry, display: Display::default(), fps });
        let mut videos = [TestVideo::default(), TestVideo::default()];
        let mut times = [0.0; 2];
        for i in 0..FRAMES {
            let picture =
                |a: u32| Image::from_fn(size, |[x, y]| [((x * 7 + y * 13 + a + 3 * i as u32) % 251) as f32 / 250.0; 3]);
            let (full, shown) = (picture(0), picture(2));
            let clock = Stopwatch::start();
            let frame = reference.push(&full, Some([0.3 * size[0] as f32, 0.4 * size[1] as f32]));
            videos[0].push(&frame, &shown);
            let one = clock.cpu_ms().ok_or("no CPU time on this platform")?;
            let clock = Stopwatch::start();
            videos[1].push(&frame, &shown);
            let two = clock.cpu_ms().ok_or("no CPU time on this platform")?;
            // The first frames fill the memory.
            if i >= FRAMES / 2 {
                times[0] += one;
                times[1] += two;
            }
        }
        let [one, further] = times.map(|ms| ms / (FRAMES / 2) as f64);
        let memory_mib = resident_mib().map_or("-".to_owned(), |mib| format!("{mib:.0} MiB"));
        say!("| {}x{}, {fps} | {one:.1} | {further:.1} | {memory_mib} |", size[0], size[1]);
    }
    Ok(())
}

/// Resident memory of the process in MiB, on Linux.
fn resident_mib() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}
