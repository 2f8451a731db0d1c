//! Marks of the methods: a color that is distinguishable with color blindness, and a shape.

use afterimage::internal::MethodKind;

/// Mark of a method.
#[derive(Clone, Copy)]
pub struct Mark {
    /// CSS class: the method's name, `other` for unknown ones.
    pub class: &'static str,
    /// Color from Okabe and Ito's palette for color blindness (2008).
    pub color: &'static str,
    outline: &'static str,
}

/// Colors and outlines of the methods, in the order of [`MethodKind::ALL`], and some more. Outlines are SVG paths
/// relative to a point, about 12 pixels wide.
const OF_METHODS: [[&str; 2]; 7] = [
    ["#7a7a7a", "m-6 0a6 6 0 1 0 12 0a6 6 0 1 0 -12 0z"],
    ["#e69f00", "m-5.5 -5.5h11v11h-11z"],
    ["#0072b2", "m-6.5 5.5h13l-6.5 -12z"],
    ["#009e73", "m-7 0l7 -7l7 7l-7 7z"],
    ["#56b4e9", "m-6.5 -5.5l6.5 3.5l6.5 -3.5v11l-6.5 -3.5l-6.5 3.5z"],
    ["#f0e442", "m-6 -3l3 -3h6l3 3v6l-3 3h-6l-3 -3z"],
    ["#000000", "m-6.5 -6.5l6.5 4l6.5 -4l-4 6.5l4 6.5l-6.5 -4l-6.5 4l4 -6.5z"],
];

const ORACLE: Mark = Mark { class: "oracle", color: "#cc79a7", outline: "m-6 -2h4v-4h4v4h4v4h-4v4h-4v-4h-4z" };

/// Mark of unknown methods.
const OTHER: Mark = Mark { class: "other", color: "#d55e00", outline: "m-6.5 -5.5h13l-6.5 12z" };

impl Mark {
    /// The mark of a method.
    pub fn of(method: &str) -> Self {
        let at = MethodKind::ALL.iter().position(|kind| kind.name() == method);
        match at {
            Some(at) => {
                let [color, outline] = OF_METHODS[at % OF_METHODS.len()];
                Self { class: MethodKind::ALL[at].name(), color, outline }
            }
            None if method == ORACLE.class => ORACLE,
            None => OTHER,
        }
    }

    /// SVG path data of the mark at a position.
    pub fn path(&self, at: [f64; 2]) -> String {
        format!("M{} {}{}", at[0], at[1], self.outline)
    }
}
