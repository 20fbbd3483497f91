use super::draw::{BOTTOM, TITLE, TITLE_FONT, TOP, fitted};
use super::*;
use crate::write::sample::folder;
use quick_xml::escape::unescape;

fn settlement() -> Plot {
    let curve = |name: &'static str, scale: f64| {
        (name, (0..=200).map(|i| [f64::from(i), -scale * (1.0 + f64::from(i)).ln()]).collect())
    };
    Plot::lines(
        "Settlement of the sleeper & <bed>".into(),
        Axis::new("cycle", "1"),
        Axis::new("settlement", "mm"),
        [curve("clean \"new\"", 1.1), curve("fouled with sand", 1.9), curve("c", 0.4)],
    )
}

fn scatter(points: &[[f64; 2]]) -> Plot {
    let marked = |dash| Style { colour: dash, dash, line: dash == 0, marks: true };
    let labels = (1..=points.len()).map(|k| k.to_string()).collect();
    let front = Curve { labels, ..Curve::new("front", points.to_vec(), marked(0)) };
    Plot {
        title: "Error & cost".into(),
        x: Axis::new("CPU time of a run", "s").logarithmic(),
        y: Axis::new("largest relative error", "1").logarithmic(),
        curves: vec![front, Curve::new("other cases", Vec::new(), marked(1))],
        level: Some(Level { name: "tolerance".into(), y: 0.05, tolerance: 0.0 }),
    }
}

fn attributes(svg: &str, element: &str, key: &str) -> Vec<String> {
    svg.split(&format!("<{element} "))
        .skip(1)
        .filter_map(|rest| {
            let tag = rest.split('>').next()?;
            Some(tag.split(&format!("{key}=\"")).nth(1)?.split('"').next()?.to_string())
        })
        .collect()
}

/// Pixels of the curves with lines.
fn pixels(svg: &str) -> Vec<Vec<[f64; 2]>> {
    let pixel = |p: &str| {
        let (x, y) = p.split_once(',').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    let curves = attributes(svg, "polyline", "points");
    curves.iter().map(|c| c.split(' ').map(pixel).collect()).collect()
}

#[track_caller]
fn well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in svg.split('<').skip(1).map(|t| t.split('>').next().unwrap()) {
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().unwrap());
        }
    }
    assert!(open.is_empty());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn curves_run_where_their_values_are() {
    let curves = pixels(&settlement().file());
    assert_eq!(curves.len(), 3);
    let ends: Vec<[f64; 2]> = curves.iter().map(|c| c[c.len() - 1]).collect();
    // Larger settlement ends lower.
    assert!(ends.iter().all(|e| e[0] == ends[0][0]));
    assert!(ends[1][1] > ends[0][1] && ends[0][1] > ends[2][1]);
    assert!(ends.iter().all(|e| e[1] < FILE[1] - BOTTOM && e[1] > TOP));
}

#[test]
fn text_stays_inside_and_apart() {
    for plot in [settlement(), scatter(&[[1.0, 0.1], [10.0, 0.01], [100.0, 0.001]])] {
        let svg = plot.file();
        let mut last_tick = f64::NEG_INFINITY;
        for part in svg.split("<text ").skip(1) {
            let number =
                |key: &str| part.split(&format!("{key}=\"")).nth(1).unwrap().split('"').next().unwrap();
            let (x, y): (f64, f64) = (number("x").parse().unwrap(), number("y").parse().unwrap());
            let content = unescape(part.split('>').nth(1).unwrap().split('<').next().unwrap()).unwrap();
            let width = text_width(&content, number("font-size").parse().unwrap());
            let (from, to) = match number("text-anchor") {
                "middle" => (x - 0.5 * width, x + 0.5 * width),
                "end" => (x - width, x),
                _ => (x, x + width),
            };
            if x == 0.0 {
                continue; // rotated label of the y axis
            }
            let inside = from >= 0.0 && to <= FILE[0] && (-TITLE..=FILE[1]).contains(&y);
            assert!(inside, "{content} from {from} to {to} at {y}");
            if y == FILE[1] - BOTTOM + 17.0 {
                assert!(from > last_tick, "{content} touches the label before it");
                last_tick = to;
            }
        }
        assert!(last_tick > 0.0);
    }
}

#[test]
fn long_texts_fit() {
    assert_eq!(fitted("Settlement", TITLE_FONT, FILE[0]), TITLE_FONT);
    let long = "Settlement of the sleeper against the number of load cycles ".repeat(3);
    assert!(text_width(&long, fitted(&long, TITLE_FONT, FILE[0])) <= FILE[0]);
    let mut plot = settlement();
    plot.curves[0].name = long;
    let width: f64 = attributes(&plot.file(), "svg", "width")[0].parse().unwrap();
    let right = pixels(&plot.file())[0].last().unwrap()[0];
    assert!(right > 300.0 && right + text_width(&plot.curves[0].name, FONT) < width, "{right} {width}");
}

#[test]
fn svg_is_well_formed() {
    let mut plot = settlement();
    let svg = plot.file();
    assert!(svg.contains("sleeper &amp; &lt;bed&gt;") && svg.contains("clean &quot;new&quot;"));
    well_formed(&svg);
    well_formed(&plot.inline().unwrap().svg);
    plot.title = "bell \u{7} and \u{1b}[31m red".into();
    let svg = plot.file();
    assert!(svg.contains("bell   and  [31m red"));
    assert!(!svg.chars().any(|c| c.is_control() && c != '\n'));
}

