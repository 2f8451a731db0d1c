//! `--gaze-layout FILE.json`: the gaze options of a whole data set.

use super::Named;
use super::gaze_columns::{NamedColumns, TimeUnit};
use afterimage_lab::scanpath::{Eye, GazeUnit};
use serde_json::{Map, Value};
use std::fs;

/// Most bytes of a file that is read: it has a few lines.
const MOST_BYTES: u64 = 1 << 16;

/// The options that a file states.
#[derive(Clone, Debug)]
pub struct GazeLayout {
    pub columns: Option<NamedColumns>,
    pub unit: Option<GazeUnit>,
    pub time_unit: Option<TimeUnit>,
    pub screen_px: Option<[u32; 2]>,
    pub screen_mm: Option<[f32; 2]>,
    pub distance_mm: Option<f32>,
    pub eye: Option<Eye>,
}

/// Reads the file.
pub fn parse_layout(file: &str) -> Result<GazeLayout, String> {
    let unreadable = |e: std::io::Error| format!("cannot be read ({e})");
    if fs::metadata(file).map_err(unreadable)?.len() > MOST_BYTES {
        return Err("is too long for a layout; docs/gaze-logs.md has one".into());
    }
    let text = fs::read_to_string(file).map_err(unreadable)?;
    let value = serde_json::from_str(&text).map_err(|e| format!("is no JSON ({e}); docs/gaze-logs.md has a layout"))?;
    let Value::Object(values) = value else {
        return Err("holds no JSON object; docs/gaze-logs.md has a layout".into());
    };
    let mut fields = Fields { values, of: "" };
    let whole_px = |v: &Value| u32::try_from(v.as_u64()?).ok().filter(|v| *v > 0);
    let layout = GazeLayout {
        columns: fields.take("columns", "an object", |v| v.as_object().cloned())?.map(columns).transpose()?,
        unit: fields.named("unit")?,
        time_unit: fields.named("time_unit")?,
        screen_px: fields.take("screen_px", "[WIDTH, HEIGHT] in whole pixels", |v| pair(v, whole_px))?,
        screen_mm: fields.take("screen_mm", "[WIDTH, HEIGHT] in millimeters", |v| pair(v, positive))?,
        distance_mm: fields.take("distance_mm", "a number of millimeters above 0", positive)?,
        eye: fields.named("eye")?,
    };
    fields.end("columns, unit, time_unit, screen_px, screen_mm, distance_mm, eye")?;
    let needs_columns = [("unit", layout.unit.is_some()), ("time_unit", layout.time_unit.is_some())];
    match needs_columns.into_iter().find(|(_, is_given)| *is_given && layout.columns.is_none()) {
        Some((name, _)) => Err(format!("`{name}` is that of `columns`, which is missing; add it")),
        None => Ok(layout),
    }
}

fn columns(values: Map<String, Value>) -> Result<NamedColumns, String> {
    let mut fields = Fields { values, of: "columns." };
    let mut name = |key| {
        let name = |v: &Value| v.as_str().map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned);
        fields.take(key, "the name of a column", name)
    };
    let [time, x, y, z, valid] = [name("t")?, name("x")?, name("y")?, name("z")?, name("valid")?];
    fields.end("t, x, y, z, valid")?;
    let needed = |key: &str, name: Option<String>| name.ok_or_else(|| format!("`columns.{key}` is missing; add it"));
    let [time, x, y] = [needed("t", time)?, needed("x", x)?, needed("y", y)?];
    Ok(NamedColumns { time, at: [Some(x), Some(y), z].into_iter().flatten().collect(), valid })
}

/// Fields of an object, which are taken one by one.
struct Fields {
    values: Map<String, Value>,
    /// The object's name and a dot, unless it is the whole file.
    of: &'static str,
}

impl Fields {
    fn take<T>(
        &mut self,
        name: &str,
        expected: &str,
        read: impl FnOnce(&Value) -> Option<T>,
    ) -> Result<Option<T>, String> {
        let Some(value) = self.values.remove(name) else { return Ok(None) };
        match read(&value) {
            None => Err(format!("`{}{name}` is {value}; expected {expected}", self.of)),
            some => Ok(some),
        }
    }

    /// A field with a value that an option has, too.
    fn named<T: Named>(&mut self, name: &str) -> Result<Option<T>, String> {
        let rows = T::rows();
        let names: Vec<String> = rows.iter().map(|row| format!("\"{}\"", row.1)).collect();
        let find = |v: &Value| rows.iter().find(|row| Some(row.1) == v.as_str()).map(|row| row.0);
        self.take(name, &names.join(", "), find)
    }

    /// Refuses what is left.
    fn end(self, known: &str) -> Result<(), String> {
        match self.values.keys().next() {
            Some(name) => Err(format!("`{}{name}` is no field; expected {known}", self.of)),
            None => Ok(()),
        }
    }
}

fn pair<T>(value: &Value, read: impl Fn(&Value) -> Option<T>) -> Option<[T; 2]> {
    match value.as_array()?.as_slice() {
        [a, b] => Some([read(a)?, read(b)?]),
        _ => None,
    }
}

fn positive(value: &Value) -> Option<f32> {
    Some(value.as_f64()? as f32).filter(|v| *v > 0.0 && v.is_finite())
}
