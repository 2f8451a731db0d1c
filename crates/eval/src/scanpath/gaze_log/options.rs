//! How a gaze log is read.

/// Whose export a gaze log is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Vendor {
    /// Tobii: Pro Lab, Studio, Pro SDK.
    Tobii,
    /// Pupil Labs Core.
    Pupil,
    /// Pupil Labs Neon and Invisible.
    Neon,
    /// Gazepoint.
    Gazepoint,
    /// Varjo.
    Varjo,
    /// SRanipal: HTC Vive Pro Eye.
    Sranipal,
    /// SR Research EyeLink: ASC text, sample reports.
    Eyelink,
    /// WebGazer: a webcam in a browser.
    Webgazer,
}

/// Which gaze of a log with several counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Eye {
    /// The tracker's gaze of both eyes, else the mean of the valid eyes.
    #[default]
    Both,
    /// The left eye's.
    Left,
    /// The right eye's.
    Right,
}

/// How a gaze log is read. What is `None` is taken from the file; what is given replaces it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GazeLogOptions {
    /// Whose export it is; `None`: found out by its columns.
    pub from: Option<Vendor>,
    /// The gaze that counts.
    pub eye: Eye,
    /// Size of the screen in pixels.
    pub screen_px: Option<[u32; 2]>,
    /// Size of the screen in millimetres.
    pub screen_mm: Option<[f32; 2]>,
    /// Distance from the eye to the middle of the screen in millimetres.
    pub distance_mm: Option<f32>,
}

impl Vendor {
    /// All vendors.
    pub const ALL: [Self; 8] = [
        Self::Tobii,
        Self::Pupil,
        Self::Neon,
        Self::Gazepoint,
        Self::Varjo,
        Self::Sranipal,
        Self::Eyelink,
        Self::Webgazer,
    ];

    /// Name in options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tobii => "tobii",
            Self::Pupil => "pupil",
            Self::Neon => "neon",
            Self::Gazepoint => "gazepoint",
            Self::Varjo => "varjo",
            Self::Sranipal => "sranipal",
            Self::Eyelink => "eyelink",
            Self::Webgazer => "webgazer",
        }
    }
}
