//! Marks of the methods: a color that is distinguishable with color blindness, and a shape.

/// Mark of a method.
#[derive(Clone, Copy)]
pub struct Mark {
    /// CSS class: the method's name, `other` for unknown ones.
    pub class: &'static str,
    /// Color from Okabe and Ito's palette for color blindness (2008).
    pub color: &'static str,
    outline: &'static str,
}

/// Outlines are SVG paths relative to a point, about 12 pixels wide.
const MARKS: [Mark; 6] = [
    Mark { class: "none", color: "#7a7a7a", outline: "m-6 0a6 6 0 1 0 12 0a6 6 0 1 0 -12 0z" },
    Mark { class: "taa", color: "#e69f00", outline: "m-5.5 -5.5h11v11h-11z" },
    Mark { class: "taau", color: "#56b4e9", outline: "m-6.5 -5.5l6.5 3.5l6.5 -3.5v11l-6.5 -3.5l-6.5 3.5z" },
    Mark { class: "wrs", color: "#0072b2", outline: "m-6.5 5.5h13l-6.5 -12z" },
    Mark { class: "smr", color: "#009e73", outline: "m-7 0l7 -7l7 7l-7 7z" },
    Mark { class: "oracle", color: "#cc79a7", outline: "m-6 -2h4v-4h4v4h4v4h-4v4h-4v-4h-4z" },
];

/// Mark of unknown methods.
const OTHER: Mark = Mark { class: "other", color: "#d55e00", outline: "m-6.5 -5.5h13l-6.5 12z" };

impl Mark {
    /// The mark of a method.
    pub fn of(method: &str) -> Self {
        MARKS.into_iter().find(|mark| mark.class == method).unwrap_or(OTHER)
    }

    /// SVG path data of the mark at a position.
    pub fn path(&self, at: [f64; 2]) -> String {
        format!("M{} {}{}", at[0], at[1], self.outline)
    }
}
