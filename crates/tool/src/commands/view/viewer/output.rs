//! Output of the viewer: window, statistics, files.

use super::super::jod::RunningJod;
use super::super::pictures;
use super::super::quality::Viewing;
use super::super::resources::{DeviceResources, scene};
use super::super::state::Side;
use super::super::times::Pass;
use super::Viewer;
use crate::args::Named;
use crate::failure::Failure;
use afterimage::doctor::Outcome;
use afterimage::wgpu;

/// Frames after a reset that have no JOD: pipelines are compiled at their first use, which delays frames.
const WARM_UP_FRAMES: u64 = 4;

impl Viewer {
    /// Takes finished measurements of PSNR, and starts new ones at the panel's interval.
    pub(super) fn measure_quality(&mut self) {
        let resources = &mut self.resources;
        for &side in self.state.shown_sides() {
            if let Some(psnr_db) = resources.quality.take(&resources.device.gpu, side) {
                self.stats.quality(side, psnr_db);
            }
            if self.stats.is_due() && self.state.has_panel && resources.pipeline.has_full() {
                let viewing =
                    Viewing { geometry: resources.pipeline.geometry(), gaze_px: self.gaze_px, gain: self.setup.gain() };
                resources.quality.measure(
                    &resources.device.gpu,
                    side,
                    resources.pipeline.full(),
                    resources.pipeline.picture(side),
                    &viewing,
                );
            }
        }
    }

    /// Gives the frame to the measurement of JOD, if the panel shows it.
    pub(super) fn measure_jod(&mut self) {
        let DeviceResources { device, pipeline, jod, .. } = &mut self.resources;
        let is_measured = self.state.has_panel && pipeline.has_full() && !self.state.is_frozen;
        if is_measured && pipeline.index() > WARM_UP_FRAMES {
            let sides: Vec<_> = self.state.shown_sides().iter().map(|&side| pipeline.picture(side)).collect();
            jod.push(&device.gpu, pipeline.full(), &sides, self.gaze_px, self.setup.gain());
        } else {
            jod.skip();
        }
    }

    /// Draws panel and window.
    pub(super) fn draw(&mut self, target: &wgpu::TextureView) -> Result<(), Failure> {
        let panel_scale = self.panel_scale();
        if self.state.has_panel && (self.is_stale || self.stats.is_due()) {
            let [w, h] = self.resources.pipeline.geometry().size_px();
            let mut lines = vec![
                shortened(self.setup.info.name.rsplit(['/', '\\']).next().unwrap_or_default()),
                format!("{w}x{h}, {:.2} of the input, {:.1} fps", self.scale, self.stats.fps()),
                shortened(&self.resources.device.gpu.info.name),
            ];
            let ms = |pass| self.resources.times.ms(pass);
            if let (Some(render), Some(left)) = (ms(Pass::Render), ms(Pass::Left)) {
                let post = left + ms(Pass::Right).unwrap_or(0.0);
                lines.push(format!("render {render:.2} ms, post {post:.2} ms"));
            }
            if self.resources.pipeline.has_full() {
                lines.push(self.resources.jod.last().map_or("JOD -".into(), |RunningJod { sides, fps }| {
                    let sides: Vec<_> = sides.iter().map(|jod| format!("{jod:.2}")).collect();
                    format!("JOD {} at {fps:.1} fps", sides.join(", "))
                }));
            }
            for finding in self.resources.pipeline.findings() {
                let outcome = match finding.outcome {
                    Outcome::Fits => "fits",
                    Outcome::CannotTell(_) => "cannot tell",
                    Outcome::Wrong(fault) => fault.name(),
                };
                lines.push(format!("{}: {outcome}", finding.check.name()));
                if finding.fault().is_some() && self.announced.insert(finding.outcome) {
                    eprintln!("afterimage: inputs: {finding}");
                }
            }
            self.stats.draw(&self.state, lines);
            self.resources.screen.set_panel(&self.resources.device.gpu, &self.stats.panel);
        }
        let layout = self.resources.layout();
        let DeviceResources { device, surface, pipeline, times, screen, .. } = &mut self.resources;
        let scene = scene(pipeline, &layout, &self.state, self.gaze_px, self.setup.gain(), panel_scale);
        times.pass(&device.gpu, Pass::Screen, |encoder, timestamps| {
            screen.record(&device.gpu, encoder, (target, surface.size()), &scene, timestamps);
            Ok(())
        })
    }