#[test]
fn empty_and_single_points_are_drawn() {
    let mut plot = Plot::default();
    assert!(!plot.file().contains("NaN"));
    plot = Plot::lines(String::new(), Axis::default(), Axis::default(), [("one", vec![[2.0, 3.0]])]);
    let svg = plot.file();
    assert_eq!(attributes(&svg, "circle", "cx").len(), 1);
    assert!(!svg.contains("NaN") && !svg.contains(">one<"), "one curve needs no legend");
    assert_eq!(plot.inline(), None);
    plot.curves.push(Curve::new("two", vec![[3.0, 3.0]], Style::default()));
    assert_eq!(attributes(&plot.file(), "circle", "cx").len(), 4, "two points, two samples");
}

#[test]
fn thinned_history_keeps_peaks() {
    let points: Vec<[f64; 2]> = (0..500_000)
        .map(|i| [f64::from(i), if i == 123_457 { 7.0 } else { (f64::from(i) * 0.37).sin() }])
        .collect();
    let plot = Plot::lines(String::new(), Axis::default(), Axis::default(), [("a", points)]);
    let svg = plot.file();
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
    let peak = pixels(&svg)[0].iter().fold(f64::INFINITY, |m, p| m.min(p[1]));
    assert!((peak - plot.frame(FILE, 0.0).y(7.0)).abs() < 0.02);
}

#[test]
fn page_has_legend_and_valid_points() {
    let style = |k| Style { colour: k, dash: k, line: true, marks: true };
    let mut plot = Plot {
        title: "a < \"b\"".into(),
        x: Axis::new("cycle N", "").logarithmic(),
        y: Axis::new("settlement", "mm").downwards(),
        curves: vec![
            Curve::new("run 1", vec![[0.0, 0.0], [1.0, 10.0], [10.0, 30.0]], style(0)),
            Curve::new("run 2", vec![[1.0, f64::NAN], [2.0, 20.0]], style(1)),
            Curve::new("run 3", vec![[1.0, f64::NAN]], style(6)),
        ],
        level: None,
    };
    let Inline { svg, legend } = plot.inline().unwrap();
    well_formed(&svg);
    assert!(svg.contains("aria-label=\"a &lt; &quot;b&quot;\"") && svg.contains(">settlement [mm]<"));
    let names: Vec<&str> = legend.iter().map(|l| l.1.as_str()).collect();
    assert_eq!(names, ["run 1", "run 2"]);
    // Deepest is lowest on the page.
    let lines = pixels(&svg);
    assert!(lines.len() == 1 && lines[0].len() == 2 && lines[0][1][1] > lines[0][0][1], "{lines:?}");
    plot.curves.remove(0);
    assert_eq!(plot.inline(), None);
}

#[test]
fn error_bars_and_band_lie_inside() {
    let style = Style { marks: true, ..Style::default() };
    let points = vec![[1.0, 5.0], [2.0, 6.0]];
    let plot = Plot {
        curves: vec![Curve { errors: vec![0.0, 3.5], ..Curve::new("case", points, style) }],
        level: Some(Level { name: "target".into(), y: 2.0, tolerance: 1.5 }),
        ..Plot::default()
    };
    let frame = plot.frame(PAGE, 0.0);
    assert!(frame.y(9.5) >= TOP && frame.y(0.5) <= PAGE[1] - BOTTOM);
    let svg = plot.inline().unwrap().svg;
    let (x, low, high) = (frame.x(2.0), frame.y(2.5), frame.y(9.5));
    assert_eq!(svg.matches(&format!("d=\"M{x} {low}V{high}")).count(), 1);
    assert_eq!(attributes(&svg, "path", "stroke").iter().filter(|s| *s == draw::COLOURS[0]).count(), 1);
    let band = format!("y=\"{}\" ", frame.y(3.5));
    assert!(svg.contains(&band), "{band} {svg}");
}

#[test]
fn rejects_nonfinite_point() {
    let dir = folder("plot_nan");
    let file = dir.join("plot.svg");
    let mut plot = settlement();
    plot.write(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    plot.curves[1].points[4][1] = f64::NAN;
    let error = plot.write(&file).unwrap_err();
    assert!(error.to_string().contains("series fouled with sand at index 4 is NaN"), "{error}");
    assert!(!file.exists());
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn plots_points_and_rejects_nonpositive() {
    let dir = folder("plot_scatter");
    let file = dir.join("p.svg");
    scatter(&[[1.0, 0.1], [10.0, 0.01], [100.0, 0.001]]).write(&file).unwrap();
    let svg = std::fs::read_to_string(&file).unwrap();
    assert_eq!(svg.matches("<circle").count(), 4, "three points and the legend's");
    assert!(svg.contains("Error &amp; cost") && svg.contains("largest relative error [1]"));
    assert!(svg.contains(">tolerance<") && !svg.contains(">other cases<"));
    assert!([">1<", ">2<", ">3<"].iter().all(|label| svg.contains(label)));
    let line = &pixels(&svg)[0];
    assert!(((line[1][0] - line[0][0]) - (line[2][0] - line[1][0])).abs() < 0.02, "{line:?}");
    for bad in [[1.0, 0.0], [-1.0, 1.0], [f64::INFINITY, 1.0]] {
        let error = scatter(&[bad]).write(&file).unwrap_err();
        assert!(error.to_string().contains("front at index 0"), "{error}");
    }
    let mut plot = scatter(&[[1.0, 0.1]]);
    plot.level.as_mut().unwrap().y = 0.0;
    assert!(plot.write(&file).unwrap_err().to_string().contains("tolerance at index 0"));
    std::fs::remove_dir_all(&dir).unwrap();
}
