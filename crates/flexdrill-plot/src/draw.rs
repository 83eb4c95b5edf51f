//! Drawing a figure as SVG.
//!
//! plotters rounds coordinates to whole units. The drawing is therefore [`SCALE`] times as large as its stated size,
//! which keeps curves smooth.

use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontError, register_font};

use super::panel::{Figure, Legend, Line, Mark, Panel};

/// Units of the drawing per unit of its stated size.
pub(crate) const SCALE: u32 = 4;
/// Stated width of a drawing that fills a page.
const WIDTH: u32 = 1080;
/// The font, so that figures have the same layout on every machine. `font/README.md` has its source.
const FONT: &[u8] = include_bytes!("font/Roboto-Regular.ttf");

/// Colours that differ for colour-blind readers too, and in grey (Okabe and Ito, 2008).
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];

/// Heights of texts and distances, in the units of a width of 1080.
const HEADING: u32 = 22;
const TITLE: u32 = 17;
const TEXT: u32 = 15;
const ROW: u32 = 22;
const LEFT: u32 = 62;
/// Width of a letter of a row's name, of medium width.
const LETTER: u32 = 7;
const BOTTOM: u32 = 46;
const MARGIN: u32 = 12;

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("figure {figure}: {reason}")]
pub struct DrawError {
    figure: &'static str,
    reason: String,
}

/// The figure as SVG, 1080 units wide.
///
/// # Errors
/// When the drawing library fails, which it does not for finite data.
pub fn svg(figure: &Figure) -> Result<String, DrawError> {
    svg_of_width(figure, WIDTH)
}

/// The figure as SVG of another width. Texts keep their size, so that a figure of 480 units can be read on a telephone.
///
/// # Errors
/// As [`svg`].
pub fn svg_of_width(figure: &Figure, width: u32) -> Result<String, DrawError> {
    drawn(figure, width, false)
}

/// The figure as a separate SVG file, 1080 units wide: with its title above and its caption below.
///
/// # Errors
/// As [`svg`].
pub fn sheet(figure: &Figure) -> Result<String, DrawError> {
    drawn(figure, WIDTH, true)
}

fn drawn(figure: &Figure, width: u32, with_words: bool) -> Result<String, DrawError> {
    static FONT_IS_KNOWN: OnceLock<bool> = OnceLock::new();
    let failed = |reason: String| DrawError {
        figure: figure.name,
        reason,
    };
    if !FONT_IS_KNOWN.get_or_init(|| register_font("sans-serif", FontStyle::Normal, FONT).is_ok()) {
        return Err(failed("the embedded font is not one".to_owned()));
    }
    // What stands above and below the panels.
    let (mut head, mut caption) = (0, Vec::new());
    if with_words {
        head = if figure.title.is_empty() { 0 } else { 2 * ROW };
        let room = (width - 2 * MARGIN) * SCALE;
        caption = wrapped(&figure.caption, room).map_err(|error| failed(error.to_string()))?;
    }
    let rows = layout(figure);
    let panels_end = head + figure.height * rows.len() as u32;
    let foot = if caption.is_empty() {
        0
    } else {
        ROW * caption.len() as u32 + MARGIN
    };
    let (stated, width) = (width, width * SCALE);
    let height = (panels_end + foot) * SCALE;
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        area.fill(&WHITE).map_err(|error| failed(error.to_string()))?;
        let words = |words: &str, down: u32, size: u32| {
            let at = (((MARGIN + 4) * SCALE) as i32, (down * SCALE) as i32);
            let drawn = area.draw(&Text::new(words.to_owned(), at, font(size)));
            drawn.map_err(|error| failed(error.to_string()))
        };
        if head > 0 {
            words(&figure.title, MARGIN, HEADING)?;
        }
        for (row, line) in (0..).zip(&caption) {
            words(line, panels_end + row * ROW, TEXT)?;
        }
        let unit = width / figure.columns as u32;
        for (row, panels) in rows.iter().enumerate() {
            let mut column = 0;
            for &index in panels {
                let panel = &figure.panels[index];
                let place = area.clone().shrink(
                    (column * unit, (head + row as u32 * figure.height) * SCALE),
                    (panel.span as u32 * unit, figure.height * SCALE),
                );
                draw(&place, panel).map_err(|error| failed(error.to_string()))?;
                column += panel.span as u32;
            }
        }
        area.present().map_err(|error| failed(error.to_string()))?;
    }
    let inner = format!("<svg width=\"{width}\" height=\"{height}\"");
    let outer = format!("<svg width=\"{stated}\" height=\"{}\"", height / SCALE);
    Ok(text.replacen(&inner, &outer, 1))
}

