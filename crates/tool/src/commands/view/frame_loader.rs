//! Background thread that reads or renders input frames, one ahead of the window, and resizes them to the requested
//! resolution.

use crate::failure::Failure;
use afterimage::Image;
use afterimage_lab::frame::{RenderedFrame, SourceFrame};
use afterimage_lab::source::{CameraPose, FrameRequest, FrameSource};
use glam::DMat4;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;

/// A requested frame.
struct Request {
    index: u64,
    /// Camera pose (world from camera), if the user steers the camera.
    pose: Option<DMat4>,
    size: [u32; 2],
    /// Counts cancellations: frames of an older generation are discarded.
    generation: u64,
}

/// A frame, and the camera that it was rendered with.
pub struct LoadedFrame {
    pub frame: RenderedFrame,
    pub camera_pose: Option<CameraPose>,
    generation: u64,
}

/// Handle to the thread.
pub struct FrameLoader {
    requests: Sender<Request>,
    frames: Receiver<Result<LoadedFrame, Failure>>,
    generation: u64,
    is_waiting: bool,
}

impl FrameLoader {
    /// Starts the thread, which owns the source.
    pub fn new(source: Box<dyn FrameSource + Send>) -> Self {
        let (requests, incoming) = channel();
        let (outgoing, frames) = channel();
        thread::spawn(move || serve(source, &incoming, &outgoing));
        Self { requests, frames, generation: 0, is_waiting: false }
    }

    /// Requests a frame, unless a request is pending.
    pub fn request(&mut self, index: u64, size: [u32; 2], pose: Option<DMat4>) {
        if !self.is_waiting {
            // `take` reports a thread that has ended.
            let _ = self.requests.send(Request { index, pose, size, generation: self.generation });
            self.is_waiting = true;
        }
    }

    /// Cancels the pending request.
    pub fn cancel(&mut self) {
        self.generation += 1;
        self.is_waiting = false;
    }

    /// The requested frame, if it is ready.
    pub fn take(&mut self) -> Result<Option<LoadedFrame>, Failure> {
        loop {
            match self.frames.try_recv() {
                Ok(frame) => {
                    let frame = frame?;
                    if frame.generation == self.generation {
                        self.is_waiting = false;
                        return Ok(Some(frame));
                    }
                }
                Err(TryRecvError::Empty) => return Ok(None),
                Err(TryRecvError::Disconnected) => {
                    return Err(Failure::Work("the thread that reads the input ended unexpectedly".into()));
                }
            }
        }
    }
}

/// The pose (world from camera) to which the user steered the camera last.
#[derive(Default)]
pub struct Steering(Option<DMat4>);

impl Steering {
    /// Steers the camera of `source` to `pose` in frame `index`; `None`: on its own path. Returns whether it jumps.
    pub fn steer(&mut self, source: &mut dyn FrameSource, index: u64, pose: Option<DMat4>) -> bool {
        // A steered camera moves from its previous pose. Back on its own path it jumps, which is a cut.
        let before = self.0.or_else(|| Some(source.camera_pose(index.saturating_sub(1))?.world_from_camera));
        let steps = before.zip(pose).map(|(before, now)| [before, now]);
        let cut = self.0.is_some() && steps.is_none();
        source.steer(index, steps);
        self.0 = steps.map(|[_, now]| now);
        cut
    }
}

/// Serves requests until the loader is dropped.
fn serve(
    mut source: Box<dyn FrameSource + Send>,
    requests: &Receiver<Request>,
    frames: &Sender<Result<LoadedFrame, Failure>>,
) {
    let mut steering = Steering::default();
    while let Ok(request) = requests.recv() {
        let cut = steering.steer(source.as_mut(), request.index, request.pose);
        let loaded = source.render(&FrameRequest::full_rate(request.index)).map(|mut frame| {
            frame.reference = resized(frame.reference, request.size);
            frame.reference.cut |= cut;
            LoadedFrame { frame, camera_pose: source.camera_pose(request.index), generation: request.generation }
        });
        if frames.send(loaded.map_err(Failure::from)).is_err() {
            break;
        }
    }
}

/// Resizes a frame: box filter for color, nearest pixel for depth and motion. Motion is scaled to the new pixels.
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
    SourceFrame { color: box_filtered(&frame.color, size), depth, motion, trust: None, ..frame }
}

/// Box filter: each pixel is the mean of the area that it covers. Separable, columns first.
fn box_filtered(color: &Image<[f32; 3]>, [width, height]: [u32; 2]) -> Image<[f32; 3]> {
    let [from_width, from_height] = color.size();
    let columns = weights(from_width, width);
    let narrow = Image::from_fn_parallel([width, from_height], |[x, y]| {
        mean(&columns[x as usize], |from| color.at(from, y as usize))
    });
    let rows = weights(from_height, height);
    Image::from_fn_parallel([width, height], |[x, y]| mean(&rows[y as usize], |from| narrow.at(x as usize, from)))
}

/// Box-filter weights for resizing a row of `from` pixels to `to`: for each output pixel, the covered input pixels and
/// their weights.
fn weights(from: u32, to: u32) -> Vec<Vec<(usize, f32)>> {
    let ratio = f64::from(from) / f64::from(to);
    let covered = |i: u32| {
        let (begin, end) = (f64::from(i) * ratio, (f64::from(i) + 1.0) * ratio);
        let pixels = begin as usize..(end.ceil() as usize).min(from as usize);
        let weight = |p: usize| ((end.min(p as f64 + 1.0) - begin.max(p as f64)) / ratio) as f32;
        pixels.map(|p| (p, weight(p))).filter(|(_, weight)| *weight > 0.0).collect()
    };
    (0..to).map(covered).collect()
}

fn mean(weights: &[(usize, f32)], pixel: impl Fn(usize) -> [f32; 3]) -> [f32; 3] {
    weights.iter().fold([0.0; 3], |sum, &(p, weight)| {
        let c = pixel(p);
        [0, 1, 2].map(|i| sum[i] + weight * c[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_picture_has_the_same_mean() {
        let color = Image::from_fn([12, 8], |[x, y]| [x as f32, y as f32, (x * y) as f32]);
        for size in [[9, 6], [6, 4], [4, 3], [1, 1]] {
            let small = box_filtered(&color, size);
            let mean = |image: &Image<[f32; 3]>| {
                let sum =
                    image.pixels().iter().fold([0.0; 3], |s: [f64; 3], c| [0, 1, 2].map(|i| s[i] + f64::from(c[i])));
                sum.map(|s| s / image.pixels().len() as f64)
            };
            let (found, expected) = (mean(&small), mean(&color));
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-4), "{size:?}: {found:?}, {expected:?}");
        }
        assert_eq!(box_filtered(&color, [6, 4]).at(2, 1), [4.5, 2.5, 11.25], "the mean of 2x2 pixels");
    }

    #[test]
    fn motion_shrinks_with_the_picture_and_depth_does_not() {
        let size = [12, 8];
        let frame = SourceFrame {
            color: Image::filled(size, [0.5; 3]),
            depth: Some(Image::from_fn(size, |[x, _]| x as f32)),
            motion: Some(Image::filled(size, [4.0, -8.0])),
            ..SourceFrame::without_images(None, false)
        };
        let small = resized(frame, [6, 2]);
        assert_eq!(small.motion.unwrap().at(3, 1), [2.0, -2.0]);
        assert_eq!(small.depth.unwrap().at(3, 1), 7.0);
    }
}
