//! All GPU resources of the viewer. A lost device takes them with it, so they are created and replaced together.

use super::device::Device;
use super::jod::Jod;
use super::layout::Layout;
use super::pipeline::ViewPipeline;
use super::quality::Quality;
use super::screen::{Scene, Screen};
use super::setup::Setup;
use super::state::{Side, State};
use super::surface::Surface;
use super::times::PassTimes;
use crate::failure::Failure;
use afterimage_lab::source::{RasterSource, ViewedScene};
use std::sync::Arc;
use winit::window::Window;

/// The window's device, and everything created on it.
pub struct DeviceResources {
    pub device: Device,
    pub surface: Surface,
    pub pipeline: ViewPipeline,
    pub times: PassTimes,
    pub quality: Quality,
    pub jod: Jod,
    pub screen: Screen,
    /// Renders the input, if it is a scene that is rendered as it is shown.
    pub renderer: Option<RasterSource>,
    /// An input frame has been uploaded.
    pub has_frame: bool,
    /// The uploaded frame has not been shown yet.
    pub is_new: bool,
}

impl DeviceResources {
    pub fn open(
        window: &Arc<Window>,
        setup: &Setup,
        state: &State,
        scale: f32,
        scene: Option<&ViewedScene>,
    ) -> Result<Self, Failure> {
        let device = Device::open(window)?;
        let size = window.inner_size();
        let surface = Surface::new(&device, [size.width, size.height])?;
        let geometry = setup.geometry(scale)?;
        let gpu = &device.gpu;
        let foveation = &setup.args.foveation;
        let renderer =
            scene.map(|scene| setup.args.input.on(&scene.clone().with_geometry(geometry), gpu.clone())).transpose()?;
        Ok(Self {
            pipeline: ViewPipeline::new(gpu, geometry, state, foveation.geometry(), setup)?,
            renderer,
            times: PassTimes::new(gpu),
            quality: Quality::new(gpu, geometry.size_px()),
            jod: Jod::new(gpu, geometry)?,
            screen: Screen::new(gpu, surface.format()),
            has_frame: false,
            is_new: false,
            surface,
            device,
        })
    }

    /// Position of the picture in the window.
    pub fn layout(&self) -> Layout {
        Layout::new(self.pipeline.geometry().size_px(), self.surface.size())
    }
}

/// Contents of the window: the output of both sides, and the overlays that the state turns on.
pub fn scene<'a>(
    pipeline: &'a ViewPipeline,
    layout: &'a Layout,
    state: &State,
    gaze_px: [f32; 2],
    gain: f32,
    panel_scale: u32,
) -> Scene<'a> {
    let [left, right] = Side::BOTH.map(|side| pipeline.on_screen(side, state));
    // Exposure does not apply to the false colors of debug views.
    let gain_of = |is_debug_view| if is_debug_view { 1.0 } else { gain };
    Scene {
        layout,
        geometry: pipeline.geometry(),
        pictures: [left.0, right.0],
        gain: [gain_of(left.1), gain_of(right.1)],
        divider: state.is_split.then_some(state.divider),
        gaze_px: state.is_marked.then_some(gaze_px),
        fovea_deg: state.fovea_deg,
        has_panel: state.has_panel,
        panel_scale,
    }
}
