//! Figures: panels with two logarithmic axes beside one legend, as SVG.
//!
//! Knows nothing of what is drawn.

use std::collections::BTreeMap;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// How a series looks.
#[derive(Clone, Copy, PartialEq)]
pub struct Look {
    pub color: (u8, u8, u8),
    pub mark: Mark,
    pub line: bool,
}

/// The shape of a point.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    Circle,
    Square,
    Up,
    Down,
    Cross,
}

/// A point, hollow where its method did not vouch for it.
#[derive(Clone, Copy)]
pub struct Dot {
    pub x: f64,
    pub y: f64,
    pub hollow: bool,
}

/// Points of one method.
pub struct Series {
    pub name: String,
    pub look: Look,
    pub dots: Vec<Dot>,
}

/// One diagram.
pub struct Panel {
    pub title: String,
    pub series: Vec<Series>,
    /// A horizontal line and its meaning.
    pub floor: Option<(f64, &'static str)>,
}

/// Panels with common axes' names.
pub struct Figure {
    pub title: String,
    pub x: &'static str,
    pub y: &'static str,
    pub panels: Vec<Panel>,
    /// Whether all panels show the same ranges.
    pub alike: bool,
    /// What hollow points mean.
    pub hollow: Option<&'static str>,
}

const PANEL: (u32, u32) = (380, 300);
const LEGEND: u32 = 190;
const HEAD: u32 = 34;
const FONT: &str = "sans-serif";

type Failure = Box<dyn std::error::Error>;

impl Figure {
    /// Draws the figure into a file.
    ///
    /// # Errors
    /// Where the file cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), Failure> {
        let columns = self.panels.len().clamp(1, 3);
        let rows = self.panels.len().div_ceil(columns);
        let size = (PANEL.0 * columns as u32 + LEGEND, PANEL.1 * rows as u32 + HEAD);
        let root = SVGBackend::new(path, size).into_drawing_area();
        root.fill(&WHITE)?;
        root.draw(&Text::new(self.title.clone(), (12, 8), (FONT, 19).into_font()))?;
        let (_, below) = root.split_vertically(HEAD);
        let (left, right) = below.split_horizontally(PANEL.0 * columns as u32);
        for (panel, area) in self.panels.iter().zip(left.split_evenly((rows, columns))) {
            self.panel(panel, &area)?;
        }
        self.legend(&right)?;
        root.present()?;
        Ok(())
    }

    fn panel(&self, panel: &Panel, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Failure> {
        let shown = || self.panels.iter().filter(|other| self.alike || std::ptr::eq(*other, panel));
        let dots = || shown().flat_map(|panel| &panel.series).flat_map(|series| &series.dots);
        let floors = shown().filter_map(|panel| panel.floor).map(|floor| floor.0);
        let (x, y) = (range(dots().map(|dot| dot.x)), range(dots().map(|dot| dot.y).chain(floors)));
        let mut chart = ChartBuilder::on(area)
            .caption(&panel.title, (FONT, 15))
            .margin(6)
            .margin_right(16)
            .x_label_area_size(38)
            .y_label_area_size(52)
            .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .x_labels(6)
            .y_labels(8)
            .x_label_formatter(&|x| power(*x))
            .y_label_formatter(&|y| power(*y))
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225))
            .label_style((FONT, 12))
            .axis_desc_style((FONT, 13))
            .draw()?;
        if let Some((height, meaning)) = panel.floor {
            let grey = RGBColor(120, 120, 120);
            chart.draw_series(LineSeries::new([(x.0, height), (x.1, height)], grey.stroke_width(1)))?;
            let style = (FONT, 11).into_font().color(&grey).pos(Pos::new(HPos::Right, VPos::Bottom));
            chart.draw_series([Text::new(meaning, (x.1, height * 1.3), style)])?;
        }
        for series in &panel.series {
            let color = rgb(series.look.color);
            if series.look.line {
                let line = series.dots.iter().map(|dot| (dot.x, dot.y));
                chart.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
            }
            for dot in &series.dots {
                let at = chart.plotting_area().map_coordinate(&(dot.x, dot.y));
                let origin = area.get_base_pixel();
                mark(area, (at.0 - origin.0, at.1 - origin.1), series.look, dot.hollow)?;
            }
        }
        Ok(())
    }

    fn legend(&self, area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Failure> {
        // By first appearance, each name once.
        let (mut seen, mut entries) = (BTreeMap::new(), Vec::new());
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if seen.insert(series.name.as_str(), ()).is_none() {
                entries.push(series);
            }
        }
        let mut y = 40;
        for series in entries {
            if series.look.line {
                let color = rgb(series.look.color).stroke_width(2);
                area.draw(&PathElement::new([(8, y), (36, y)], color))?;
            }
            mark(area, (22, y), series.look, false)?;
            area.draw(&Text::new(series.name.clone(), (44, y - 7), (FONT, 13).into_font()))?;
            y += 22;
        }
        if let Some(hollow) = self.hollow {
            for (i, line) in hollow.split('\n').enumerate() {
                area.draw(&Text::new(line.to_owned(), (8, y + 8 + 16 * i as i32), (FONT, 12).into_font()))?;
            }
        }
        Ok(())
    }
}

const fn rgb(color: (u8, u8, u8)) -> RGBColor {
    RGBColor(color.0, color.1, color.2)
}

fn mark(area: &DrawingArea<SVGBackend<'_>, Shift>, at: (i32, i32), look: Look, hollow: bool) -> Result<(), Failure> {
    let color = rgb(look.color);
    let style = if hollow { color.stroke_width(1) } else { color.filled() };
    let corners = |corners: &[(i32, i32)]| corners.iter().map(|c| (at.0 + c.0, at.1 + c.1)).collect::<Vec<_>>();
    let outline = match look.mark {
        Mark::Circle => {
            if hollow {
                area.draw(&Circle::new(at, 4, WHITE.filled()))?;
            }
            area.draw(&Circle::new(at, 4, style))?;
            return Ok(());
        }
        Mark::Square => corners(&[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -4)]),
        Mark::Up => corners(&[(0, -5), (5, 4), (-5, 4), (0, -5)]),
        Mark::Down => corners(&[(0, 5), (5, -4), (-5, -4), (0, 5)]),
        Mark::Cross => {
            area.draw(&PathElement::new(corners(&[(-4, -4), (4, 4)]), color.stroke_width(2)))?;
            area.draw(&PathElement::new(corners(&[(-4, 4), (4, -4)]), color.stroke_width(2)))?;
            return Ok(());
        }
    };
    if hollow {
        area.draw(&Polygon::new(outline.clone(), WHITE.filled()))?;
        area.draw(&PathElement::new(outline, style))?;
    } else {
        area.draw(&Polygon::new(outline, style))?;
    }
    Ok(())
}

/// Whole decades around all values.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    if !(low > 0.0 && low.is_finite() && high.is_finite()) {
        return (0.1, 10.0);
    }
    let (low, high) = (low.log10().floor(), (high.log10() + 1e-9).ceil());
    (10_f64.powf(low), 10_f64.powf(high.max(low + 1.0)))
}

/// A power of ten in figures where that is short, with an exponent otherwise.
fn power(value: f64) -> String {
    let exponent = value.log10().round();
    if (value / 10_f64.powf(exponent) - 1.0).abs() > 1e-6 {
        return String::new();
    }
    match exponent {
        -2.0 => "0.01".to_owned(),
        -1.0 => "0.1".to_owned(),
        0.0..=5.0 => format!("{:.0}", 10_f64.powf(exponent)),
        _ => format!("1e{exponent}"),
    }
}
