//! What no action of a plan may do, as said on the command line.

use clap::Args;

use steadfast::io::Problem;
use steadfast::robot::{Region, Requirement};
use steadfast::spatial::Vec3;

/// `--forbid-module` and `--forbid-region`, besides what the start says itself.
#[derive(Debug, Args)]
pub struct Restrictions {
    /// A module that no action may move, though nothing else holds it; may be given several times
    #[arg(long = "forbid-module", value_name = "ID")]
    modules: Vec<String>,
    /// A box that no move may pass through, by its lowest and highest corner in m; may be given several times
    #[arg(long = "forbid-region", value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = region, allow_hyphen_values = true)]
    regions: Vec<Region>,
}

impl Restrictions {
    /// Adds them to what the start requires.
    ///
    /// # Errors
    /// A sentence about a module that there is not.
    pub fn apply(&self, problem: &mut Problem) -> Result<(), String> {
        match problem {
            Problem::Lattice(problem) => {
                let ids: Vec<&str> = problem.start.modules.iter().map(|module| module.id.as_str()).collect();
                self.add(&ids, &mut problem.start.require)
            }
            Problem::Linkage(problem) => {
                let ids: Vec<&str> = problem.start.modules.iter().map(|module| module.id.as_str()).collect();
                self.add(&ids, &mut problem.start.require)
            }
        }
    }

    fn add(&self, ids: &[&str], require: &mut Requirement) -> Result<(), String> {
        for forbidden in &self.modules {
            let module = ids.iter().position(|id| id == forbidden);
            let module = module.ok_or_else(|| format!("--forbid-module: the start has no module `{forbidden}`"))?;
            if !require.stay.contains(&module) {
                require.stay.push(module);
            }
        }
        require.keep_out.extend(&self.regions);
        Ok(())
    }
}

fn region(text: &str) -> Result<Region, String> {
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
