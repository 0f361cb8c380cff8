//! Collects the problems of files while they are read.

use super::codes::{self, Code};
use super::diagnostics::{Diagnostic, Diagnostics};
use super::document::{LARGEST_FILE, SourceFile};
use super::excerpt::excerpt;
use super::form::Form;
use super::json::{self, Fault, Member, Node, Span};
use super::tables;

/// Most problems that are kept; what is found beyond them is not shown.
const MOST: usize = 50;

/// The problems found so far.
#[derive(Debug, Default)]
pub(super) struct Findings {
    // Each with its sort key: the file in the order of opening, then the place in it.
    items: Vec<((usize, u32), Diagnostic)>,
    files: Vec<String>,
    truncated: bool,
}

/// A parsed text.
#[derive(Debug)]
pub(super) struct Document<'a> {
    pub(super) name: &'a str,
    pub(super) text: &'a str,
    pub(super) root: Node,
    /// What it was taken for.
    pub(super) form: Form,
}

/// A value in a document, which need not exist: a missing one is shown at the
/// nearest value around it.
#[derive(Clone, Debug)]
pub(super) struct Place<'a> {
    document: &'a Document<'a>,
    node: &'a Node,
    exists: bool,
    path: String,
}

impl Findings {
    /// Parses a file; `None` after a problem that leaves nothing to look at.
    pub(super) fn open<'a>(&mut self, file: &'a SourceFile) -> Option<Document<'a>> {
        let (name, text) = self.text(file)?;
        self.json(name, text)
    }

    /// Parses a file that says what a robot is, in this program's format or in one of the RoFI platform's.
    pub(super) fn open_robot<'a>(&mut self, file: &'a SourceFile) -> Option<Document<'a>> {
        let (name, text) = self.text(file)?;
        if let Some(form) = Form::of_text(text) {
            let root = Node { span: Span::new(0, text.len()), value: json::Value::Null };
            return Some(Document { name, text, root, form });
        }
        let mut document = self.json(name, text)?;
        document.form = Form::of_json(&document.root);
        Some(document)
    }

    /// Parses a file that is written in TOML.
    pub(super) fn open_tables<'a>(&mut self, file: &'a SourceFile) -> Option<Document<'a>> {
        let (name, text) = self.text(file)?;
        let (root, faults) = tables::parse(text);
        self.faults(name, text, faults);
        Some(Document { name, text, root: root?, form: Form::Tables })
    }

    /// Parses the lines of a file, each of which is a document of its own. What follows the last line feed is not looked
    /// at.
    pub(super) fn open_lines<'a>(&mut self, file: &'a SourceFile) -> Option<Vec<Document<'a>>> {
        let (name, text) = self.text(file)?;
        let mut documents = Vec::new();
        let mut from = 0;
        for line in text.split_inclusive('\n').filter(|line| line.ends_with('\n')) {
            let to = from + line.len() - 1;
            let (root, faults) = json::parse_from(&text[..to], from);
            self.faults(name, text, faults);
            documents.extend(root.map(|root| Document { name, text, root, form: Form::Own }));
            from = to + 1;
        }
        Some(documents)
    }

    /// Adds what a parser found.
    fn faults(&mut self, name: &str, text: &str, faults: Vec<Fault>) {
        for Fault { span, code, message, hint } in faults {
            self.push(name, text, span, code, String::new(), message, hint);
        }
    }

    /// The text of a file, with its name.
    fn text<'a>(&mut self, file: &'a SourceFile) -> Option<(&'a str, &'a str)> {
        let name = file.name.as_str();
        self.files.push(name.to_string());
        let bytes = match &file.bytes {
            Ok(bytes) if bytes.len() <= LARGEST_FILE => bytes,
            Ok(_) => {
                let message = format!("the file is larger than the {} MB that are read", LARGEST_FILE >> 20);
                self.whole(name, codes::TOO_LARGE, message, "is it the right file?");
                return None;
            }
            Err(why) => {
                self.whole(name, codes::UNREADABLE, format!("cannot be read: {why}"), "check the path");
                return None;
            }
        };
        match std::str::from_utf8(bytes) {
            Ok(text) => Some((name, text)),
            Err(error) => {
                self.not_utf8(name, bytes, error.valid_up_to());
                None
            }
        }
    }

    fn json<'a>(&mut self, name: &'a str, text: &'a str) -> Option<Document<'a>> {
        let (root, faults) = json::parse(text);
        self.faults(name, text, faults);
        Some(Document { name, text, root: root?, form: Form::Own })
    }

    /// Adds a problem of a text that is no JSON, at a place in it.
    pub(super) fn add_in_text(
        &mut self,
        file: &SourceFile,
        text: &str,
        span: Span,
        code: Code,
        message: String,
        hint: &str,
    ) {
        self.files.push(file.name.clone());
        self.push(&file.name, text, span, code, String::new(), message, Some(hint.to_string()));
    }

    /// Adds a problem of a file as a whole.
    pub(super) fn add_in_file(&mut self, file: &SourceFile, code: Code, message: String, hint: &str) {
        self.files.push(file.name.clone());
        self.whole(&file.name, code, message, hint);
    }

    /// Adds a problem of a file as a whole.
    fn whole(&mut self, name: &str, code: Code, message: String, hint: &str) {
        self.push(name, "", Span::new(0, 0), code, String::new(), message, Some(hint.to_string()));
    }

    fn not_utf8(&mut self, name: &str, bytes: &[u8], valid: usize) {
        let text = std::str::from_utf8(&bytes[..valid]).unwrap_or_default();
        let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
        let hint = if utf16 { "the file looks like UTF-16: save it as UTF-8" } else { "save the file as UTF-8" };
        let message = format!("the byte 0x{:02x} is not UTF-8 here", bytes[valid]);
        let span = Span::new(valid, valid + 1);
        self.push(name, text, span, codes::NOT_UTF8, String::new(), message, Some(hint.to_string()));
    }

    /// Adds a problem of a value.
    pub(super) fn add(
        &mut self,
        place: &Place<'_>,
        code: Code,
        message: impl Into<String>,
        hint: impl Into<Option<String>>,
    ) {
        self.add_at(place, place.span(), code, message.into(), hint.into());
    }

    /// Adds a problem of a value, shown at a place of its own, e.g. its key.
    pub(super) fn add_at(&mut self, place: &Place<'_>, span: Span, code: Code, message: String, hint: Option<String>) {
        let message = if place.path.is_empty() { message } else { format!("`{}`: {message}", place.path) };
        let message = match place.document.form {
            Form::Own | Form::Tables => message,
            form => format!("{message} (read as {})", form.name()),
        };
        self.push(place.document.name, place.document.text, span, code, place.path.clone(), message, hint);
    }

    #[expect(clippy::too_many_arguments, reason = "one place that builds a diagnostic")]
    fn push(
        &mut self,
        file: &str,
        text: &str,
        span: Span,
        code: Code,
        path: String,
        message: String,
        hint: Option<String>,
    ) {
        if self.items.len() == MOST {
            self.truncated = true;
            return;
        }
        let shown = excerpt(text, span);
        let rank = self.files.iter().position(|name| name == file).unwrap_or(self.files.len());
        let (line, column, excerpt) = (shown.line, shown.column, shown.picture);
        let item = Diagnostic { code, file: file.to_string(), path, line, column, message, hint, excerpt };
        self.items.push(((rank, span.start), item));
    }

    /// Whether further problems would not be kept.
    pub(super) fn is_full(&self) -> bool {
        self.items.len() == MOST
    }

    /// How many problems were found so far.
    pub(super) fn count(&self) -> usize {
        self.items.len() + usize::from(self.truncated)
    }

    /// Notes that there may be more problems than those that are kept.
    pub(super) fn truncate(&mut self) {
        self.truncated = true;
    }

    /// The value read, unless something was found.
    ///
    /// # Errors
    /// All that was found.
    pub(super) fn finish<T>(mut self, value: Option<T>) -> Result<T, Diagnostics> {
        match value {
            Some(value) if self.items.is_empty() => Ok(value),
            _ => {
                self.items.sort_by_key(|(place, _)| *place);
                Err(Diagnostics::new(self.items.into_iter().map(|(_, item)| item).collect(), self.truncated))
            }
        }
    }
}

