//! What `afterimage info` says of motion vectors: their convention, and the command that reads them.

use crate::args::channels::{ChannelArgs, quoted};
use afterimage::Image;
use afterimage::doctor::{Check, Fault, Finding};
use afterimage_lab::error::InputError;
use afterimage_lab::source::exr_file::MotionReading;
use afterimage_lab::source::motion_check::{Verdict, detect};

/// The input and its options, for the command that reads it.
pub struct Reader<'a> {
    pub input: &'a str,
    pub channels: &'a ChannelArgs,
    /// How its motion vectors are read; `None` for those that are not of a file.
    pub reading: Option<MotionReading>,
}

impl Reader<'_> {
    /// The command that reads the motion vectors as `reading`.
    fn command(&self, reading: MotionReading) -> String {
        let (input, channels) = (quoted(self.input), self.channels.text());
        format!("afterimage run {input}{channels} --motion-convention {reading} --out out")
    }
}

/// Prints the convention under which frame 0 predicts frame 1 best. Returns it, if it is another than that of reading.
pub fn motion_info(
    reader: &Reader,
    frames: [&Image<[f32; 3]>; 2],
    motion: &Image<[f32; 2]>,
) -> Result<Option<MotionReading>, InputError> {
    let read = reader.reading.unwrap_or_default();
    // As stored, but for centre and scale.
    let factor = read.convention.to_internal(motion.size());
    let stored = motion.map(|m| [m[0] / factor[0], m[1] / factor[1]]);
    let check = detect(frames[0], frames[1], &stored)?;
    if reader.reading.is_some() {
        say!("motion read as: {read}");
    }
    let explains = |db: f64| format!("frame 0 warped by it matches frame 1 at {db:.1} dB");
    let best = check.psnr_db.first().map_or(f64::NAN, |p| p.1);
    let found = MotionReading { convention: check.best, ..read };
    let is_as_read = check.psnr_db.iter().any(|(convention, db)| *convention == read.convention && best - db < 0.3);
    match check.verdict {
        Verdict::Undecidable if check.pixels == 0 => say!("motion convention: not known, nothing moves"),
        Verdict::Undecidable => {
            say!("motion convention: not known, too little motion, or several conventions explain it equally well");
        }
        Verdict::YAxisOpen if is_as_read => {
            say!("motion convention: as read, but nothing moves up or down: the y axis is open ({})", explains(best));
        }
        _ if is_as_read => say!("motion convention: as read ({})", explains(best)),
        verdict => {
            let is_open = verdict == Verdict::YAxisOpen;
            let open = if is_open { "; nothing moves up or down: the y axis may be the other" } else { "" };
            say!("motion convention: WRONG? {found} fits, {}{open}", explains(best));
        }
    }
    let is_known = check.verdict != Verdict::Undecidable;
    if reader.reading.is_some() && is_known {
        say!("read it with: {}", reader.command(if is_as_read { read } else { found }));
    }
    Ok((is_known && !is_as_read).then_some(found))
}

/// A finding with what mends it here, instead of in Rust: an option, or the command that has it. `found` is the
/// convention that fits.
pub fn with_option(finding: &Finding, reader: &Reader, found: Option<MotionReading>) -> Finding {
    let read = reader.reading.unwrap_or_default();
    let mend = match (finding.fault(), found) {
        (None, _) => None,
        _ if reader.reading.is_none() => finding.mend.clone(),
        (Some(_), Some(found)) if finding.check == Check::Motion => Some(reader.command(found)),
        (Some(Fault::MotionScale), _) => Some(format!(
            "they are too long or too short: --motion-convention {read},scale=N with a factor N, as 2 or 0.5"
        )),
        (Some(Fault::MotionAxes), _) => Some("name the two channels in the other order: --motion Y,X".to_owned()),
        (Some(Fault::MotionDirection | Fault::MotionYAxis | Fault::MotionUnit), _) => {
            Some("name another --motion-convention UNIT,DIRECTION,YAXIS".to_owned())
        }
        (Some(Fault::DepthConvention | Fault::DepthPlanes), _) => {
            Some("name another --depth-convention KIND (docs/renderers.md)".to_owned())
        }
        (Some(Fault::ColorEncoded), _) => Some("write linear color into the EXR files".to_owned()),
        (Some(_), _) => None,
    };
    Finding { mend, ..finding.clone() }
}
