//! The EXR files of a folder: numbered frames, and passes in files of their own.

use crate::error::{InputError, io_error};
use crate::file_kind::ending;
use std::fs;
use std::path::{Path, PathBuf};

/// The files of one pass, or of whole frames, in playback order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PassFiles {
    /// Name of the pass: what its files' names (or its folder's) have and those of other passes lack, in lower case.
    pub pass: String,
    pub files: Vec<PathBuf>,
    pub numbers: Vec<Option<i64>>,
}

/// The passes of a folder: of its `.exr` files, or else of those in its folders.
pub(super) fn passes(folder: &Path) -> Result<Vec<PassFiles>, InputError> {
    let subject = folder.display().to_string();
    let folders = match exr_files(folder) {
        Err(error) => folders_of_passes(folder)?.ok_or(error)?,
        Ok(files) => return passes_of(&subject, files),
    };
    let mut passes = vec![];
    for folder in folders {
        let subject = folder.display().to_string();
        let [only] = <[PassFiles; 1]>::try_from(passes_of(&subject, exr_files(&folder)?)?).map_err(|several| {
            let names: Vec<&str> = several.iter().take(4).map(|pass| pass.pass.as_str()).collect();
            InputError::request(
                &subject,
                format!("holds several passes ({}) in a folder of passes", names.join(", ")),
                "expected one pass in each folder, or all passes in one folder",
            )
        })?;
        let pass = folder.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        passes.push(PassFiles { pass, ..only });
    }
    Ok(passes)
}

/// The folders in a folder that hold `.exr` files, by name; `None` if there is none.
fn folders_of_passes(folder: &Path) -> Result<Option<Vec<PathBuf>>, InputError> {
    let subject = folder.display().to_string();
    let mut folders = vec![];
    for entry in fs::read_dir(folder).map_err(|e| io_error(&subject, &e))? {
        let path = entry.map_err(|e| io_error(&subject, &e))?.path();
        if path.is_dir() && exr_files(&path).is_ok() {
            folders.push(path);
        }
    }
    folders.sort();
    Ok((!folders.is_empty()).then_some(folders))
}

/// Files by pass: those whose names differ in numbers alone are of one.
fn passes_of(subject: &str, files: Vec<PathBuf>) -> Result<Vec<PassFiles>, InputError> {
    let parts = parts_of_all(&files);
    let mut groups: Vec<(String, Vec<PathBuf>)> = vec![];
    let are_numbered = parts.iter().any(|(_, numbers)| !numbers.is_empty());
    for (file, (text, _)) in files.into_iter().zip(parts) {
        // Files without numbers are frames in the order of their names.
        match groups.iter_mut().find(|(other, _)| *other == text || !are_numbered) {
            Some((_, files)) => files.push(file),
            None => groups.push((text, vec![file])),
        }
    }
    let names = pass_names(&groups.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>());
    let numbered = groups.into_iter().zip(names).map(|((_, files), pass)| {
        let (files, numbers) = numbered_files(subject, files)?;
        Ok(PassFiles { pass, files, numbers })
    });
    numbered.collect()
}

/// Files of one sequence of frames.
pub(super) fn one_sequence(subject: &str, files: Vec<PathBuf>) -> Result<PassFiles, InputError> {
    let mut passes = passes_of(subject, files)?;
    let first = passes.swap_remove(0);
    if let Some(other) = passes.first() {
        let [a, b] = [&first, other].map(|pass| pass.files[0].file_name().unwrap_or_default().to_string_lossy());
        let problem = format!("holds two sequences: {a} and {b} differ in more than numbers");
        return Err(InputError::request(
            subject,
            problem,
            "expected the frames of one sequence; keep one sequence in a folder",
        ));
    }
    Ok(first)
}