/// The lines of a text within `room` units of the drawing.
fn wrapped(text: &str, room: u32) -> Result<Vec<String>, FontError> {
    let style = font(TEXT);
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        if let Some(line) = lines.last_mut() {
            let longer = format!("{line} {word}");
            // A viewer may draw with a wider font than the embedded one, which measures: a twelfth is kept free.
            if style.font.box_size(&longer)?.0 * 12 / 11 <= room {
                *line = longer;
                continue;
            }
        }
        lines.push(word.to_owned());
    }
    Ok(lines)
}

/// Panels of each row.
fn layout(figure: &Figure) -> Vec<Vec<usize>> {
    let mut rows: Vec<Vec<usize>> = vec![];
    let mut used = figure.columns;
    for (index, panel) in figure.panels.iter().enumerate() {
        if used + panel.span > figure.columns {
            rows.push(vec![]);
            used = 0;
        }
        used += panel.span;
        if let Some(row) = rows.last_mut() {
            row.push(index);
        }
    }
    rows
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", size * SCALE).into_font().color(&RGBColor(30, 30, 30))
}

fn draw<'a>(area: &Area<'a>, panel: &Panel) -> Result<(), Failure<'a>> {
    let named: Vec<(usize, &Line)> = panel
        .lines
        .iter()
        .enumerate()
        .filter(|(_, line)| !line.name.is_empty())
        .collect();
    // The legend stands above the plot, so its rows must be known before the plot has its height.
    let legend_rows = match panel.legend {
        _ if named.is_empty() => 0,
        Legend::Row => 1,
        Legend::Stacked => named.len() as u32,
    };
    let s = |length: u32| (length * SCALE) as i32;
    area.draw(&Text::new(panel.title.clone(), (s(MARGIN + 4), s(8)), font(TITLE)))?;
    let top = 8 + ROW + legend_rows * ROW;
    legend(area, panel.legend, &named)?;
    let (width, height) = area.dim_in_pixel();
    let left = left(panel);
    let plot_width = f64::from(width) - f64::from((left + 2 * MARGIN) * SCALE);
    let plot_height = f64::from(height) - f64::from((top + BOTTOM + MARGIN) * SCALE);
    // Ranges of equal scale depend on the shape of the plot, which is known only now.
    let (x, y) = ranges(panel, plot_width / plot_height);
    // A reversed range turns the axis: the low side of the hole is drawn below.
    let (y_from, y_to) = if panel.down { (y[1], y[0]) } else { (y[0], y[1]) };
    let mut chart = ChartBuilder::on(area)
        .margin_top(top * SCALE)
        .margin_left(MARGIN * SCALE)
        .margin_right(MARGIN * SCALE)
        .margin_bottom(MARGIN * SCALE)
        .x_label_area_size(BOTTOM * SCALE)
        .y_label_area_size(left * SCALE)
        .build_cartesian_2d(x[0]..x[1], y_from..y_to)?;
    let grey = RGBColor(110, 110, 110);
    // Names are at whole numbers only.
    let at = |names: &[String], value: &f64| {
        if names.is_empty() {
            return tick(value);
        }
        let whole = (value - value.round()).abs() < 1e-9 && *value > -0.5;
        let name = whole.then(|| names.get(value.round() as usize)).flatten();
        name.cloned().unwrap_or_default()
    };
    let (at_x, at_y) = (|x: &f64| at(&panel.names, x), |y: &f64| at(&panel.rows, y));
    // Labels by the size of the plot: about 45 units apart, so that numbers never overlap. Rows are named each.
    let y_labels = match panel.rows.len() {
        0 => ((plot_height / f64::from(SCALE) / 45.0) as usize).clamp(4, 9),
        rows => rows + 1,
    };
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(SCALE))
        .axis_style(grey.stroke_width(SCALE))
        .set_all_tick_mark_size((4 * SCALE) as i32)
        // About 50 units apart on x.
        .x_labels(((plot_width / f64::from(SCALE) / 50.0) as usize).clamp(5, 10))
        .y_labels(y_labels)
        .x_label_formatter(&at_x)
        .y_label_formatter(&at_y)
        .label_style(font(TEXT - 1))
        .axis_desc_style(font(TEXT))
        .x_desc(panel.x.as_str())
        .y_desc(panel.y.as_str())
        .draw()?;
    // The caller puts areas and cells first, because later lines cover earlier ones.
    for (index, line) in panel.lines.iter().enumerate() {
        let color = color(index, line);
        let points = || line.points.iter().copied();
        match line.mark {
            Mark::Solid | Mark::Thin | Mark::Wide => {
                chart.draw_series(LineSeries::new(points(), color.stroke_width(stroke(line.mark))))?;
            }
            Mark::Dashed => {
                let (dash, gap) = (8 * SCALE, 5 * SCALE);
                chart.draw_series(DashedLineSeries::new(
                    points(),
                    dash,
                    gap,
                    color.stroke_width(stroke(line.mark)),
                ))?;
            }
            Mark::Area => {
                let corners: Vec<_> = points().collect();
                chart.draw_series(std::iter::once(Polygon::new(corners, color.filled())))?;
            }
            // Cells have the size that the line gives, in data units, and join without gaps.
            Mark::Cells | Mark::PaleCells => {
                let [across, up] = line.half;
                chart.draw_series(
                    points().map(|(x, y)| Rectangle::new([(x - across, y - up), (x + across, y + up)], color.filled())),
                )?;
            }
            Mark::Bars => {
                let bars = |lines: &[Line]| lines.iter().filter(|line| line.mark == Mark::Bars).count() as f64;
                let (place, count) = (bars(&panel.lines[..index]), bars(&panel.lines));
                // A tenth of the unit is left between groups, a tenth of each bar's share between bars.
                let share = 0.9 / count;
                let (aside, half) = ((place - 0.5 * (count - 1.0)) * share, 0.45 * share);
                let beside = || points().map(|(x, y)| (x + aside, y));
                chart.draw_series(
                    beside().map(|(x, y)| Rectangle::new([(x - half, 0.0), (x + half, y)], color.filled())),
                )?;
                let value = font(TEXT - 2).pos(Pos::new(HPos::Center, VPos::Bottom));
                chart.draw_series(beside().map(|(x, y)| Text::new(format!("{y:.1}"), (x, y), value.clone())))?;
            }
            Mark::Dots => {
                chart.draw_series(points().map(|at| Circle::new(at, 3 * SCALE, color.filled())))?;
            }
            // A diamond has its size on the paper and not in data, so that it stays one in every scale.
            Mark::Diamond => {
                let r = (7 * SCALE) as i32;
                let corners = [(0, -r), (r, 0), (0, r), (-r, 0)];
                chart.draw_series(points().map(|at| EmptyElement::at(at) + Polygon::new(corners, color.filled())))?;
            }
        }
    }
    Ok(())
}

