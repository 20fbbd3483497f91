//! Writes the text of the kernels that devices are given, for models with each of the laws, into a folder: one file each, for compilers
//! to look at (`tests/nvrtc_check.py`).
//!
//! `cargo run --release -p trackbed-dem --example kernels -- FOLDER`

use std::path::Path;
use trackbed_dem::bond::{Bond, BondDamping, BondInput, ContactPoint};
use trackbed_dem::law::table;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::{BodyInput, LocalDamping, Material, Model, ModelInput, Shape, Vec3, device};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("the name of a folder is missing")?;
    std::fs::create_dir_all(&folder)?;
    let spring =
        Material { density: 2600.0, stiffness: 1e5, friction: 0.5, restitution: 0.5, ..Material::RIGID };
    let rough = Material { asperity_friction: 0.5, asperity_pressure: 1e6, ..spring };
    let elastic = Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..spring };
    let yielding = Material { normal: table::normal_named("walton_braun"), ..spring };
    for (name, material) in [("linear", spring), ("rough", rough), ("hertz", elastic), ("several", yielding)]
    {
        for (suffix, turning, clumps) in
            [("", false, false), ("_with_all", true, false), ("_clumps", true, true)]
        {
            let mut material = material;
            let mut input =
                ModelInput { shapes: vec![Shape::Sphere { radius: 0.01 }], ..ModelInput::default() };
            if turning {
                // All that a model can have.
                (material.rolling_friction, material.twisting_friction) = (0.1, 0.1);
                input.damping = Some(LocalDamping { factor: 0.2 });
            }
            input.materials = vec![material];
            let position = Vec3::new(0.0, 0.0, 0.02);
            input.bodies = vec![BodyInput::default(), BodyInput { position, ..BodyInput::default() }];
            if turning {
                bonded(&mut input);
            }
            if clumps {
                let two = [([0.0, 0.0, 0.0], 0.01), ([0.01, 0.0, 0.0], 0.01)];
                input.shapes.push(Shape::Clump(Clump::from_spheres(&two)?));
                let position = Vec3::new(0.0, 0.0, 0.06);
                input.bodies.push(BodyInput { shape: 1, position, ..BodyInput::default() });
            }
            let text = device::source(&Model::new(input)?)?;
            let file = format!("{name}{suffix}.cu");
            std::fs::write(Path::new(&folder).join(&file), &text)?;
            println!("{file}: {} bytes", text.len());
        }
    }
    Ok(())
}

/// Bonds the first two bodies.
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
