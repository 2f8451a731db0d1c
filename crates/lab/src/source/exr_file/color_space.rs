//! Primaries of an EXR file, and the conversion of its color to those of Rec. 709, which all else is in.

use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities};
use exr::meta::header::Header;
use glam::{DMat3, DVec2, DVec3};

/// Largest difference of a chromaticity coordinate from Rec. 709's that is rounding: files have 2 to 5 digits.
const ROUNDING: f64 = 0.002;

/// Chromaticities (CIE xy) of red, green, blue and white.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Primaries([DVec2; 4]);

const fn primaries(values: [[f64; 2]; 4]) -> Primaries {
    let [r, g, b, w] = values;
    Primaries([DVec2::new(r[0], r[1]), DVec2::new(g[0], g[1]), DVec2::new(b[0], b[1]), DVec2::new(w[0], w[1])])
}

const D65: [f64; 2] = [0.3127, 0.329];
/// White of ACES, about D60.
const ACES: [f64; 2] = [0.32168, 0.33767];
const REC_709: Primaries = primaries([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], D65]);

/// Spaces by name; the words are those of attributes that name one, each in lower case and without punctuation.
const NAMED: [(&str, &str, Primaries); 5] = [
    ("ACEScg", "acescg linap1 linap1scene", primaries([[0.713, 0.293], [0.165, 0.83], [0.128, 0.044], ACES])),
    ("ACES2065-1", "aces20651 linap0 linap0scene", primaries([[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], ACES])),
    (
        "Rec. 2020",
        "linearrec2020 linrec2020 linrec2020scene",
        primaries([[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65]),
    ),
    ("P3-D65", "linearp3d65 linp3d65 linp3d65scene", primaries([[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], D65])),
    ("Rec. 709", "linearrec709srgb linrec709 linrec709scene linear", REC_709),
];

/// Attributes in which programs name the space of linear colors.
const NAMING: [&str; 3] = ["colorInteropID", "oiio:ColorSpace", "colorSpace"];

/// What a file's colors are, beside linear.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ColorSpace {
    /// Rows of the matrix to Rec. 709; `None`: they are in it.
    to_rec_709: Option<[[f32; 3]; 3]>,
    /// What was assumed or converted.
    pub warning: Option<String>,
}

impl ColorSpace {
    /// The space that a part states: by its chromaticities, else by a name.
    pub fn of(header: &Header) -> Self {
        if let Some(stated) = &header.shared_attributes.chromaticities {
            return Self::from_chromaticities(stated);
        }
        let named = NAMING.iter().find_map(|name| by_name(&text_attribute(header, name)?));
        match named {
            Some((name, primaries)) => Self::from_primaries(primaries, name),
            None => Self::default(),
        }
    }

    fn from_chromaticities(stated: &Chromaticities) -> Self {
        let xy = |v: Vec2<f32>| DVec2::new(v.0.into(), v.1.into());
        let primaries = Primaries([stated.red, stated.green, stated.blue, stated.white].map(xy));
        let name = NAMED.iter().find(|(_, _, known)| known.is_close(&primaries)).map_or("other", |(name, ..)| name);
        Self::from_primaries(primaries, name)
    }

    fn from_primaries(primaries: Primaries, name: &str) -> Self {
        if primaries.is_close(&REC_709) {
            return Self::default();
        }
        let of = if name == "other" { "of other primaries".to_owned() } else { format!("of {name}") };
        match primaries.to_rec_709() {
            Some(matrix) => {
                let warning = format!("its colors are {of} by its header; they are converted to Rec. 709");
                let rows = [0, 1, 2].map(|i| matrix.row(i).as_vec3().to_array());
                Self { to_rec_709: Some(rows), warning: Some(warning) }
            }
            None => {
                let warning = "its chromaticities are those of no color space; its colors are read as Rec. 709";
                Self { to_rec_709: None, warning: Some(warning.into()) }
            }
        }
    }

    /// Converts colors. What Rec. 709 cannot hold loses its negative parts; those that were there stay.
    pub fn convert(&self, colors: &mut [[f32; 3]]) {
        let Some(rows) = self.to_rec_709 else { return };
        for color in colors {
            let lowest = color.iter().copied().fold(0.0, f32::min);
            *color = rows.map(|row| (row[0] * color[0] + row[1] * color[1] + row[2] * color[2]).max(lowest));
        }
    }
}

