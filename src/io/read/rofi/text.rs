//! The text format: `C`, `M id alpha beta gamma`, `E id side dock orientation dock side id`.

use std::collections::HashMap;

use super::super::super::codes;
use super::super::super::findings::{Document, Findings, Place};
use super::super::super::json::{Span, clipped};
use super::super::super::rofi::{
    QUARTERS,
    text::{DOCKS, ORIENTATIONS, SIDES},
};
use super::world::{Joint, Joints, Kind, Mark, Module, World};

/// A word of a line and where it stands.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a str,
    span: Span,
}

pub(super) fn parse<'a>(document: &'a Document<'a>, findings: &mut Findings) -> Option<World<'a>> {
    let root = document.root();
    let mut reader = Reader {
        root: root.clone(),
        findings,
        modules: Vec::new(),
        numbers: HashMap::new(),
        begun: false,
        ended: false,
    };
    let lines: Vec<_> = lines(document.text).collect();
    let before = reader.findings.count();
    for words in &lines {
        reader.begin_or_module(words);
    }
    // Modules first: a joint may stand before its modules.
    let joints = lines.iter().filter_map(|words| reader.joint(words)).collect();
    let modules = reader.modules;
    if modules.is_empty() && findings.count() == before {
        let hint = "a line `M 0 0 0 0` is module 0 with all joints at zero";
        Mark::from(root.clone()).report(findings, codes::WRONG_LENGTH, "there are no modules", hint);
    }
    let world = World { modules, joints: Joints::Listed(joints), anchors: Vec::new(), whole: root.into() };
    (findings.count() == before).then_some(world)
}

/// The words of every line that has some and is no comment.
fn lines(text: &str) -> impl Iterator<Item = Vec<Word<'_>>> {
    let start = text.as_ptr() as usize;
    text.lines().filter_map(move |line| {
        let words = line.split_whitespace().map(|word| {
            let at = word.as_ptr() as usize - start;
            Word { text: word, span: Span::new(at, at + word.len()) }
        });
        let words: Vec<_> = words.collect();
        words.first().is_some_and(|first| !first.text.starts_with('#')).then_some(words)
    })
}

struct Reader<'a, 'f> {
    root: Place<'a>,
    findings: &'f mut Findings,
    modules: Vec<Module<'a>>,
    numbers: HashMap<i64, usize>,
    begun: bool,
    ended: bool,
}

