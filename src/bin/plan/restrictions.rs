//! What no action of a plan may do, as said on the command line besides what the start says itself.

use steadfast::io::Problem;
use steadfast::robot::{Region, Requirement};
use steadfast::spatial::Vec3;

use crate::arguments::PlanningArguments;

/// Adds `--forbid-module` and `--forbid-region` to what the start requires.
///
/// # Errors
/// A sentence about a module that there is not.
pub fn apply(arguments: &PlanningArguments, problem: &mut Problem) -> Result<(), String> {
    match problem {
        Problem::Lattice(problem) => {
            let ids: Vec<&str> = problem.start.modules.iter().map(|module| module.id.as_str()).collect();
            add(arguments, &ids, &mut problem.start.require)
        }
        Problem::Linkage(problem) => {
            let ids: Vec<&str> = problem.start.modules.iter().map(|module| module.id.as_str()).collect();
            add(arguments, &ids, &mut problem.start.require)
        }
    }
}

fn add(arguments: &PlanningArguments, ids: &[&str], require: &mut Requirement) -> Result<(), String> {
    for forbidden in &arguments.forbid_module {
        let module = ids.iter().position(|id| id == forbidden);
        let module = module.ok_or_else(|| format!("--forbid-module: the start has no module `{forbidden}`"))?;
        if !require.stay.contains(&module) {
            require.stay.push(module);
        }
    }
    require.keep_out.extend(&arguments.forbid_region);
    Ok(())
}

/// A box as `--forbid-region` gives it.
///
/// # Errors
/// A sentence for the user.
pub fn region(text: &str) -> Result<Region, String> {
    let number = |part: &str| part.trim().parse::<f64>().map_err(|error| format!("`{part}`: {error}"));
    let numbers = text.split(',').map(number).collect::<Result<Vec<f64>, String>>()?;
    let [x0, y0, z0, x1, y1, z1] = numbers[..] else {
        return Err(format!("six numbers with commas between are needed, not {}", numbers.len()));
    };
    let region = Region { low: Vec3::new(x0, y0, z0), high: Vec3::new(x1, y1, z1) };
    let extent = region.high - region.low;
    match extent.iter().all(|&length| length > 0.0 && length.is_finite()) {
        true => Ok(region),
        false => Err("the second corner must be above the first along every axis".to_string()),
    }
}
