//! Triangles of STL and OBJ files, as the crates `stl_io` and `tobj` read them.

use std::io::{Cursor, Read, Result as IoResult, Seek, SeekFrom};

use tobj::{LoadError, LoadOptions};

use super::super::codes;
use super::super::document::{LARGEST_FILE, SourceFile};
use super::super::findings::Findings;
use super::super::json::{Span, clipped};
use crate::robot::MOST_TRIANGLES;
use crate::spatial::Vec3;

/// Length of a binary STL before its triangles, and of each of them, in bytes.
const STL_HEADER: usize = 84;
const STL_TRIANGLE: usize = 50;

/// The two formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Stl,
    Obj,
}

/// Vertices in the file's unit, and triangles by their indices.
pub(super) type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// Reads the triangles of a file.
pub(super) fn read(file: &SourceFile, kind: Kind, findings: &mut Findings) -> Option<Triangles> {
    let bytes = match &file.bytes {
        Ok(bytes) if bytes.len() <= LARGEST_FILE => bytes,
        Ok(_) => {
            let message = format!("the file is larger than the {} MB that are read", LARGEST_FILE >> 20);
            findings.add_in_file(file, codes::TOO_LARGE, message, "is it the right file?");
            return None;
        }
        Err(why) => {
            findings.add_in_file(file, codes::UNREADABLE, format!("cannot be read: {why}"), "check the path");
            return None;
        }
    };
    if bytes.is_empty() {
        findings.add_in_file(file, codes::EMPTY, "the file is empty".to_string(), "is it the right file?");
        return None;
    }
    match kind {
        Kind::Stl if is_binary_stl(bytes) => binary_stl(bytes, file, findings),
        Kind::Stl => ascii_stl(bytes, file, findings),
        Kind::Obj => obj(bytes, file, findings),
    }
}

/// A binary STL may begin with anything, also with the word of a text; its length tells.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..STL_HEADER).map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    count.is_some_and(|count| bytes.len() == STL_HEADER + STL_TRIANGLE * count as usize)
}

fn binary_stl(bytes: &[u8], file: &SourceFile, findings: &mut Findings) -> Option<Triangles> {
    // So that its header is not taken for the first line of a text.
    let mut bytes = bytes.to_vec();
    bytes[0] = 0;
    let read = stl_io::create_stl_reader(&mut Cursor::new(&bytes)).and_then(|mut reader| collected(&mut *reader));
    match read {
        Ok(triangles) => Some(triangles),
        Err(error) => {
            findings.add_in_file(file, codes::SYNTAX, format!("is no STL: {error}"), "export the mesh anew");
            None
        }
    }
}

fn ascii_stl(bytes: &[u8], file: &SourceFile, findings: &mut Findings) -> Option<Triangles> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        let message = "is neither a text nor a binary STL whose length fits its number of triangles".to_string();
        findings.add_in_file(file, codes::SYNTAX, message, "export the mesh anew: the file may be cut off");
        return None;
    };
    let mut lines = Lines(Cursor::new(bytes));
    let read = stl_io::create_stl_reader(&mut lines).and_then(|mut reader| collected(&mut *reader));
    let end = lines.0.position() as usize;
    match read {
        Ok(triangles) => {
            let rest = text.get(end..).unwrap_or_default();
            if rest.trim().is_empty() {
                return Some(triangles);
            }
            let at = end + rest.len() - rest.trim_start().len();
            let message = "there is more after the first solid".to_string();
            findings.add_in_text(file, text, line_at(text, at), codes::UNSUPPORTED, message, "join the solids to one");
            None
        }
        Err(error) => {
            let hint = "a text STL is `solid NAME`, then `facet normal x y z`, `outer loop`, three `vertex x y z`, \
                        `endloop`, `endfacet` for each triangle, then `endsolid NAME`";
            let message = format!("is no STL: {}", clipped(&error.to_string()));
            findings.add_in_text(file, text, line_at(text, end.saturating_sub(1)), codes::SYNTAX, message, hint);
            None
        }
    }
}

