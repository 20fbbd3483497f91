//! Writes the device kernel sources of models with each law, for `tests/nvrtc_check.py`.
//!
//! `cargo run --release -p trackbed-dem --example kernels -- FOLDER`

use std::path::Path;
use trackbed_dem::bond::{Bond, BondDamping, BondInput, ContactPoint};
use trackbed_dem::law::table;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::{
    BodyInput, LocalDamping, Material, Model, ModelInput, Shape, Vec3, WallInput, WallShape, device,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("the name of a folder is missing")?;
    std::fs::create_dir_all(&folder)?;
    let spring =
        Material { density: 2600.0, stiffness: 1e5, friction: 0.5, restitution: 0.5, ..Material::RIGID };
    let rough = Material { asperity_friction: 0.5, asperity_pressure: 1e6, ..spring };
    let elastic = Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..spring };
    let yielding = Material { normal: table::normal_named("walton_braun"), ..spring };
    let crushing = Material { corner_strength: 1e6, corner_angle: 1.36, ..elastic };
    for (name, material) in [
        ("linear", spring),
        ("rough", rough),
        ("hertz", elastic),
        ("crushing", crushing),
        ("several", yielding),
    ] {
        for scene in [
            Scene::Spheres,
            Scene::All,
            Scene::Loose,
            Scene::Clumps,
            Scene::Walls,
            Scene::Borders,
            Scene::Ground,
        ] {
            let text = device::source(&Model::new(scene.input(material)?)?)?;
            let file = format!("{name}{}.cu", scene.suffix());
            std::fs::write(Path::new(&folder).join(&file), &text)?;
            println!("{file}: {} bytes", text.len());
        }
    }
    Ok(())
}

/// Bodies of a model and their contact partners.
#[derive(Clone, Copy, PartialEq)]
enum Scene {
    Spheres,
    /// Spheres, with all features supported for spheres and planes.
    All,
    /// Clumps; then with bonds, triangle walls or periodic borders.
    Loose,
    Clumps,
    Walls,
    Borders,
    /// Clumps on a surface with contacts computed on the CPU.
    Ground,
}

impl Scene {
    fn suffix(self) -> &'static str {
        match self {
            Scene::Spheres => "",
            Scene::All => "_with_all",
            Scene::Loose => "_loose",
            Scene::Clumps => "_clumps",
            Scene::Walls => "_walls",
            Scene::Borders => "_borders",
            Scene::Ground => "_ground",
        }
    }

    fn input(self, mut material: Material) -> Result<ModelInput, Box<dyn std::error::Error>> {
        let mut input = ModelInput { shapes: vec![Shape::Sphere { radius: 0.01 }], ..ModelInput::default() };
        if self != Scene::Spheres {
            (material.rolling_friction, material.twisting_friction) = (0.1, 0.1);
            input.damping = Some(LocalDamping { factor: 0.2 });
        }
        input.materials = vec![material];
        let at = |z: f64| Vec3::new(0.0, 0.0, z);
        input.bodies = [0.0, 0.02].map(|z| BodyInput { position: at(z), ..BodyInput::default() }).to_vec();
        match self {
            Scene::Spheres => return Ok(input),
            Scene::Loose => (),
            Scene::Ground => input.surface_material = Some(0),
            Scene::Borders => input.periodic = [Some([-1.0, 1.0]), None, None],
            _ => bonded(&mut input),
        }
        if self != Scene::All {
            let two = [([0.0, 0.0, 0.0], 0.01), ([0.01, 0.0, 0.0], 0.01)];
            input.shapes.push(Shape::Clump(Clump::from_spheres(&two)?));
            input.bodies.push(BodyInput { shape: 1, position: at(0.06), ..BodyInput::default() });
        }
        if self == Scene::Walls {
            let vertices = vec![at(-0.1), at(-0.1) + Vec3::x(), at(-0.1) + Vec3::y()];
            let floor = WallShape::Triangles { vertices, triangles: vec![[0, 1, 2]] };
            input.walls.push(WallInput::fixed(floor, 0));
        }
        Ok(input)
    }
}

fn bonded(input: &mut ModelInput) {
    let tension_limit = f64::INFINITY;
    input.bond_kinds = vec![Bond::ContactPoint(ContactPoint {
        normal: 1e5,
        shear: 1e5,
        tension_limit,
        shear_limit: tension_limit,
        damping: BondDamping::None,
        contact: false,
    })];
    input.bonds = vec![BondInput::new(0, 1, 0)];
}
