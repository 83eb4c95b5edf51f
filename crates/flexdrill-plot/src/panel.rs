//! A figure as data.

/// One curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Line {
    /// For the legend and the CSV; empty is not in the legend.
    pub name: String,
    /// Points.
    pub points: Vec<(f64, f64)>,
    /// Look.
    pub mark: Mark,
    /// Place in the palette; the line's number in the panel if not given.
    pub color: Option<usize>,
    /// Half the width and half the height of [`Mark::Cells`].
    pub half: [f64; 2],
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Mark {
    /// Line.
    #[default]
    Solid,
    /// Thin line, for dense histories.
    Thin,
    /// Broad line, to lie under others.
    Wide,
    /// Dashed line.
    Dashed,
    /// Filled circles.
    Dots,
    /// A large diamond: a single value.
    Diamond,
    /// What the points enclose, pale.
    Area,
    /// A rectangle around each point.
    Cells,
    /// The same, pale.
    PaleCells,
    /// A bar from zero per point, with its value. Bars of several lines at one x stand side by side in its unit of x.
    Bars,
}

/// Position of the legend.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Legend {
    /// One row above the plot.
    #[default]
    Row,
    /// A row per entry above the plot.
    Stacked,
}

/// One coordinate system.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// x axis, with unit.
    pub x: String,
    /// y axis, with unit.
    pub y: String,
    /// Curves.
    pub lines: Vec<Line>,
    /// Same scale on both axes.
    pub equal: bool,
    /// y grows downwards.
    pub down: bool,
    /// Range of x, if not that of the data.
    pub x_range: Option<[f64; 2]>,
    /// Names at x = 0, 1, ... instead of numbers.
    pub names: Vec<String>,
    /// Names at y = 0, 1, ... from the top down, instead of numbers.
    pub rows: Vec<String>,
    /// y begins at zero.
    pub from_zero: bool,
    /// Position of the legend.
    pub legend: Legend,
    /// Number of columns of the figure.
    pub span: usize,
}

impl Panel {
    /// An empty panel.
    pub fn new(title: impl Into<String>, x: &str, y: &str) -> Self {
        Self {
            title: title.into(),
            x: x.to_owned(),
            y: y.to_owned(),
            span: 1,
            ..Self::default()
        }
    }

    /// The panel with a further curve.
    #[must_use]
    pub fn line(mut self, line: Line) -> Self {
        self.lines.push(line);
        self
    }

    /// With equal scales.
    #[must_use]
    pub fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    /// With y downwards.
    #[must_use]
    pub fn down(mut self) -> Self {
        self.down = true;
        self
    }

    /// With a given range of x.
    #[must_use]
    pub fn over(mut self, low: f64, high: f64) -> Self {
        self.x_range = Some([low, high]);
        self
    }

    /// With names at x = 0, 1, ... instead of numbers, and half a unit on both sides.
    #[must_use]
    pub fn named(mut self, names: Vec<String>) -> Self {
        self.x_range = Some([-0.5, names.len() as f64 - 0.5]);
        self.names = names;
        self
    }

    /// With names at y = 0, 1, ... from the top down, instead of numbers.
    #[must_use]
    pub fn rows(mut self, rows: Vec<String>) -> Self {
        self.rows = rows;
        self.down()
    }

    /// With y from zero.
    #[must_use]
    pub fn from_zero(mut self) -> Self {
        self.from_zero = true;
        self
    }

    /// With a position of the legend.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Over several columns.
    #[must_use]
    pub fn span(mut self, columns: usize) -> Self {
        self.span = columns;
        self
    }
}

impl Line {
    /// A solid line.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            points,
            ..Self::default()
        }
    }

    fn marked(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }

    /// Thin.
    #[must_use]
    pub fn thin(self) -> Self {
        self.marked(Mark::Thin)
    }

    /// Broad.
    #[must_use]
    pub fn wide(self) -> Self {
        self.marked(Mark::Wide)
    }

    /// Dashed.
    #[must_use]
    pub fn dashed(self) -> Self {
        self.marked(Mark::Dashed)
    }

    /// Circles.
    #[must_use]
    pub fn dots(self) -> Self {
        self.marked(Mark::Dots)
    }

    /// A diamond.
    #[must_use]
    pub fn diamond(self) -> Self {
        self.marked(Mark::Diamond)
    }

    /// A pale area.
    #[must_use]
    pub fn area(self) -> Self {
        self.marked(Mark::Area)
    }

    /// A rectangle around each point, so far to its sides and up and down.
    #[must_use]
    pub fn cells(mut self, half: [f64; 2]) -> Self {
        self.half = half;
        self.marked(Mark::Cells)
    }

    /// The same, pale.
    #[must_use]
    pub fn pale_cells(mut self, half: [f64; 2]) -> Self {
        self.half = half;
        self.marked(Mark::PaleCells)
    }

    /// As bars.
    #[must_use]
    pub fn bars(self) -> Self {
        self.marked(Mark::Bars)
    }

    /// In a colour of the palette.
    #[must_use]
    pub fn color(mut self, color: usize) -> Self {
        self.color = Some(color);
        self
    }
}

/// One figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Of its files.
    pub name: &'static str,
    /// Above it in the report.
    pub title: String,
    /// Below it in the report.
    pub caption: String,
    /// Panels side by side.
    pub columns: usize,
    /// Of a row of panels, in the units of a width of 1080.
    pub height: u32,
    /// Row by row.
    pub panels: Vec<Panel>,
}

/// The figure's data, a line per point.
pub fn csv(figure: &Figure) -> String {
    let mut out = String::from("panel,series,x_quantity,x,y_quantity,y\n");
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    for panel in &figure.panels {
        for line in &panel.lines {
            let [title, name, x, y] = [&panel.title, &line.name, &panel.x, &panel.y].map(|text| quoted(text));
            for point in &line.points {
                out.push_str(&format!("{title},{name},{x},{:.7e},{y},{:.7e}\n", point.0, point.1));
            }
        }
    }
    out
}
