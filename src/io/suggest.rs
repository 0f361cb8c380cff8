//! "Did you mean": the known name that an unknown one was probably meant to be.

/// The candidate most like `word`, if any is like it: the same but for a unit
/// suffix or letter case, or a few edits away. The first of equals.
pub(super) fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    let distance = |candidate: &str| {
        let known = candidate.to_lowercase();
        if known == lower || known.strip_prefix(&lower).is_some_and(|rest| rest.starts_with('_')) {
            return Some(0);
        }
        let edits = strsim::damerau_levenshtein(&lower, &known);
        let tolerated = 1 + lower.chars().count().min(known.chars().count()) / 4;
        // Of very short names any other is a few edits away.
        (edits <= tolerated && edits < known.chars().count().min(lower.chars().count())).then_some(edits)
    };
    let near = candidates.into_iter().filter(|candidate| candidate.len() <= LONGEST);
    let scored = near.filter_map(|candidate| distance(candidate).map(|d| (d, candidate)));
    scored.min_by_key(|(d, _)| *d).map(|(_, candidate)| candidate)
}

/// A hint for an unknown name: the one that was probably meant, or all there are.
pub(super) fn hint<'a>(word: &str, what: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let candidates: Vec<_> = candidates.into_iter().collect();
    match closest(word, candidates.iter().copied()) {
        Some(meant) => Some(format!("did you mean `{meant}`?")),
        None if candidates.is_empty() => Some(format!("there are no {what}")),
        None => Some(format!("{what}: {}", listed(&candidates))),
    }
}

/// Names as a list that does not grow beyond a line or two.
pub(super) fn listed(names: &[&str]) -> String {
    const MOST: usize = 12;
    let quoted: Vec<_> = names.iter().take(MOST).map(|name| format!("`{}`", super::json::clipped(name))).collect();
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    quoted.join(", ") + &more
}

#[cfg(test)]
mod tests {
    use super::closest;

    #[test]
    fn finds_what_was_meant() {
        let keys = ["id", "mass_kg", "com_m", "fixed"];
        assert_eq!(closest("mas_kg", keys), Some("mass_kg"));
        assert_eq!(closest("mass", keys), Some("mass_kg"));
        assert_eq!(closest("Fixed", keys), Some("fixed"));
        assert_eq!(closest("fxied", keys), Some("fixed"));
    }

    #[test]
    fn suggests_nothing_far_fetched() {
        assert_eq!(closest("colour", ["id", "mass_kg"]), None);
        assert_eq!(closest("b", ["a", "c"]), None);
        assert_eq!(closest(&"x".repeat(1_000_000), ["x"]), None);
    }
}
