//! Everything that is on one device, and gone with it.

use super::device::Device;
use super::lanes::Lanes;
use super::layout::Layout;
use super::quality::Quality;
use super::screen::{Scene, Screen};
use super::setup::Setup;
use super::state::{Side, State};
use super::surface::Surface;
use super::times::PassTimes;
use crate::failure::Failure;
use std::sync::Arc;
use winit::window::Window;

/// A window's device and what is made of it.
pub struct OnDevice {
    pub device: Device,
    pub surface: Surface,
    pub lanes: Lanes,
    pub times: PassTimes,
    pub quality: Quality,
    pub screen: Screen,
    /// A frame of the input is there.
    pub has_frame: bool,
    /// It has not been shown yet.
    pub is_new: bool,
}

impl OnDevice {
    pub fn open(window: &Arc<Window>, setup: &Setup, state: &State, scale: f32) -> Result<Self, Failure> {
        let device = Device::open(window)?;
        let size = window.inner_size();
        let surface = Surface::new(&device, [size.width, size.height])?;
        let geometry = setup.geometry(scale)?;
        let gpu = &device.gpu;
        Ok(Self {
            lanes: Lanes::new(gpu, geometry, state, &|shows| setup.settings(state, shows))?,
            times: PassTimes::new(gpu),
            quality: Quality::new(gpu, geometry.size_px()),
            screen: Screen::new(gpu, surface.format()),
            has_frame: false,
            is_new: false,
            surface,
            device,
        })
    }

    /// Where the picture lies in the window.
    pub fn layout(&self) -> Layout {
        Layout::new(self.lanes.geometry().size_px(), self.surface.size())
    }
}

/// What the lanes show, as the state has it.
pub fn scene<'a>(
    lanes: &'a Lanes,
    layout: &'a Layout,
    state: &State,
    gaze_px: [f32; 2],
    gain: f32,
    panel_scale: u32,
) -> Scene<'a> {
    let [left, right] = Side::BOTH.map(|side| lanes.on_screen(side, state));
    // Colors of decisions stand for themselves.
    let gain_of = |is_decisions| if is_decisions { 1.0 } else { gain };
    Scene {
        layout,
        geometry: lanes.geometry(),
        pictures: [left.0, right.0],
        gain: [gain_of(left.1), gain_of(right.1)],
        divider: state.is_split.then_some(state.divider),
        gaze_px: state.is_marked.then_some(gaze_px),
        fovea_deg: state.fovea_deg,
        has_panel: state.has_panel,
        panel_scale,
    }
}
