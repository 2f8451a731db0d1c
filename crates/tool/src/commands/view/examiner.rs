//! The doctor in the viewer: looks at the frames that the methods get, and reads its words a few frames later, without
//! a stall.

use super::device;
use crate::failure::Failure;
use afterimage::doctor::Finding;
use afterimage::gpu::{Doctor, Frame};
use afterimage::internal::{ContextDesc, Reset};
use afterimage::wgpu::{self, Buffer, BufferUsages};
use afterimage_lab::device::{Headless, mapped};
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Frames whose words may be on their way.
const PENDING: usize = 4;

/// A doctor and its buffers.
pub struct Examiner {
    doctor: Doctor,
    words: Buffer,
    free: Vec<Buffer>,
    /// In the order of the frames; the flag becomes `true` when the buffer is mapped.
    pending: VecDeque<(Buffer, Arc<AtomicBool>)>,
    /// The doctor did not look at the last frame.
    has_skipped: bool,
}

impl Examiner {
    pub fn new(gpu: &Headless, desc: &ContextDesc) -> Result<Self, Failure> {
        let doctor = Doctor::new(&gpu.device, desc, 0)?;
        let size = doctor.words_bytes();
        let buffer = |usage| {
            let label = Some("view examiner");
            gpu.device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        let words = buffer(BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC);
        let free = (0..PENDING).map(|_| buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST)).collect();
        Ok(Self { doctor, words, free, pending: VecDeque::new(), has_skipped: false })
    }

    /// Gives a frame to the doctor, unless all buffers are on their way.
    pub fn examine(&mut self, gpu: &Headless, frame: &Frame<'_>) -> Result<(), Failure> {
        self.take(gpu);
        let Some(buffer) = self.free.pop() else {
            self.has_skipped = true;
            return Ok(());
        };
        // The doctor compares frames that follow each other.
        let reset = if self.has_skipped { Reset::All } else { frame.reset };
        self.has_skipped = false;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.doctor.record(&gpu.device, &mut encoder, &Frame { reset, ..*frame }, &self.words)?;
        encoder.copy_buffer_to_buffer(&self.words, 0, &buffer, 0, self.words.size());
        gpu.queue.submit([encoder.finish()]);
        let done = device::map(&buffer);
        self.pending.push_back((buffer, done));
        Ok(())
    }

    /// Reads the words that have arrived.
    fn take(&mut self, gpu: &Headless) {
        // `Viewer::frame` handles a lost device.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        while self.pending.front().is_some_and(|(_, done)| done.load(Ordering::Acquire)) {
            let Some((buffer, _)) = self.pending.pop_front() else { return };
            if let Some(words) = mapped(&buffer) {
                self.doctor.read(&words);
            }
            buffer.unmap();
            self.free.push(buffer);
        }
    }

    /// What the doctor says.
    pub fn findings(&self) -> Vec<Finding> {
        self.doctor.findings()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::doctor::Fault;
    use afterimage::internal::{FoveationKind, ViewFrame};
    use afterimage::{Gaze, Image, ViewGeometry};
    use wgpu::{TextureFormat, TextureUsages};

    const SIZE: [u32; 2] = [160, 96];

    /// Faults found in frames that move to the right by 2 pixels, with vectors of that sign. `waits`: for each frame.
    fn faults(waits: bool) -> Option<Vec<Fault>> {
        let adapter = afterimage_testing::gpu::adapter()?;
        let gpu = Headless::on(adapter, wgpu::Limits::default()).unwrap();
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let [color, motion] = [(); 2].map(|()| gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, usage));
        gpu.write_rgb(&motion, 0, &Image::filled(SIZE, [2.0, 0.0, 0.0]));
        let mut desc = ContextDesc::new(SIZE);
        desc.settings.foveation.kind = FoveationKind::Off;
        let mut examiner = Examiner::new(&gpu, &desc).unwrap();
        let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0).unwrap(), Gaze::At { px: [40.0, 30.0] })];
        for index in 0..12 {
            let shown = |[x, y]: [u32; 2]| {
                let x = x as f32 - 2.0 * index as f32;
                [0.5 + 0.2 * (0.4 * x + 0.2 * y as f32).sin() + 0.2 * (0.1 * x - 0.3 * y as f32).cos(); 3]
            };
            gpu.write_rgb(&color, 0, &Image::from_fn(SIZE, shown));
            let frame = Frame { motion: Some((&motion).into()), ..Frame::new(&color, &views, index) };
            examiner.examine(&gpu, &frame).unwrap();
            if waits {
                gpu.wait();
            }
        }
        Some(examiner.findings().iter().filter_map(Finding::fault).collect())
    }

    #[test]
    fn it_names_a_wrong_sign_and_skips_frames_rather_than_wait() {
        let Some(found) = faults(true) else { return };
        assert_eq!(found, [Fault::MotionDirection]);
        assert!(faults(false).unwrap().iter().all(|f| *f == Fault::MotionDirection));
    }
}
