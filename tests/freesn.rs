//! The built-in catalogue `freesn` on the published suspension of 76 modules.

use steadfast::io::{Checkable, NamedStructure, SourceFile, no_references, read_checkable, read_structure};
use steadfast::statics::{Question, assess};

/// Four columns of eight nodes that hang from four struts on a wall, with vertical struts between and
/// twelve horizontal ones in four of the rows: only the four upper struts have a place.
fn suspension() -> String {
    let mut modules = Vec::new();
    let mut connections = Vec::new();
    let mut module = |id: &str, kind: &str, place: &str| {
        modules.push(format!(r#"{{"id":"{id}","type":"{kind}"{place}}}"#));
    };
    // At the lower pole half a turn keeps the x axes of the strut and the node parallel.
    let mut connect = |strut: &str, node: &str, direction: &str| {
        let ports = format!(r#""ports":["{strut}","{node}:surface"]"#);
        let spin = if direction == "0,0,-1" { 180 } else { 0 };
        connections.push(format!(r#"{{{ports},"direction":[{direction}],"spin_deg":{spin}}}"#));
    };
    for column in 0..4 {
        let x = f64::from(column) * 0.207;
        let wall = format!("w{column}");
        module(&wall, "strut", &format!(r#","position_m":[{x},0,1.5525],"fixed":true"#));
        let mut above = wall;
        for row in 0..8 {
            let node = format!("n{row}{column}");
            module(&node, "node", "");
            connect(&format!("{above}:bottom"), &node, "0,0,1");
            if row < 7 {
                above = format!("s{row}{column}");
                module(&above, "strut", "");
                connect(&format!("{above}:top"), &node, "0,0,-1");
            }
            if row % 2 == 1 && column < 3 {
                module(&format!("h{row}{column}"), "strut", "");
                connect(&format!("h{row}{column}:bottom"), &node, "1,0,0");
            }
            if row % 2 == 1 && column > 0 {
                connect(&format!("h{row}{}:top", column - 1), &node, "-1,0,0");
            }
        }
    }
    let (modules, connections) = (modules.join(","), connections.join(","));
    format!(
        r#"{{"format":"configuration/1","catalogue":"freesn","gravity_m_s2":[0,0,-9.8],
            "modules":[{modules}],"connections":[{connections}]}}"#
    )
}

#[test]
fn the_suspension_needs_what_its_structure_needs() {
    let file = SourceFile::new("suspension", suspension());
    let linkage = match read_checkable(&file, &no_references) {
        Ok(Checkable::Linkage(linkage)) => linkage,
        Ok(other) => panic!("{other:?}"),
        Err(diagnostics) => panic!("{diagnostics}"),
    };
    assert_eq!(linkage.modules.len(), 76);
    let structure = NamedStructure::of_linkage(&linkage).structure;
    assert_eq!(structure.connections.len(), 84);
    let text = std::fs::read(problems::root().join("structures/suspension_76.json")).unwrap();
    let known = read_structure(&SourceFile::new("known", text)).unwrap().structure;
    let [found, expected] = [&structure, &known].map(|s| assess(s, Question::VALUE).unwrap().utilisation);
    assert!((found.upper - expected.upper).abs() <= 1e-6, "{found:?} {expected:?}");
    assert!((found.upper * 109.2 - 76.518).abs() < 1e-3, "{found:?}");
}