/// Width left of the plot: of numbers, or of the longest name of a row.
fn left(panel: &Panel) -> u32 {
    let letters = panel.rows.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    LEFT.max(LETTER * letters as u32 + MARGIN)
}

fn stroke(mark: Mark) -> u32 {
    match mark {
        Mark::Thin => SCALE,
        Mark::Wide => 5 * SCALE,
        _ => 2 * SCALE,
    }
}

fn color(index: usize, line: &Line) -> RGBAColor {
    let color = PALETTE[line.color.unwrap_or(index) % PALETTE.len()];
    color.mix(match line.mark {
        Mark::Wide => 0.45,
        Mark::Area => 0.25,
        Mark::Cells => 0.6,
        Mark::PaleCells => 0.25,
        _ => 1.0,
    })
}

/// Samples of the lines with their names, above the plot.
fn legend<'a>(area: &Area<'a>, kind: Legend, named: &[(usize, &Line)]) -> Result<(), Failure<'a>> {
    // The samples stand in the order of the lines, in their colours and
    // marks, so that the legend is read without a key.
    let s = |length: u32| (length * SCALE) as i32;
    let mut at = (s(LEFT + MARGIN), s(8 + ROW + ROW / 2));
    let text = font(TEXT - 1).pos(Pos::new(HPos::Left, VPos::Center));
    for &(index, line) in named {
        let color = color(index, line);
        let (x, y) = at;
        let sample = [(x, y), (x + s(22), y)];
        match line.mark {
            Mark::Solid | Mark::Thin | Mark::Wide => {
                area.draw(&PathElement::new(
                    sample,
                    // Thin lines have a thicker sample, because a short thin one has no visible colour.
                    color.stroke_width(stroke(line.mark).max(2 * SCALE)),
                ))?;
            }
            Mark::Dashed => {
                let style = color.stroke_width(stroke(line.mark));
                area.draw(&PathElement::new([(x, y), (x + s(9), y)], style))?;
                area.draw(&PathElement::new([(x + s(14), y), (x + s(23), y)], style))?;
            }
            Mark::Area | Mark::Bars | Mark::Cells | Mark::PaleCells => {
                area.draw(&Rectangle::new([(x, y - s(6)), (x + s(22), y + s(6))], color.filled()))?
            }
            Mark::Dots => area.draw(&Circle::new((x + s(11), y), 3 * SCALE, color.filled()))?,
            Mark::Diamond => {
                let (c, r) = (x + s(11), s(6));
                area.draw(&Polygon::new(
                    [(c, y - r), (c + r, y), (c, y + r), (c - r, y)],
                    color.filled(),
                ))?;
            }
        }
        area.draw(&Text::new(line.name.clone(), (x + s(28), y), text.clone()))?;
        match kind {
            Legend::Row => {
                // plotters estimates the width of a text; the next sample begins after it.
                let (width, _) = area.estimate_text_size(&line.name, &text)?;
                at.0 += s(28 + 16) + width as i32;
            }
            Legend::Stacked => at.1 += s(ROW),
        }
    }
    Ok(())
}

