//! The page: self-contained, complete, and safe against HTML in names.

use super::table::{INPUTS, measurements, of, table};
use afterimage_cli::report::page::page;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

fn nothing(_: &str, _: &str) -> Option<Vec<u8>> {
    None
}

/// The JSON data of an element.
fn island(page: &str, id: &str) -> Value {
    let start = format!("<script type=\"application/json\" id=\"data-{id}\">");
    let text = page.split(&start).nth(1).unwrap().split("</script>").next().unwrap();
    serde_json::from_str(text).unwrap()
}

/// The markup of the page without its data.
fn markup(page: &str) -> String {
    let mut rest = page;
    let mut markup = String::new();
    while let Some((before, after)) = rest.split_once("<script type=\"application/json\"") {
        markup += before;
        rest = after.split_once("</script>").unwrap().1;
    }
    markup + rest
}

#[test]
fn it_fetches_nothing() {
    let page = page(&table(None), &|_, _| Some(vec![0xff, 0xd8, 1]));
    assert!(!page.contains("://"), "no address of anything outside");
    for attribute in ["src=", "href=", "url(", "@import"] {
        for (i, _) in page.match_indices(attribute) {
            let value = page[i + attribute.len()..].trim_start_matches('"');
            assert!(value.starts_with('#'), "{attribute}{}", &value[..40]);
        }
    }
    assert!(page.contains("default-src 'none'"), "and the browser holds it to that");
    assert!(!page.contains("{{"));
}

#[test]
fn its_data_is_the_table() {
    for table in [table(Some(12.0)), table(None)] {
        let page = page(&table, &nothing);
        // Parse from text as well, since the last digit of a number may differ.
        let same: serde_json::Value = serde_json::from_str(&serde_json::to_string(&table).unwrap()).unwrap();
        assert!(island(&page, "table") == same);
        for (input, key) in INPUTS.iter().flat_map(|i| ["flip", "psnr_db"].map(|k| (*i, k))) {
            assert!(!island(&page, "equal")[input][key][0]["equal_time"].as_array().unwrap().is_empty());
            assert!(island(&page, "plots")[input][key].as_str().unwrap().starts_with("<svg"));
        }
    }
}

#[test]
fn names_of_strangers_stay_text() {
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>{{script}}<!--";
    let mut all = measurements();
    for m in &mut all {
        m.point.input = format!("{evil}{}", m.point.input);
        m.point.options.insert("smr-tolerance".into(), evil.into());
        m.machine.name = evil.into();
        m.rust = evil.into();
    }
    all[0].point.options.insert("only".into(), evil.into());
    let mut table = of(&all, None);
    table.command = format!("afterimage sweep '{evil}'");
    let page = page(&table, &nothing);
    let markup = markup(&page);
    assert!(!markup.contains("<img") && !markup.contains("alert(1)</script>"), "a name became an element");
    assert!(markup.contains("&lt;img src=x onerror=alert(2)&gt;"), "names are shown");
    let own = self::page(&super::table::table(None), &nothing);
    let scripts = |page: &str| page.matches("<script").count();
    assert_eq!(scripts(&page), scripts(&own), "as many scripts as without it");
    assert_eq!(page.matches("</script>").count(), own.matches("</script>").count());
    assert_eq!(island(&page, "table")["machines"][0]["name"], evil);
}

#[test]
fn pictures_are_embedded_once_and_bounded() {
    let table = table(None);
    let own = |id: &str, what: &str| {
        if what == "reference" { vec![0xff, 0xd8, 7] } else { [id.as_bytes(), what.as_bytes()].concat() }
    };
    let small = island(&page(&table, &|id, what| Some(own(id, what))), "pictures");
    let points = small["points"].as_object().unwrap();
    assert_eq!(points.len(), 24);
    assert_eq!(small["images"].as_array().unwrap().len(), 24 * 2 + 1, "the reference of all is one");
    for (id, of) in points {
        for what in ["shown", "error", "reference"] {
            let image = small["images"][of[what].as_u64().unwrap() as usize].as_str().unwrap();
            let data = image.strip_prefix("data:image/jpeg;base64,").unwrap();
            assert_eq!(STANDARD.decode(data).unwrap(), own(id, what));
        }
    }
    let is_best = |id: &&String| table.rows.iter().any(|r| r.id == **id && r.frontier.contains(&"flip"));
    let best = table.rows.iter().filter(|r| r.frontier.contains(&"flip")).count();
    assert_eq!(points.keys().filter(is_best).count(), best.min(24), "the frontier of FLIP comes first");

    let large = page(&table, &|id, what| Some([own(id, what), vec![b'x'; 400_000]].concat()));
    assert!(large.len() < 10 << 20, "{} bytes", large.len());
    let some = island(&large, "pictures")["points"].as_object().unwrap().len();
    assert!((4..24).contains(&some), "{some} points fit");
}
