//! Random damage to sound files must never make a reader panic, and whatever
//! is accepted must be written and read back equal.

use steadfast::io::{
    Form, SourceFile, no_references, read_catalogue, read_certificate, read_configuration, read_linkage,
    read_linkage_plan, read_plan, read_problem, read_structure, write_catalogue, write_certificate,
    write_configuration, write_linkage, write_linkage_plan, write_plan, write_rofi, write_structure,
};
use steadfast::robot::linkage::Linkage;

/// Mutations of each kind of file.
const ROUNDS: u64 = 20_000;

/// Marsaglia's xorshift: small, and the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound.max(1) as u64) as usize
    }
}

const TOKENS: [&str; 32] = [
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "\\",
    "null",
    "true",
    "0",
    "-1",
    "1e999",
    "-1e308",
    "5e-324",
    "1e300",
    "NaN",
    "9223372036854775808",
    "-0.0",
    "0.5",
    "\"world\"",
    "\"a\"",
    "\"a:+z\"",
    "\"model\"",
    "\"cone\"",
    "\"cell\"",
    "[]",
    "{}",
    "\\ud800",
    "\u{feff}",
    "\u{1f916}",
    "1000000",
];

/// Damages `text` once or a few times.
fn mutate(text: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..=random.below(3) {
        let (at, other) = (random.below(bytes.len()), random.below(bytes.len()));
        let (low, high) = (at.min(other), at.max(other));
        match random.below(8) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(low..high.min(low + 20))),
            2 => bytes.insert(at, random.next() as u8),
            3 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            4 => drop(bytes.splice(at..at, TOKENS[random.below(TOKENS.len())].bytes())),
            5 => replace_token(&mut bytes, at, TOKENS[random.below(TOKENS.len())]),
            6 if !bytes.is_empty() => bytes.swap(at, other),
            _ => {
                let copy = bytes[low..high.min(low + 60)].to_vec();
                drop(bytes.splice(other..other, copy));
            }
        }
    }
    bytes
}

/// Replaces the number or word around `at`.
fn replace_token(bytes: &mut Vec<u8>, at: usize, token: &str) {
    let in_token = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+' | b'_' | b'"' | b':');
    let start = at - bytes[..at].iter().rev().take_while(|byte| in_token(byte)).count();
    let end = at + bytes[at..].iter().take_while(|byte| in_token(byte)).count();
    bytes.splice(start..end, token.bytes());
}

/// Feeds damaged copies of a file to `read`, which says whether it accepted one.
fn damage(name: &str, seed: u64, read: impl Fn(&SourceFile) -> Result<(), String>) {
    damage_often(ROUNDS, name, seed, read);
}

fn damage_often(rounds: u64, name: &str, seed: u64, read: impl Fn(&SourceFile) -> Result<(), String>) {
    let text = std::fs::read(problems::root().join("valid").join(name)).unwrap();
    assert_eq!(read(&SourceFile::new(name, text.clone())), Ok(()), "{name} itself is sound");
    let mut random = Random(seed);
    let mut accepted = 0;
    for _ in 0..rounds {
        let file = SourceFile::new(name, mutate(&text, &mut random));
        match read(&file) {
            Ok(()) => accepted += 1,
            // The schema and the decoder must agree on what a format is.
            Err(shown) => assert!(!shown.contains("does not fit the format"), "{shown}"),
        }
    }
    assert!(accepted > 0, "no mutation of {name} was harmless: the test tests little");
}

#[test]
fn structures() {
    damage("structure.json", 0x51ed_270b, |file| {
        let named = read_structure(file).map_err(|e| e.to_string() + &e.to_json())?;
        let text = write_structure(&named).unwrap();
        assert_eq!(read_structure(&SourceFile::new("again", text)), Ok(named));
        Ok(())
    });
}

#[test]
fn catalogues() {
    damage("catalogue.json", 0x9e37_79b9, |file| {
        let catalogue = read_catalogue(file).map_err(|e| e.to_string())?;
        let text = write_catalogue(&catalogue).unwrap();
        assert_eq!(read_catalogue(&SourceFile::new("again", text)), Ok(catalogue));
        Ok(())
    });
}

