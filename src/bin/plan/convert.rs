//! `plan convert IN [OUT] [--to FORMAT]`

use std::path::Path;
use std::{fs, io};

use steadfast::io::{Form, read_linkage, write_linkage, write_rofi};

use crate::arguments::{ConvertArguments, RobotFormat};
use crate::exit::Exit;
use crate::{files, output};

/// Reads a robot of any format and writes it in another.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &ConvertArguments) -> io::Result<Exit> {
    let Some(to) = arguments.to.or_else(|| arguments.output.as_deref().and_then(by_ending)) else {
        output::message("error: say --to FORMAT: the name of the output does not tell")?;
        return Ok(Exit::Usage);
    };
    let file = files::read(&arguments.input);
    let mut linkage = match read_linkage(&file, &files::resolve) {
        Ok(linkage) => linkage,
        Err(diagnostics) => return output::bad_input(&diagnostics, false),
    };
    if arguments.robot_only {
        linkage = linkage.on_its_own();
    }
    let form = match to {
        RobotFormat::Configuration => Form::Own,
        RobotFormat::RofiJson => Form::RofiWorld,
        RobotFormat::RofiText => Form::RofiText,
        RobotFormat::RofiVoxel => Form::RofiVoxels,
    };
    let written = match form {
        Form::Own => write_linkage(&linkage).map_err(|problem| vec![problem.to_string()]),
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

/// The format that the name of a file tells: `.rofi` and `.in` are the platform's text; what a `.json` holds
/// its name does not say.
fn by_ending(path: &Path) -> Option<RobotFormat> {
    match path.extension()?.to_str()? {
        "rofi" | "in" => Some(RobotFormat::RofiText),
        _ => None,
    }
}
