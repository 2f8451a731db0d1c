//! What `-h` shows: the options that people need first. `--help` shows all.

use clap::Command;

/// Subcommands whose options fill more than two screens, and which of them `-h` shows.
const FIRST: [(&str, &[&str]); 3] = [
    ("run", &["name", "out", "gaze", "frames", "size", "source", "camera", "filter", "method", "backend", "video"]),
    ("trace", &["scene", "out", "size", "frames", "camera", "spp", "sampling", "gaze", "sky", "aov", "backend"]),
    ("view", &["name", "size", "source", "camera", "method", "split", "gaze", "filter", "fovea", "screenshot"]),
];

/// The command with a short `-h` for each subcommand.
pub fn with_short_help(mut command: Command) -> Command {
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    for name in names {
        command = command.mut_subcommand(name, shortened);
    }
    command
}

fn shortened(command: Command) -> Command {
    // The help of a few options is short.
    if command.get_opts().count() < 3 {
        return command;
    }
    let first = FIRST.iter().find(|(name, _)| *name == command.get_name()).map(|(_, first)| *first);
    let long = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    // An empty line ends the examples; what is written follows.
    let end = long.find("Example").and_then(|at| Some(at + long[at..].find("\n\n")?)).unwrap_or(long.len());
    let examples = &long[..end];
    let more = match first {
        Some(_) => "These are the options that people need first. --help has all, and says more.",
        None => "See --help for more of each option and its values.",
    };
    let short = format!("{examples}\n\n{more}");
    let command = command.after_help(short).after_long_help(long);
    match first {
        Some(first) => command.mut_args(|arg| {
            let is_first = first.contains(&arg.get_id().as_str());
            arg.hide_short_help(!is_first)
        }),
        None => command,
    }
}
