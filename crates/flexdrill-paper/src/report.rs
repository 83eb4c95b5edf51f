//! The report: findings, settings and quality figures, as Markdown and as one self-contained page.

use std::fmt::Write;

use super::error::ENERGY_LIMIT;
use super::figures::Figure;
use super::findings::{Finding, Verdict, score};
use super::hinge::Hinge;
use super::{Record, Setup};

/// Contents of the report.
pub struct Report<'a> {
    /// The case.
    pub case: &'a Setup,
    /// Its record.
    pub record: &'a Record,
    /// Its findings.
    pub findings: &'a [Finding],
    /// Findings of the same run at half the step, if it was made.
    pub half_step: Option<&'a [Finding]>,
    /// Fig. 9's case.
    pub hinge: &'a Hinge,
    /// Figures with their drawings.
    pub figures: &'a [(Figure, String)],
}

/// A table: titles and rows.
struct Table {
    titles: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

impl Report<'_> {
    /// The report as Markdown, with links to the figures in the same folder.
    pub fn markdown(&self) -> String {
        let mut out = format!("# {}\n\n{}\n", self.heading(), self.summary());
        for (title, text, table) in self.sections() {
            let _ = write!(out, "\n## {title}\n{text}\n\n{}", table.markdown());
        }
        out.push_str("\n## Figures\n");
        for (figure, _) in self.figures {
            let _ = write!(
                out,
                "\n### {}\n![{}]({}.svg)\n\n{} Data: [{}.csv]({}.csv).\n",
                figure.title, figure.title, figure.name, figure.caption, figure.name, figure.name
            );
        }
        out
    }

    /// As one page with the drawings in it.
    pub fn html(&self) -> String {
        let mut out = String::from(HEAD);
        let heading = escaped(&self.heading());
        let _ = write!(
            out,
            "<title>{heading}</title></head><body><h1>{heading}</h1><p>{}</p>",
            escaped(&self.summary())
        );
        for (title, text, table) in self.sections() {
            let _ = write!(
                out,
                "<h2>{}</h2><p>{}</p>{}",
                escaped(title),
                escaped(&text),
                table.html()
            );
        }
        out.push_str("<h2>Figures</h2>");
        for (figure, svg) in self.figures {
            let drawing = svg.find("<svg").map_or("", |start| &svg[start..]);
            let _ = write!(
                out,
                "<figure id=\"{}\"><h3>{}</h3>{drawing}<figcaption>{}</figcaption></figure>",
                figure.name,
                escaped(&figure.title),
                escaped(&figure.caption)
            );
        }
        out.push_str("</body></html>\n");
        out
    }

    fn heading(&self) -> String {
        let title = &self.case.config.run.title;
        if title.is_empty() {
            "The paper's findings".to_owned()
        } else {
            format!("The paper's findings: {title}")
        }
    }

    fn summary(&self) -> String {
        let count = |verdict| {
            self.findings
                .iter()
                .filter(|finding| finding.verdict == verdict)
                .count()
        };
        format!(
            "Of {} findings of Lin, Luo, Wang, Xiu, Li (Scientific Reports, 2024) {} agree, {} agree partly, {} do not. Mean closeness {:.3}.",
            self.findings.len(),
            count(Verdict::Agrees),
            count(Verdict::Partly),
            count(Verdict::No),
            score(self.findings).0
        )
    }

    fn sections(&self) -> Vec<(&'static str, String, Table)> {
        vec![
            (
                "Findings",
                "A number agrees within 20 %, partly within a factor of two; a place within 5 and 15 degrees. Effective values are root \
                 mean squares over the record."
                    .to_owned(),
                self.findings_table(),
            ),
            (
                "Can the numbers be trusted",
                format!(
                    "Runs whose energy audit is off by more than {:.0} % of the drive's work are refused.",
                    100.0 * ENERGY_LIMIT
                ),
                self.trust_table(),
            ),
            ("Settings", String::new(), self.settings_table()),
            ("Definitions", String::new(), self.definitions_table()),
        ]
    }