#[test]
fn configurations() {
    damage("configuration.json", 0x85eb_ca6b, |file| {
        let configuration = read_configuration(file, &no_references).map_err(|e| e.to_string())?;
        let text = write_configuration(&configuration).unwrap();
        assert_eq!(read_configuration(&SourceFile::new("again", text), &no_references), Ok(configuration));
        Ok(())
    });
}

#[test]
fn linkages() {
    damage("linkage.json", 0x1b87_3593, |file| {
        let linkage = read_linkage(file, &no_references).map_err(|e| e.to_string())?;
        let text = write_linkage(&linkage).unwrap();
        let again = read_linkage(&SourceFile::new("again", text), &no_references);
        assert_eq!(again, Ok(linkage));
        Ok(())
    });
}

#[test]
fn goals_of_linkages() {
    let start = SourceFile::new("start.json", std::fs::read(problems::root().join("valid/linkage.json")).unwrap());
    // Start and goal are read again every time.
    damage_often(ROUNDS / 4, "linkage.json", 0xcc9e_2d51, |file| {
        read_problem(&start, file, &no_references).map(drop).map_err(|e| e.to_string())
    });
}

#[test]
fn goals() {
    let start = std::fs::read(problems::root().join("valid/configuration.json")).unwrap();
    let start = SourceFile::new("start.json", start);
    damage("goal.json", 0xc2b2_ae35, |file| {
        read_problem(&start, file, &no_references).map(drop).map_err(|e| e.to_string())
    });
}

#[test]
fn plans() {
    damage("plan.json", 0x27d4_eb2f, |file| {
        let plan = read_plan(file).map_err(|e| e.to_string())?;
        let text = write_plan(&plan).unwrap();
        assert_eq!(read_plan(&SourceFile::new("again", text)), Ok(plan));
        Ok(())
    });
}

/// Whatever is accepted is written in the same format and read back as the same robot.
fn damaged_rofi(name: &str, seed: u64, form: Form) {
    damage(name, seed, |file| {
        let linkage = read_linkage(file, &no_references).map_err(|e| e.to_string())?;
        let text = write_rofi(&linkage, form).unwrap_or_else(|why| panic!("{why:?}"));
        let again = read_linkage(&SourceFile::new("again", text), &no_references).unwrap();
        let joints = |linkage: &Linkage| -> Vec<_> { linkage.modules.iter().map(|m| m.joints.clone()).collect() };
        assert_eq!(again.modules.len(), linkage.modules.len());
        if form != Form::RofiVoxels {
            // Voxels tell neither a module's halves apart nor its X docks.
            assert_eq!(joints(&again), joints(&linkage));
            assert_eq!(again.connections, linkage.connections);
        }
        Ok(())
    });
}

#[test]
fn rofi_worlds() {
    damaged_rofi("rofi_world.json", 0x2545_f491, Form::RofiWorld);
}

#[test]
fn rofi_texts() {
    damaged_rofi("rofi.rofi", 0x9e6c_63d0, Form::RofiText);
}

#[test]
fn rofi_voxels() {
    damaged_rofi("rofi_voxels.json", 0x7f4a_7c15, Form::RofiVoxels);
}

#[test]
fn plans_of_linkages() {
    for (name, seed) in [("linkage_plan.json", 0x1656_67b1), ("joint_plan.json", 0xe654_6b64)] {
        damage(name, seed, |file| {
            let plan = read_linkage_plan(file).map_err(|e| e.to_string())?;
            let text = write_linkage_plan(&plan).unwrap();
            assert_eq!(read_linkage_plan(&SourceFile::new("again", text)), Ok(plan));
            Ok(())
        });
    }
}

#[test]
fn certificates() {
    damage("certificate.json", 0x1656_67b1, |file| {
        let certificate = read_certificate(file).map_err(|e| e.to_string())?;
        let text = write_certificate(&certificate).unwrap();
        assert_eq!(read_certificate(&SourceFile::new("again", text)), Ok(certificate));
        Ok(())
    });
}
