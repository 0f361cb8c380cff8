//! Certificates as files: nothing is lost, and damage is noticed.

use steadfast::io::{CertificateDocument, SourceFile, read_certificate, write_certificate};

use crate::random::Random;
use crate::tampered::certificates;
use crate::{library, named};

fn documents() -> Vec<CertificateDocument> {
    certificates().into_iter().map(|c| CertificateDocument::new(&named(&c.structure), c)).collect()
}

fn read(text: Vec<u8>) -> Option<CertificateDocument> {
    read_certificate(&SourceFile::new("certificate.json", text)).ok()
}

#[test]
fn what_is_written_reads_back_equal() {
    for document in documents() {
        let text = write_certificate(&document).unwrap();
        assert_eq!(read(text.clone().into_bytes()), Some(document));
    }
}

/// A thousand bytes changed at random, each with an effect: none goes unnoticed.
#[test]
fn the_checksum_notices_every_changed_byte() {
    let texts: Vec<Vec<u8>> = documents().iter().map(|d| write_certificate(d).unwrap().into_bytes()).collect();
    let mut random = Random::new(8);
    let mut noticed = 0;
    while noticed < 1000 {
        let index = random.below(texts.len());
        let mut text = texts[index].clone();
        let at = random.below(text.len());
        let byte = if random.chance(0.5) { b'0' + random.below(10) as u8 } else { random.below(128) as u8 };
        if text[at] == byte {
            continue;
        }
        text[at] = byte;
        match read(text) {
            None => noticed += 1,
            // Another space between two values, or another spelling of the same number.
            Some(same) => assert_eq!(write_certificate(&same).unwrap().into_bytes(), texts[index]),
        }
    }
}

#[test]
fn a_certificate_keeps_the_names_of_its_structure() {
    let named = library("suspension_76");
    let document = CertificateDocument::new(&named, crate::certify(&named.structure).unwrap());
    let read = read(write_certificate(&document).unwrap().into_bytes()).unwrap();
    assert_eq!(read.named(), named);
}