impl<'a> Reader<'a, '_> {
    fn mark(&self, span: Span) -> Mark<'a> {
        Mark::in_text(self.root.clone(), span)
    }

    /// Reads what a line says other than a joint.
    fn begin_or_module(&mut self, words: &[Word<'a>]) {
        let first = words[0];
        match first.text {
            _ if self.ended => {}
            "C" if self.begun || !self.modules.is_empty() => {
                let hint = "keep one configuration in a file; a start and a goal are two files";
                let message = "a second configuration starts here";
                self.mark(first.span).report(self.findings, codes::UNSUPPORTED, message, hint);
                self.ended = true;
            }
            "C" => {
                self.begun = true;
                self.count(words, 1, "`C` stands alone");
            }
            "M" => self.module(words),
            "E" => {}
            other => {
                let message = format!("expected `C`, `M` or `E`, found `{}`", clipped(other));
                let hint = "`M id alpha beta gamma` is a module, `E id side dock orientation dock side id` a joint, `#` starts a comment";
                self.mark(first.span).report(self.findings, codes::UNKNOWN_VALUE, message, hint);
            }
        }
    }

    /// Whether a line has this many words.
    fn count(&mut self, words: &[Word<'a>], expected: usize, form: &str) -> bool {
        if words.len() == expected {
            return true;
        }
        let span = match words.get(expected) {
            Some(extra) => Span { start: extra.span.start, end: words[words.len() - 1].span.end },
            None => Span { start: words[0].span.start, end: words[words.len() - 1].span.end },
        };
        let message = format!("expected {expected} words, found {}", words.len());
        self.mark(span).report(self.findings, codes::WRONG_LENGTH, message, form);
        false
    }

    fn module(&mut self, words: &[Word<'a>]) {
        if !self.count(words, 5, "the form is `M id alpha beta gamma`") {
            return;
        }
        let number = self.number(words[1]);
        let joints = [words[2], words[3], words[4]].map(|word| self.degrees(word));
        let (Some(number), [Some(alpha), Some(beta), Some(gamma)]) = (number, joints) else { return };
        let index = self.modules.len();
        if let Some(first) = self.numbers.get(&number) {
            let message = format!("the id `{number}` is taken already, by number {} of the modules", first + 1);
            self.mark(words[1].span).report(self.findings, codes::DUPLICATE_ID, message, "ids are unique");
            return;
        }
        self.numbers.insert(number, index);
        let mark = self.mark(Span { start: words[0].span.start, end: words[4].span.end });
        self.modules.push(Module { id: number.to_string(), kind: Kind::Universal([alpha, beta, gamma]), mark });
    }

    fn number(&mut self, word: Word<'a>) -> Option<i64> {
        let number = word.text.parse().ok().filter(|number: &i64| number.to_string() == word.text);
        if number.is_none() {
            let message = format!("expected a module's id, found `{}`", clipped(word.text));
            self.mark(word.span).report(self.findings, codes::WRONG_TYPE, message, "ids are whole numbers");
        }
        number
    }

    fn degrees(&mut self, word: Word<'a>) -> Option<(f64, Mark<'a>)> {
        let number = word.text.parse().ok().filter(|degrees: &f64| degrees.is_finite());
        if number.is_none() {
            let message = format!("expected an angle in degrees, found `{}`", clipped(word.text));
            self.mark(word.span).report(self.findings, codes::WRONG_TYPE, message, "e.g. `90` or `-90`");
        }
        number.map(|degrees| (degrees, self.mark(word.span)))
    }

    /// Reads a line's joint, if it is one.
    fn joint(&mut self, words: &[Word<'a>]) -> Option<Joint<'a>> {
        if words[0].text != "E" || self.ended {
            return None;
        }
        if !self.count(words, 8, "the form is `E id side dock orientation dock side id`, e.g. `E 0 A -Z N -Z B 1`") {
            return None;
        }
        let modules = [words[1], words[7]].map(|word| self.known(word));
        let sides = [words[2], words[6]].map(|word| self.choice(word, "a side", &SIDES));
        let docks = [words[3], words[5]].map(|word| self.choice(word, "a dock", &DOCKS));
        let orientation = self.choice(words[4], "an orientation", &ORIENTATIONS);
        let end = |i: usize| Some((modules[i]?, sides[i]? * DOCKS.len() + docks[i]?));
        let mark = self.mark(Span { start: words[0].span.start, end: words[7].span.end });
        Some(Joint { ends: [end(0)?, end(1)?], quarters: QUARTERS[orientation?], mark })
    }

    /// The module with this number.
    fn known(&mut self, word: Word<'a>) -> Option<usize> {
        let number = self.number(word)?;
        let found = self.numbers.get(&number).copied();
        if found.is_none() {
            let message = format!("there is no module {number}");
            let hint = format!("a line `M {number} 0 0 0` makes one, with all joints at zero");
            self.mark(word.span).report(self.findings, codes::UNKNOWN_NAME, message, hint);
        }
        found
    }

    /// One of a few, by name or number.
    fn choice(&mut self, word: Word<'a>, what: &str, names: &[&str]) -> Option<usize> {
        let found = (0..names.len()).find(|&i| word.text == names[i] || word.text == i.to_string());
        if found.is_none() {
            let message = format!("expected {what}, found `{}`", clipped(word.text));
            let hint = format!("one of {}, or its number from 0 to {}", names.join(", "), names.len() - 1);
            self.mark(word.span).report(self.findings, codes::UNKNOWN_VALUE, message, hint);
        }
        found
    }
}
