//! Notes about a pixel of a clip: as lines of text, and as a table.

use crate::output::{Table, WriteError, csv_cell};
use afterimage::internal::{Note, NoteValues};
use std::fmt::Write;
use std::ops::RangeInclusive;

/// File of the notes.
pub const FILE: &str = "pixel.csv";

/// Columns of [`FILE`]. Values of a note stand in one column, with spaces between them.
pub const HEADER: &str = "frame,method,stage,name,unit,values";

/// A pixel to explain, in some frames of a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedPixel {
    /// (0, 0) is the top-left pixel, y down.
    pub px: [u32; 2],
    /// Frames.
    pub frames: RangeInclusive<usize>,
}

impl ExplainedPixel {
    /// The pixel, if it is explained in frame `index`.
    pub fn in_frame(&self, index: usize) -> Option<[u32; 2]> {
        self.frames.contains(&index).then_some(self.px)
    }

    /// Notes of a method about a frame as lines: stage, name, values and unit in columns.
    pub fn lines(&self, frame: usize, method: &str, notes: &[Note]) -> String {
        let [x, y] = self.px;
        let width = notes.iter().map(|note| note.name.len()).max().unwrap_or(0);
        let mut text = format!("frame {frame}, pixel {x},{y}, {method}\n");
        let mut before = None;
        for note in notes {
            let stage = if before.replace(note.stage) == Some(note.stage) { "" } else { note.stage.name() };
            let unit = if note.unit.is_empty() { String::new() } else { format!("  ({})", note.unit) };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {stage:12}  {:width$}  {}{unit}", note.name, values(&note.values));
        }
        text
    }

    /// Writes the notes of a method about a frame as rows.
    pub fn write(&self, frame: usize, method: &str, notes: &[Note], table: &mut Table) -> Result<(), WriteError> {
        notes.iter().try_for_each(|note| {
            let texts = [note.name, note.unit, &values(&note.values)].map(csv_cell);
            table.row(&format!("{frame},{method},{},{}", note.stage.name(), texts.join(",")))
        })
    }
}

/// Values with spaces between them: numbers with as many digits as tell the float from all others, words in
/// hexadecimal.
fn values(values: &NoteValues) -> String {
    match values {
        NoteValues::Numbers(numbers) => numbers.iter().map(|&v| number(v)).collect::<Vec<_>>().join(" "),
        NoteValues::Words(words) => words.iter().map(|word| format!("0x{word:08x}")).collect::<Vec<_>>().join(" "),
        NoteValues::Text(text) => (*text).into(),
    }
}

fn number(v: f32) -> String {
    let text = format!("{v:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use afterimage::internal::NoteStage;

    #[test]
    fn notes_stand_in_columns_and_numbers_are_exact() {
        let note = |stage, name, values, unit| Note { stage, name, values, unit };
        let notes = [
            note(NoteStage::Input, "gaze", NoteValues::Numbers(vec![12.0, -0.5]), "px"),
            note(NoteStage::Input, "color", NoteValues::Numbers(vec![0.1, 1e-30, f32::NAN]), ""),
            note(NoteStage::Stored, "words", NoteValues::Words(vec![255, 1]), "a, b"),
        ];
        let pixel = ExplainedPixel { px: [3, 4], frames: 1..=2 };
        let expected = "frame 1, pixel 3,4, smr\n  \
                        input         gaze   12 -0.5  (px)\n                \
                        color  0.1 1e-30 NaN\n  \
                        stored        words  0x000000ff 0x00000001  (a, b)\n";
        assert_eq!(pixel.lines(1, "smr", &notes), expected);
        assert_eq!([0, 1, 2, 3].map(|frame| pixel.in_frame(frame)), [None, Some([3, 4]), Some([3, 4]), None]);
        assert_eq!((csv_cell("a, b"), csv_cell("a b")), ("\"a, b\"".into(), "a b".into()));
    }
}
