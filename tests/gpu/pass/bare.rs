//! Contexts on a device, for tests that record frames by themselves.

use super::*;

/// A device, and the description of one view for a context of this size.
pub struct Bare {
    pub device: Device,
    pub queue: Queue,
    pub desc: ContextDesc,
    pub views: [ViewFrame; 1],
}

impl Bare {
    /// On a device with WebGPU's default limits; `None`, after a message, without an adapter.
    pub fn new(desc: ContextDesc) -> Option<Self> {
        Some(Self::on(afterimage_testing::gpu::device()?, desc))
    }

    pub fn on((device, queue): (Device, Queue), desc: ContextDesc) -> Self {
        let geometry = ViewGeometry::flat(desc.size_px, 70.0).unwrap();
        Self { device, queue, desc, views: [ViewFrame::new(geometry, Gaze::At { px: [3.0, 4.0] })] }
    }

    pub fn context(&self, output: TextureFormat) -> Afterimage {
        Afterimage::new(&self.device, &self.desc, output).unwrap()
    }

    pub fn texture(&self, format: TextureFormat, usage: TextureUsages) -> Texture {
        make_texture(&self.device, &self.desc, format, usage)
    }

    pub fn input(&self, format: TextureFormat) -> Texture {
        self.texture(format, Afterimage::INPUT_USAGE | TextureUsages::COPY_DST)
    }

    /// An input whose views have these texels.
    pub fn filled<T: bytemuck::NoUninit>(&self, format: TextureFormat, texels: &[T]) -> Texture {
        let input = self.input(format);
        for layer in 0..self.desc.view_count as usize {
            afterimage_testing::gpu::write_layer(&self.queue, &input, layer, bytemuck::cast_slice(texels));
        }
        input
    }

    pub fn output(&self, format: TextureFormat) -> Texture {
        self.texture(format, Afterimage::OUTPUT_USAGE | TextureUsages::COPY_SRC)
    }

    /// Records a frame and submits it.
    ///
    /// # Errors
    /// If the frame is refused.
    pub fn record<'a>(
        &self,
        post: &mut Afterimage,
        frame: &Frame<'_>,
        target: impl Into<Target<'a>>,
    ) -> Result<(), FrameError> {
        afterimage_testing::gpu::validated(&self.device, "record", || {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let result = post.record(&self.device, &mut encoder, frame, target);
            self.queue.submit([encoder.finish()]);
            result.map(|_| ())
        })
    }

    /// Plans a frame.
    pub fn plan(&self, post: &mut Afterimage, frame: &Frame<'_>) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        post.plan(&self.device, &mut encoder, frame).unwrap();
        self.queue.submit([encoder.finish()]);
    }

    /// The message of a frame that is refused.
    pub fn refusal<'a>(&self, post: &mut Afterimage, frame: &Frame<'_>, target: impl Into<Target<'a>>) -> String {
        self.record(post, frame, target).unwrap_err().to_string()
    }

    pub fn read(&self, texture: &Texture) -> Vec<u32> {
        afterimage_testing::gpu::read_texture(&self.device, &self.queue, texture)
    }
}
