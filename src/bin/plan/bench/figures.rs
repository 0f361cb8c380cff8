//! Figures of a suite, as SVG. Knows nothing of what is drawn.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

const SIZE: (u32, u32) = (860, 440);
const LEGEND: u32 = 260;
const FONT: &str = "sans-serif";

/// Colours that people with any colour vision tell apart (M. Okabe, K. Ito: "Color universal design", 2008).
const COLORS: [(u8, u8, u8); 7] =
    [(0, 114, 178), (213, 94, 0), (0, 158, 115), (204, 121, 167), (230, 159, 0), (86, 180, 233), (60, 60, 60)];

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Logarithmic,
}

/// What is drawn along an axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Its name, with the unit.
    pub name: &'static str,
    /// How it is divided.
    pub scale: Scale,
}

/// A point, hollow where it stands for less than it seems.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    pub x: f64,
    pub y: f64,
    pub hollow: bool,
}

/// One line or cloud of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// Corners of a line.
    pub line: Vec<(f64, f64)>,
    /// Points of their own.
    pub marks: Vec<Mark>,
}

/// A diagram.
#[derive(Clone, Debug)]
pub struct Figure {
    pub title: &'static str,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
}

impl Axis {
    fn place(self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.max(f64::MIN_POSITIVE).log10(),
        }
    }

    /// The range of some values, with a little room.
    fn range(self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        let places = values.filter(|value| value.is_finite()).map(|value| self.place(value));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if !(low <= high) {
            return (0.0, 1.0);
        }
        let room = 0.04 * (high - low).max(0.5);
        (low - room, high + room)
    }

    /// The label of a place on an axis of this length. A logarithmic one of several decades has labels at powers of
    /// ten alone.
    fn label(self, place: f64, length: f64) -> String {
        let value = match self.scale {
            Scale::Linear => place,
            Scale::Logarithmic if length > 1.5 && (place - place.round()).abs() > 1e-9 => return String::new(),
            Scale::Logarithmic => 10_f64.powf(place),
        };
        match value.abs() {
            0.0 => "0".to_string(),
            size if !(1e-3..1e5).contains(&size) => format!("{value:.0e}"),
            size if size < 1.0 => format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_string(),
            size if size < 10.0 => format!("{value:.1}").trim_end_matches(".0").to_string(),
            _ => format!("{value:.0}"),
        }
    }
}

impl Figure {
    /// Draws the figure into a file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let root = SVGBackend::new(path, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let (left, right) = root.split_horizontally(SIZE.0 - LEGEND);
        let all = || {
            let lines = self.series.iter().flat_map(|series| series.line.iter().copied());
            lines.chain(self.series.iter().flat_map(|series| series.marks.iter().map(|mark| (mark.x, mark.y))))
        };
        let (x, y) = (self.x.range(all().map(|at| at.0)), self.y.range(all().map(|at| at.1)));
        let mut chart = ChartBuilder::on(&left)
            .caption(self.title, (FONT, 17))
            .margin(10)
            .x_label_area_size(42)
            .y_label_area_size(62)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        chart
            .configure_mesh()
            .x_desc(self.x.name)
            .y_desc(self.y.name)
            .x_labels(7)
            .y_labels(7)
            .x_label_formatter(&|place| self.x.label(*place, x.1 - x.0))
            .y_label_formatter(&|place| self.y.label(*place, y.1 - y.0))
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .label_style((FONT, 12))
            .axis_desc_style((FONT, 13))
            .draw()?;
        let at = |(x, y): (f64, f64)| (self.x.place(x), self.y.place(y));
        for (index, series) in self.series.iter().enumerate() {
            let color = color(index);
            chart.draw_series(LineSeries::new(series.line.iter().copied().map(at), color.stroke_width(2)))?;
            for mark in &series.marks {
                let style = if mark.hollow { color.stroke_width(1) } else { color.filled() };
                chart.draw_series([Circle::new(at((mark.x, mark.y)), 4, style)])?;
            }
            let height = 46 + 22 * i32::try_from(index)?;
            right.draw(&PathElement::new([(6, height), (30, height)], color.stroke_width(3)))?;
            right.draw(&Text::new(series.name.clone(), (38, height - 7), (FONT, 13).into_font()))?;
        }
        root.present()?;
        Ok(())
    }
}

fn color(index: usize) -> RGBColor {
    let (red, green, blue) = COLORS[index % COLORS.len()];
    RGBColor(red, green, blue)
}
