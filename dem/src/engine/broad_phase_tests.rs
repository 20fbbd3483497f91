use super::*;
use crate::base::Vec3;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::law::material::Material;
use crate::shape::Shape;
use crate::shape::clump::Clump;
use crate::spatial::surface::NoSurface;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

fn thrown(seed: u64) -> ModelInput {
    let mut rng = Pcg64Mcg::new(seed.into());
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let mut clump = |n: usize| {
        let spheres: Vec<_> =
            (0..n).map(|_| ([unit(), unit(), unit()].map(|x| 0.008 * x), 0.007 + 0.005 * unit())).collect();
        Shape::Clump(Clump::from_spheres(&spheres).unwrap())
    };
    let shapes = vec![clump(2), clump(6), Shape::Sphere { radius: 0.008 }, clump(4)];
    let mut input = ModelInput {
        materials: vec![Material { density: 2600.0, stiffness: 1e5, ..Material::RIGID }],
        shapes,
        ..ModelInput::default()
    };
    for k in 0..700 {
        let position = Vec3::new(unit(), unit(), unit()) * 0.25;
        let fixed = [k % 7 == 0; 6];
        input.bodies.push(BodyInput {
            shape: k % 4,
            position,
            fixed,
            scale: 0.5 + unit(),
            ..BodyInput::default()
        });
    }
    input
}

#[test]
fn hulls_find_what_spheres_find() {
    for seed in 0..4 {
        let model = Model::new(thrown(seed)).unwrap();
        let state = State::new(&model);
        let mut work = Work::new(&model, &state);
        search(&model, &state, &mut work, &NoSurface, Listed::All);
        let own = (&(0..state.blocks.len()), &[][..]);
        let mut all = All::new(&model, &state, &work.members, &work.held, own, Listed::All);
        assert!(all.clump_bounds.take().is_some());
        all.cells.build(&all.points, model.radii, model.skin);
        let mut count = 0;
        for b in 0..state.blocks.len() {
            let (mut spheres, clump_bounds) = (Candidates::default(), &work.blocks[b].candidates);
            all.spheres(b, &mut spheres);
            assert_eq!((&spheres.pairs, &spheres.cross), (&clump_bounds.pairs, &clump_bounds.cross));
            assert_eq!(spheres.planes, clump_bounds.planes);
            count += spheres.pairs.len() + spheres.cross.len();
        }
        assert!(count > 3000, "{count}");
    }
}