/// The words of each text without those that all have in front and behind.
fn pass_names(texts: &[&str]) -> Vec<String> {
    let is_between = |c: char| "#._- ".contains(c);
    let words: Vec<Vec<&str>> =
        texts.iter().map(|text| text.split(is_between).filter(|word| !word.is_empty()).collect()).collect();
    let shortest = words.iter().map(Vec::len).min().unwrap_or(0);
    let same = |at: &dyn Fn(&Vec<&'_ str>) -> String| words.windows(2).all(|pair| at(&pair[0]) == at(&pair[1]));
    let front = (0..shortest).take_while(|&i| same(&|words| words[i].to_owned())).count();
    let behind = (0..shortest - front).take_while(|&i| same(&|words| words[words.len() - 1 - i].to_owned())).count();
    words.iter().map(|words| words[front..words.len() - behind].join("_")).collect()
}

/// Refuses passes of which one lacks a frame that another has.
pub(super) fn check_same_frames(subject: &str, passes: &[PassFiles]) -> Result<(), InputError> {
    for (has, lacks) in passes.iter().flat_map(|a| passes.iter().map(move |b| (a, b))) {
        let Some(at) = has.numbers.iter().position(|number| !lacks.numbers.contains(number)) else { continue };
        let number = has.numbers[at].map_or("without a number".to_owned(), |number| number.to_string());
        return Err(InputError::invalid(
            subject,
            format!("frame {number} has the pass {} and lacks the pass {}", named(has), named(lacks)),
            format!("add the missing file, or remove {}", has.files[at].display()),
        ));
    }
    Ok(())
}

fn named(pass: &PassFiles) -> String {
    let like = pass.files.first().and_then(|file| file.file_name()).unwrap_or_default().to_string_lossy().into_owned();
    if pass.pass.is_empty() { format!("of files like {like}") } else { format!("{} (files like {like})", pass.pass) }
}

/// The `.exr` files of a folder, by name. Hidden files are skipped.
fn exr_files(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    let subject = folder.display().to_string();
    let (mut files, mut pictures) = (Vec::new(), 0);
    for entry in fs::read_dir(folder).map_err(|e| io_error(&subject, &e))? {
        let path = entry.map_err(|e| io_error(&subject, &e))?.path();
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if !hidden && ending(&path) == "exr" && path.is_file() {
            files.push(path);
        } else if !hidden && ["png", "jpg", "jpeg"].contains(&ending(&path).as_str()) {
            pictures += 1;
        }
    }
    if files.is_empty() && pictures > 0 {
        return Err(InputError::request(
            subject,
            format!("holds {pictures} pictures and no .exr file; a sequence needs motion vectors, which only EXR has"),
            "render EXR frames with motion vectors, or give the path of one picture as a still",
        ));
    }
    if files.is_empty() {
        return Err(InputError::request(
            subject,
            "holds no .exr file",
            "expected a folder of EXR frames, or the path of one image",
        ));
    }
    files.sort();
    Ok(files)
}

/// Which hyphens before a number are its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    /// Those behind neither a letter nor a digit: `f_-001`, `-001`, `shot--001`. Others separate: `shot-001`.
    Apart,
    /// All: `f-001` beside `f0000`.
    All,
}

/// A file's name without its ending: the text around its numbers, in lower case, and the numbers.
fn parts_of(file: &Path, sign: Sign) -> (String, Vec<i64>) {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let (mut text, mut numbers, mut rest) = (String::new(), vec![], stem.as_str());
    while let Some(first_digit) = rest.find(|c: char| c.is_ascii_digit()) {
        let end = rest[first_digit..].find(|c: char| !c.is_ascii_digit()).map_or(rest.len(), |n| first_digit + n);
        // Without text in between, the hyphen is behind the number before.
        let is_apart = |before: &str| !before.chars().next_back().map_or(!text.is_empty(), char::is_alphanumeric);
        let is_sign = |before: &str| sign == Sign::All || is_apart(before);
        let before = rest[..first_digit].strip_suffix('-').filter(|before| is_sign(before));
        let start = before.map_or(first_digit, str::len);
        text.push_str(&rest[..start]);
        match rest[start..end].parse() {
            Ok(number) => {
                text.push('#');
                numbers.push(number);
            }
            // Longer than any frame number.
            Err(_) => text.push_str(&rest[start..end]),
        }
        rest = &rest[end..];
    }
    text.push_str(rest);
    (text, numbers)
}

/// Text and numbers of each file's name. If hyphens differ, they are signs, if that makes one sequence through frame 0.
fn parts_of_all(files: &[PathBuf]) -> Vec<(String, Vec<i64>)> {
    let all = |sign| files.iter().map(|file| parts_of(file, sign)).collect::<Vec<_>>();
    let is_one = |parts: &[(String, Vec<i64>)]| parts.windows(2).all(|pair| pair[0].0 == pair[1].0);
    let parts = all(Sign::Apart);
    if is_one(&parts) {
        return parts;
    }
    let signed = all(Sign::All);
    let has_frame_0 = signed.iter().any(|(_, numbers)| numbers.contains(&0));
    if is_one(&signed) && has_frame_0 { signed } else { parts }
}

