//! Pictures embedded in a page: those of the most interesting points, without duplicates.

use crate::sweep::{Row, Table};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};

/// Limit on points with pictures in a page.
const MAX_POINTS: usize = 24;

/// Limit on the size of all pictures in a page, bytes.
const MAX_BYTES: usize = 8 << 20;

/// Pictures, and the points that they belong to.
#[derive(Debug, Default, Serialize)]
pub struct Pictures {
    /// Pictures as data URLs.
    images: Vec<String>,
    /// Index into `images` by the point's id and `shown`, `error` or `reference`.
    points: BTreeMap<String, BTreeMap<&'static str, usize>>,
}

/// Embeds pictures up to the limits.
pub fn embed(table: &Table, read: &dyn Fn(&str, &str) -> Option<Vec<u8>>) -> Pictures {
    let mut pictures = Pictures::default();
    let mut known: HashMap<Vec<u8>, usize> = HashMap::new();
    let mut bytes = 0;
    for row in in_order(table) {
        let Some(shown) = read(&row.id, "shown") else { continue };
        let rest = ["error", "reference"].into_iter().filter_map(|what| Some((what, read(&row.id, what)?)));
        let found: Vec<(&'static str, Vec<u8>)> = [("shown", shown)].into_iter().chain(rest).collect();
        let more: usize =
            found.iter().filter(|(_, b)| !known.contains_key(b)).map(|(_, b)| b.len().div_ceil(3) * 4).sum();
        if pictures.points.len() == MAX_POINTS || bytes + more > MAX_BYTES {
            break;
        }
        bytes += more;
        for (what, picture) in found {
            let next = pictures.images.len();
            let index = *known.entry(picture).or_insert_with_key(|picture| {
                pictures.images.push(format!("data:image/jpeg;base64,{}", STANDARD.encode(picture)));
                next
            });
            pictures.points.entry(row.id.clone()).or_default().insert(what, index);
        }
    }
    pictures
}

/// Rows in order of interest: points on a frontier, then the base points of switches, then the rest; inputs take turns.
fn in_order(table: &Table) -> Vec<&Row> {
    let rank = |row: &Row| {
        let place = ["jod", "flip", "psnr_db", "retained_psnr_db"].iter().position(|key| row.frontier.contains(key));
        let is_base = table.prices.iter().any(|p| p.base == row.id);
        place.unwrap_or(if is_base { 4 } else { 5 })
    };
    let mut seen: HashMap<(&str, usize), usize> = HashMap::new();
    let mut order: Vec<((usize, usize), &Row)> = vec![];
    for row in &table.rows {
        let turn = seen.entry((&row.point.input, rank(row))).or_insert(0);
        order.push(((rank(row), *turn), row));
        *turn += 1;
    }
    order.sort_by_key(|(key, _)| *key);
    order.into_iter().map(|(_, row)| row).collect()
}
