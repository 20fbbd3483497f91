//! Element faces by corner nodes, and elements that overlap.

use trackbed_fem::Mesh;

/// Ascending corner ids; the fourth of a triangle is `u32::MAX`.
pub(crate) type Key = [u32; 4];

pub(crate) fn key(corners: &[u32]) -> Key {
    let mut key = [u32::MAX; 4];
    for (k, corner) in key.iter_mut().zip(corners) {
        *k = *corner;
    }
    key.sort_unstable();
    key
}

pub(super) struct Faces(Vec<(Key, [u32; 2])>);

impl Faces {
    pub fn of(mesh: &Mesh) -> Faces {
        let mut all = Vec::new();
        for (e, nodes) in mesh.connectivity.iter().enumerate() {
            for (side, local) in mesh.connectivity.kind(e).faces().iter().enumerate() {
                // Faces of 3 or 4 nodes have corners only; otherwise half are corners.
                let corners = if local.len() > 4 { local.len() / 2 } else { local.len() };
                let mut of_face = [u32::MAX; 4];
                of_face.iter_mut().zip(&local[..corners]).for_each(|(node, l)| *node = nodes[*l]);
                of_face.sort_unstable();
                all.push((of_face, [e as u32, side as u32]));
            }
        }
        all.sort_unstable();
        Faces(all)
    }

    /// Element and side of the faces with these corners.
    pub fn find(&self, key: Key) -> impl Iterator<Item = [u32; 2]> + '_ {
        let first = self.0.partition_point(|(k, _)| *k < key);
        self.0[first..].iter().take_while(move |(k, _)| *k == key).map(|(_, face)| *face)
    }

    /// First face of more than two elements, or pair of identical elements: key, found, expected.
    pub fn fault(&self, mesh: &Mesh) -> Option<(String, String, String)> {
        let faults = self.0.chunk_by(|a, b| a.0 == b.0).filter(|group| crowded(mesh, group));
        let of_elements =
            |group: &[(Key, [u32; 2])]| group.iter().map(|(_, [e, _])| *e).collect::<Vec<u32>>();
        let mut groups: Vec<_> = faults.map(|g| (of_elements(g), g)).collect();
        groups.sort_by(|a, b| a.0.cmp(&b.0));
        groups.dedup_by(|a, b| a.0 == b.0);
        let first = groups.first()?.1;
        let numbers = |ids: Vec<u32>| {
            let shown = ids.iter().take(10).map(u32::to_string).collect::<Vec<_>>().join(", ");
            if ids.len() > 10 { format!("{shown}, …") } else { shown }
        };
        let elements: Vec<u32> = first.iter().map(|(_, [e, _])| mesh.element_ids[*e as usize]).collect();
        let nodes = first[0].0.iter().filter(|n| **n != u32::MAX);
        let nodes: Vec<u32> = nodes.map(|n| mesh.node_ids[*n as usize]).collect();
        let others = match groups.len() {
            1 => String::new(),
            all => format!(" (and {} more such groups)", all - 1),
        };
        let key = format!("elements {}", numbers(elements));
        if first.windows(2).any(|pair| are_twins(mesh, pair)) {
            let expected = "each volume once; a volume in several groups is one element in several sets";
            return Some((key, format!("the same corners{others}"), expected.into()));
        }
        let found = format!("the face of nodes {} in all of them{others}", numbers(nodes));
        Some((key, found, "a face that two elements share, or one element has".into()))
    }
}

fn crowded(mesh: &Mesh, group: &[(Key, [u32; 2])]) -> bool {
    group.len() > 2 || group.len() == 2 && are_twins(mesh, group)
}

fn are_twins(mesh: &Mesh, pair: &[(Key, [u32; 2])]) -> bool {
    let corners = |at: usize| {
        let element = pair[at].1[0] as usize;
        let count = mesh.connectivity.kind(element).corner_count();
        let mut nodes = mesh.connectivity[element][..count].to_vec();
        nodes.sort_unstable();
        nodes
    };
    corners(0) == corners(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample;
    use trackbed_fem::ElementKind;

    #[test]
    fn twins_and_faces_of_three_elements() {
        let mesh = sample::straight_block([2, 2, 1]);
        assert_eq!(Faces::of(&mesh).fault(&mesh), None);
        let inner = mesh.face(0, 3);
        let found: Vec<[u32; 2]> = Faces::of(&mesh).find(key(inner.corners())).collect();
        assert!(found.len() <= 2 && found.contains(&[0, 3]), "{found:?}");

        let mut twin = mesh.clone();
        let c: Vec<u32> = mesh.connectivity[1][..8].to_vec();
        twin.push_element(50, 1, ElementKind::Hex8, &[c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]]);
        let (key, found, _) = Faces::of(&twin).fault(&twin).unwrap();
        assert!(key.contains(&format!("{}", mesh.element_ids[1])) && key.contains("50"), "{key}");
        assert!(found.starts_with("the same corners"), "{found}");

        let mut three = mesh.clone();
        let face = (0..6)
            .map(|side| mesh.face(0, side))
            .find(|f| Faces::of(&mesh).find(self::key(f.corners())).count() == 2);
        let c = face.unwrap().corners().to_vec();
        let apex = three.node_count() as u32;
        three.node_ids.push(9000);
        three.coordinates.push([9.0; 3]);
        three.push_element(60, 1, ElementKind::Pyramid5, &[c[0], c[1], c[2], c[3], apex]);
        let (key, found, _) = Faces::of(&three).fault(&three).unwrap();
        assert!(key.matches(',').count() == 2 && key.contains("60"), "{key}");
        assert!(found.starts_with("the face of nodes "), "{found}");
    }
}