impl<'a> Document<'a> {
    /// The whole document.
    pub(super) fn root(&'a self) -> Place<'a> {
        Place { document: self, node: &self.root, exists: true, path: String::new() }
    }
}

impl<'a> Place<'a> {
    /// The member `key` of this object.
    pub(super) fn key(&self, key: &str) -> Self {
        self.step(self.node.get(key), &self.key_step(key))
    }

    /// This member of this object.
    pub(super) fn member(&self, member: &'a Member) -> Self {
        self.step(Some(&member.node), &self.key_step(&member.key))
    }

    fn key_step(&self, key: &str) -> String {
        let plain = !key.is_empty()
            && key.len() <= 40
            && key.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-' | b'$'));
        match (plain, self.path.is_empty()) {
            (true, true) => key.to_string(),
            (true, false) => format!(".{key}"),
            (false, _) => format!("[\"{}\"]", json::clipped(key)),
        }
    }

    /// This item of this array, at `index`.
    pub(super) fn item(&self, index: usize, item: &'a Node) -> Self {
        self.step(Some(item), &format!("[{index}]"))
    }

    /// The member number `index` of this object.
    pub(super) fn entry(&self, index: usize) -> Self {
        match &self.node.value {
            json::Value::Object(members) if index < members.len() => self.member(&members[index]),
            _ => self.index(index),
        }
    }

    /// The item `index` of this array.
    pub(super) fn index(&self, index: usize) -> Self {
        let item = match &self.node.value {
            json::Value::Array(items) => items.get(index),
            _ => None,
        };
        self.step(item, &format!("[{index}]"))
    }

    fn step(&self, node: Option<&'a Node>, step: &str) -> Self {
        let found = node.filter(|_| self.exists);
        let path = format!("{}{step}", self.path);
        Self { document: self.document, node: found.unwrap_or(self.node), exists: found.is_some(), path }
    }

    /// The value, if it exists.
    pub(super) fn node(&self) -> Option<&'a Node> {
        self.exists.then_some(self.node)
    }

    /// The value's text, if it exists.
    pub(super) fn text(&self) -> Option<&'a str> {
        self.exists.then(|| &self.document.text[self.node.span.range()])
    }

    /// A part of the document's text.
    pub(super) fn source(&self, span: Span) -> &'a str {
        &self.document.text[span.range()]
    }

    /// Its path within the document, e.g. `modules[3].id`; empty for the whole.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// How a file of this form says which format it has.
    pub(super) fn opening(&self, wanted: &str) -> String {
        match self.document.form {
            Form::Tables => format!("the file starts with format = {wanted}"),
            _ => format!("the file starts with \"format\": {wanted}"),
        }
    }

    /// Name of the file.
    pub(super) fn file(&self) -> &'a str {
        self.document.name
    }

    /// Where to show it: the value, or the opening bracket of what it is missing in.
    pub(super) fn span(&self) -> Span {
        match self.exists {
            true => self.node.span,
            false => Span { start: self.node.span.start, end: self.node.span.start + 1 },
        }
    }
}
