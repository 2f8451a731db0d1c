//! What a viewer puts out: the window, figures, files.

use super::super::on_device::{OnDevice, scene};
use super::super::pictures;
use super::super::quality::Viewing;
use super::super::state::Side;
use super::super::times::Pass;
use super::Viewer;
use crate::failure::Failure;

impl Viewer {
    /// Quality of what is shown, now and then.
    pub(super) fn measure(&mut self) {
        let on = &mut self.on;
        for &side in self.state.shown_sides() {
            if let Some(psnr_db) = on.quality.take(&on.device.gpu, side) {
                self.figures.quality(side, psnr_db);
            }
            if self.figures.is_due() && self.state.has_panel {
                let viewing = Viewing { geometry: on.lanes.geometry(), gaze_px: self.gaze_px, gain: self.setup.gain() };
                on.quality.measure(&on.device.gpu, side, on.lanes.full(), on.lanes.picture(side), &viewing);
            }
        }
    }

    /// Draws panel and window.
    pub(super) fn draw(&mut self, target: &wgpu::TextureView) -> Result<(), Failure> {
        let panel_scale = self.panel_scale();
        if self.state.has_panel && (self.is_stale || self.figures.is_due()) {
            let [w, h] = self.on.lanes.geometry().size_px();
            let lines = vec![
                shortened(self.setup.info.name.rsplit(['/', '\\']).next().unwrap_or_default()),
                format!("{w}x{h}, {:.2} of the input, {:.1} fps", self.scale, self.figures.fps()),
                shortened(&self.on.device.gpu.info.name),
            ];
            self.figures.draw(&self.state, lines);
            self.on.screen.set_panel(&self.on.device.gpu, &self.figures.panel);
        }
        let layout = self.on.layout();
        let OnDevice { device, surface, lanes, times, screen, .. } = &mut self.on;
        let scene = scene(lanes, &layout, &self.state, self.gaze_px, self.setup.gain(), panel_scale);
        times.pass(&device.gpu, Pass::Screen, |encoder, timestamps| {
            screen.record(&device.gpu, encoder, (target, surface.size()), &scene, timestamps);
            Ok(())
        })
    }

    /// The picture, and the record of how it came about.
    pub(super) fn write_picture(&self) -> Result<(), Failure> {
        let (on, state) = (&self.on, &self.state);
        let sides = Side::BOTH.map(|side| on.lanes.picture(side));
        let divider = state.is_split.then_some(state.divider);
        let picture = pictures::picture(&on.device.gpu, sides, divider, self.setup.args.exposure);
        pictures::write(&picture, self.setup.args.screenshot.as_deref())?;
        self.write_record()
    }

    pub(super) fn write_window(&self) -> Result<(), Failure> {
        let (on, layout) = (&self.on, self.on.layout());
        let scene = scene(&on.lanes, &layout, &self.state, self.gaze_px, self.setup.gain(), self.panel_scale());
        let picture = pictures::window(&on.device.gpu, on.surface.size(), &self.figures.panel, &scene);
        pictures::write(&picture, None)
    }

    /// Where the eye looked since the last fresh start, if that is asked for and it looked anywhere.
    fn write_record(&self) -> Result<(), Failure> {
        match &self.setup.args.record {
            Some(path) if self.record.len() > 0 => {
                self.record.write(path, self.on.lanes.geometry().size_px(), f64::from(self.setup.fps))
            }
            _ => Ok(()),
        }
    }

    /// Writes what was asked for at the end.
    pub fn finish(&self) -> Result<(), Failure> {
        match (self.setup.args.frames, &self.setup.args.screenshot) {
            (Some(frames), Some(_)) if frames == self.record.len() as u64 => self.write_picture(),
            _ => self.write_record(),
        }
    }
}

/// The end of a text that is too long for the panel.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let length = text.chars().count();
    if length <= MOST { text.into() } else { text.chars().skip(length - MOST).collect() }
}
