//! Notes about a pixel are what its pass computed, for all methods and kinds of frames.

use super::*;
use crate::any_frame::{SIZE, all_settings, any_frame};
use crate::images::planned;
use afterimage::internal::{Foveation, FoveationKind, Smr};
use afterimage::internal::{Note, NoteStage, NoteValues, PixelNotes};
use std::collections::BTreeSet;

/// Frames of a run.
const FRAMES: u64 = 24;

/// Every method on whole frames, on single pixels and on quads.
fn all_kinds() -> Vec<Settings> {
    let quads = Foveation { fovea_deg: 20.0, mid_deg: 40.0, rate_mid: 4, ..Foveation::quads() };
    let single = Foveation { single_pixels: true, rate_mid: 2, rate_far: 4, ..quads };
    let mut all = all_settings();
    for foveation in [single, quads] {
        let smr = [true, false].map(|antialias| Method::Smr(Smr { antialias, ..Smr::default() }));
        let methods = MethodKind::ALL.into_iter().map(Method::from).chain(smr);
        all.extend(methods.map(|method| Settings { method, foveation, ..Settings::default() }));
        all.push(Settings { foveation, ..Settings::weighted() });
    }
    all.extend([single, quads].map(|foveation| Settings { foveation, noisy: true, ..Settings::default() }));
    all
}

/// A frame that fits the settings.
fn frame(draws: &mut Draws, settings: &Settings, index: u64) -> View {
    let view = any_frame(draws, 0.03).with(|view| view.noise = view.noise.take().filter(|_| settings.noisy));
    let whole = |view: View| view.with(|view| view.lod = None);
    match settings.foveation.kind {
        FoveationKind::Quads => whole(view).with(|view| view.facts.jitter_px = Foveation::jitter_px(index + 1)),
        _ => view,
    }
}

/// Processes a frame, with notes about a pixel if one is given. Returns the output.
fn process(post: &mut CpuAfterimage, index: u64, view: &View, pixel: Option<&mut PixelNotes>) -> Color {
    let images = Images::of([view]);
    let exposure = Exposure::Scene { exposure: [1.0, 0.37, 4.0][index as usize % 3] };
    let frame = Frame { exposure, ..images.frame(index) };
    planned(post, &frame);
    let mut shown = [Image::filled(SIZE, [f32::NAN; 3])];
    match pixel {
        Some(pixel) => post.process_noted(&frame, &mut shown, None, pixel).unwrap(),
        None => post.process(&frame, &mut shown).unwrap(),
    };
    let [shown] = shown;
    shown
}

fn bits(note: Option<&Note>) -> Vec<u32> {
    match note.map(|note| &note.values) {
        Some(NoteValues::Numbers(numbers)) => numbers.iter().map(|v| v.to_bits()).collect(),
        Some(NoteValues::Words(words)) => words.clone(),
        _ => vec![],
    }
}

/// Words that history stores for a pixel.
fn stored(post: &CpuAfterimage, i: usize) -> Vec<u32> {
    let history = post.history();
    let surface = history.surfaces().get(i).map(|words| words.to_vec());
    history.words().get(i).map(|words| words.to_vec()).or(surface).unwrap_or_default()
}

/// Whether notes say what a frame shows and stores.
fn agree(pixel: &PixelNotes, shown: [f32; 3], stored: &[u32]) -> bool {
    bits(pixel.find(NoteStage::Shown, "color")) == shown.map(f32::to_bits)
        && bits(pixel.find(NoteStage::Stored, "words")) == stored
}

#[test]
fn notes_are_what_the_pass_computed_and_change_nothing() {
    let mut texts = BTreeSet::new();
    for (kind, settings) in all_kinds().into_iter().enumerate() {
        let name = format!("{kind}: {} of {:?}", settings.method.name(), settings.foveation.kind);
        let mut draws = Draws::new(&format!("notes about {kind}"));
        let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
        let [mut plain, mut noted, mut late] = [(); 3].map(|()| CpuAfterimage::new(&desc).unwrap());
        let mut caught = [0; 3];
        for index in 0..FRAMES {
            let view = frame(&mut draws, &settings, index);
            let px = SIZE.map(|side| draws.bits() % side);
            let (i, [x, y]) = ((px[1] * SIZE[0] + px[0]) as usize, px.map(|v| v as usize));
            let [mut pixel, mut of_late] = [(); 2].map(|()| PixelNotes::new(0, px));
            let shown = process(&mut plain, index, &view, None);
            assert_eq!(process(&mut noted, index, &view, Some(&mut pixel)), shown, "{name}, frame {index}");
            assert_eq!(noted.history(), plain.history(), "{name}, frame {index}");
            let (color, words) = (shown.at(x, y), stored(&plain, i));
            assert!(agree(&pixel, color, &words), "{name}, frame {index}, pixel {px:?}: {pixel:#?}");
            assert!(pixel.notes.is_sorted_by_key(|note| note.stage), "{name}");
            if let Some(Note { values: NoteValues::Text(text), .. }) = pixel.find(NoteStage::Verdict, "history") {
                texts.insert(*text);
            }
            // Planted: another color in the lowest bit, another word in the lowest bit, a context that missed a frame.
            caught[0] += usize::from(!agree(&pixel, color.map(|v| f32::from_bits(v.to_bits() ^ 1)), &words));
            let flipped: Vec<u32> = words.iter().map(|word| word ^ 1).collect();
            caught[1] += usize::from(!agree(&pixel, color, &flipped));
            if index % 3 != 1 {
                process(&mut late, index, &view, Some(&mut of_late));
                caught[2] += usize::from(!agree(&of_late, color, &words));
            }
        }
        println!("{name}: planted errors caught {caught:?}");
        assert_eq!(caught[0] as u64, FRAMES);
        assert!(settings.method == Method::None || (caught[1] as u64 == FRAMES && caught[2] > 0), "{name}: {caught:?}");
    }
    println!("{texts:#?}");
    assert!(texts.len() > 5, "verdicts have their reasons: {texts:#?}");
}

#[test]
fn a_pixel_outside_the_frame_has_no_notes() {
    let mut draws = Draws::new("notes about nothing");
    let mut post = CpuAfterimage::new(&ContextDesc::new(SIZE)).unwrap();
    for (view, px) in [(0, [SIZE[0], 0]), (0, [0, SIZE[1]]), (1, [0, 0])] {
        let mut pixel = PixelNotes::new(view, px);
        process(&mut post, 0, &frame(&mut draws, &Settings::default(), 0), Some(&mut pixel));
        assert_eq!(pixel.notes, []);
    }
}