/// Ranges of both axes: the data's with some room, or of equal scale for a plot whose width over height is `aspect`.
fn ranges(panel: &Panel, aspect: f64) -> ([f64; 2], [f64; 2]) {
    // Cells reach beyond their points.
    let corners = |line: &Line| {
        let [across, up] = line.half;
        let around = |(x, y): (f64, f64)| [(x - across, y - up), (x + across, y + up)];
        line.points.iter().copied().flat_map(around).collect::<Vec<_>>()
    };
    let points = || panel.lines.iter().flat_map(corners);
    let range = |values: &mut dyn Iterator<Item = f64>| {
        // NaN and infinity are gaps in a curve and must not set its range.
        values
            .filter(|value| value.is_finite())
            .fold([f64::MAX, f64::MIN], |[low, high], value| {
                [low.min(value), high.max(value)]
            })
    };
    let mut x = panel.x_range.unwrap_or_else(|| range(&mut points().map(|p| p.0)));
    // A bar stands around its number, half a unit to each side.
    if panel.x_range.is_none() && panel.lines.iter().any(|line| line.mark == Mark::Bars) {
        x = [x[0] - 0.5, x[1] + 0.5];
    }
    let mut y = range(&mut points().map(|p| p.1));
    for range in [&mut x, &mut y] {
        // Without any finite point the range is the empty fold; the axis then shows 0 to 1.
        if range[0] > range[1] {
            *range = [0.0, 1.0];
        }
        // A constant curve would have a range of width zero, which no scale can be made of.
        if range[1] - range[0] <= 1e-12 * range[1].abs().max(1e-9) {
            let half = 0.05 * range[1].abs().max(1e-9);
            *range = [range[0] - half, range[1] + half];
        }
    }
    let padded = |[low, high]: [f64; 2], part: f64| [low - part * (high - low), high + part * (high - low)];
    // Equal scale: the larger of both widths decides, and the other range grows around its middle.
    if panel.equal {
        let (x, y) = (padded(x, 0.05), padded(y, 0.05));
        let scale = ((x[1] - x[0]) / aspect).max(y[1] - y[0]);
        let around = |[low, high]: [f64; 2], width: f64| [0.5 * (low + high - width), 0.5 * (low + high + width)];
        return (around(x, scale * aspect), around(y, scale));
    }
    let mut y = padded(y, 0.06);
    if !panel.rows.is_empty() {
        y = [-0.5, panel.rows.len() as f64 - 0.5];
    }
    // After the padding, which would lower the zero line.
    if panel.from_zero {
        y[0] = 0.0;
    }
    if panel.x_range.is_none() {
        x = padded(x, 0.01);
    }
    (x, y)
}

/// A tick's number without noise of rounding or needless digits.
fn tick(value: &f64) -> String {
    let mut text = format!("{value:.6}");
    while text.contains('.') && (text.ends_with('0') || text.ends_with('.')) {
        let dot = text.ends_with('.');
        text.pop();
        if dot {
            break;
        }
    }
    if text == "-0" {
        "0".to_owned()
    } else {
        text.replace('-', "\u{2212}")
    }
}
