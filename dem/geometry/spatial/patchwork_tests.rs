use super::*;
use crate::base::random::Random;
use crate::spatial::facet::facets;

#[test]
fn trees_find_patches_of_moved_walls() {
    let mut random = Random::new(5, 0);
    let mut vector = |scale: f64| Vec3::from_fn(|_, _| scale * (2.0 * random.uniform() - 1.0));
    let (mut patches, mut walls) = (Vec::new(), Vec::new());
    for wall in 0..3 {
        let vertices: Vec<Vec3> = (0..40)
            .flat_map(|_| {
                let at = vector(2.0);
                [at, at + vector(0.3), at + vector(0.3)]
            })
            .collect();
        let triangles: Vec<[u32; 3]> = (0..40).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let same: Vec<u32> = (0..vertices.len() as u32).collect();
        let forms = facets(&vertices, &triangles, &same).into_iter().map(|f| Form::Facet(Box::new(f)));
        patches.extend(forms.map(|form| Patch::new(wall, form, Partner::Wall(wall))));
        walls.push(WallView {
            origin: vector(3.0),
            orientation: UnitQuaternion::from_scaled_axis(vector(3.0)),
            centre: Vec3::zeros(),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            material: 0,
            inverse_mass: 0.0,
            open: false,
            driven: false,
            scarred: false,
        });
    }
    let trees = Trees::new(&patches);
    let (mut found, mut there) = (0, 0);
    for _ in 0..2000 {
        let (at, half) = (vector(4.0), Vec3::repeat(0.2));
        let mut row = Vec::new();
        trees.query(&walls, ((at - half).into(), (at + half).into()), &mut row);
        assert!(row.is_sorted_by(|a, b| a < b), "{row:?}");
        for (k, patch) in patches.iter().enumerate() {
            let wall = &walls[patch.wall as usize];
            let Form::Facet(facet) = &patch.form else { unreachable!() };
            let within = |p: &Vec3| (wall.origin + wall.orientation * p - at).amax() <= 0.2;
            if facet.corners.iter().any(within) {
                there += 1;
                assert!(row.contains(&(k as u32)), "patch {k} of wall {}", patch.wall);
            }
        }
        found += row.len();
    }
    assert!(there > 50 && found < 2000 * patches.len() / 20, "{found} found, {there} there");
}
