use super::*;
use crate::write::sample::folder;
use quick_xml::escape::unescape;

fn labels(values: &[f64], most: usize) -> Vec<String> {
    Axis::over(values.iter().copied(), most).labels()
}

#[test]
fn ticks_are_round_and_enclose_values() {
    assert_eq!(labels(&[0.0, 10.0], 5), ["0", "2", "4", "6", "8", "10"]);
    assert_eq!(labels(&[-0.3, 0.71], 6), ["−0.4", "−0.2", "0.0", "0.2", "0.4", "0.6", "0.8"]);
    assert_eq!(labels(&[3.0, 3.0], 4), ["1", "2", "3", "4", "5"]);
    assert_eq!(labels(&[], 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(labels(&[0.0, 2.0e7], 4), ["0", "5.0e6", "1.0e7", "1.5e7", "2.0e7"]);
    assert_eq!(labels(&[0.0, 3.0e-5], 3), ["0", "1e−5", "2e−5", "3e−5"]);
    for (low, high) in [(1e-9, 2e-9), (-5e8, 7e11), (0.1, 0.1 + 1e-7), (1e5, 1e5 + 0.3), (0.0, 0.3)] {
        let axis = Axis::over([low, high].into_iter(), 6);
        let (first, last) = (axis.fraction(low), axis.fraction(high));
        assert!((-1e-6..1.0).contains(&first) && first < last && last <= 1.0 + 1e-6, "{low} {high}");
        assert!((1..=8).contains(&axis.steps), "{low} {high}: {} steps", axis.steps);
        let names = axis.labels();
        assert!(names.windows(2).all(|w| w[0] != w[1]), "{names:?}");
    }
}

fn settlement() -> LinePlot {
    let curve = |name: &str, scale: f64| Series {
        name: name.to_string(),
        points: (0..=200).map(|i| [f64::from(i), -scale * (1.0 + f64::from(i)).ln()]).collect(),
    };
    LinePlot {
        title: "Settlement of the sleeper & <bed>".to_string(),
        x_label: "cycle [1]".to_string(),
        y_label: "settlement [mm]".to_string(),
        series: vec![curve("clean \"new\"", 1.1), curve("fouled with sand", 1.9), curve("c", 0.4)],
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

#[test]
fn curves_run_where_their_values_are() {
    let svg = settlement().render();
    let curves = attributes(&svg, "polyline", "points");
    assert_eq!(curves.len(), 3);
    let ends: Vec<[f64; 2]> = curves
        .iter()
        .map(|c| {
            let (x, y) = c.split(' ').next_back().unwrap().split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        })
        .collect();
    // Larger settlement ends lower.
    assert!(ends.iter().all(|e| e[0] == ends[0][0]));
    assert!(ends[1][1] > ends[0][1] && ends[0][1] > ends[2][1]);
    assert!(ends.iter().all(|e| e[1] < HEIGHT - BOTTOM && e[1] > TOP));
}

#[test]
fn text_stays_inside_and_apart() {
    let svg = settlement().render();
    let mut last_tick = f64::NEG_INFINITY;
    for part in svg.split("<text ").skip(1) {
        let number = |key: &str| part.split(&format!("{key}=\"")).nth(1).unwrap().split('"').next().unwrap();
        let (x, y): (f64, f64) = (number("x").parse().unwrap(), number("y").parse().unwrap());
        let content = unescape(part.split('>').nth(1).unwrap().split('<').next().unwrap()).unwrap();
        let width = text_width(&content, FONT);
        let (from, to) = match number("text-anchor") {
            "middle" => (x - 0.5 * width, x + 0.5 * width),
            "end" => (x - width, x),
            _ => (x, x + width),
        };
        if x == 0.0 {
            continue; // rotated label of the y axis
        }
        assert!(from >= 0.0 && to <= WIDTH && y <= HEIGHT, "{content} from {from} to {to} at {y}");
        if y == HEIGHT - BOTTOM + 18.0 {
            assert!(from > last_tick, "{content} touches the label before it");
            last_tick = to;
        }
    }
    assert!(last_tick > 0.0);
}

#[test]
fn long_titles_shrink_to_fit() {
    assert_eq!(fitted("Settlement", TITLE_FONT, WIDTH), TITLE_FONT);
    let long = "Settlement of the sleeper against the number of load cycles ".repeat(3);
    assert!(text_width(&long, fitted(&long, TITLE_FONT, WIDTH)) <= WIDTH);
}

#[test]
fn the_text_is_well_formed() {
    let svg = settlement().render();
    assert!(svg.contains("sleeper &amp; &lt;bed&gt;") && svg.contains("clean &quot;new&quot;"));
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
fn removes_control_characters() {
    let plot = LinePlot { title: "bell \u{7} and \u{1b}[31m red".to_string(), ..settlement() };
    let svg = plot.render();
    assert!(svg.contains("bell   and  [31m red"));
    assert!(!svg.chars().any(|c| c.is_control() && c != '\n'));
}

#[test]
fn empty_and_single_points_are_drawn() {
    let mut plot = LinePlot::default();
    assert!(!plot.render().contains("NaN"));
    plot.series = vec![Series { name: "one".to_string(), points: vec![[2.0, 3.0]] }];
    let svg = plot.render();
    assert_eq!(attributes(&svg, "circle", "cx").len(), 1);
    assert!(!svg.contains("NaN") && !svg.contains(">one<"), "one curve needs no legend");
}

#[test]
fn thinned_history_keeps_peaks() {
    let points: Vec<[f64; 2]> = (0..500_000)
        .map(|i| [f64::from(i), if i == 123_457 { 7.0 } else { (f64::from(i) * 0.37).sin() }])
        .collect();
    let plot = LinePlot { series: vec![Series { name: "a".to_string(), points }], ..LinePlot::default() };
    let svg = plot.render();
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
    let list = &attributes(&svg, "polyline", "points")[0];
    let heights: Vec<f64> = list.split(' ').map(|p| p.split_once(',').unwrap().1.parse().unwrap()).collect();
    let axis = Axis::over([-1.0, 7.0].into_iter(), 6);
    let area = Area { left: 0.0, right: 1.0, top: TOP, bottom: HEIGHT - BOTTOM };
    let peak = heights.into_iter().fold(f64::INFINITY, f64::min);
    assert!((peak - area.y(axis.fraction(7.0))).abs() < 0.02);
}

#[test]
fn rejects_nonfinite_point() {
    let dir = folder("svg_nan");
    let file = dir.join("plot.svg");
    let mut plot = settlement();
    plot.write(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    plot.series[1].points[4][1] = f64::NAN;
    let error = plot.write(&file).unwrap_err();
    assert!(error.to_string().contains("series fouled with sand at index 4 is NaN"), "{error}");
    assert!(!file.exists());
    std::fs::remove_dir_all(&dir).unwrap();
}
