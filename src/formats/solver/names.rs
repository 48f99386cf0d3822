//! Names as a solver takes them.

use std::collections::HashSet;

/// What names may be.
pub struct NameRule {
    /// Longest name, in characters.
    pub longest: usize,
    /// Whether spaces may be in it.
    pub spaces: bool,
    /// Whether it makes no difference of capitals.
    pub lower_case: bool,
    /// Why a name cannot be taken whatever is done with it: it would be read as something else.
    pub refused: fn(&str) -> Option<String>,
}

impl NameRule {
    /// Any name, up to a length.
    pub(super) const fn any(longest: usize) -> NameRule {
        NameRule { longest, spaces: true, lower_case: false, refused: |_| None }
    }

    /// A name that the solver takes and that is not among those so far, made from one that is wished for.
    pub(super) fn name(&self, wish: &str, so_far: &mut HashSet<String>) -> String {
        let plain = |c: char| if c.is_whitespace() && !self.spaces { '_' } else { c };
        let text: String = wish.trim().chars().map(plain).take(self.longest).collect();
        let text = if self.lower_case { text.to_lowercase() } else { text };
        let text = if text.is_empty() { "unnamed".to_owned() } else { text };
        let mut name = text.clone();
        let mut number = 2;
        while !so_far.insert(name.clone()) {
            let suffix = format!("_{number}");
            name = text.chars().take(self.longest - suffix.len()).collect::<String>() + &suffix;
            number += 1;
        }
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_what_the_rule_allows_and_differ() {
        let rule = NameRule { spaces: false, lower_case: true, ..NameRule::any(8) };
        let mut so_far = HashSet::new();
        let names =
            ["Wall 1", "wall_1", "", "a name of many words", "a name of few"].map(|wish| rule.name(wish, &mut so_far));
        assert_eq!(names, ["wall_1", "wall_1_2", "unnamed", "a_name_o", "a_name_2"]);
    }
}
