//! Shaders that weigh little: without comments and indentation, with short names of what functions declare.

use std::collections::{BTreeMap, BTreeSet};

/// Rewrites the texts of shaders that are composed with each other.
pub fn compact(shaders: &mut [String]) {
    shaders.iter_mut().for_each(|text| *text = without_space(text));
    let global: BTreeSet<String> = shaders.iter().flat_map(|text| global_words(text)).map(str::to_string).collect();
    shaders.iter_mut().for_each(|text| *text = with_short_locals(text, &global));
}

/// A shader's text without comments, indentation, and spaces beside punctuation. The library itself reads lines of
/// `//#use`, `@group` and `override`: these stay.
fn without_space(text: &str) -> String {
    let mut short = String::with_capacity(text.len());
    for line in text.lines() {
        let comment = line.find("//").unwrap_or(line.len());
        let code = if line[comment..].starts_with("//#use ") { line } else { &line[..comment] }.trim();
        let is_read = ["//", "@", "override"].iter().any(|start| code.starts_with(start));
        let code = code.as_bytes();
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
            short.extend((0..code.len()).filter(|&at| at == 0 || !is_spare(at)).map(|at| char::from(code[at])));
            short.push('\n');
        }
    }
    short
}

/// Words outside of all brackets: names of what modules declare, and keywords.
fn global_words(text: &str) -> Vec<&str> {
    let mut depth = 0;
    let mut words = tokens(text);
    words.retain(|token| {
        depth += i32::from(matches!(*token, "(" | "{")) - i32::from(matches!(*token, ")" | "}"));
        depth == 0 && is_word(token)
    });
    words
}

/// The text with short names of parameters and of what functions declare. Entry points keep theirs, and so does what is
/// named like something `global`.
fn with_short_locals(text: &str, global: &BTreeSet<String>) -> String {
    let tokens = tokens(text);
    let mut short = String::with_capacity(text.len());
    let mut rest = &tokens[..];
    while let Some(start) = rest.iter().position(|&token| token == "fn") {
        let body = start + rest[start..].iter().position(|&token| token == "{").expect("functions have bodies");
        let mut depth = 0;
        let end = body
            + rest[body..]
                .iter()
                .position(|&token| {
                    depth += i32::from(token == "{") - i32::from(token == "}");
                    depth == 0
                })
                .expect("brackets are closed");
        let function = &rest[start..=end];
        let names = match function[..body - start].contains(&"@") {
            true => BTreeMap::new(),
            false => short_names(function, body - start, global),
        };
        short.extend(rest[..start].iter().copied());
        for (at, token) in function.iter().enumerate() {
            let is_member = at > 0 && function[at - 1] == ".";
            short.push_str(names.get(token).filter(|_| !is_member).map_or(*token, String::as_str));
        }
        rest = &rest[end + 1..];
    }
    short.extend(rest.iter().copied());
    short
}

/// Short names that the function does not use yet, by the names that it declares.
fn short_names<'a>(function: &[&'a str], body: usize, global: &BTreeSet<String>) -> BTreeMap<&'a str, String> {
    let used: BTreeSet<_> = function.iter().copied().collect();
    let letters = || (b'a'..=b'z').map(char::from);
    let one = letters().map(String::from);
    let two = letters().flat_map(|a| letters().map(move |b| format!("{a}{b}")));
    let mut free = one
        .chain(two)
        .filter(|name| !used.contains(name.as_str()) && !["as", "do", "fn", "if"].contains(&name.as_str()));
    let mut names = BTreeMap::new();
    for (at, &token) in function.iter().enumerate().skip(2) {
        let is_parameter = at < body && function[at + 1] == ":";
        let is_declared = function[at - 1] == " " && matches!(function[at - 2], "let" | "var" | "const");
        if (is_parameter || is_declared) && is_word(token) && !global.contains(token) && !names.contains_key(token) {
            names.insert(token, free.next().expect("no function declares hundreds of names"));
        }
    }
    names
}

/// Words, and every other character by itself.
fn tokens(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if is_part(first) { rest.find(|c| !is_part(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (token, after) = rest.split_at(end);
        tokens.push(token);
        rest = after;
    }
    tokens
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}
