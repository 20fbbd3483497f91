//! Degenerate bricks: wedges, pyramids and tetrahedra in the form of SOLID186 and SOLID185.
//!
//! | kind | corners I…P | mid-sides Q…T, U…X, Y…B |
//! |---|---|---|
//! | wedge | I J K K, M N O O | S = K, W = O, B = A |
//! | pyramid | I J K L, M M M M | U = V = W = X = M |
//! | tetrahedron | I J K K, M M M M | S = K, U = V = W = X = M, B = A |
//!
//! Source: ANSYS Mechanical APDL Element Reference, SOLID186 and SOLID185. A mid-side node 0 is absent; if
//! all are, the element is linear.

use trackbed_fem::ElementKind;

struct Form {
    kind: ElementKind,
    /// Brick positions of the nodes, corners first.
    nodes: &'static [usize],
    /// Repeating and repeated positions.
    repeats: &'static [(usize, usize)],
}

const FORMS: [Form; 4] = [
    Form {
        kind: ElementKind::Hex20,
        nodes: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19],
        repeats: &[],
    },
    Form {
        kind: ElementKind::Wedge15,
        nodes: &[0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18],
        repeats: &[(3, 2), (7, 6), (10, 2), (14, 6), (19, 18)],
    },
    Form {
        kind: ElementKind::Pyramid13,
        nodes: &[0, 1, 2, 3, 4, 8, 9, 10, 11, 16, 17, 18, 19],
        repeats: &[(5, 4), (6, 4), (7, 4), (12, 4), (13, 4), (14, 4), (15, 4)],
    },
    Form {
        kind: ElementKind::Tet10,
        nodes: &[0, 1, 2, 4, 8, 9, 11, 16, 17, 18],
        repeats: &[(3, 2), (5, 4), (6, 4), (7, 4), (10, 2), (12, 4), (13, 4), (14, 4), (15, 4), (19, 18)],
    },
];

const LETTERS: [&str; 20] =
    ["I", "J", "K", "L", "M", "N", "O", "P", "Q", "R", "S", "T", "U", "V", "W", "X", "Y", "Z", "A", "B"];

/// Mismatch of brick nodes with all known forms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Value found.
    pub found: String,
    /// Expected value.
    pub expected: &'static str,
}

/// Returns the element kind of 8 or 20 brick node ids, and its nodes in their order.
///
/// # Errors
/// Unknown repetitions, missing corners, some but not all mid-sides missing.
pub fn from_brick(ids: &[u32]) -> Result<(ElementKind, Vec<u32>), Fault> {
    const FORMS_EXPECTED: &str = "different nodes, or those of a wedge (K = L, O = P), a pyramid (M = N = O = P) or a \
                              tetrahedron (both)";
    debug_assert!(ids.len() == 8 || ids.len() == 20);
    if let Some(corner) = ids[..8].iter().position(|id| *id == 0) {
        return Err(Fault { found: format!("no node {}", LETTERS[corner]), expected: "all corners" });
    }
    let holds = |form: &Form| form.repeats.iter().filter(|(p, _)| *p < 8).all(|(p, of)| ids[*p] == ids[*of]);
    // Most degenerate first; the plain brick matches any nodes.
    let order = [3, 2, 1, 0].map(|f| &FORMS[f]);
    let form = order.into_iter().find(|form| holds(form)).unwrap_or(&FORMS[0]);
    let corner_count = form.kind.corner_count();
    let mids = form.nodes[corner_count..].iter().filter(|p| **p < ids.len());
    let missing = mids.clone().find(|p| ids[**p] == 0);
    let linear = mids.clone().all(|p| ids[*p] == 0);
    let (kind, count) =
        if linear { (form.kind.linear(), corner_count) } else { (form.kind, form.nodes.len()) };
    if let (false, Some(p)) = (linear, missing) {
        return Err(Fault {
            found: format!("no node {}, and other mid-side nodes are there", LETTERS[*p]),
            expected: "all mid-side nodes of an element, or none",
        });
    }
    // Mid-sides of collapsed edges repeat a corner, usually their own, or are absent.
    for &(p, of) in form.repeats.iter().filter(|(p, _)| (8..ids.len()).contains(p)) {
        let corner_of_point = of < 8 && ids[..8].contains(&ids[p]);
        if ids[p] != ids[of] && ids[p] != 0 && !corner_of_point {
            let found = format!("node {} = {} on an edge of a {}", LETTERS[p], ids[p], kind.name());
            return Err(Fault { found, expected: "the node of the corner or edge that it is folded onto" });
        }
    }
    let nodes: Vec<u32> = form.nodes[..count].iter().map(|p| ids[*p]).collect();
    let mut sorted = nodes.clone();
    sorted.sort_unstable();
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(Fault { found: format!("node {} more than once", pair[0]), expected: FORMS_EXPECTED });
    }
    Ok((kind, nodes))
}