    fn findings_table(&self) -> Table {
        let mut titles = vec!["Figure", "The paper's finding", "Ours", "Agrees?", "Why"];
        if self.half_step.is_some() {
            titles.push("Ours at half the step");
        }
        let row = |(i, finding): (usize, &Finding)| {
            let mut row = vec![
                finding.figure.to_owned(),
                finding.paper.to_owned(),
                finding.ours.clone(),
                finding.verdict.word().to_owned(),
                finding.why.clone(),
            ];
            if let Some(half) = self.half_step {
                row.push(
                    half.get(i)
                        .map_or(String::new(), |f| format!("{} ({})", f.ours, f.verdict.word())),
                );
            }
            row
        };
        let (corrected, printed) = self.hinge.worst();
        let mut hinge = vec![
            "9".to_owned(),
            "the hinge's displacement is within 0.9 % of the analytic solution".to_owned(),
            format!("{:.2} % from the corrected closed form", 100.0 * corrected),
            Verdict::Agrees.word().to_owned(),
            format!(
                "{:.0} % from Eq. 45 as printed, whose first branch has the locked joint's stiffness",
                100.0 * printed
            ),
        ];
        if corrected > 0.009 {
            hinge[3] = Verdict::No.word().to_owned();
        }
        hinge.resize(titles.len(), String::new());
        let mut rows = vec![hinge];
        rows.extend(self.findings.iter().enumerate().map(row));
        Table { titles, rows }
    }

    fn trust_table(&self) -> Table {
        let energy = &self.record.energy;
        let solver = &self.record.solver;
        let steps = self.record.steps;
        // The table answers whether the numbers can be trusted, in the
        // order in which a reviewer asks: balance, solver, step.
        let mut rows = vec![
            (
                "energy error over the drive's work",
                format!("{:.2e}", self.record.energy_error()),
            ),
            (
                "work of drive and weight on bit; bit, friction, damping (contact, Rayleigh, scheme)",
                format!(
                    "{:.1}, {:.1} J; {:.1}, {:.1}, {:.1}, {:.1}, {:.1} J",
                    energy.drive,
                    energy.weight_on_bit,
                    energy.bit,
                    energy.friction,
                    energy.contact_damping,
                    energy.rayleigh_damping,
                    energy.numerical_damping
                ),
            ),
            (
                "steps; halved, failed; Newton iterations per step",
                format!(
                    "{steps}; {}, {}; {:.2}",
                    solver.halved_steps,
                    solver.failed_steps,
                    solver.newton_iterations as f64 / steps.max(1) as f64
                ),
            ),
            (
                "steps accepted without convergence",
                "0: a step that does not converge is halved, or ends the run".to_owned(),
            ),
        ];
        // The half step shows the error of the time step by the figures themselves. Verdicts are compared because
        // chaotic motions differ in every number.
        match self.half_step {
            Some(half) => {
                let same = self
                    .findings
                    .iter()
                    .zip(half)
                    .filter(|(a, b)| a.verdict == b.verdict)
                    .count();
                let worst = self
                    .findings
                    .iter()
                    .zip(half)
                    // Only these are positive figures of the motion, whose ratio means something.
                    .filter(|(a, _)| ["ripple", "inner_force", "outer_force"].contains(&a.key))
                    .map(|(a, b)| (a.value / b.value - 1.0).abs())
                    .fold(0.0, f64::max);
                rows.push((
                    "error of the step: against the same run at half of it",
                    format!(
                        "{same} of {} verdicts are the same; ripple at the bit and largest effective forces differ by up to {:.1} % \
                         (motion under bit torque is chaotic: perturbed runs differ too)",
                        half.len(),
                        100.0 * worst
                    ),
                ));
            }
            None => rows.push(("error of the step", "not checked in this run".to_owned())),
        }
        Table::of_pairs(["Check", "Result"], rows)
    }

