//! Every broken file of the library gives exactly the error output that stands
//! beside it. `STEADFAST_WRITE=1 cargo test --test malformed` writes the outputs
//! anew, to be read one by one.

use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Failed, Trial};
use steadfast::io::{
    Diagnostics, SourceFile, no_references, read_catalogue, read_certificate, read_checkable, read_configuration,
    read_linkage, read_problem, read_results, read_structure, read_suite, read_verifiable,
};

const KINDS: [&str; 8] =
    ["structure", "catalogue", "configuration", "lattice", "goal", "linkage_goal", "plan", "certificate"];

fn main() {
    let mut trials = Vec::new();
    for kind in KINDS {
        for path in problems::json_files(&format!("malformed/{kind}")).expect("the directory is there") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            trials.push(Trial::test(format!("{kind}/{name}"), move || check(kind, &path)));
        }
    }
    trials.push(Trial::test("ten megabytes of brackets", || bounded("structure", "[".repeat(10_000_000))));
    trials.push(Trial::test("ten megabytes of nested objects", || bounded("structure", "{\"a\":".repeat(2_000_000))));
    trials.push(Trial::test("ten megabytes of unknown keys", || {
        let keys: Vec<_> = (0..700_000).map(|i| format!("\"k{i:07}\":1")).collect();
        bounded("structure", format!("{{\"format\":\"structure/1\",{}}}", keys.join(",")))
    }));
    trials.push(Trial::test("ten megabytes in one line", || {
        bounded("structure", format!("{{\"format\":\"structure/1\",\"bodies\":[{}1]}}", "1,".repeat(5_000_000)))
    }));
    trials.push(Trial::test("all modules in all obstacles", || {
        let list = |item: &dyn Fn(usize) -> String| (0..20_000).map(item).collect::<Vec<_>>().join(",");
        let modules = list(&|i| format!(r#"{{"id":"{i}","type":"cube","cell":[{i},0,0]}}"#));
        let cuboid = r#""shape":{"cuboid":{"half_extents_m":[2000,1,1]}},"position_m":[0,0,0],"friction":0"#;
        let obstacles = list(&|_| format!("{{{cuboid}}}"));
        bounded(
            "configuration",
            format!(
                r#"{{"format":"configuration/1","catalogue":"cube","gravity_m_s2":[0,0,0],"connections":"touching",
                "environment":{{"obstacles":[{obstacles}]}},"modules":[{modules}]}}"#
            ),
        )
    }));
    for kind in ["rofi", "suite", "result"] {
        for path in problems::texts_and_json_files(&format!("malformed/{kind}")).expect("the directory is there") {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            trials.push(Trial::test(format!("{kind}/{name}"), move || check(kind, &path)));
        }
    }
    trials.push(Trial::test("ten megabytes of tables", || bounded("suite", "[[case]]\n".repeat(1_000_000))));
    trials.push(Trial::test("ten megabytes of nested tables", || bounded("suite", "a={".repeat(3_000_000))));
    trials
        .push(Trial::test("ten megabytes of text", || bounded("rofi", format!("C\n{}", "M 0 0\n".repeat(1_500_000)))));
    trials.push(Trial::test("a pad of a million docks, joined nowhere", || {
        let world = r#"{"modules": [{"id": 1, "type": "pad", "width": 1000, "height": 1001}], "moduleJoints": []}"#;
        bounded("rofi", world.to_string())
    }));
    trials.push(Trial::test("all modules in each other", || {
        let module = |i| format!(r#"{{"id":"{i}","type":"node","position_m":[0,0,{}]}}"#, f64::from(i) * 1e-6);
        let modules = (0..20_000).map(module).collect::<Vec<_>>().join(",");
        bounded(
            "configuration",
            format!(
                r#"{{"format":"configuration/1","catalogue":"freesn","gravity_m_s2":[0,0,0],"connections":[],
                "require":{{"connected":false}},"modules":[{modules}]}}"#
            ),
        )
    }));
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn read(kind: &str, file: &SourceFile) -> Result<(), Diagnostics> {
    match kind {
        "structure" => read_structure(file).map(drop),
        "catalogue" => read_catalogue(file).map(drop),
        "configuration" => read_checkable(file, &references).map(drop),
        "lattice" => read_configuration(file, &references).map(drop),
        "rofi" => read_linkage(file, &no_references).map(drop),
        "plan" => read_verifiable(file).map(drop),
        "certificate" => read_certificate(file).map(drop),
        "suite" => read_suite(file).map(drop),
        "result" => read_results(file).map(drop),
        _ => {
            let text = match kind {
                "linkage_goal" => &include_bytes!("../problems/malformed/linkage_start.json")[..],
                _ => &include_bytes!("../problems/malformed/start.json")[..],
            };
            let start = SourceFile::new("start.json", text);
            read_problem(&start, file, &no_references).map(drop)
        }
    }
}

/// Files beside the malformed ones.
fn references(_from: &str, reference: &str) -> Result<SourceFile, String> {
    let path = problems::root()
        .join("malformed")
        .join(Path::new(reference).strip_prefix("..").unwrap_or(Path::new(reference)));
    let bytes = std::fs::read(path).map_err(|_| "there is no such file".to_string())?;
    Ok(SourceFile::new(reference, bytes))
}

fn check(kind: &str, path: &PathBuf) -> Result<(), Failed> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let file = SourceFile::new(name, std::fs::read(path)?);
    let Err(diagnostics) = read(kind, &file) else { return Err("the file is accepted".into()) };
    if let Some(bare) = diagnostics.items().iter().find(|item| item.hint.is_none()) {
        return Err(format!("no hint for\n{bare}").into());
    }
    let (found, expected) = (diagnostics.to_string(), path.with_extension("stderr"));
    if std::env::var_os("STEADFAST_WRITE").is_some() {
        std::fs::write(&expected, &found)?;
    }
    let expected = std::fs::read_to_string(expected)?;
    if found != expected {
        return Err(format!("found\n{found}\nexpected\n{expected}").into());
    }
    Ok(())
}

/// A hostile file must be refused in few words.
fn bounded(kind: &str, text: String) -> Result<(), Failed> {
    let Err(diagnostics) = read(kind, &SourceFile::new("hostile.json", text)) else {
        return Err("the file is accepted".into());
    };
    let shown = diagnostics.to_string();
    if shown.len() > 20_000 {
        return Err(format!("{} bytes of errors", shown.len()).into());
    }
    Ok(())
}
