//! Tables and plots of a life.

use super::outcome::{Agreement, LawAlone, Period, Resistance, Tamped, range};
use super::plan::Plan;
use crate::study::{Cell, Table};
use serde_json::{Value, json};
use trackbed_io::plot::{Axis, Curve, Plot, Style};

/// Points of a decade in tables and plots.
const DECADE: [f64; 3] = [1.0, 2.0, 5.0];

/// Results of a life.
#[derive(Debug)]
pub struct Life<'a> {
    plan: &'a Plan,
    /// Periods of all packings.
    pub periods: Vec<Period>,
    /// Tampings of all packings.
    pub tampings: Vec<Tamped>,
    /// Lateral resistances.
    pub resistances: Vec<Resistance>,
    /// Judgement of jumps per period.
    pub agreements: Vec<Agreement>,
    /// Laws without simulated cycles beyond the first jump.
    pub laws: Vec<LawAlone>,
}

/// Settlement of all packings at one traffic.
struct Point {
    traffic: f64,
    period: usize,
    cycle: f64,
    /// Settlement since the last tamping: mean, smallest and largest with the error of jumps [m].
    settlement: [f64; 3],
    /// Level below the built track [m], likewise.
    level: [f64; 3],
}

impl<'a> Life<'a> {
    /// Life without results.
    pub fn new(plan: &'a Plan) -> Life<'a> {
        Life {
            plan,
            periods: Vec::new(),
            tampings: Vec::new(),
            resistances: Vec::new(),
            agreements: Vec::new(),
            laws: Vec::new(),
        }
    }

    /// First periods of all packings.
    pub fn first_periods(&self) -> Vec<Period> {
        self.periods.iter().filter(|p| p.period == 1).cloned().collect()
    }

    fn of(&self, period: usize) -> Vec<&Period> {
        self.periods.iter().filter(|p| p.period == period + 1).collect()
    }

    /// Level of each packing at the start of a period, and the error of its earlier jumps [m].
    fn starts(&self, period: usize) -> Vec<[f64; 2]> {
        let start = |packing: usize| {
            let settled = || self.periods.iter().filter(move |p| p.packing == packing && p.period <= period);
            let raised = self.tampings.iter().filter(|t| t.packing == packing && t.tamping <= period);
            let next = self.periods.iter().find(|p| p.packing == packing && p.period == period + 1);
            let level = next.map_or(0.0, |p| p.before_cycles)
                + settled().map(|p| p.before_cycles + p.settlement).sum::<f64>()
                - raised.map(|t| t.raised).sum::<f64>();
            [level, settled().map(|p| p.jump_error).sum()]
        };
        (1..=self.plan.packings.len()).map(start).collect()
    }

    fn points(&self) -> Vec<Point> {
        let mut points = Vec::new();
        for (period, cycles) in self.plan.cycles.iter().enumerate() {
            let begun = if period == 0 { 0.0 } else { self.plan.ends[period - 1] };
            let (all, starts) = (self.of(period), self.starts(period));
            for cycle in decades(f64::from(*cycles)) {
                let values: Vec<[f64; 2]> = all.iter().map(|p| at(p, cycle)).collect();
                let settlement = band(values.iter().copied());
                let level =
                    band(values.iter().zip(&starts).map(|([s, e], [level, error])| [level + s, error + e]));
                let traffic = begun + cycle / self.plan.cycles_per_mgt;
                points.push(Point { traffic, period, cycle, settlement, level });
            }
        }
        points
    }

    /// `life.json`.
    pub fn json(&self) -> Value {
        let points = self.points();
        let curve: Vec<Value> = points
            .iter()
            .map(|p| {
                json!({ "traffic_mgt": p.traffic, "period": p.period + 1, "cycle": p.cycle,
                    "settlement": p.settlement, "level": p.level })
            })
            .collect();
        json!({
            "title": self.plan.title,
            "packings": self.plan.packings,
            "axles_per_mgt": self.plan.axles_per_mgt,
            "cycles_per_mgt": self.plan.cycles_per_mgt,
            "periods": self.periods,
            "tampings": self.tampings,
            "lateral_resistance": self.resistances,
            "jumps": self.agreements,
            "laws_alone": self.laws,
            "curve": curve,
        })
    }

    /// `life.csv`: mean and band over traffic.
    pub fn csv(&self) -> String {
        let mut text = "traffic [MGT],period,cycle,settlement [m],lowest [m],highest [m],level [m],lowest level [m],highest level [m]\n"
            .to_string();
        for p in self.points() {
            let numbers: Vec<String> = p.settlement.iter().chain(&p.level).map(|v| format!("{v}")).collect();
            text += &format!("{},{},{},{}\n", p.traffic, p.period + 1, p.cycle, numbers.join(","));
        }
        text
    }

    fn curve(&self) -> Table {
        let heads = ["traffic [MGT]", "cycle", "settlement [mm]", "band [mm]", "level [mm]"];
        let row = |p: &Point| {
            let mm = |v: f64| format!("{:.2}", 1e3 * v);
            vec![
                Cell::number(Some(p.traffic)),
                Cell::text(format!("{:.0}", p.cycle)),
                Cell::text(mm(p.settlement[0])),
                Cell::text(format!("{} to {}", mm(p.settlement[1]), mm(p.settlement[2]))),
                Cell::text(mm(p.level[0])),
            ]
        };
        Table { heads: heads.map(String::from).to_vec(), rows: self.points().iter().map(row).collect() }
    }

    fn events(&self) -> Table {
        let heads = [
            "after",
            "packing",
            "cycles",
            "simulated",
            "lowering [mm]",
            "jump error [mm]",
            "bed stiffness [kN/mm]",
            "lateral resistance at 2 mm [kN]",
            "CPU time [s]",
        ];
        let force = |packing: usize, after: &str| {
            let own = self.resistances.iter().find(|r| r.packing == packing && r.after.starts_with(after));
            Cell::number(own.and_then(|r| Some(1e-3 * r.force?)))
        };
        let mut rows = Vec::new();
        for packing in 1..=self.plan.packings.len() {
            let name = packing.to_string();
            if !self.resistances.is_empty() {
                let mut row = vec![Cell::text("built"), Cell::text(&name)];
                row.extend(std::iter::repeat_n(Cell::Nothing, 5));
                row.extend([force(packing, "built"), Cell::Nothing]);
                rows.push(row);
            }
            for p in self.periods.iter().filter(|p| p.packing == packing) {
                let after = format!("traffic {}", p.period);
                rows.push(vec![
                    Cell::text(&after),
                    Cell::text(&name),
                    Cell::text(p.cycles.to_string()),
                    Cell::text(p.simulated.to_string()),
                    Cell::number(Some(1e3 * p.settlement)),
                    Cell::number(Some(1e3 * p.jump_error)),
                    Cell::number(Some(1e-6 * p.bed_stiffness).filter(|k| *k > 0.0)),
                    force(packing, &format!("traffic-{}", p.period)),
                    Cell::number(Some(p.cpu_seconds)),
                ]);
                let tamped = self.tampings.iter().find(|t| t.packing == packing && t.tamping == p.period);
                if let Some(t) = tamped {
                    let mut row = vec![Cell::text(format!("tamping {}", t.tamping)), Cell::text(&name)];
                    row.extend([Cell::Nothing, Cell::Nothing, Cell::number(Some(-1e3 * t.raised))]);
                    row.extend([Cell::Nothing, Cell::Nothing]);
                    row.push(force(packing, &format!("tamped-{}", t.tamping)));
                    row.push(Cell::number(Some(t.cpu_seconds)));
                    rows.push(row);
                }
            }
        }
        Table { heads: heads.map(String::from).to_vec(), rows }
    }

    fn laws(&self) -> Table {
        let heads = ["law, fitted before the first jump", "settlement [mm]", "over the simulated one"];
        let row = |law: &LawAlone| {
            vec![
                Cell::text(&law.law),
                Cell::number(Some(1e3 * law.settlement)),
                Cell::number(Some(law.ratio)),
            ]
        };
        Table { heads: heads.map(String::from).to_vec(), rows: self.laws.iter().map(row).collect() }
    }

    /// Check of the jumps.
    fn forecasts(&self) -> Option<Table> {
        let heads = [
            "period",
            "packing",
            "from cycle",
            "cycle",
            "forecast [mm]",
            "estimated error [mm]",
            "found [mm]",
        ];
        let mut rows = Vec::new();
        for p in &self.periods {
            rows.extend(p.forecasts.iter().map(|f| {
                let mut row = [p.period.to_string(), p.packing.to_string()].map(Cell::text).to_vec();
                row.extend([f.from, f.cycle].map(|n| Cell::text(format!("{n:.0}"))));
                let lengths = [f.predicted, f.error_estimate, f.settlement];
                row.extend(lengths.map(|s| Cell::text(format!("{:.2}", 1e3 * s))));
                row
            }));
        }
        (!rows.is_empty()).then(|| Table { heads: heads.map(String::from).to_vec(), rows })
    }

    fn remarks(&self) -> Vec<String> {
        let plan = self.plan;
        let mut lines = vec![format!(
            "{:.0} axles and {:.0} load cycles of equal settlement per MGT",
            plan.axles_per_mgt, plan.cycles_per_mgt
        )];
        if let (Some(per_year), Some(end)) = (plan.per_year, plan.ends.last()) {
            lines.push(format!("{end} MGT in {:.2} years", end / per_year));
        }
        for t in &self.tampings {
            if let Some([entering, closing]) = t.forces {
                lines.push(format!(
                    "packing {}, tamping {}: raised {:.1} mm, {:.1} kN entering, {:.1} kN closing, porosity {:.4} to {:.4}",
                    t.packing, t.tamping, 1e3 * t.raised, 1e-3 * entering, 1e-3 * closing, t.porosity[0], t.porosity[1]
                ));
            }
        }
        for a in &self.agreements {
            let judged = if a.agreed { "agree" } else { "DISAGREE" };
            let again = match a.repetitions {
                0 => "",
                1 => ", repeated with shorter jumps",
                _ => ", repeated several times with shorter jumps",
            };
            lines.push(format!(
                "jumps of period {}: packings {judged}, difference {:.0} % of the settlement during jumps (at most {:.0} %){again}",
                a.period,
                100.0 * a.difference,
                100.0 * plan.tolerance
            ));
        }
        let delays: usize = self.periods.iter().map(|p| p.delays).sum();
        if delays > 0 {
            lines.push(format!("delayed jumps: {delays}"));
        }
        lines
    }

    /// Table for the terminal.
    pub fn printed(&self) -> String {
        let lines: String = self.remarks().iter().map(|line| format!("  {line}\n")).collect();
        let laws = match self.laws.is_empty() {
            true => String::new(),
            false => format!("\n{}", self.laws().aligned(1)),
        };
        format!("{}\n{}\n{}{laws}", self.plan.title, self.events().aligned(1), lines)
    }

    /// `life.md`.
    pub fn markdown(&self) -> String {
        let lines: String = self.remarks().iter().map(|line| format!("* {line}\n")).collect();
        let mut text = format!("# {}\n\n![settlement](life.svg)\n\n", self.plan.title);
        text += &format!("{}\n{lines}\n## Settlement\n\n", self.events().markdown());
        text += "Mean of the packings; band: all packings with the estimated error of their jumps. Level: below the built track.\n\n";
        text += &self.curve().markdown();
        if let Some(forecasts) = self.forecasts() {
            text += "\n## Forecasts of simulated cycles\n\nExtrapolated as by a jump, from earlier cycles of the same bed.\n\n";
            text += &forecasts.markdown();
        }
        if !self.resistances.is_empty() {
            text += "\n![lateral resistance](resistance.svg)\n";
        }
        if !self.laws.is_empty() {
            text += "\n## Laws alone\n\nWithout the simulated cycles after the first jump, end of the first period.\n\n";
            text += &self.laws().markdown();
        }
        text
    }

    /// Level over traffic.
    pub fn settlement_plot(&self) -> Plot {
        let points = self.points();
        let curve = |k: usize, name: &str, colour: usize| {
            let line = points.iter().map(|p| [p.traffic, p.level[k]]).collect();
            Curve::new(name, line, Style { colour, dash: k, line: true, marks: k == 0 })
        };
        Plot {
            title: self.plan.title.clone(),
            x: Axis::new("traffic", "MGT").with_zero(),
            y: Axis::new("level below the built track", "m").downwards().with_zero(),
            curves: vec![curve(0, "mean", 0), curve(1, "least", 1), curve(2, "most", 1)],
            level: None,
        }
    }

    /// Lateral resistance over traffic.
    pub fn resistance_plot(&self) -> Option<Plot> {
        let curve = |packing: usize| {
            let own = self.resistances.iter().filter(|r| r.packing == packing);
            let points = own.filter_map(|r| Some([r.traffic, r.force?])).collect();
            let style = Style { colour: packing - 1, dash: packing - 1, line: true, marks: true };
            Curve::new(format!("packing {packing}"), points, style)
        };
        (!self.resistances.is_empty()).then(|| Plot {
            title: "Lateral resistance at 2 mm".into(),
            x: Axis::new("traffic", "MGT").with_zero(),
            y: Axis::new("force", "N").with_zero(),
            curves: (1..=self.plan.packings.len()).map(curve).collect(),
            level: None,
        })
    }
}

/// Mean, smallest and largest of values with errors.
fn band(values: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 3] {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().map(|v| v[0]).sum::<f64>() / count;
    let [low, high] = range(values.flat_map(|[v, e]| [v - e, v + e]));
    [mean, low, high]
}

/// Settlement after a cycle, linear in ln N between rows, and the error of jumps so far.
fn at(period: &Period, cycle: f64) -> [f64; 2] {
    let rows = &period.rows;
    let k = rows.partition_point(|row| row[0] < cycle);
    let settlement = match (k.checked_sub(1).map(|k| rows[k]), rows.get(k)) {
        (Some(a), Some(b)) => {
            let share = libm::log(cycle / a[0]) / libm::log(b[0] / a[0]);
            a[1] + share * (b[1] - a[1])
        }
        (_, Some(b)) => b[1],
        (Some(a), None) => a[1],
        (None, None) => 0.0,
    };
    let share = match (period.first, rows.last()) {
        (Some(first), Some(last)) if cycle > first && last[0] > first => {
            libm::log(cycle / first) / libm::log(last[0] / first)
        }
        _ => 0.0,
    };
    [settlement, share * period.jump_error]
}

/// 1, 2, 5 of each decade up to `last`, and `last`.
fn decades(last: f64) -> Vec<f64> {
    let mut out = Vec::new();
    let mut power = 1.0;
    while power <= last {
        out.extend(DECADE.iter().map(|d| d * power).filter(|n| *n < last));
        power *= 10.0;
    }
    out.push(last);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_end_with_the_last_cycle() {
        assert_eq!(decades(30.0), [1.0, 2.0, 5.0, 10.0, 20.0, 30.0]);
        assert_eq!(decades(1.0), [1.0]);
        assert_eq!(decades(10.0), [1.0, 2.0, 5.0, 10.0]);
    }

    #[test]
    fn settlement_between_rows_follows_the_logarithm() {
        let rows = vec![[1.0, 1e-3], [10.0, 2e-3], [1000.0, 4e-3]];
        let period = Period {
            packing: 1,
            period: 1,
            cycles: 1000,
            simulated: 3,
            settlement: 4e-3,
            before_cycles: 0.0,
            before_jumps: Some(2e-3),
            first: Some(10.0),
            jump_error: 1e-4,
            forecasts: Vec::new(),
            delays: 0,
            bed_stiffness: 0.0,
            cpu_seconds: 0.0,
            peak_memory: 0.0,
            rows,
        };
        let close = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(close(at(&period, 1.0), [1e-3, 0.0]));
        assert!(close(at(&period, 100.0), [3e-3, 5e-5]), "{:?}", at(&period, 100.0));
        assert!(close(at(&period, 1000.0), [4e-3, 1e-4]));
        let both = band([[1.0, 0.1], [2.0, 0.3]].into_iter());
        assert_eq!(both, [1.5, 0.9, 2.3]);
    }
}
