//! Frames of the input, read or rendered beside the window's thread, one ahead, at the resolution that is asked for.

use crate::failure::Failure;
use afterimage::Image;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::{CameraPose, FrameSource};
use glam::DMat4;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;

/// A frame that is asked for.
struct Ask {
    index: u64,
    /// Where the camera is to be, if it is steered.
    pose: Option<DMat4>,
    size: [u32; 2],
    /// Tells answers to what is still wanted from those to what is not.
    generation: u64,
}

/// A frame, and where its camera was.
pub struct Given {
    pub frame: SourceFrame,
    pub stance: Option<CameraPose>,
    generation: u64,
}

/// The input.
pub struct Feed {
    asks: Sender<Ask>,
    answers: Receiver<Result<Given, Failure>>,
    generation: u64,
    is_waiting: bool,
}

impl Feed {
    /// Reads from a source, from now on.
    pub fn new(source: Box<dyn FrameSource + Send>) -> Self {
        let (asks, asked) = channel();
        let (answer, answers) = channel();
        thread::spawn(move || serve(source, &asked, &answer));
        Self { asks, answers, generation: 0, is_waiting: false }
    }

    /// Asks for a frame, unless one is on its way.
    pub fn ask(&mut self, index: u64, size: [u32; 2], pose: Option<DMat4>) {
        if !self.is_waiting {
            // A source that has gone is noticed when its answer is missed.
            let _ = self.asks.send(Ask { index, pose, size, generation: self.generation });
            self.is_waiting = true;
        }
    }

    /// Drops what is on its way.
    pub fn drop_pending(&mut self) {
        self.generation += 1;
        self.is_waiting = false;
    }

    /// The frame that was asked for, if it has come.
    pub fn take(&mut self) -> Result<Option<Given>, Failure> {
        loop {
            match self.answers.try_recv() {
                Ok(given) => {
                    let given = given?;
                    if given.generation == self.generation {
                        self.is_waiting = false;
                        return Ok(Some(given));
                    }
                }
                Err(TryRecvError::Empty) => return Ok(None),
                Err(TryRecvError::Disconnected) => return Err(Failure::Work("the input broke off".into())),
            }
        }
    }
}

/// Until nobody asks any more.
fn serve(mut source: Box<dyn FrameSource + Send>, asked: &Receiver<Ask>, answer: &Sender<Result<Given, Failure>>) {
    let mut steered: Option<DMat4> = None;
    while let Ok(ask) = asked.recv() {
        // Off its path the camera comes from where it was; back on it, from nowhere.
        let before = steered.or_else(|| Some(source.camera_pose(ask.index.saturating_sub(1))?.world_from_camera));
        let steps = before.zip(ask.pose).map(|(before, now)| [before, now]);
        let cut = steered.is_some() && steps.is_none();
        source.steer(ask.index, steps);
        steered = steps.map(|[_, now]| now);
        let given = source.frame(ask.index).map(|frame| {
            let frame = SourceFrame { cut: frame.cut || cut, ..resized(frame, ask.size) };
            Given { frame, stance: source.camera_pose(ask.index), generation: ask.generation }
        });
        if answer.send(given.map_err(Failure::from)).is_err() {
            break;
        }
    }
}

/// The frame in another size: colors averaged, depth and motion of the nearest pixel.
fn resized(frame: SourceFrame, size: [u32; 2]) -> SourceFrame {
    let from = frame.color.size();
    if from == size {
        return frame;
    }
    let ratio = [0, 1].map(|i| size[i] as f32 / from[i] as f32);
    let nearest = |v: u32, i: usize| (((v as f32 + 0.5) / ratio[i]) as usize).min(from[i] as usize - 1);
    let depth = frame.depth.as_ref().map(|d| Image::from_fn(size, |[x, y]| d.at(nearest(x, 0), nearest(y, 1))));
    let motion = frame.motion.as_ref().map(|m| {
        Image::from_fn(size, |[x, y]| {
            let [dx, dy] = m.at(nearest(x, 0), nearest(y, 1));
            [dx * ratio[0], dy * ratio[1]]
        })
    });
    SourceFrame { color: averaged(&frame.color, size), depth, motion, trust: None, ..frame }
}

/// Each pixel the mean of what it covers, along one axis after the other.
fn averaged(color: &Image<[f32; 3]>, [width, height]: [u32; 2]) -> Image<[f32; 3]> {
    let [from_width, from_height] = color.size();
    let columns = shares(from_width, width);
    let narrow = Image::from_fn_parallel([width, from_height], |[x, y]| {
        mean(&columns[x as usize], |from| color.at(from, y as usize))
    });
    let rows = shares(from_height, height);
    Image::from_fn_parallel([width, height], |[x, y]| mean(&rows[y as usize], |from| narrow.at(x as usize, from)))
}

/// Of each of `to` pixels of a row, the pixels of a row of `from` that it covers, and their shares in it.
fn shares(from: u32, to: u32) -> Vec<Vec<(usize, f32)>> {
    let ratio = f64::from(from) / f64::from(to);
    let covered = |i: u32| {
        let (begin, end) = (f64::from(i) * ratio, (f64::from(i) + 1.0) * ratio);
        let pixels = begin as usize..(end.ceil() as usize).min(from as usize);
        let share = |p: usize| ((end.min(p as f64 + 1.0) - begin.max(p as f64)) / ratio) as f32;
        pixels.map(|p| (p, share(p))).filter(|(_, share)| *share > 0.0).collect()
    };
    (0..to).map(covered).collect()
}

fn mean(shares: &[(usize, f32)], pixel: impl Fn(usize) -> [f32; 3]) -> [f32; 3] {
    shares.iter().fold([0.0; 3], |sum, &(p, share)| {
        let c = pixel(p);
        [0, 1, 2].map(|i| sum[i] + share * c[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_picture_has_the_same_mean() {
        let color = Image::from_fn([12, 8], |[x, y]| [x as f32, y as f32, (x * y) as f32]);
        for size in [[9, 6], [6, 4], [4, 3], [1, 1]] {
            let small = averaged(&color, size);
            let mean = |image: &Image<[f32; 3]>| {
                let sum =
                    image.pixels().iter().fold([0.0; 3], |s: [f64; 3], c| [0, 1, 2].map(|i| s[i] + f64::from(c[i])));
                sum.map(|s| s / image.pixels().len() as f64)
            };
            let (found, expected) = (mean(&small), mean(&color));
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-4), "{size:?}: {found:?}, {expected:?}");
        }
        assert_eq!(averaged(&color, [6, 4]).at(2, 1), [4.5, 2.5, 11.25], "the mean of 2x2 pixels");
    }

    #[test]
    fn motion_shrinks_with_the_picture_and_depth_does_not() {
        let size = [12, 8];
        let frame = SourceFrame {
            color: Image::filled(size, [0.5; 3]),
            depth: Some(Image::from_fn(size, |[x, _]| x as f32)),
            motion: Some(Image::filled(size, [4.0, -8.0])),
            trust: None,
            previous_from_current: None,
            cut: false,
            nonfinite: 0,
        };
        let small = resized(frame, [6, 2]);
        assert_eq!(small.motion.unwrap().at(3, 1), [2.0, -2.0]);
        assert_eq!(small.depth.unwrap().at(3, 1), 7.0);
    }
}