    /// Saves the gaze record, then the picture that it led to: who reads the printed path finds both.
    pub(super) fn write_picture(&self) -> Result<(), Failure> {
        let (resources, state) = (&self.resources, &self.state);
        let sides = Side::BOTH.map(|side| resources.pipeline.picture(side));
        let divider = state.is_split.then_some(state.divider);
        let picture = pictures::picture(&resources.device.gpu, sides, divider, self.setup.args.exposure);
        self.write_record()?;
        pictures::write(&picture, self.setup.args.screenshot.as_deref())
    }

    pub(super) fn write_window(&self) -> Result<(), Failure> {
        let (resources, layout) = (&self.resources, self.resources.layout());
        let scene =
            scene(&resources.pipeline, &layout, &self.state, self.gaze_px, self.setup.gain(), self.panel_scale());
        let picture = pictures::window(&resources.device.gpu, resources.surface.size(), &self.stats.panel, &scene);
        pictures::write(&picture, None)
    }

    /// Prints the command that explains the pixel under the mouse, or why there is none.
    pub(super) fn explain(&self) -> Result<(), Failure> {
        let pixel = self.pointer.and_then(|at| Some((self.layout().pixel(at)?, at[0])));
        let Some((px, x)) = pixel.filter(|_| self.record.len() > 0) else {
            eprintln!("afterimage: no pixel is under the mouse; move it over the picture");
            return Ok(());
        };
        let is_right = self.state.is_split && x >= self.layout().divider_x(self.state.divider) as f32;
        let side = if is_right { Side::Right } else { Side::Left };
        let file = std::env::temp_dir().join("afterimage-gaze.csv");
        let file = self.setup.args.record.clone().unwrap_or(file);
        let words: Vec<String> = std::env::args().collect();
        let at = (px, self.record.len());
        let (args, fps) = (&self.setup.args, self.setup.fps);
        match self.repeatable.command(&words, args, (&self.state, side), at, (&file, fps)) {
            Ok(command) => {
                self.record.write(&file, self.resources.pipeline.geometry().size_px(), f64::from(fps))?;
                say!("{command}");
            }
            Err(reason) => eprintln!("afterimage: run cannot repeat these frames: {reason}"),
        }
        Ok(())
    }

    /// Saves the gaze record, if --record is given and there are frames.
    fn write_record(&self) -> Result<(), Failure> {
        match &self.setup.args.record {
            Some(path) if self.record.len() > 0 => {
                self.record.write(path, self.resources.pipeline.geometry().size_px(), f64::from(self.setup.fps))
            }
            _ => Ok(()),
        }
    }

    /// Saves the files due at the end.
    pub fn finish(&mut self) -> Result<(), Failure> {
        if let Some(frames) = self.setup.args.frames {
            say!("{frames} frames, {} read back", self.resources.device.gpu.readbacks());
            self.resources.jod.finish();
            if let Some(RunningJod { sides, fps }) = self.resources.jod.last() {
                let names = self.state.sides.map(Named::name);
                let sides: Vec<_> = names.iter().zip(sides).map(|(name, jod)| format!("{name} {jod:.2}")).collect();
                say!("JOD {} at {fps:.1} fps", sides.join(", "));
            }
        }
        match (self.setup.args.frames, &self.setup.args.screenshot) {
            (Some(frames), Some(_)) if frames == self.record.len() as u64 => self.write_picture(),
            _ => self.write_record(),
        }
    }
}

/// The last characters of a text that is too long for the panel.
fn shortened(text: &str) -> String {
    const MAX_CHARS: usize = 40;
    let length = text.chars().count();
    if length <= MAX_CHARS { text.into() } else { text.chars().skip(length - MAX_CHARS).collect() }
}
