//! The exports of eye trackers: which columns hold time, gaze and validity, in which units and axes.
//!
//! Names are those of [`super::super::table::Columns::find`]. `docs/gaze-logs.md` says where each comes from.

use super::options::Vendor;

/// What a place's columns hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Plane {
    /// Screen pixels from the top left corner, y down.
    Pixels,
    /// Shares of the screen's width and height from the top left corner, y down.
    Fractions,
    /// Shares of the screen's width and height from the bottom left corner, y up.
    FractionsUp,
    /// A direction from the head: x right, y up, z ahead.
    Forward,
    /// A direction from the head: x **left**, y up, z ahead.
    ForwardLeft,
    /// Azimuth to the right and elevation upwards, degrees.
    Angles,
    /// The same in radians.
    Radians,
}

impl Plane {
    /// Number of columns.
    pub fn axes(self) -> usize {
        if self.is_forward() { 3 } else { 2 }
    }

    fn is_forward(self) -> bool {
        matches!(self, Self::Forward | Self::ForwardLeft)
    }

    /// Whether it gives visual angles, with no screen.
    pub fn is_angular(self) -> bool {
        self.is_forward() || matches!(self, Self::Angles | Self::Radians)
    }
}

/// Unit of a time column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// As many ticks a second.
    PerSecond(f64),
    /// As the column's name ends (`_ms`, `_f_10000000`); without one, that in which a usual tracker has 5 to 5000
    /// samples a second: loggers of one's own write `time` in any of them.
    Named,
}

/// What says that a sample is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Validity {
    /// 1 or true.
    Flag,
    /// 0 or false: the eye blinks.
    NoFlag,
    /// The word `Valid`.
    Word,
    /// A number of at most 1: Tobii's codes, 0 certain to 4 not found.
    Code,
    /// A number of at least this.
    AtLeast(f64),
    /// A number above 0, a true word or `valid`; inverted, what is none of these.
    Truth { is_inverted: bool },
    /// A true word, 1, or a mask with the bit 2 of the direction.
    Mask,
}

/// Gaze of one eye or of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Its columns, by axis; none: the export has no such gaze.
    pub at: &'static [&'static str],
    /// Columns that say whether it is valid; any of them that does is enough.
    pub valid: &'static [&'static str],
}

const NO_PLACE: Place = Place { at: &[], valid: &[] };

/// One kind of export.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub vendor: Vendor,
    /// The program that writes it.
    pub writer: &'static str,
    /// Time columns; the first that is there counts.
    pub time: &'static [(&'static str, Unit)],
    pub plane: Plane,
    pub both: Place,
    pub left: Place,
    pub right: Place,
    /// What the columns for validity hold.
    pub rule: Validity,
    /// Only rows with this word in this column are samples.
    pub rows: Option<(&'static str, &'static str)>,
    /// A sample in which this column has a value other than 0 is lost: the number of a blink.
    pub blink: Option<&'static str>,
    /// Columns with the screen's size in pixels.
    pub screen_px: Option<[&'static str; 2]>,
}

const EMPTY: Layout = Layout {
    vendor: Vendor::Tobii,
    writer: "",
    time: &[],
    plane: Plane::Pixels,
    both: NO_PLACE,
    left: NO_PLACE,
    right: NO_PLACE,
    rule: Validity::Flag,
    rows: None,
    blink: None,
    screen_px: None,
};

const fn place(at: &'static [&'static str], valid: &'static [&'static str]) -> Place {
    Place { at, valid }
}

const SECONDS: Unit = Unit::PerSecond(1.0);
const MILLISECONDS: Unit = Unit::PerSecond(1e3);
const MICROSECONDS: Unit = Unit::PerSecond(1e6);
const NANOSECONDS: Unit = Unit::PerSecond(1e9);

const PRO_LAB: Layout = Layout {
    vendor: Vendor::Tobii,
    writer: "Tobii Pro Lab",
    time: &[("recording_timestamp*|eyetracker_timestamp*|computer_timestamp*", Unit::Named)],
    rows: Some(("sensor", "eye tracker")),
    screen_px: Some(["recording_resolution_width*", "recording_resolution_height*"]),
    ..EMPTY
};

