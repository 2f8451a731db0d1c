//! The demo in a browser: WebGPU through wgpu, with the drop-in's executor on the device and, with the feature
//! `compare`, the one on the CPU. `page/main.js` has the controls, and calls what is here.

#[cfg(feature = "compare")]
mod compare;
mod gpu;
mod show;
mod space;
mod stage;

use afterimage::internal::{Foveation, FoveationKind, MethodKind, Settings};
use gpu::Gpu;
use show::{Marks, Show};
use stage::Stage;
use wasm_bindgen::prelude::*;

/// Everything behind the page.
#[wasm_bindgen]
pub struct Demo {
    gpu: Gpu,
    show: Show,
    stage: Stage,
}

/// Share of the pixels that smr shades by need.
const BUDGET: f32 = 0.065;

type Result<T> = std::result::Result<T, JsError>;

#[wasm_bindgen]
impl Demo {
    /// A demo of frames of `width` x `height` pixels on a canvas.
    ///
    /// # Errors
    /// Without WebGPU, an adapter or a device.
    pub async fn open(canvas: web_sys::HtmlCanvasElement, width: u32, height: u32) -> Result<Demo> {
        console_error_panic_hook::set_once();
        let size = [width, height];
        let (gpu, surface, adapter) = Gpu::open(&canvas).await?;
        let show = Show::new(&gpu, &adapter, surface, size)?;
        let stage = Stage::new(&gpu, size, Settings::default())?;
        Ok(Self { gpu, show, stage })
    }

    /// Name of the adapter.
    pub fn adapter(&self) -> String {
        self.gpu.adapter.clone()
    }

    /// Shows a picture: sRGB and alpha, a byte each, of the size of the frames.
    ///
    /// # Errors
    /// If it has another size.
    pub fn picture(&mut self, rgba: &[u8]) -> Result<()> {
        self.stage.show_picture(&self.gpu, rgba)
    }

    /// Shows the rendered scene.
    ///
    /// # Errors
    /// If its textures cannot be made.
    pub fn space(&mut self) -> Result<()> {
        self.stage.show_space(&self.gpu)
    }

    /// Changes the size of the frames; the next call is one of `picture` and `space`.
    ///
    /// # Errors
    /// If a side is 0.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<()> {
        self.show.resize(&self.gpu, [width, height]);
        self.stage = Stage::new(&self.gpu, [width, height], self.stage.settings())?;
        Ok(())
    }

    /// Sets the method and the foveation: diameters in degrees, block edges in pixels. With the filter `quads` single
    /// pixels are planned; the rendered scene has no other. History is discarded.
    ///
    /// # Errors
    /// If a name is not known, or a value is out of range.
    pub fn configure(
        &mut self,
        method: &str,
        filter: &str,
        fovea_deg: f32,
        mid_deg: f32,
        rate_mid: u32,
        rate_far: u32,
    ) -> Result<()> {
        let method = MethodKind::from_name(method).ok_or_else(|| JsError::new(method))?;
        let filter = FoveationKind::ALL.into_iter().find(|f| f.name() == filter).ok_or_else(|| JsError::new(filter))?;
        let rates = Foveation { kind: filter, fovea_deg, mid_deg, rate_mid, rate_far, ..Foveation::default() };
        let foveation = Foveation { single_pixels: true, budget: BUDGET, ..rates };
        self.stage.configure(&self.gpu, Settings { method: method.into(), foveation, ..Settings::default() })
    }

    /// Draws a frame: gaze in pixels, time of the camera in seconds, position of the divider and width of lines in
    /// pixels. Left of the divider is the renderer's frame, right of it the method's output.
    ///
    /// # Errors
    /// If a frame is not what the description says.
    pub fn frame(&mut self, gaze_x: f32, gaze_y: f32, seconds: f32, divider_px: f32, line_px: f32) -> Result<()> {
        let gaze = [gaze_x, gaze_y];
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.stage.record(&self.gpu, &mut encoder, gaze, seconds)?;
        let images = [&self.stage.plain_output, &self.stage.output];
        let marks = Marks { gaze_px: gaze, ring_px: self.stage.fovea_radius_px(), divider_px, line_px };
        self.show.record(&self.gpu, &mut encoder, images, marks)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.show.present(&self.gpu);
        Ok(())
    }

    /// Resolves when all frames are done.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn finished(&self) -> Result<()> {
        self.gpu.finished().await
    }

    /// Share of the pixels that the last frame shaded.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn shaded(&self) -> Result<f32> {
        self.stage.shaded(&self.gpu).await
    }

    /// PSNR in dB of sRGB values, against the frame at full rate: of what the renderer delivered, and of what is shown.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn quality(&mut self) -> Result<Vec<f32>> {
        self.stage.quality(&self.gpu).await
    }

    /// Pixels of what the renderer delivered: linear color and alpha, floats.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn delivered(&self) -> Result<Vec<f32>> {
        self.gpu.read(&self.stage.plain_output).await
    }

    /// Pixels of the method's output.
    ///
    /// # Errors
    /// On a lost device.
    pub async fn shown(&self) -> Result<Vec<f32>> {
        self.gpu.read(&self.stage.output).await
    }

    /// What went wrong on the device, once.
    pub fn fault(&self) -> Option<String> {
        self.gpu.fault.lock().ok()?.take()
    }

    /// Loses the device, to see what the page does.
    pub fn lose(&self) {
        self.gpu.device.destroy();
    }
}
