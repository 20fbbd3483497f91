//! Scatter plots with logarithmic axes as SVG, styled as in [`super::svg`].

use std::path::Path;

use super::atomic;
use super::error::{WriteError, check_field};
use super::svg::{
    BOTTOM, COLOURS, FONT, HEIGHT, SAMPLE, TITLE_FONT, TOP, WIDTH, fitted, power_of_ten, round, text,
    text_width,
};

/// Marker shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Filled circle.
    Circle,
    /// Open square.
    Square,
    /// Filled diamond.
    Diamond,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Name in the legend.
    pub name: String,
    /// Marker shape.
    pub mark: Mark,
    /// Whether a line joins the points in order.
    pub joined: bool,
    /// Label, x and y of each point, both positive, in axis units.
    pub points: Vec<(String, [f64; 2])>,
}

/// Scatter plot with logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterPlot {
    /// Title above the plot.
    pub title: String,
    /// Quantity and unit along x.
    pub x_label: String,
    /// Quantity and unit along y.
    pub y_label: String,
    /// Groups of points.
    pub groups: Vec<Group>,
    /// Name and y of a horizontal line.
    pub level: Option<(String, f64)>,
}

const RADIUS: f64 = 4.5;

impl ScatterPlot {
    /// Writes the plot.
    ///
    /// # Errors
    /// Coordinates not positive or not finite; I/O errors.
    pub fn write(&self, file: &Path) -> Result<(), WriteError> {
        let level = self.level.iter().map(|(name, y)| (name, [1.0, *y]));
        let points = self.groups.iter().flat_map(|g| g.points.iter().map(|(_, p)| (&g.name, *p)));
        for (name, [x, y]) in points.chain(level) {
            check_field(file, name, &[libm::log(x), libm::log(y)], 2, 1)?;
        }
        let text = self.render();
        atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))
    }

    fn render(&self) -> String {
        let points = || self.groups.iter().flat_map(|g| g.points.iter().map(|(_, p)| *p));
        let x = LogAxis::over(points().map(|p| p[0]));
        let y = LogAxis::over(points().map(|p| p[1]).chain(self.level.iter().map(|l| l.1)));
        let widest = y.ticks.iter().map(|t| text_width(&t.1, FONT)).fold(0.0, f64::max);
        let area = Area { left: widest + 44.0, right: WIDTH - self.legend_width(), x, y };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
             height=\"{HEIGHT}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"{FONT}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        self.frame(&mut svg, &area);
        if let Some((_, y)) = &self.level {
            let at = area.y(*y);
            svg += &format!("<path d=\"M{} {at}H{}\" {}/>\n", round(area.left), round(area.right), LEVEL);
        }
        for (index, group) in self.groups.iter().enumerate() {
            svg += &points_of(group, index, &area);
        }
        self.legend(&mut svg, &area);
        svg + "</svg>\n"
    }

    fn legend_width(&self) -> f64 {
        let names = self.groups.iter().map(|g| &g.name).chain(self.level.iter().map(|l| &l.0));
        names.map(|name| text_width(name, FONT)).fold(0.0, f64::max) + SAMPLE + 26.0
    }

    fn frame(&self, svg: &mut String, area: &Area) {
        let (left, right, bottom) = (round(area.left), round(area.right), HEIGHT - BOTTOM);
        for (value, label) in &area.x.ticks {
            let at = area.x(*value);
            *svg += &format!("<path d=\"M{at} {TOP}V{bottom}\" stroke=\"#ddd\"/>\n");
            *svg += &text(at, bottom + 18.0, "middle", label);
        }
        for (value, label) in &area.y.ticks {
            let at = area.y(*value);
            *svg += &format!("<path d=\"M{left} {at}H{right}\" stroke=\"#ddd\"/>\n");
            *svg += &text(left - 8.0, at + 0.35 * FONT, "end", label);
        }
        let (w, h) = (round(right - left), bottom - TOP);
        *svg += &format!(
            "<rect x=\"{left}\" y=\"{TOP}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#333\"/>\n"
        );
        *svg += &text(0.5 * (left + right), bottom + 42.0, "middle", &self.x_label);
        let (middle, font) = (0.5 * (TOP + bottom), fitted(&self.y_label, FONT, h));
        *svg += &format!("<g font-size=\"{font}\" transform=\"translate(18 {middle}) rotate(-90)\">");
        *svg += &text(0.0, 0.0, "middle", &self.y_label);
        *svg += "</g>\n";
        let font = fitted(&self.title, TITLE_FONT, WIDTH - 32.0);
        *svg += &format!("<g font-size=\"{font}\" font-weight=\"bold\">");
        *svg += &text(0.5 * WIDTH, 28.0, "middle", &self.title);
        *svg += "</g>\n";
    }

    fn legend(&self, svg: &mut String, area: &Area) {
        let from = area.right + 14.0;
        let height = |row: usize| TOP + 14.0 + 20.0 * row as f64;
        for (index, group) in self.groups.iter().enumerate() {
            let at = height(index);
            if group.joined {
                *svg += &format!("<path d=\"M{} {at}h{}\" {}/>\n", round(from), SAMPLE - 8.0, stroke(index));
            }
            *svg += &mark(group.mark, index, round(from + 0.5 * (SAMPLE - 8.0)), at);
            *svg += &text(from + SAMPLE, at + 0.35 * FONT, "start", &group.name);
        }
        if let Some((name, _)) = &self.level {
            let at = height(self.groups.len());
            *svg += &format!("<path d=\"M{} {at}h{}\" {LEVEL}/>\n", round(from), SAMPLE - 8.0);
            *svg += &text(from + SAMPLE, at + 0.35 * FONT, "start", name);
        }
    }
}