    fn settings_table(&self) -> Table {
        // The settings that the paper does not give, or gives otherwise, so that a reader can repeat the run.
        let config = &self.case.config;
        let tool = &config.tool;
        let joint = &tool.joint;
        let mm = |value: f64| format!("{:.1}", 1e3 * value);
        // Sections of the elements, because thick ends make the first one differ from the middle.
        let pipe = tool.pipe.element_sections(tool.elements_per_link);
        let [begin, end] = self.case.times();
        let layer = |layer: &flexdrill_config::Layer| {
            format!(
                "{:.3e} N/m, {} s/m, friction {:.3} around, {:.3} along",
                layer.stiffness, layer.damping, layer.friction_tangential, layer.friction_axial
            )
        };
        // Every number with its unit, as this table is read next to the paper and without the program.
        let rows = vec![
            ("version of flexdrill", env!("CARGO_PKG_VERSION").to_owned()),
            ("configuration hash (SHA-256)", config.hash()),
            (
                "rotary speed, weight on bit",
                format!(
                    "{} r/min, {} kN",
                    self.case.rotary_speed_rpm, self.case.weight_on_bit_kn
                ),
            ),
            (
                "recorded",
                format!("{begin:.2} to {end:.2} s, every {:.1} ms", 1e3 * self.record.interval),
            ),
            (
                "links x elements, stations",
                format!(
                    "{} x {}, {}",
                    tool.links,
                    tool.elements_per_link,
                    self.record.stations.len()
                ),
            ),
            (
                "pipe, first element",
                pipe.first().map_or(String::new(), |p| {
                    format!("{} / {} mm", mm(p.outer_diameter), mm(p.inner_diameter))
                }),
            ),
            (
                "guide, bending factor; hole",
                format!(
                    "{} / {} mm, {:.3}; {} mm",
                    mm(tool.guide.outer_diameter),
                    mm(tool.guide.inner_diameter),
                    tool.guide.bending_factor,
                    mm(config.well.hole_diameter)
                ),
            ),
            (
                "joints",
                format!(
                    "{}, angle across the hinge {}, limit {:.2} deg, stop {:.2e} N m/rad, phase {:.1} deg, {:.1} deg from one to the next",
                    word(&joint.kind),
                    word(&joint.hinge_angle),
                    joint.limit_deg,
                    joint.stop_stiffness,
                    joint.cross_phase_deg,
                    joint.cross_phase_step_deg
                ),
            ),
            ("path of the weight on bit", word(&config.boundary.wob_path)),
            ("contact pipe-guide", layer(&config.contact.inner)),
            ("contact guide-wall", layer(&config.contact.outer)),
            (
                "Rayleigh alpha, beta",
                format!("{} 1/s, {:.2e} s", tool.damping.alpha, tool.damping.beta),
            ),
            (
                "step, scheme",
                format!(
                    "{} ms, {}",
                    1e3 * config.solver.time_step,
                    config.solver.scheme_in_words()
                ),
            ),
        ];
        Table::of_pairs(["Setting", "Value"], rows)
    }

    fn definitions_table(&self) -> Table {
        Table {
            titles: vec!["Finding", "What is measured"],
            rows: self
                .findings
                .iter()
                .map(|finding| vec![finding.key.to_owned(), finding.definition.to_owned()])
                .collect(),
        }
    }
}

/// A choice as the configuration writes it.
fn word(choice: &impl serde::Serialize) -> String {
    match serde_json::to_value(choice) {
        Ok(serde_json::Value::String(word)) => word,
        _ => String::new(),
    }
}

impl Table {
    fn of_pairs(titles: [&'static str; 2], rows: Vec<(&str, String)>) -> Self {
        Self {
            titles: titles.to_vec(),
            rows: rows
                .into_iter()
                .map(|(name, value)| vec![name.to_owned(), value])
                .collect(),
        }
    }

    fn markdown(&self) -> String {
        let line = |cells: &mut dyn Iterator<Item = String>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
        let mut out = line(&mut self.titles.iter().map(|title| (*title).to_owned()));
        out.push_str(&format!("|{}\n", "---|".repeat(self.titles.len())));
        for row in &self.rows {
            out.push_str(&line(&mut row.iter().map(|cell| cell.replace('|', "\\|"))));
        }
        out
    }

    fn html(&self) -> String {
        let mut out = String::from("<table><tr>");
        for title in &self.titles {
            let _ = write!(out, "<th>{}</th>", escaped(title));
        }
        out.push_str("</tr>");
        for row in &self.rows {
            out.push_str("<tr>");
            for cell in row {
                let class = match cell.as_str() {
                    "agrees" => " class=\"agrees\"",
                    "partly" => " class=\"partly\"",
                    "no" => " class=\"no\"",
                    _ => "",
                };
                let _ = write!(out, "<td{class}>{}</td>", escaped(cell));
            }
            out.push_str("</tr>");
        }
        out.push_str("</table>");
        out
    }
}

const HEAD: &str = "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><style>\
body{font:16px/1.5 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:1em 0}th,td{border:1px solid #ccc;padding:.3em .6em;text-align:left;vertical-align:top}\
th{background:#f2f2f2}.agrees{background:#cfe8f5}.partly{background:#fbeecb}.no{background:#f7d9c8}\
figure{margin:2em 0}svg{max-width:100%;height:auto}figcaption{color:#555}</style>";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