const STUDIO: Layout = Layout {
    vendor: Vendor::Tobii,
    writer: "Tobii Studio",
    time: &[("recordingtimestamp", MILLISECONDS), ("eyetrackertimestamp", MICROSECONDS)],
    ..EMPTY
};

const GAZEPOINT: Layout = Layout {
    vendor: Vendor::Gazepoint,
    writer: "Gazepoint Analysis",
    time: &[("timetick_f*", Unit::Named), ("time|time_2*", SECONDS)],
    plane: Plane::Fractions,
    blink: Some("bkid"),
    ..EMPTY
};

const CORE: Layout = Layout {
    vendor: Vendor::Pupil,
    writer: "Pupil Core's player",
    time: &[("gaze_timestamp|timestamp", SECONDS)],
    plane: Plane::FractionsUp,
    ..EMPTY
};

const NEON: Layout = Layout {
    vendor: Vendor::Neon,
    writer: "Pupil Cloud or Neon Player",
    time: &[("timestamp_ns", NANOSECONDS)],
    blink: Some("blink_id"),
    ..EMPTY
};

/// All kinds, by the order in which they are tried.
pub(super) const LAYOUTS: [Layout; 16] = [
    Layout {
        both: place(
            &["gaze_point_x_dacs_px|gaze_point_x", "gaze_point_y_dacs_px|gaze_point_y"],
            &["validity_left", "validity_right"],
        ),
        left: place(
            &["gaze_point_left_x_dacs_px|gaze_point_left_x", "gaze_point_left_y_dacs_px|gaze_point_left_y"],
            &["validity_left"],
        ),
        right: place(
            &["gaze_point_right_x_dacs_px|gaze_point_right_x", "gaze_point_right_y_dacs_px|gaze_point_right_y"],
            &["validity_right"],
        ),
        rule: Validity::Word,
        ..PRO_LAB
    },
    Layout {
        plane: Plane::Fractions,
        both: place(&["gaze_point_x_mcs_norm", "gaze_point_y_mcs_norm"], &["validity_left", "validity_right"]),
        left: place(&["gaze_point_left_x_mcs_norm", "gaze_point_left_y_mcs_norm"], &["validity_left"]),
        right: place(&["gaze_point_right_x_mcs_norm", "gaze_point_right_y_mcs_norm"], &["validity_right"]),
        rule: Validity::Word,
        ..PRO_LAB
    },
    Layout {
        both: place(
            &["gazepointx_adcspx|gazepointx_px|gazepointx", "gazepointy_adcspx|gazepointy_px|gazepointy"],
            &["validityleft", "validityright"],
        ),
        left: place(
            &["gazepointleftx_adcspx|gazepointxleft", "gazepointlefty_adcspx|gazepointyleft"],
            &["validityleft"],
        ),
        right: place(
            &["gazepointrightx_adcspx|gazepointxright", "gazepointrighty_adcspx|gazepointyright"],
            &["validityright"],
        ),
        rule: Validity::Code,
        ..STUDIO
    },
    Layout {
        vendor: Vendor::Tobii,
        writer: "the Tobii Pro SDK",
        time: &[("device_time_stamp|system_time_stamp", MICROSECONDS)],
        plane: Plane::Fractions,
        left: place(
            &["left_gaze_point_on_display_area_x", "left_gaze_point_on_display_area_y"],
            &["left_gaze_point_validity"],
        ),
        right: place(
            &["right_gaze_point_on_display_area_x", "right_gaze_point_on_display_area_y"],
            &["right_gaze_point_validity"],
        ),
        ..EMPTY
    },
    Layout {
        writer: "Pupil Core's surface tracker",
        time: &[("gaze_timestamp|world_timestamp", SECONDS)],
        both: place(&["x_norm", "y_norm"], &["confidence"]),
        rule: Validity::AtLeast(0.6),
        ..CORE
    },
    Layout { both: place(&["norm_pos_x", "norm_pos_y"], &["confidence"]), rule: Validity::AtLeast(0.6), ..CORE },
    Layout {
        writer: "Pupil Cloud's marker mapper",
        plane: Plane::Fractions,
        both: place(&["gaze_position_on_surface_x_normalized", "gaze_position_on_surface_y_normalized"], &[]),
        ..NEON
    },
    Layout {
        writer: "Pupil Cloud's reference image mapper",
        both: place(
            &["gaze_position_in_reference_image_x_px", "gaze_position_in_reference_image_y_px"],
            &["gaze_detected_in_reference_image"],
        ),
        ..NEON
    },
    Layout {
        plane: Plane::Angles,
        both: place(&["azimuth_deg", "elevation_deg"], &["worn"]),
        rule: Validity::AtLeast(0.5),
        ..NEON
    },
    Layout { both: place(&["gaze_x_px", "gaze_y_px"], &["worn"]), rule: Validity::AtLeast(0.5), ..NEON },
    Layout {
        both: place(&["bpogx", "bpogy"], &["bpogv"]),
        left: place(&["lpogx", "lpogy"], &["lpogv"]),
        right: place(&["rpogx", "rpogy"], &["rpogv"]),
        ..GAZEPOINT
    },
    Layout { both: place(&["fpogx", "fpogy"], &["fpogv"]), ..GAZEPOINT },
    Layout {
        vendor: Vendor::Varjo,
        writer: "Varjo Base",
        time: &[(
            "raw_timestamp|relative_to_unix_epoch_timestamp|relative_to_video_first_frame_timestamp",
            NANOSECONDS,
        )],
        plane: Plane::Forward,
        both: place(&["gaze_forward_x", "gaze_forward_y", "gaze_forward_z"], &["status|gaze_status"]),
        left: place(&["left_forward_x", "left_forward_y", "left_forward_z"], &["left_status|left_eye_status"]),
        right: place(&["right_forward_x", "right_forward_y", "right_forward_z"], &["right_status|right_eye_status"]),
        rule: Validity::AtLeast(2.0),
        ..EMPTY
    },
    Layout {
        vendor: Vendor::Sranipal,
        writer: "a program with SRanipal",
        time: &[("time_stamp_ms|timestamp_ms|time_stamp|timestamp|time_100ns|time_ms|time", Unit::Named)],
        plane: Plane::ForwardLeft,
        both: place(&["gaze_direct_c_x", "gaze_direct_c_y", "gaze_direct_c_z"], &["eye_valid_c"]),
        left: place(&["gaze_direct_l_x", "gaze_direct_l_y", "gaze_direct_l_z"], &["eye_valid_l"]),
        right: place(&["gaze_direct_r_x", "gaze_direct_r_y", "gaze_direct_r_z"], &["eye_valid_r"]),
        rule: Validity::Mask,
        ..EMPTY
    },
    Layout {
        vendor: Vendor::Eyelink,
        writer: "EyeLink's Data Viewer",
        time: &[("timestamp|sample_time", MILLISECONDS)],
        left: place(&["left_gaze_x", "left_gaze_y"], &["left_in_blink"]),
        right: place(&["right_gaze_x", "right_gaze_y"], &["right_in_blink"]),
        rule: Validity::NoFlag,
        ..EMPTY
    },
    Layout {
        vendor: Vendor::Webgazer,
        writer: "a page with WebGazer, or a plain table",
        time: &[(
            "t|time|timestamp|elapsedtime|elapsed_time|t_s|t_ms|t_us|t_ns|t_sec|time_s|time_ms|time_us|time_ns|time_sec|\
             time_seconds|time_milliseconds|timestamp_s|timestamp_ms|timestamp_us|timestamp_ns|timestamp_sec|\
             timestamp_seconds|timestamp_milliseconds|elapsed_s|elapsed_ms|elapsed_time_s|elapsed_time_ms",
            Unit::Named,
        )],
        both: place(&["x|x_px|gaze_x|gazex", "y|y_px|gaze_y|gazey"], &[]),
        ..EMPTY
    },
];