const LEVEL: &str = "fill=\"none\" stroke=\"#000000\" stroke-width=\"1.2\" stroke-dasharray=\"7 4\"";

fn stroke(index: usize) -> String {
    format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"", COLOURS[index % COLOURS.len()])
}

fn mark(mark: Mark, index: usize, x: f64, y: f64) -> String {
    let (colour, r) = (COLOURS[index % COLOURS.len()], RADIUS);
    match mark {
        Mark::Circle => format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{colour}\"/>\n"),
        Mark::Square => format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n",
            round(x - r),
            round(y - r),
            2.0 * r,
            2.0 * r,
            stroke(index)
        ),
        Mark::Diamond => {
            let r = 1.4 * r;
            format!("<path d=\"M{x} {y}m-{r} 0l{r} -{r}l{r} {r}l-{r} {r}z\" fill=\"{colour}\"/>\n")
        }
    }
}

fn points_of(group: &Group, index: usize, area: &Area) -> String {
    let pixels: Vec<[f64; 2]> = group.points.iter().map(|(_, p)| [area.x(p[0]), area.y(p[1])]).collect();
    let mut svg = String::new();
    if group.joined && pixels.len() > 1 {
        let list = pixels.iter().map(|[x, y]| format!("{x},{y}")).collect::<Vec<_>>().join(" ");
        svg += &format!("<polyline points=\"{list}\" {}/>\n", stroke(index));
    }
    for ([x, y], (label, _)) in pixels.iter().zip(&group.points) {
        svg += &mark(group.mark, index, *x, *y);
        svg += &text(x + 7.0, y - 6.0, "start", label);
    }
    svg
}

struct Area {
    left: f64,
    right: f64,
    x: LogAxis,
    y: LogAxis,
}

impl Area {
    fn x(&self, value: f64) -> f64 {
        round(self.left + self.x.fraction(value) * (self.right - self.left))
    }

    fn y(&self, value: f64) -> f64 {
        let bottom = HEIGHT - BOTTOM;
        round(bottom - self.y.fraction(value) * (bottom - TOP))
    }
}

/// Decadic logarithms from tick to tick.
struct LogAxis {
    low: f64,
    high: f64,
    ticks: Vec<(f64, String)>,
}

