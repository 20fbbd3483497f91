//! Packed constants of all bodies: shared class, individual scale.

use super::input::BodyInput;
use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::law::material::Material;
use crate::shape::Shape;
use nalgebra::UnitQuaternion;
use std::collections::HashMap;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    Sphere,
    Clump,
    Solid,
}

#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub kind: BodyKind,
    pub shape: usize,
    pub scale: f64,
    pub material: u32,
    pub part: u32,
    pub mass: f64,
    /// Zero without free translation.
    pub inverse_mass: f64,
    /// Principal moments [kg m²].
    pub inertia: Vec3,
    pub radius: f64,
    /// Bits 0–2 translation, 3–5 rotation.
    pub fixed: u8,
}

#[derive(Clone, Copy, Debug)]
struct Class {
    kind: BodyKind,
    shape: u32,
    material: u32,
    part: u32,
    fixed: u8,
    mass: Option<f64>,
    density: f64,
    /// Unscaled: volume, bounding radius, moments over mass.
    volume: f64,
    radius: f64,
    gyration2: Vec3,
}

#[derive(Clone, Debug, Default)]
pub struct Bodies {
    classes: Vec<Class>,
    /// Empty for a single class.
    class: Vec<u32>,
    scale: Vec<f64>,
    /// `None` once released.
    positions: Option<Vec<Vec3>>,
    /// Empty if all are unrotated or at rest, likewise below.
    orientations: Vec<UnitQuaternion<f64>>,
    velocities: Vec<Vec3>,
    spins: Vec<Vec3>,
    absent: Vec<bool>,
}

impl Bodies {
    pub fn new(input: &[BodyInput], shapes: &[Shape], materials: &[Material]) -> Result<Bodies, ModelError> {
        let n = input.len();
        let mut bodies = Bodies {
            class: Vec::with_capacity(n),
            scale: input.iter().map(|b| b.scale).collect(),
            positions: Some(input.iter().map(|b| b.position).collect()),
            ..Bodies::default()
        };
        let mut known = HashMap::new();
        for (index, b) in input.iter().enumerate() {
            let fixed = b.fixed.iter().enumerate().map(|(k, &f)| u8::from(f) << k).sum::<u8>();
            let key = (b.shape, b.material, b.part, fixed, b.mass.map(f64::to_bits));
            let class = *known.entry(key).or_insert_with(|| {
                bodies.classes.push(class(b, &shapes[b.shape], materials[b.material].density, fixed));
                bodies.classes.len() as u32 - 1
            });
            bodies.class.push(class);
            let body = bodies.get(index);
            for (quantity, value) in [("mass", body.mass), ("moment of inertia", body.inertia.min())] {
                if !(value > 0.0 && value.is_finite()) {
                    let requirement = "be positive and finite";
                    return Err(ModelError::Body { body: index, quantity, value, requirement });
                }
            }
        }
        if bodies.classes.len() == 1 {
            bodies.class = Vec::new();
        }
        if input.iter().any(|b| b.orientation != UnitQuaternion::identity()) {
            bodies.orientations = input.iter().map(|b| b.orientation).collect();
        }
        if input.iter().any(|b| b.velocity != Vec3::zeros()) {
            bodies.velocities = input.iter().map(|b| b.velocity).collect();
        }
        if input.iter().any(|b| b.spin != Vec3::zeros()) {
            bodies.spins = input.iter().map(|b| b.spin).collect();
        }
        if input.iter().any(|b| b.absent) {
            bodies.absent = input.iter().map(|b| b.absent).collect();
        }
        Ok(bodies)
    }

    #[inline]
    pub fn len(&self) -> usize {
        self.scale.len()
    }

    #[inline]
    fn class(&self, k: usize) -> &Class {
        &self.classes[self.class.get(k).map_or(0, |&c| c as usize)]
    }

    #[inline]
    pub fn kind(&self, k: usize) -> BodyKind {
        self.class(k).kind
    }

    #[inline]
    pub fn mass(&self, k: usize) -> f64 {
        let c = self.class(k);
        c.mass.unwrap_or(c.density * (c.volume * self.scale[k].powi(3)))
    }

    #[inline]
    pub fn get(&self, k: usize) -> Body {
        let c = self.class(k);
        let scale = self.scale[k];
        let mass = self.mass(k);
        Body {
            kind: c.kind,
            shape: c.shape as usize,
            scale,
            material: c.material,
            part: c.part,
            mass,
            inverse_mass: if c.fixed & 7 == 7 { 0.0 } else { 1.0 / mass },
            inertia: c.gyration2 * (mass * scale * scale),
            radius: c.radius * scale,
            fixed: c.fixed,
        }
    }

    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = Body> + '_ {
        (0..self.len()).map(|k| self.get(k))
    }

    #[inline]
    pub fn positions(&self) -> Option<&[Vec3]> {
        self.positions.as_deref()
    }

    #[inline]
    pub fn forget_positions(&mut self) {
        self.positions = None;
    }

    #[inline]
    pub fn orientation(&self, k: usize) -> UnitQuaternion<f64> {
        self.orientations.get(k).copied().unwrap_or_default()
    }

    #[inline]
    pub fn velocity(&self, k: usize) -> Vec3 {
        self.velocities.get(k).copied().unwrap_or_default()
    }

    #[inline]
    pub fn spin(&self, k: usize) -> Vec3 {
        self.spins.get(k).copied().unwrap_or_default()
    }

    #[inline]
    pub fn absent(&self, k: usize) -> bool {
        self.absent.get(k).is_some_and(|a| *a)
    }
}

fn class(b: &BodyInput, shape: &Shape, density: f64, fixed: u8) -> Class {
    let kind = match shape {
        Shape::Sphere { .. } => BodyKind::Sphere,
        _ if shape.query(|s| s.sphere_count()) > 0 => BodyKind::Clump,
        _ => BodyKind::Solid,
    };
    Class {
        kind,
        shape: b.shape as u32,
        material: b.material as u32,
        part: b.part,
        fixed,
        mass: b.mass,
        density,
        volume: shape.query(|s| s.volume()),
        radius: shape.query(|s| s.bounding_radius()),
        gyration2: shape.query(|s| s.gyration2()),
    }
}

/// Calls `act` with centre and radius [m] of each sphere of a body at a scale.
pub fn for_members(shape: &Shape, scale: f64, mut act: impl FnMut(Vec3, f64)) {
    shape.query(|s| s.for_spheres(&mut |c, r| act(c * scale, r * scale)));
}
