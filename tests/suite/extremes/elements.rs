//! Slender and skewed elements.

use super::case::{Case, off};
use super::scenes::{LISTS, TABLES, block, held, material, pressure, rollers};
use super::table::{Row, figures, rows};
use trackbed_fem::mesh::Mesh;

rows! {
    flat_elements: "elements of aspect 1:100";
    beam: "bending of a beam 1:100";
    plate: "bending of a plate 1:100";
    skew: "elements skewed to the zero of the Jacobian";
}

fn flat_elements() -> Row {
    let mut errors = Vec::new();
    for order in ["quadratic", "linear"] {
        for count in [100, 1000] {
            let mut text = block([
                "{ lines = [0.0, 1.0], counts = [1] }",
                "{ lines = [0.0, 1.0], counts = [1] }",
                &format!("{{ lines = [0.0, 1.0], counts = [{count}] }}"),
            ]);
            text = text.replace("gravity = false", &format!("gravity = false\norder = \"{order}\""));
            text += &(material(1, "") + &rollers() + &pressure("z+", 1e3) + TABLES);
            if order == "quadratic" {
                text = text.replace("order = \"quadratic\"\n", "");
            }
            let case = Case::run(&text, &[]).good();
            errors.push(off(case.value("/statics/largest_displacement/0"), 1e3 / 24e6));
        }
    }
    assert!(errors.iter().all(|e| *e < 1e-9), "{errors:?}");
    Row::new(
        "column of elements 1 m wide and 10 mm, 1 mm thick, 20 and 8 nodes",
        format!("right: settlement off by {}", figures(&errors)),
        "oedometric modulus",
    )
}

fn beam() -> Row {
    let mut errors = Vec::new();
    let full = "integration = \"full\"";
    let eight = "order = \"linear\"";
    let scene = |keys: &str, counts: [u32; 3]| {
        block([
            &format!("{{ lines = [0.0, 1.0], counts = [{}] }}", counts[0]),
            &format!("{{ lines = [0.0, 0.01], counts = [{}] }}", counts[1]),
            &format!("{{ lines = [0.0, 0.01], counts = [{}] }}", counts[2]),
        ])
        .replace("gravity = false", &format!("gravity = false\n{keys}"))
            + &material(1, "young = 200e9\npoisson = 0")
            + &held("x-", "xyz", "")
            + "\n[[solid.load]]\nkind = \"traction\"\nside = \"x+\"\ntraction = [0, 0, -1000]\n"
            + TABLES
    };
    for (keys, counts) in [
        ("", [10, 2, 1]),
        ("", [1, 2, 1]),
        (full, [10, 1, 1]),
        (full, [1, 1, 1]),
        (eight, [100, 1, 4]),
        (eight, [10, 1, 1]),
        (eight, [1, 1, 1]),
    ] {
        let case = Case::run(&scene(keys, counts), &[]).good();
        let right = 0.1 / (3.0 * 200e9 * 0.01_f64.powi(4) / 12.0);
        errors.push(off(case.value("/statics/largest_displacement/0"), right));
    }
    assert!(errors[..3].iter().chain(&errors[4..6]).all(|e| *e < 5e-3), "{errors:?}");
    // A single element has constant curvature.
    assert!([errors[3], errors[6]].iter().all(|e| (e - 0.25).abs() < 1e-2), "{errors:?}");
    Case::run(&scene("", [10, 1, 1]), &[]).refused("use full integration in rows one element wide");
    Row::new(
        "cantilever 1 m × 10 mm: 20 nodes reduced, elements 10:1 and 100:1; full 10:1; 8 nodes 4:1, 10:1; one element full, 8 nodes",
        format!(
            "right: deflection off by {}; limit: a single element along the beam, full rule or 8 nodes, bends with one \
             curvature, {} % too little; reduced rule on one row of elements refused: `use the full rule`",
            figures(&[errors[0], errors[1], errors[2], errors[4], errors[5]]),
            figures(&[100.0 * errors[3], 100.0 * errors[6]])
        ),
        "F l³/(3 E I)",
    )
}

fn plate() -> Row {
    let mut errors = Vec::new();
    for (keys, count) in [("", 4), ("", 8), ("integration = \"full\"", 8), ("order = \"linear\"", 16)] {
        // Quarter plate, 1 m × 10 mm, simply supported at mid-plane.
        let mut text = block([
            &format!("{{ lines = [0.0, 0.5], counts = [{count}] }}"),
            &format!("{{ lines = [0.0, 0.5], counts = [{count}] }}"),
            &format!("{{ lines = [0.0, 0.01], counts = [{}] }}", if keys.contains("linear") { 2 } else { 1 }),
        ])
        .replace("gravity = false", &format!("gravity = false\n{keys}"));
        text += &(material(1, "young = 200e9\npoisson = 0.3") + &held("x-", "x", "") + &held("y-", "y", ""));
        for edge in ["[0.499, -1, 0.004], [0.501, 1, 0.006]", "[-1, 0.499, 0.004], [1, 0.501, 0.006]"] {
            text += &format!("\n[[solid.support]]\nnodes_in = [{edge}]\ndirections = [\"z\"]\n");
        }
        text += &(pressure("z+", 1e3) + TABLES);
        let case = Case::run(&text, &[]).good();
        let stiffness = 200e9 * 1e-6 / (12.0 * (1.0 - 0.09));
        errors.push(off(case.value("/statics/largest_displacement/0"), 0.004_062_35 * 1e3 / stiffness));
    }
    assert!(errors.iter().all(|e| *e < 0.02), "{errors:?}");
    Row::new(
        "simply supported square plate 1:100: 4², 8² elements of 20 nodes reduced, 8² full, 16² × 2 of 8 nodes to a quarter",
        format!("right: deflection off by {}", figures(&errors)),
        "0.00406235 q a⁴/D, Timoshenko & Woinowsky-Krieger",
    )
}

fn skew() -> Row {
    let run = |mesh: &Mesh| {
        let text = LISTS.to_string() + &material(1, "") + &rollers() + &pressure("z+", 1e3) + TABLES;
        Case::on_mesh(mesh, &[], &text, &[])
    };
    let mut errors = Vec::new();
    // Inner corner of 2 × 2 × 1 elements moved towards a block corner: at 0.5 zero Jacobian at the element
    // corner, at 0.6 negative at an integration point.
    let skewed = |share: f64| {
        let mut mesh = Mesh::block([2, 2, 1], [1.0, 1.0, 1.0]);
        let tent = |x: f64| 1.0 - (2.0 * x - 1.0).abs();
        for x in &mut mesh.coordinates {
            let way = 0.5 * share * tent(x[0]) * tent(x[1]);
            x[0] += way;
            x[1] += way;
        }
        run(&mesh)
    };
    for (share, inside_out) in [(0.4, false), (0.49, false), (0.4999, false), (0.5, true), (0.51, true)] {
        let case = skewed(share).good();
        errors.push(off(case.value("/statics/largest_displacement/0"), 1e3 / 24e6));
        assert_eq!(case.warned("element 4 is inverted at corner I"), inside_out, "{share}");
    }
    assert!(errors.iter().all(|e| *e < 1e-12), "{errors:?}");
    skewed(0.6).refused("element 4: found a Jacobian determinant of -");
    Row::new(
        "corner of an element moved to 0.8, 0.98, 0.9998, 1, 1.02, 1.2 of where its Jacobian is zero",
        format!(
            "right: settlement off by {}; from the zero on warned: `element 4 is inverted at corner I`; refused where \
             it is below zero at a point of integration: element and determinant",
            figures(&errors)
        ),
        "patch test: uniform stress",
    )
}