/// Files of one pass in playback order, and their frame numbers: of the numbers in their names, the one that is another
/// in every file. If several are, the last that has even steps, or else the last. Files without numbers are in order of
/// their names.
fn numbered_files(subject: &str, files: Vec<PathBuf>) -> Result<(Vec<PathBuf>, Vec<Option<i64>>), InputError> {
    let parts = parts_of_all(&files);
    if files.len() < 2 || parts.iter().all(|(_, numbers)| numbers.is_empty()) {
        let numbers = vec![None; files.len()];
        return Ok((files, numbers));
    }
    let file_name = |i: usize| files[i].file_name().unwrap_or_default().to_string_lossy().into_owned();
    let column = |place: usize| parts.iter().map(move |(_, numbers)| numbers[place]);
    let sorted = |place: usize| {
        let mut numbers: Vec<i64> = column(place).collect();
        numbers.sort_unstable();
        numbers
    };
    let places = 0..parts[0].1.len();
    let varying: Vec<usize> = places.clone().filter(|&place| sorted(place).windows(2).all(|w| w[0] < w[1])).collect();
    let is_even = |&&place: &&usize| {
        let numbers = sorted(place);
        numbers.windows(2).all(|w| w[1].abs_diff(w[0]) == numbers[1].abs_diff(numbers[0]))
    };
    let Some(&place) = varying.iter().rev().find(is_even).or(varying.last()) else {
        let distinct = |&place: &usize| {
            let mut numbers = sorted(place);
            numbers.dedup();
            numbers.len()
        };
        let place = places.max_by_key(distinct).unwrap_or(0);
        let numbers: Vec<i64> = column(place).collect();
        let pairs = (0..numbers.len()).flat_map(|i| (0..i).map(move |j| [j, i]));
        let [a, b] = pairs.into_iter().find(|&[a, b]| numbers[a] == numbers[b]).unwrap_or([0, 1]);
        let number = numbers[a];
        let problem = format!("has two frames of number {number}: {} and {}", file_name(a), file_name(b));
        return Err(InputError::request(subject, problem, "keep the frames of one sequence in a folder"));
    };
    let numbers: Vec<i64> = column(place).collect();
    let mut order: Vec<usize> = (0..files.len()).collect();
    order.sort_by_key(|&i| numbers[i]);
    Ok((order.iter().map(|&i| files[i].clone()).collect(), order.iter().map(|&i| Some(numbers[i])).collect()))
}

