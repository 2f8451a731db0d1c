//! `bindgen LIBRARY.wasm FOLDER NAME`: the WebAssembly that a browser loads, and the JavaScript that calls it.
//! `bindgen compact SHADERS...`: rewrites files of shaders, so that they weigh little in a library.

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

fn compact_files(shaders: &[String]) -> Result<(), Box<dyn Error>> {
    for shader in shaders {
        let text = fs::read(shader).map_err(|error| format!("{shader}: {error}"))?;
        fs::write(shader, compact(&text)).map_err(|error| format!("{shader}: {error}"))?;
    }
    Ok(())
}

fn write(library: &str, folder: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(library).typescript(false).remove_name_section(true).remove_producers_section(true);
    bindgen.omit_default_module_path(false).out_name(name);
    Ok(bindgen.web(true)?.generate(folder)?)
}

/// A shader's text without comments, indentation, and spaces beside punctuation. The library itself reads lines of
/// `//#use`, `@group` and `override`: these stay.
fn compact(text: &[u8]) -> Vec<u8> {
    let mut short = Vec::with_capacity(text.len());
    for line in text.split(|&byte| byte == b'\n') {
        let comment = line.windows(2).position(|pair| pair == b"//").unwrap_or(line.len());
        let code = if line[comment..].starts_with(b"//#use ") { line } else { &line[..comment] };
        let code = code.trim_ascii();
        let is_read = [&b"//"[..], b"@", b"override"].iter().any(|start| code.starts_with(start));
        // Between two operators they stay, as in `a - -b` and `array<f32, 4> =`; so they do beside `<` and `>`, which
        // are read as brackets.
        let is_spare = |at: usize| {
            let beside = [code[at - 1], *code.get(at + 1).unwrap_or(&b' ')];
            let is_beside = |bytes: &[u8]| beside.iter().any(|byte| bytes.contains(byte));
            let is_operand = |byte: &u8| byte.is_ascii_alphanumeric() || b"_.]".contains(byte);
            let is_at_operand = is_beside(b"+-*/=&|") && beside.iter().any(is_operand);
            code[at] == b' ' && !is_read && (is_beside(b" ,;:(){}") || is_at_operand)
        };
        if !code.is_empty() {
            short.extend((0..code.len()).filter(|&at| at == 0 || !is_spare(at)).map(|at| code[at]));
            short.push(b'\n');
        }
    }
    short
}