impl LogAxis {
    /// Ticks at 1, 2 and 5 of each decade if few, else at decades.
    fn over(values: impl Iterator<Item = f64>) -> LogAxis {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 1.0) };
        let every = 1 + libm::log10(high / low) as i32 / 8;
        let decades = (libm::log10(low).floor() as i32 - every)..=(libm::log10(high).ceil() as i32 + every);
        let few = libm::log10(high / low) <= 2.5;
        let digits: &[u32] = if few { &[1, 2, 5] } else { &[1] };
        let all: Vec<(i32, u32)> =
            decades.filter(|d| d % every == 0).flat_map(|d| digits.iter().map(move |k| (d, *k))).collect();
        let value = |(decade, digit): &(i32, u32)| f64::from(*digit) * 10.0_f64.powi(*decade);
        // A value on a tick would be cut by the frame.
        let first = all.iter().rposition(|t| value(t) < low).unwrap_or(0);
        let last = all.iter().position(|t| value(t) > high).unwrap_or(all.len() - 1);
        let ticks: Vec<(f64, String)> =
            all[first..=last].iter().map(|t| (value(t), power_of_ten(t.0, t.1))).collect();
        LogAxis { low: ticks[0].0, high: ticks[ticks.len() - 1].0, ticks }
    }

    fn fraction(&self, value: f64) -> f64 {
        libm::log(value / self.low) / libm::log(self.high / self.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample::folder;

    fn labels(values: &[f64]) -> Vec<String> {
        LogAxis::over(values.iter().copied()).ticks.into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn ticks_enclose_the_values() {
        assert_eq!(labels(&[0.3, 4.0]), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(labels(&[1.0]), ["0.5", "1", "2"]);
        assert_eq!(labels(&[2e-5, 0.3]), ["1e\u{2212}5", "1e\u{2212}4", "0.001", "0.01", "0.1", "1"]);
        assert_eq!(labels(&[]), ["0.5", "1", "2"]);
        for (low, high) in [(1e-12, 1e9), (3.0, 3.1), (1e-30, 1e30), (99.0, 101.0)] {
            let axis = LogAxis::over([low, high].into_iter());
            let (first, last) = (axis.fraction(low), axis.fraction(high));
            assert!(0.0 < first && first < last && last < 1.0, "{low} {high}: {first} {last}");
            assert!((2..=16).contains(&axis.ticks.len()), "{low} {high}: {} ticks", axis.ticks.len());
        }
    }

    #[test]
    fn plots_points_and_rejects_nonpositive() {
        let group = |points: &[[f64; 2]]| Group {
            name: "front".into(),
            mark: Mark::Circle,
            joined: true,
            points: points.iter().enumerate().map(|(k, p)| (format!("{}", k + 1), *p)).collect(),
        };
        let plot = |points: &[[f64; 2]]| ScatterPlot {
            title: "Error & cost".into(),
            x_label: "CPU time of a run [s]".into(),
            y_label: "largest relative error [1]".into(),
            groups: vec![group(points)],
            level: Some(("tolerance".into(), 0.05)),
        };
        let dir = folder("scatter");
        let file = dir.join("p.svg");
        plot(&[[1.0, 0.1], [10.0, 0.01], [100.0, 0.001]]).write(&file).unwrap();
        let svg = std::fs::read_to_string(&file).unwrap();
        assert_eq!(svg.matches("<circle").count(), 4, "three points and the legend's");
        assert!(svg.contains("Error &amp; cost") && svg.contains("largest relative error [1]"));
        let line = svg.split("<polyline points=\"").nth(1).unwrap().split('"').next().unwrap();
        let x: Vec<f64> = line.split(' ').map(|p| p.split(',').next().unwrap().parse().unwrap()).collect();
        assert!(((x[1] - x[0]) - (x[2] - x[1])).abs() < 0.02, "{x:?}");
        for bad in [[1.0, 0.0], [-1.0, 1.0], [f64::INFINITY, 1.0]] {
            let error = plot(&[bad]).write(&file).unwrap_err();
            assert!(error.to_string().contains("front at index 0"), "{error}");
        }
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
