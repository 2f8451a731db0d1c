//! `bindgen LIBRARY.wasm FOLDER NAME`: the WebAssembly that a browser loads, and the JavaScript that calls it.
//! `bindgen compact SHADERS...`: rewrites files of shaders that are composed with each other, so that they weigh
//! little in a library.

mod compact;

use compact::compact;
use std::env::args;
use std::path::Path;
use std::process::ExitCode;
use std::{error::Error, fs};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let words: Vec<_> = args().skip(1).collect();
    let result = match words.as_slice() {
        [word, shaders @ ..] if word == "compact" => compact_files(shaders),
        [library, folder, name] => write(library, Path::new(folder), name),
        _ => {
            eprintln!("expected: bindgen LIBRARY.wasm FOLDER NAME, or bindgen compact SHADERS...");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error:#}", words[0]);
            ExitCode::FAILURE
        }
    }
}

fn compact_files(files: &[String]) -> Result<(), Box<dyn Error>> {
    let mut shaders = Vec::new();
    for file in files {
        shaders.push(fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?);
    }
    compact(&mut shaders);
    for (file, text) in files.iter().zip(&shaders) {
        fs::write(file, text).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

fn write(library: &str, folder: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(library).typescript(false).remove_name_section(true).remove_producers_section(true);
    bindgen.omit_default_module_path(false).out_name(name);
    Ok(bindgen.web(true)?.generate(folder)?)
}
