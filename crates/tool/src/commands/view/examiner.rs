//! The doctor in the viewer: looks at the frames that the methods get, and reads its words a few frames later, without
//! a stall.

use crate::failure::Failure;
use afterimage::gpu::{Doctor, Frame};
use afterimage::wgpu::{self, Buffer, BufferUsages};
use afterimage::{ContextDesc, Finding, Reset};
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

    /// Looks at a frame, unless all buffers are on their way.
    pub fn look(&mut self, gpu: &Headless, frame: &Frame<'_>) -> Result<(), Failure> {
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
        let done = Arc::new(AtomicBool::new(false));
        let arrived = done.clone();
        buffer.map_async(wgpu::MapMode::Read, .., move |r| arrived.store(r.is_ok(), Ordering::Release));
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