/// Brick of 20 or 8 nodes that [`from_brick`] reads as this element.
pub fn to_brick(kind: ElementKind, nodes: &[u32]) -> Vec<u32> {
    let form = FORMS.iter().find(|form| form.kind.shape() == kind.shape()).unwrap_or(&FORMS[0]);
    let (size, count) = if kind.has_mid_sides() { (20, form.nodes.len()) } else { (8, kind.corner_count()) };
    let mut brick = vec![0; size];
    for (p, node) in form.nodes[..count].iter().zip(nodes) {
        brick[*p] = *node;
    }
    for &(p, of) in form.repeats {
        if p < brick.len() {
            brick[p] = brick[of];
        }
    }
    brick
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_forms_of_the_element_reference() {
        let letters = |text: &str| -> Vec<u32> {
            text.split(' ').map(|l| LETTERS.iter().position(|x| *x == l).unwrap() as u32 + 1).collect()
        };
        for (kind, brick, nodes) in [
            (ElementKind::Tet10, "I J K K M M M M Q R K T M M M M Y Z A A", "I J K M Q R T Y Z A"),
            (ElementKind::Pyramid13, "I J K L M M M M Q R S T M M M M Y Z A B", "I J K L M Q R S T Y Z A B"),
            (
                ElementKind::Wedge15,
                "I J K K M N O O Q R K T U V O X Y Z A A",
                "I J K M N O Q R T U V X Y Z A",
            ),
        ] {
            let (brick, nodes) = (letters(brick), letters(nodes));
            assert_eq!(from_brick(&brick), Ok((kind, nodes.clone())), "{}", kind.name());
            assert_eq!(to_brick(kind, &nodes), brick);
            let (eight, corners) = (&brick[..8], &nodes[..kind.corner_count()]);
            assert_eq!(from_brick(eight), Ok((kind.linear(), corners.to_vec())));
            assert_eq!(to_brick(kind.linear(), corners), eight);
            for mut dropped in [brick.clone(), eight.to_vec()] {
                dropped.resize(20, 0);
                dropped[8..].fill(0);
                assert_eq!(from_brick(&dropped), Ok((kind.linear(), corners.to_vec())));
            }
        }
    }

    #[test]
    fn other_foldings_and_holes_are_refused() {
        let plain: Vec<u32> = (1..=20).collect();
        let with = |changes: &[(usize, u32)]| {
            let mut ids = plain.clone();
            changes.iter().for_each(|(p, id)| ids[*p] = *id);
            from_brick(&ids).unwrap_err().found
        };
        assert_eq!(with(&[(1, 1)]), "node 1 more than once");
        assert_eq!(with(&[(3, 3)]), "node 3 more than once");
        assert_eq!(with(&[(19, 12)]), "node 12 more than once");
        assert_eq!(with(&[(9, 0)]), "no node R, and other mid-side nodes are there");
        assert_eq!(with(&[(2, 0)]), "no node K");
        // Mid-side S is not K; then B is not A.
        assert_eq!(with(&[(3, 3), (7, 7)]), "node S = 11 on an edge of a wedge15");
        assert_eq!(with(&[(3, 3), (7, 7), (10, 3), (14, 7)]), "node B = 20 on an edge of a wedge15");
    }
}