fn collected(reader: &mut dyn stl_io::TriangleIterator<Item = IoResult<stl_io::Triangle>>) -> IoResult<Triangles> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let mut known = std::collections::HashMap::new();
    // One more than is taken is refused with a reason.
    for triangle in reader.take(MOST_TRIANGLES + 1) {
        let corners = triangle?.vertices.map(|vertex| {
            *known.entry(vertex.0.map(f32::to_bits)).or_insert_with(|| {
                vertices.push(Vec3::from(vertex.0.map(decimal)));
                (vertices.len() - 1) as u32
            })
        });
        triangles.push(corners);
    }
    Ok((vertices, triangles))
}

/// The shortest decimal number that a single precision one stands for: where a modeller
/// said 0.3, the file has 0.300000012, and 0.3 is meant.
fn decimal(single: f32) -> f64 {
    single.to_string().parse().unwrap_or(f64::NAN)
}

fn obj(bytes: &[u8], file: &SourceFile, findings: &mut Findings) -> Option<Triangles> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        findings.add_in_file(file, codes::NOT_UTF8, "is no UTF-8".to_string(), "an OBJ is a text: save it as UTF-8");
        return None;
    };
    let options = LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let mut cursor = Cursor::new(bytes);
    // Materials say nothing about the shape.
    let read = tobj::load_obj_buf(&mut cursor, &options, |_| Ok((Vec::new(), Default::default())));
    let end = cursor.position() as usize;
    match read {
        Ok((models, _)) => {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            for tobj::Model { mesh, .. } in models {
                let first = vertices.len() as u32;
                vertices.extend(mesh.positions.chunks_exact(3).map(Vec3::from_column_slice));
                triangles.extend(mesh.indices.chunks_exact(3).map(|v| [v[0] + first, v[1] + first, v[2] + first]));
            }
            Some((vertices, triangles))
        }
        Err(error) => {
            let (message, hint) = obj_problem(&error);
            if matches!(error, LoadError::FaceVertexOutOfBounds) {
                findings.add_in_file(file, codes::OUT_OF_RANGE, message.to_string(), hint);
            } else {
                let span = line_at(text, end.saturating_sub(1));
                findings.add_in_text(file, text, span, codes::SYNTAX, message.to_string(), hint);
            }
            None
        }
    }
}

fn obj_problem(error: &LoadError) -> (&'static str, &'static str) {
    match error {
        LoadError::FaceVertexOutOfBounds => (
            "a face names a vertex that there is not",
            "vertices are counted from 1, or from the last one backwards by negative numbers",
        ),
        LoadError::PositionParseError | LoadError::ColorParseError | LoadError::ScalingByZeroError => {
            ("is no vertex", "a vertex is `v x y z`")
        }
        LoadError::FaceParseError | LoadError::InvalidPolygon => {
            ("is no face", "a face is `f i j k` with the numbers of three or more vertices")
        }
        LoadError::NormalParseError
        | LoadError::TexcoordParseError
        | LoadError::MaterialParseError
        | LoadError::InvalidObjectName
        | LoadError::UnrecognizedCharacter
        | LoadError::ReadError
        | LoadError::OpenFileFailed
        | LoadError::FaceTexCoordOutOfBounds
        | LoadError::FaceNormalOutOfBounds
        | LoadError::FaceColorOutOfBounds
        | LoadError::InvalidLoadOptionConfig
        | LoadError::GenericFailure => ("cannot be read as OBJ", "export the mesh anew, with vertices and faces only"),
    }
}

/// The line that holds a byte, without its ends.
fn line_at(text: &str, at: usize) -> Span {
    let bytes = text.as_bytes();
    let at = at.min(bytes.len());
    let start = bytes[..at].iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let end = bytes[at..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |length| at + length);
    let line = text.get(start..end).unwrap_or_default();
    let lead = line.len() - line.trim_start().len();
    Span::new(start + lead, start + lead.max(line.trim_end().len()))
}

/// Hands out a line at a time, so that where reading stopped is the line that it stopped at.
struct Lines<'a>(Cursor<&'a [u8]>);

impl Read for Lines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> IoResult<usize> {
        let rest = &self.0.get_ref()[(self.0.position() as usize).min(self.0.get_ref().len())..];
        let line = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
        let room = line.min(buffer.len());
        self.0.read(&mut buffer[..room])
    }
}

impl Seek for Lines<'_> {
    fn seek(&mut self, to: SeekFrom) -> IoResult<u64> {
        self.0.seek(to)
    }
}
