//! Words and numbers in messages.

/// The known word that `word` most likely means; none when nothing is near.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = word.to_lowercase();
    let edits_allowed = (typed.chars().count() / 3).max(2);
    known
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(&typed, candidate), candidate))
        .filter(|(edits, candidate)| *edits <= edits_allowed && *edits < candidate.chars().count())
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

/// "did you mean `speed`?", or the list of what there is.
pub fn suggest<'a>(word: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(word, known.clone()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => match list(known) {
            names if names.is_empty() => "there is none".into(),
            names => format!("there is {names}"),
        },
    }
}

/// `` `a`, `b`, `c` ``
pub fn list<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<_> = words.into_iter().map(|word| format!("`{word}`")).collect();
    quoted.join(", ")
}

/// A number with at most six significant digits.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_near() {
        let known = ["radius", "restitution", "x"];
        assert_eq!(nearest("radus", known), Some("radius"));
        assert_eq!(nearest("Restitutoin", known), Some("restitution"));
        assert_eq!(nearest("spring", known), None);
        // Any letter is one edit from `x`.
        assert_eq!(nearest("q", known), None);
    }

    #[test]
    fn numbers_are_short() {
        let expected = [
            (0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (-9.81, "-9.81"),
            (0.001234567, "0.00123457"),
            (1e6, "1000000"),
            (1e-9, "1e-9"),
            (2.5e12, "2.5e12"),
        ];
        for (value, text) in expected {
            assert_eq!(number(value), text);
        }
    }
}
