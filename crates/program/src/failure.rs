//! Errors of programs: one line of text, and an exit code that separates bad input from failed work.

use afterimage::{CreateError, FrameError, SettingsError};
use afterimage_eval::clip::ClipError;
use afterimage_eval::error::{Bound, InputError};
use afterimage_eval::output::WriteError;
use clap::error::ErrorKind;
use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

/// Error that ends a program.
#[derive(Debug)]
pub enum Failure {
    /// Bad usage or input: exit code 2.
    Input(String),
    /// The work failed: exit code 1.
    Work(String),
}

impl Failure {
    /// Prints the error to stderr and returns the exit code.
    pub fn report(&self) -> ExitCode {
        let (text, code) = match self {
            Self::Input(text) => (text, 2),
            Self::Work(text) => (text, 1),
        };
        eprintln!("afterimage: {}", text.replace('\n', " "));
        ExitCode::from(code)
    }

    /// Exit code of a command that has ended; prints its error.
    pub fn exit_code(result: Result<(), Self>) -> ExitCode {
        result.map_or_else(|failure| failure.report(), |()| ExitCode::SUCCESS)
    }

    /// Exit code of a command line that is not run: prints help and version, or a usage error in one line.
    pub fn usage_exit_code(error: &clap::Error) -> ExitCode {
        if !error.use_stderr() {
            // A closed pipe is not an error.
            let _ = error.print();
            return ExitCode::SUCCESS;
        }
        Self::usage(error).report()
    }

    /// A usage error of the command line, in one line.
    pub fn usage(error: &clap::Error) -> Self {
        if error.kind() == ErrorKind::InvalidUtf8
            && let Some(argument) = std::env::args_os().skip(1).find(|argument| argument.to_str().is_none())
        {
            // Debug text shows the bytes.
            return Self::Input(format!(
                "the argument {argument:?} is not UTF-8 text; rename the file, or make a link to it with such a name"
            ));
        }
        let text = error.render().to_string();
        let lines: Vec<&str> = text
            .lines()
            .map(str::trim)
            .take_while(|l| !l.starts_with("Usage:"))
            .filter(|l| !l.is_empty() && !l.starts_with("For more information"))
            .collect();
        let line = lines.join(" ");
        let line = line.strip_prefix("error: ").unwrap_or(&line);
        Self::Input(format!("{line}; see --help"))
    }

    /// A file that cannot be written during the work.
    pub fn writing(path: &Path, error: impl Display) -> Self {
        WriteError::new(path, error).into()
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(with_option(&error))
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Work(error.to_string())
    }
}

impl From<ClipError> for Failure {
    fn from(error: ClipError) -> Self {
        match error {
            ClipError::Input(error) => error.into(),
            ClipError::Create(error) => error.into(),
            ClipError::Frame(error) => error.into(),
            ClipError::Write(error) => error.into(),
        }
    }
}

/// Prints warnings, those of gaze logs and channels with options.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        eprintln!("afterimage: warning: {}", with_options(warning));
    }
}

/// The line of `error`, with the option of this tool that solves the problem: the library does not know these options.
fn with_option(error: &InputError) -> String {
    match error {
        // These remedies end with "or raise the limit".
        InputError::Limit { exceeded, .. } if exceeded.bound == Bound::Pixels => {
            let megapixels = exceeded.needed_megapixels().map_or("N".to_owned(), |n| n.to_string());
            format!("{error} with --max-megapixels {megapixels}")
        }
        InputError::Request(message) | InputError::Invalid(message) if message.remedy.contains('`') => {
            with_options(&error.to_string())
        }
        // If a camera does not exist, the error's subject is "camera NAME".
        InputError::Request(message) if message.subject.starts_with("camera ") => format!("--{error}"),
        // These remedies end with the suggestion to use the CPU.
        InputError::Device(_) => format!("{error} (--backend cpu)"),
        _ => error.to_string(),
    }
}

/// `text` with the options of gaze logs and of channels instead of the names of their fields.
pub fn with_options(text: &str) -> String {
    let options = [
        ("`screen_px`", "--screen-px WxH"),
        ("`screen_mm`", "--screen-mm WxH"),
        ("`distance_mm`", "--distance-mm D"),
        ("`eye`", "--eye"),
        ("`gaze_columns`", "--gaze-columns t=NAME,x=NAME,y=NAME"),
        ("the gaze map `fit`", "--gaze-map fit"),
        ("`info`", "afterimage info"),
        ("`color`", "--color"),
        ("`depth`", "--depth"),
        ("`albedo`=", "--albedo "),
        ("`albedo`", "--albedo"),
        ("`motion`=", "--motion "),
        ("`motion`", "--motion"),
        ("`motion_convention`=", "--motion-convention "),
        ("`depth_convention`=", "--depth-convention "),
    ];
    options.iter().fold(text.to_owned(), |text, (field, option)| text.replace(field, option))
}

impl From<SettingsError> for Failure {
    fn from(error: SettingsError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<CreateError> for Failure {
    fn from(error: CreateError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<FrameError> for Failure {
    fn from(error: FrameError) -> Self {
        Self::Work(error.to_string())
    }
}
