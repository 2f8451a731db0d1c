//! Comments and string literals of Rust and WGSL; the rule about string literals of the lab.

use super::tree::{Tree, expect_none, read};

/// What a piece of source text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One line, without its slashes and the character that makes it a doc comment.
    Comment,
    /// Between the quotes, as written in the source.
    Literal,
    /// A name, a number or a character of the code.
    Code,
}

/// A piece of source text, and its line from 1.
#[derive(Debug, PartialEq, Eq)]
pub struct Piece<'a> {
    pub kind: Kind,
    pub line: usize,
    pub text: &'a str,
}

/// Comments and string literals of Rust or WGSL, in order.
pub fn pieces(source: &str) -> Vec<Piece<'_>> {
    all_pieces(source).into_iter().filter(|p| p.kind != Kind::Code).collect()
}

/// Comments, string literals and code of Rust or WGSL, in order, without spaces and character literals. Block comments,
/// which the sources do not have, are not recognized.
pub fn all_pieces(source: &str) -> Vec<Piece<'_>> {
    let mut found = vec![];
    let (mut at, mut line) = (0, 1);
    while at < source.len() {
        let rest = &source[at..];
        let mut piece = |kind, text| found.push(Piece { kind, line, text });
        let step = if let Some(comment) = rest.strip_prefix("//") {
            let text = comment.lines().next().unwrap_or("");
            piece(Kind::Comment, text.trim_start_matches(['/', '!']));
            2 + text.len()
        } else if let Some(quoted) = rest.strip_prefix('"') {
            let length = end_of_literal(quoted);
            piece(Kind::Literal, &quoted[..length]);
            length + 2
        } else if let Some((open, close)) = raw_quotes(rest) {
            let quoted = &rest[open..];
            let length = quoted.find(&close).expect("raw strings end");
            piece(Kind::Literal, &quoted[..length]);
            open + length + close.len()
        } else if let Some(length) = character(rest) {
            length
        } else if rest.starts_with(is_of_identifier) {
            let length = rest.find(|c| !is_of_identifier(c)).unwrap_or(rest.len());
            piece(Kind::Code, &rest[..length]);
            length
        } else {
            let length = rest.chars().next().map_or(1, char::len_utf8);
            if !rest.starts_with(char::is_whitespace) {
                piece(Kind::Code, &rest[..length]);
            }
            length
        };
        line += rest[..step].matches('\n').count();
        at += step;
    }
    found
}

pub fn is_of_identifier(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn end_of_literal(quoted: &str) -> usize {
    let mut escaped = false;
    quoted
        .find(|c| {
            let ends = c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
            ends
        })
        .expect("string literals end")
}

/// Length of the opening quote of a raw string at the start of `rest`, with its prefix, and the closing quote.
fn raw_quotes(rest: &str) -> Option<(usize, String)> {
    let prefix = ["br", "r"].into_iter().find(|p| rest.starts_with(p))?;
    let hashes = rest[prefix.len()..].len() - rest[prefix.len()..].trim_start_matches('#').len();
    let open = prefix.len() + hashes + 1;
    (rest.as_bytes().get(open - 1) == Some(&b'"')).then(|| (open, format!("\"{}", "#".repeat(hashes))))
}

/// Length of a character literal at the start of `rest`, which a lifetime is not.
fn character(rest: &str) -> Option<usize> {
    let inner = rest.strip_prefix('\'')?;
    if let Some(escaped) = inner.strip_prefix('\\') {
        let skipped = escaped.chars().next()?.len_utf8();
        return Some(2 + skipped + escaped[skipped..].find('\'')? + 1);
    }
    let first = inner.chars().next()?.len_utf8();
    inner[first..].starts_with('\'').then_some(first + 2)
}

/// String literals that name an option of a command line.
fn options_in_literals(path: &str, source: &str) -> Vec<String> {
    let names_option = |text: &str| {
        text.match_indices("--").any(|(at, _)| {
            let starts = !text[..at].ends_with(|c: char| c == '-' || is_of_identifier(c));
            starts && text[at + 2..].starts_with(|c: char| c.is_ascii_lowercase())
        })
    };
    let literals = pieces(source).into_iter().filter(|p| p.kind == Kind::Literal && names_option(p.text));
    literals.map(|p| format!("{path}:{}: \"{}\"", p.line, p.text)).collect()
}

/// The lab, and what it has of evaluation, is a library: what to do about an error is said in terms of its interface,
/// and the tool adds its options.
#[test]
fn the_lab_names_no_options_of_the_tool() {
    let tree = Tree::read();
    let of_eval = ["frame/", "metric/", "pipeline/", "scanpath/", "source/", "error.rs"];
    let folders = of_eval
        .map(|part| format!("crates/eval/src/{part}"))
        .into_iter()
        .chain(["crates/lab/src/".into(), "crates/trace/src/".into()]);
    let files = folders.flat_map(|folder| tree.files(&folder, &[".rs"]).map(str::to_owned).collect::<Vec<_>>());
    let violations: Vec<_> = files.flat_map(|f| options_in_literals(&f, &read(&f))).collect();
    expect_none("options of the tool in the lab's string literals", &violations);
}

#[test]
fn an_option_in_a_literal_is_found() {
    let source = "// --size\nlet a = \"raise the limit with --size N\"; // \"--b\"\nlet c = \"a--b, 1 -- 2\";\n";
    assert_eq!(options_in_literals("x.rs", source), ["x.rs:2: \"raise the limit with --size N\""]);
}

#[test]
fn comments_and_literals_are_told_apart() {
    let source = r##"
//! Doc "quoted" // twice
fn f<'a>(c: char) -> &'a str { // trailing
    let quote = ['"', '\'', '\\']; "a \" // b" }
const R: &str = r#"raw "inner" // text"#; /// Last"##;
    let comment = |line, text| Piece { kind: Kind::Comment, line, text };
    let literal = |line, text| Piece { kind: Kind::Literal, line, text };
    let expected = [
        comment(2, " Doc \"quoted\" // twice"),
        comment(3, " trailing"),
        literal(4, "a \\\" // b"),
        literal(5, "raw \"inner\" // text"),
        comment(5, " Last"),
    ];
    assert_eq!(pieces(source), expected);
}
