//! Where the findings of a benchmark go: standard output, and its record.

use std::io::Write as _;

/// Whether the benchmark is only to show that it starts, as `cargo test --benches` asks.
pub fn only_starts() -> bool {
    std::env::args().any(|argument| argument == "--test")
}

/// Prints `report`, and writes it and `table` to `benches/record/<name>.{md,csv}`.
pub fn publish(name: &str, report: &str, table: &str) {
    std::io::stdout().write_all(report.as_bytes()).expect("the report can be written");
    if only_starts() {
        return;
    }
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/record");
    std::fs::create_dir_all(record).expect("the folder of records can be made");
    std::fs::write(format!("{record}/{name}.md"), report).expect("the record can be written");
    std::fs::write(format!("{record}/{name}.csv"), table).expect("the record can be written");
}