/// Refuses a sequence with a missing frame, because the motion vectors of the frame after it refer to the missing one.
pub(super) fn check_gaps(subject: &str, numbers: &[Option<i64>]) -> Result<(), InputError> {
    let Some(numbers) = numbers.iter().copied().collect::<Option<Vec<i64>>>() else {
        return Ok(());
    };
    let steps: Vec<u64> = numbers.windows(2).map(|w| w[1].abs_diff(w[0])).collect();
    let smallest = steps.iter().copied().min().unwrap_or(0);
    match steps.iter().position(|&s| s != smallest) {
        Some(at) => Err(InputError::invalid(
            subject,
            format!("its frame numbers jump from {} to {}", numbers[at], numbers[at + 1]),
            format!(
                "expected steps of {smallest}; add the missing frames, or put each unbroken run into a folder of its own"
            ),
        )),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frame numbers of files in playback order, or the error.
    fn numbered(names: &[&str]) -> Result<Vec<(String, Option<i64>)>, String> {
        let files = names.iter().map(PathBuf::from).collect();
        let (files, numbers) = numbered_files("d", files).map_err(|e| e.to_string())?;
        Ok(files.iter().map(|file| file.display().to_string()).zip(numbers).collect())
    }

    #[test]
    fn the_number_that_varies_counts() {
        let numbers = |names: &[&str]| numbered(names).unwrap().into_iter().map(|(_, n)| n).collect::<Vec<_>>();
        assert_eq!(numbers(&["t2_0041.exr", "t2_0043.exr", "t2_0042.exr"]), [Some(41), Some(42), Some(43)]);
        assert_eq!(numbers(&["f0008_v2.exr", "f0010_v2.exr", "f0009_v2.exr"]), [Some(8), Some(9), Some(10)]);
        // A time stamp beside the number, in the same order.
        assert_eq!(numbers(&["1700000100_1.exr", "1700000233_2.exr", "1700000310_3.exr"]), [Some(1), Some(2), Some(3)]);
        assert_eq!(numbers(&["1_1700000100.exr", "2_1700000233.exr", "3_1700000310.exr"]), [Some(1), Some(2), Some(3)]);
        assert_eq!(numbers(&["9.exr", "10.exr", "11.exr"]), [Some(9), Some(10), Some(11)]);
        assert_eq!(numbers(&["\u{fc}n\u{ef}12.exr", "\u{fc}n\u{ef}13.EXR"]), [Some(12), Some(13)]);
        assert_eq!(numbers(&["b.exr", "a.exr"]), [None, None]);
        assert_eq!(numbers(&["beauty.exr"]), [None]);
    }

    #[test]
    fn frames_before_zero_come_first() {
        for names in [
            ["f_-0002.exr", "f_-0001.exr", "f_0000.exr", "f_0001.exr"],
            ["-0002.exr", "-0001.exr", "0000.exr", "0001.exr"],
            ["f.-2.exr", "f.-1.exr", "f.0.exr", "f.1.exr"],
            ["render-002.exr", "render-001.exr", "render0000.exr", "render0001.exr"],
            ["shot--002.exr", "shot--001.exr", "shot-000.exr", "shot-001.exr"],
        ] {
            let in_order = |order: [usize; 4]| numbered(&order.map(|i| names[i]));
            let expected: Vec<_> = names.iter().map(|name| (*name).to_owned()).zip([-2, -1, 0, 1].map(Some)).collect();
            assert_eq!(in_order([3, 1, 2, 0]).unwrap(), expected);
        }
        assert_eq!(numbered(&["f_-3.exr", "f_-2.exr", "f_-1.exr"]).unwrap()[0].1, Some(-3));
        // A hyphen behind a word separates.
        assert_eq!(numbered(&["shot-001.exr", "shot-002.exr"]).unwrap()[0].1, Some(1));
        assert_eq!(numbered(&["2024-01-05_1.exr", "2024-01-05_2.exr"]).unwrap()[1].1, Some(2));
    }

    #[test]
    fn names_that_differ_in_words_are_those_of_passes() {
        let found = |names: &[&str]| -> Vec<(String, usize)> {
            let found = passes_of("d", names.iter().map(PathBuf::from).collect()).unwrap();
            found.into_iter().map(|pass| (pass.pass, pass.files.len())).collect()
        };
        let passes =
            |names: &[(&str, usize)]| names.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect::<Vec<_>>();
        assert_eq!(found(&["f_1.exr", "f_2.exr"]), passes(&[("", 2)]));
        assert_eq!(found(&["a_1.exr", "a_2.exr", "b_1.exr", "b_2.exr"]), passes(&[("a", 2), ("b", 2)]));
        assert_eq!(found(&["frame_1.L.exr", "frame_1.R.exr"]), passes(&[("l", 1), ("r", 1)]));
        assert_eq!(found(&["f-1.exr", "f1.exr", "f2.exr"]), passes(&[("", 1), ("", 2)]));
        let queue = ["Shot.FinalImage.0001.exr", "Shot.FinalImageMovieRenderQueue_MotionVectors.0001.exr"];
        let names = [("finalimage", 1), ("finalimagemovierenderqueue_motionvectors", 1)];
        assert_eq!(found(&queue), passes(&names));
        assert_eq!(found(&["shot1_1.exr", "shot1_depth_1.exr"]), passes(&[("", 1), ("depth", 1)]));
    }

    #[test]
    fn two_frames_of_a_number_are_refused_by_name() {
        let error = numbered(&["f1.exr", "f01.exr"]).unwrap_err();
        assert!(error.contains("number 1: f1.exr and f01.exr"), "{error}");
        let error = numbered(&["shot1_1.exr", "shot1_2.exr", "shot2_1.exr", "shot2_2.exr"]).unwrap_err();
        assert!(error.contains("two frames of number"), "{error}");
    }

    #[test]
    fn passes_have_the_same_frames() {
        let pass = |name: &str, numbers: &[i64]| PassFiles {
            pass: name.into(),
            files: numbers.iter().map(|n| format!("{name}_{n}.exr").into()).collect(),
            numbers: numbers.iter().map(|&n| Some(n)).collect(),
        };
        assert!(check_same_frames("d", &[pass("a", &[1, 2]), pass("b", &[1, 2])]).is_ok());
        let error = check_same_frames("d", &[pass("a", &[1, 3]), pass("b", &[1, 2, 3])]).unwrap_err().to_string();
        assert!(error.contains("frame 2 has the pass b") && error.contains("lacks the pass a"), "{error}");
        assert!(error.contains("remove b_2.exr"), "{error}");
    }

    #[test]
    fn a_missing_frame_is_noticed() {
        let gap = |v: &[i64]| check_gaps("d", &v.iter().map(|&n| Some(n)).collect::<Vec<_>>());
        assert!(gap(&[3, 4, 5]).is_ok());
        assert!(gap(&[0, 10, 20]).is_ok());
        let e = gap(&[1, 2, 4]).unwrap_err().to_string();
        assert!(e.contains("from 2 to 4"), "{e}");
    }
}
