//! Clock times: `2021-04-05T12:00:00.250Z`, `2021-04-05 12:00:00,250+02:00`, `12:00:00.250`.

use super::samples::Clock;

/// Ticks a second of clock times.
pub(super) const PER_SECOND: f64 = 1e9;

const DAY_S: i64 = 86_400;

/// A date and time, or a time of day, in nanoseconds; `None` for anything else.
pub(super) fn parse(cell: &str) -> Option<Clock> {
    let (date, time) = match cell.split_once(['T', ' ']) {
        Some((date, time)) => (Some(date), time.trim()),
        None => (None, cell),
    };
    let days = date.map_or(Some(0), days_since_1970)?;
    let (time, offset_s) = zone(time)?;
    let mut parts = time.splitn(3, ':');
    let [hours, minutes] = [parts.next()?, parts.next()?].map(|part| whole(part, 2));
    let (seconds, nanoseconds) = seconds(parts.next().unwrap_or("0"))?;
    let (hours, minutes) = (hours.filter(|h| *h < 24)?, minutes.filter(|m| *m < 60)?);
    let total_s = days * DAY_S + hours * 3600 + minutes * 60 + seconds - offset_s;
    Some(Clock::of_whole(total_s.checked_mul(1_000_000_000)?.checked_add(nanoseconds)?))
}

/// A number of at most `digits` digits.
fn whole(text: &str, digits: usize) -> Option<i64> {
    let is_number = (1..=digits).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    is_number.then(|| text.parse().ok()).flatten()
}

/// Seconds below a minute (60: a leap second), and nanoseconds.
fn seconds(text: &str) -> Option<(i64, i64)> {
    let (whole_s, part) = text.split_once(['.', ',', ':']).unwrap_or((text, "0"));
    let seconds = whole(whole_s, 2).filter(|s| *s <= 60)?;
    let digits = part.len().min(9);
    let nanoseconds = whole(part.get(..digits)?, 9)? * 10_i64.pow(9 - digits as u32);
    Some((seconds, nanoseconds))
}

/// A time without its zone, and the zone's seconds before UTC.
fn zone(time: &str) -> Option<(&str, i64)> {
    if let Some(time) = time.strip_suffix(['Z', 'z']) {
        return Some((time, 0));
    }
    let Some(at) = time.rfind(['+', '-']) else { return Some((time, 0)) };
    let (time, zone) = time.split_at(at);
    let digits = zone[1..].replace(':', "");
    let (hours, minutes) =
        (whole(digits.get(..2)?, 2)?, whole(digits.get(2..).filter(|m| !m.is_empty()).unwrap_or("0"), 2)?);
    let offset_s = hours * 3600 + minutes * 60;
    Some((time, if zone.starts_with('-') { -offset_s } else { offset_s }))
}

/// Days of a date `YYYY-MM-DD` or `YYYY/MM/DD` since 1970.
fn days_since_1970(date: &str) -> Option<i64> {
    let mut parts = date.split(['-', '/']);
    let year = whole(parts.next()?, 4).filter(|y| *y >= 1900)?;
    let month = whole(parts.next()?, 2).filter(|m| (1..=12).contains(m))?;
    let day = whole(parts.next()?, 2).filter(|d| (1..=31).contains(d))?;
    if parts.next().is_some() {
        return None;
    }
    // Years begin in March, so that the leap day is their last.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let day_of_year = (153 * month + 2) / 5 + day - 1;
    let leap_days = year / 4 - year / 100 + year / 400;
    // 1970-01-01 is day 719468 of this count.
    Some(365 * year + leap_days + day_of_year - 719_468)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_times_are_nanoseconds_and_other_texts_are_none() {
        let ns = |text: &str| parse(text).map(|clock| clock.since(Clock::of_whole(0)));
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2021-04-05T12:00:00.250000Z", 1_617_624_000.25),
            ("2021/04/05 14:00:00,25+02:00", 1_617_624_000.25),
            ("2021-04-05T07:00:00.25-0500", 1_617_624_000.25),
            ("2000-02-29 23:59:60", 951_868_800.0),
            ("12:30:01.5", 45_001.5),
            ("12:30", 45_000.0),
            ("01:02:03:004", 3723.004),
        ] {
            assert_eq!(ns(text), Some(seconds * 1e9), "{text}");
        }
        for text in
            ["", "soon", "12", "25:00:00", "12:61", "2021-13-01T00:00:00", "2021-04-05", "12:00:00.x", "1:2:3:4:5"]
        {
            assert_eq!(ns(text), None, "{text}");
        }
    }
}