/// The space that a text names.
fn by_name(text: &str) -> Option<(&'static str, Primaries)> {
    let plain: String = text.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect();
    let fits = |words: &str| words.split(' ').any(|word| word == plain);
    NAMED.iter().find(|(_, words, _)| fits(words)).map(|(name, _, primaries)| (*name, *primaries))
}

impl Primaries {
    fn is_close(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| (*a - b).abs().max_element() <= ROUNDING)
    }

    /// Matrix of linear RGB to CIE XYZ, with Y 1 for white; `None` if the primaries span no space.
    fn to_xyz(self) -> Option<DMat3> {
        let xyz = |p: DVec2| DVec3::new(p.x / p.y, 1.0, (1.0 - p.x - p.y) / p.y);
        let [r, g, b, white] = self.0;
        // Primaries may have y 0 or less, so that their columns are x, y, z.
        let columns = DMat3::from_cols_array_2d(&[r, g, b].map(|p| [p.x, p.y, 1.0 - p.x - p.y]));
        let is_space = columns.is_finite() && columns.determinant().abs() > 1e-4 && white.y > 0.05;
        let shares =
            is_space.then(|| columns.inverse() * xyz(white)).filter(|s| s.is_finite() && s.min_element() > 0.0);
        Some(columns * DMat3::from_diagonal(shares?))
    }

    /// Matrix to Rec. 709, with white adapted by the Bradford transform.
    fn to_rec_709(self) -> Option<DMat3> {
        // Lam, Metamerism and colour constancy (1985), as in ICC.1:2010, annex E.
        let bradford = DMat3::from_cols_array(&[
            0.8951, -0.7502, 0.0389, //
            0.2664, 1.7135, -0.0685, //
            -0.1614, 0.0367, 1.0296,
        ]);
        let (from, to) = (self.to_xyz()?, REC_709.to_xyz()?);
        let response = |to_xyz: DMat3| bradford * (to_xyz * DVec3::ONE);
        let gains = response(to) / response(from);
        Some(to.inverse() * bradford.inverse() * DMat3::from_diagonal(gains) * bradford * from)
    }
}

/// A text attribute of a part.
fn text_attribute(header: &Header, name: &str) -> Option<String> {
    let mut all = header.own_attributes.other.iter().chain(&header.shared_attributes.other);
    match all.find(|(key, _)| **key == *name)?.1 {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(name: &str) -> ColorSpace {
        let (name, primaries) = by_name(name).unwrap();
        ColorSpace::from_primaries(primaries, name)
    }

    /// The matrix of ACEScg to linear sRGB that the ACES project publishes (ACEScsc, Bradford).
    #[test]
    fn acescg_converts_by_the_published_matrix() {
        let expected = [[1.7051, -0.6218, -0.0833], [-0.1303, 1.1408, -0.0105], [-0.0240, -0.1290, 1.1530]];
        for name in ["ACEScg", "lin_ap1_scene"] {
            let found = space(name).to_rec_709.unwrap();
            let error = found.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
            assert!(error.fold(0.0, f32::max) < 2e-3, "{found:?}");
        }
    }

    #[test]
    fn white_stays_white_and_rec_709_stays_as_it_is() {
        for name in ["acescg", "ACES2065-1", "lin_rec2020_scene", "lin_p3d65_scene"] {
            let mut colors = [[0.25; 3], [0.0, 0.0, 1.0], [-0.5, -0.5, -0.5]];
            space(name).convert(&mut colors);
            let [white, blue, negative] = colors;
            assert!(white.iter().all(|c| (c - 0.25).abs() < 1e-4), "{name}: {white:?}");
            assert!(blue.iter().all(|c| *c >= 0.0) && blue[2] > 1.0, "{name}: {blue:?}");
            assert!(negative.iter().all(|c| (c + 0.5).abs() < 1e-4), "{name}: {negative:?}");
        }
        assert_eq!(space("lin_rec709_scene"), ColorSpace::default());
        assert!(by_name("Utility - Raw").is_none());
    }

    #[test]
    fn chromaticities_of_no_space_are_doubted() {
        let [r, g, b, w] = REC_709.0;
        for broken in [[r, r, b, w], [r, g, b, DVec2::ZERO], [DVec2::NAN, g, b, w], [r, g, b, DVec2::new(0.9, 0.1)]] {
            let space = ColorSpace::from_primaries(Primaries(broken), "other");
            assert!(space.to_rec_709.is_none() && space.warning.unwrap().contains("no color space"), "{broken:?}");
        }
        let rounded = Primaries(REC_709.0.map(|p| p + 0.0004));
        assert_eq!(ColorSpace::from_primaries(rounded, "other"), ColorSpace::default());
    }
}
