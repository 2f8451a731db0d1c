//! Running JOD of each side. A thread scores bursts of consecutive frames at the rate at which they were shown: frames
//! picked here and there would turn fast flicker into slow flicker, which is seen more. The next burst is recorded when
//! the last one is scored, so that one burst is held.

use super::burst::{Burst, BurstRecorder};
use crate::failure::Failure;
use afterimage::ViewGeometry;
use afterimage::wgpu::Texture;
use afterimage_lab::device::Headless;
use afterimage_metric::{Display, ReferenceVideo, TestVideo, Viewing};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::mpsc::{Receiver, Sender, channel};

/// JOD of what is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningJod {
    /// Mean of the frames that are counted, for each side.
    pub sides: Vec<f64>,
    /// Rate of the frames.
    pub fps: f32,
}

/// Measures the JOD of the sides.
pub struct Jod {
    recorder: BurstRecorder,
    /// One thread, so that the metric leaves the other cores to the viewer.
    pool: ThreadPool,
    scoring: Option<Scoring>,
    last: Option<RunningJod>,
}

/// A burst that is being scored.
struct Scoring {
    frame_count: usize,
    fps: f32,
    /// JOD of each side, frame by frame.
    incoming: Receiver<Vec<f64>>,
    frames: Vec<Vec<f64>>,
}

impl Scoring {
    /// The burst's JOD, once all its frames are scored. The first half of the burst fills the metric's memory, and the
    /// second half counts.
    fn figure(&self) -> Option<RunningJod> {
        let counted = self.frames.get(self.frame_count / 2..).filter(|_| self.frames.len() == self.frame_count)?;
        let mean = |side: usize| counted.iter().map(|frame| frame[side]).sum::<f64>() / counted.len() as f64;
        Some(RunningJod { sides: (0..counted.first()?.len()).map(mean).collect(), fps: self.fps })
    }
}

impl Jod {
    /// Measures frames of this size and field of view.
    pub fn new(gpu: &Headless, geometry: ViewGeometry) -> Result<Self, Failure> {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|e| Failure::Work(format!("no thread can be started ({e})")))?;
        Ok(Self { recorder: BurstRecorder::new(gpu, geometry), pool, scoring: None, last: None })
    }

    /// Takes the frame that is shown now: the full-rate frame and what the sides show.
    pub fn push(&mut self, gpu: &Headless, full: &Texture, sides: &[&Texture], gaze_px: [f32; 2], gain: f32) {
        if let Some(scoring) = &mut self.scoring {
            scoring.frames.extend(scoring.incoming.try_iter());
            let Some(figure) = scoring.figure() else { return };
            (self.last, self.scoring) = (Some(figure), None);
        }
        self.recorder.push(gpu, full, sides, gaze_px, gain);
        if let Some(burst) = self.recorder.take(gpu) {
            let (outgoing, incoming) = channel();
            let (frame_count, fps) = (burst.frames.len(), burst.fps);
            self.scoring = Some(Scoring { frame_count, fps, incoming, frames: vec![] });
            self.pool.spawn(move || _ = score(&burst, &outgoing));
        }
    }

    /// A frame that is shown is not measured: the next one does not follow the last.
    pub fn skip(&mut self) {
        self.recorder.clear();
    }

    /// Forgets everything: what follows is another video.
    pub fn reset(&mut self) {
        self.recorder.clear();
        (self.scoring, self.last) = (None, None);
    }

    /// The last burst's JOD.
    pub fn last(&self) -> Option<&RunningJod> {
        self.last.as_ref()
    }

    /// Waits for the burst that is being scored.
    pub fn finish(&mut self) {
        if let Some(mut scoring) = self.scoring.take() {
            scoring.frames.extend(scoring.incoming.iter());
            self.last = scoring.figure().or(self.last.take());
        }
    }
}

