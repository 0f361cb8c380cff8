//! JSON numbers.

use super::Span;
use super::parse::Fault;
use super::string::clipped;

/// What to do about a NaN or an infinity.
pub(super) const NOT_JSON: &str = "JSON has no NaN and no infinities; where no limit is meant, write `null`";

/// Reads the number that starts at `start`. Its value is infinite when it is
/// beyond the range of a double.
pub(super) fn scan(text: &str, start: usize) -> Result<(f64, Span), Fault> {
    let bytes = text.as_bytes();
    let in_number = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'+' | b'-' | b'_');
    let end = start + bytes[start..].iter().take_while(|byte| in_number(byte)).count();
    let span = Span::new(start, end);
    let word = &text[start..end];
    if let Some(hint) = defect(word) {
        return Err(Fault::syntax(span, format!("`{}` is not a JSON number", clipped(word)), hint));
    }
    let value =
        word.parse().map_err(|_| Fault::syntax(span, format!("`{}` is not a JSON number", clipped(word)), ""))?;
    Ok((value, span))
}

/// Why `word` is not a number in JSON's grammar:
/// `-? (0 | [1-9][0-9]*) (. [0-9]+)? ([eE] [+-]? [0-9]+)?`.
fn defect(word: &str) -> Option<&'static str> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let unsigned = word.strip_prefix('-').unwrap_or(word);
    if unsigned.to_ascii_lowercase().starts_with("inf") || unsigned.to_ascii_lowercase().starts_with("nan") {
        return Some(NOT_JSON);
    }
    let whole = digits(unsigned);
    match whole {
        0 if unsigned.starts_with('.') => return Some("a number starts with a digit: write 0.5, not .5"),
        0 if unsigned.starts_with('+') => return Some("leave out the plus sign"),
        0 => return Some("a number needs a digit after the minus sign"),
        1 => {}
        _ if unsigned.starts_with('0') => return Some("a number has no leading zeros"),
        _ => {}
    }
    let mut rest = &unsigned[whole..];
    if let Some(fraction) = rest.strip_prefix('.') {
        if digits(fraction) == 0 {
            return Some("a decimal point is followed by a digit: write 1.0, not 1.");
        }
        rest = &fraction[digits(fraction)..];
    }
    if let Some(exponent) = rest.strip_prefix(['e', 'E']) {
        let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        if digits(exponent) == 0 {
            return Some("an exponent is followed by digits: write 1e3");
        }
        rest = &exponent[digits(exponent)..];
    }
    (!rest.is_empty()).then_some("numbers are plain decimals without units, e.g. 9.81 or 1e-3")
}
