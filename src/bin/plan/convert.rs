//! `plan convert IN [OUT] [--to FORMAT]`

use std::path::Path;
use std::{fs, io};

use steadfast::io::{Form, read_linkage, write_linkage, write_rofi};

use steadfast::robot::linkage::Linkage;
use steadfast::robot::{Environment, Requirement};
use steadfast::spatial::Vec3;

use crate::arguments::{ConvertArguments, RobotFormat};
use crate::exit::Exit;
use crate::{files, output};

/// Reads a robot of any format and writes it in another.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &ConvertArguments) -> io::Result<Exit> {
    let by_ending = arguments.output.as_deref().and_then(by_ending);
    let to = arguments.to.or(by_ending).unwrap_or(RobotFormat::Configuration);
    let file = files::read(&arguments.input);
    let mut linkage = match read_linkage(&file, &files::resolve) {
        Ok(linkage) => linkage,
        Err(diagnostics) => return output::bad_input(&diagnostics, false),
    };
    if arguments.robot_only {
        on_its_own(&mut linkage);
    }
    let form = match to {
        RobotFormat::Configuration => Form::Own,
        RobotFormat::RofiJson => Form::RofiWorld,
        RobotFormat::RofiText => Form::RofiText,
        RobotFormat::RofiVoxel => Form::RofiVoxels,
    };
    let written = match form {
        Form::Own | Form::Tables => write_linkage(&linkage).map_err(|problem| vec![problem.to_string()]),
        _ => write_rofi(&linkage, form),
    };
    let text = match written {
        Ok(text) => text,
        Err(reasons) => {
            let reasons = reasons.into_iter().map(|reason| format!("cannot be written as {}: {reason}", form.name()));
            return output::refused(&file.name, reasons, false);
        }
    };
    match &arguments.output {
        None => output::result(&text)?,
        Some(path) => {
            if let Err(trouble) = fs::write(path, text) {
                output::message(&format!("error: {}: {trouble}", path.display()))?;
                return Ok(Exit::BadInput);
            }
        }
    }
    Ok(Exit::Yes)
}

/// Leaves out what surrounds a robot and what is asked of it. Pads are fixed in the platform's formats.
fn on_its_own(linkage: &mut Linkage) {
    linkage.gravity = Vec3::zeros();
    let module_friction = linkage.environment.module_friction;
    linkage.environment = Environment { module_friction, ..Environment::default() };
    linkage.loads = Vec::new();
    linkage.require = Requirement::default();
    for module in &mut linkage.modules {
        module.fixed &= linkage.catalogue.module_types[module.module_type].joints.is_empty();
    }
}

/// The format that the name of a file tells: `.rofi` and `.in` are the platform's text; what a `.json` holds
/// its name does not say.
fn by_ending(path: &Path) -> Option<RobotFormat> {
    match path.extension()?.to_str()? {
        "rofi" | "in" => Some(RobotFormat::RofiText),
        _ => None,
    }
}