/// Scores a burst frame by frame. Ends early if the device is lost or the scores are not wanted any more.
fn score(burst: &Burst, scores: &Sender<Vec<f64>>) -> Option<()> {
    let Burst { geometry, fps, frames } = burst;
    let mut reference = ReferenceVideo::new(Viewing { geometry: *geometry, display: Display::default(), fps: *fps });
    let mut sides: Vec<TestVideo> = vec![];
    for frame in frames {
        let mut pictures = frame.pictures(geometry.size_px())?.into_iter();
        let full_rate = reference.push(&pictures.next()?, Some(frame.gaze_px));
        sides.resize_with(pictures.len(), TestVideo::default);
        let jod = sides.iter_mut().zip(pictures).map(|(side, shown)| side.push(&full_rate, &shown).jod);
        scores.send(jod.collect()).ok()?;
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::Image;
    use afterimage::wgpu::{self, TextureFormat, TextureUsages};
    use afterimage_lab::metric::encode;
    use std::time::{Duration, Instant};

    /// No multiple of four wide.
    const SIZE: [u32; 2] = [150, 70];
    const EXPOSURE_EV: f32 = 0.5;
    const GAZE_PX: [f32; 2] = [40.0, 30.0];

    fn pattern(seed: u32) -> Image<[f32; 3]> {
        let value = |x: u32, y: u32, c: u32| ((x / 4 * 31 + y / 3 * 57 + c * 91) % 101 + seed) as f32 / 100.0 - 0.1;
        Image::from_fn(SIZE, |[x, y]| [0, 1, 2].map(|c| value(x, y, c)))
    }

    /// The metric itself, on a still picture.
    fn expected(geometry: ViewGeometry, fps: f32, full: &Image<[f32; 3]>, shown: &Image<[f32; 3]>) -> f64 {
        let mut reference = ReferenceVideo::new(Viewing { geometry, display: Display::default(), fps });
        let full_rate = reference.push(&encode(full, EXPOSURE_EV), Some(GAZE_PX));
        TestVideo::default().push(&full_rate, &encode(shown, EXPOSURE_EV)).jod
    }

    #[test]
    fn a_burst_of_a_still_has_the_score_of_the_picture_and_a_reset_forgets_it() {
        let Some(adapter) = afterimage_testing::gpu::adapter() else { return };
        let gpu = Headless::on(adapter, wgpu::Limits::default()).unwrap();
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let images = [pattern(0), pattern(5)];
        let textures = images.each_ref().map(|image| {
            let texture = gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, usage);
            gpu.write_rgb(&texture, 0, image);
            texture
        });
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        let mut jod = Jod::new(&gpu, geometry).unwrap();
        let push = |jod: &mut Jod, sides: &[&Texture]| {
            jod.push(&gpu, &textures[0], sides, GAZE_PX, EXPOSURE_EV.exp2());
            std::thread::sleep(Duration::from_millis(10));
        };
        let begun = Instant::now();
        while jod.last().is_none() {
            push(&mut jod, &[&textures[1], &textures[0]]);
        }
        let RunningJod { sides, fps } = jod.last().unwrap().clone();
        let expected = expected(geometry, fps, &images[0], &images[1]);
        println!("{sides:?} at {fps} fps, expected {expected}");
        assert!((sides[0] - expected).abs() < 0.02 && expected < 9.5);
        assert_eq!((sides.len(), sides[1]), (2, 10.0), "the full-rate frame is no different from itself");
        // How long a frame takes depends on what else the machine does.
        let least = 1.0 / begun.elapsed().as_secs_f32();
        assert!((least..100.0).contains(&fps), "frames are at least 10 ms apart");

        jod.reset();
        assert_eq!(jod.last(), None);
        while jod.scoring.is_none() {
            push(&mut jod, &[&textures[0]]);
        }
        jod.finish();
        assert_eq!(
            jod.last().map(|figure| &figure.sides[..]),
            Some(&[10.0][..]),
            "one side, of frames after the reset"
        );
    }
}
