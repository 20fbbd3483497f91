//! Consistent nodal loads of contact forces, audited at every sub-step.
//!
//! Fᵢ = Nᵢ(ξ, η) F: RailwayFEM-DEM manual (2015), eq. 19; Theory manual: eq. (5.2).

use crate::face::{self, cross};
use crate::surface::SolidSurface;
use std::ops::Range;
use trackbed_dem::sheet::couple_at_corners;
use trackbed_dem::surface::SurfaceContact;
use trackbed_fem::mesh::Face;

/// Largest transfer errors so far.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct TransferAudit {
    /// Sub-steps with contacts.
    pub exchanges: u64,
    /// Largest |Σ nodal load − Σ contact force| / Σ |contact force|.
    pub force: f64,
    /// Largest |Σ xᵢ × nodal loadᵢ − Σ p × contact force| / Σ R |contact force|, R the farthest node
    /// distance.
    pub moment: f64,
}

/// Contact impulses of one window at the surface nodes.
pub struct Transfer {
    /// Nodal impulse [N s]. Shape `[surface nodes]`.
    impulse: Vec<[f64; 3]>,
    /// Dashpot part, total and in the first sub-step [N s].
    drag: Vec<[f64; 3]>,
    first_drag: Vec<[f64; 3]>,
    steps: u32,
    /// Load in this sub-step [N], zero outside `loaded`.
    load: Vec<[f64; 3]>,
    loaded: Vec<u32>,
    /// Contact impulse per face [N s]. Shape `[faces]`.
    face_impulse: Vec<[f64; 3]>,
}

impl Transfer {
    /// Empty transfer for a surface.
    pub fn new(surface: &SolidSurface) -> Transfer {
        let n = surface.nodes().len();
        Transfer {
            impulse: vec![[0.0; 3]; n],
            drag: vec![[0.0; 3]; n],
            first_drag: vec![[0.0; 3]; n],
            steps: 0,
            load: vec![[0.0; 3]; n],
            loaded: Vec::with_capacity(n),
            face_impulse: vec![[0.0; 3]; surface.faces().len()],
        }
    }

    /// Resets the impulses.
    pub fn begin_window(&mut self) {
        self.impulse.fill([0.0; 3]);
        self.drag.fill([0.0; 3]);
        self.first_drag.fill([0.0; 3]);
        self.steps = 0;
        self.face_impulse.fill([0.0; 3]);
    }

    /// Adds the forces of a sub-step of `dt` [s].
    pub fn add(
        &mut self,
        surface: &SolidSurface,
        contacts: &[SurfaceContact],
        dt: f64,
        audit: &mut TransferAudit,
    ) {
        self.steps += 1;
        if contacts.is_empty() {
            return;
        }
        let mut force = [0.0; 3];
        let mut moment = [0.0; 3];
        let mut force_scale = 0.0;
        let mut moment_scale = 0.0;
        for contact in contacts {
            let n = surface.shape_functions(contact.patch, contact.local);
            for (&node, n) in surface.face_nodes(contact.patch).iter().zip(n) {
                let load = &mut self.load[node as usize];
                if *load == [0.0; 3] {
                    self.loaded.push(node);
                }
                let drag = &mut self.drag[node as usize];
                for d in 0..3 {
                    load[d] += n * contact.force[d];
                    drag[d] += n * contact.dashpot[d] * dt;
                }
            }
            if contact.couple != [0.0; 3] {
                self.add_couple(surface, contact);
            }
            let arm = cross(contact.point, contact.force);
            for d in 0..3 {
                force[d] += contact.force[d];
                moment[d] += arm[d] + contact.couple[d];
                self.face_impulse[contact.patch as usize][d] += contact.force[d] * dt;
            }
            force_scale += norm(contact.force);
            moment_scale += surface.reach(contact.patch) * norm(contact.force);
        }
        for &node in &self.loaded {
            let load = std::mem::take(&mut self.load[node as usize]);
            let x = surface.position(node);
            let arm = cross(x, load);
            for d in 0..3 {
                force[d] -= load[d];
                moment[d] -= arm[d];
                self.impulse[node as usize][d] += load[d] * dt;
            }
        }
        self.loaded.clear();
        if self.steps == 1 {
            self.first_drag.copy_from_slice(&self.drag);
        }
        audit.exchanges += 1;
        if force_scale > 0.0 {
            audit.force = audit.force.max(norm(force) / force_scale);
            audit.moment = audit.moment.max(norm(moment) / moment_scale.max(f64::MIN_POSITIVE));
        }
    }

    fn add_couple(&mut self, surface: &SolidSurface, contact: &SurfaceContact) {
        let nodes = surface.face_nodes(contact.patch);
        let corners = [0, 1, 2].map(|k| surface.position(nodes[k]));
        for (&node, force) in nodes.iter().zip(couple_at_corners(corners, contact.couple)) {
            let load = &mut self.load[node as usize];
            if *load == [0.0; 3] {
                self.loaded.push(node);
            }
            (0..3).for_each(|d| load[d] += force[d]);
        }
    }

    /// Contact impulse of the window [N s].
    pub fn total_impulse(&self) -> [f64; 3] {
        self.impulse_on(0..self.face_impulse.len())
    }

    /// Contact impulse on `faces` [N s].
    pub fn impulse_on(&self, faces: Range<usize>) -> [f64; 3] {
        let mut total = [0.0; 3];
        for impulse in &self.face_impulse[faces] {
            for d in 0..3 {
                total[d] += impulse[d];
            }
        }
        total
    }

    /// Returns the largest normal force over area of one face [Pa] in a window of `window` [s].
    pub fn peak_face_pressure(&self, surface: &SolidSurface, window: f64) -> f64 {
        self.peak_pressure_on(0..self.face_impulse.len(), surface, window)
    }

    /// The same for `faces` [Pa]; flat facets of one element face count together.
    pub fn peak_pressure_on(&self, faces: Range<usize>, surface: &SolidSurface, window: f64) -> f64 {
        let mut patch = faces.start;
        let mut peak = 0.0_f64;
        let same = |a: &Face, b: &Face| (a.element, a.side) == (b.element, b.side);
        for whole in surface.faces()[faces].chunk_by(same) {
            let (mut impulse, mut area) = ([0.0; 3], [0.0; 3]);
            for part in patch..patch + whole.len() {
                let own = surface.area_vector(part as u32);
                for d in 0..3 {
                    impulse[d] += self.face_impulse[part][d];
                    area[d] += own[d];
                }
            }
            peak = peak.max(-face::dot(impulse, area) / (window * face::dot(area, area)));
            patch += whole.len();
        }
        peak
    }

    /// Adds the mean nodal load over `window` [s] to `load`, shape `[3·nodes]`.
    pub fn add_mean_load(&self, surface: &SolidSurface, window: f64, load: &mut [f64]) {
        on_solid(surface, &self.impulse, |dof, impulse| load[dof] += impulse / window);
    }

    /// Returns the interface dashpot error [J]; Theory manual: eq. (5.16).
    ///
    /// Surface velocity: predicted `rate`, in the previous window `last`, computed mean `found` [m/s]. Shapes
    /// `[3·nodes]`.
    pub fn interface_dashpot_error(
        &self,
        surface: &SolidSurface,
        rate: impl Fn(usize) -> f64,
        last: impl Fn(usize) -> f64,
        found: impl Fn(usize) -> f64,
    ) -> f64 {
        let mut lag = 0.0;
        on_solid(surface, &self.drag, |i, drag| lag += drag * (rate(i) - found(i)));
        on_solid(surface, &self.first_drag, |i, drag| lag += drag * 0.5 * (rate(i) - last(i)));
        lag
    }

    /// Audits a distributed mean load, shape `[3·nodes]`, in the undeformed shape.
    pub fn audit_spread(&self, surface: &SolidSurface, window: f64, load: &[f64], audit: &mut TransferAudit) {
        if surface.spread().is_none() {
            return;
        }
        let (mut force, mut moment, mut scales) = ([0.0; 3], [0.0; 3], [0.0; 2]);
        for ((impulse, &node), k) in self.impulse.iter().zip(surface.nodes()).zip(0..) {
            let given = impulse.map(|i| i / window);
            let x = surface.mesh_position(k);
            let put = [0, 1, 2].map(|d| load[3 * node as usize + d]);
            let (arm, put_moment) = (cross(x, given), cross(x, put));
            for d in 0..3 {
                force[d] += given[d] - put[d];
                moment[d] += arm[d] - put_moment[d];
            }
            scales[0] += norm(given);
            scales[1] += norm(x) * norm(given);
        }
        if scales[0] > 0.0 {
            audit.force = audit.force.max(norm(force) / scales[0]);
            audit.moment = audit.moment.max(norm(moment) / scales[1].max(f64::MIN_POSITIVE));
        }
    }
}

fn on_solid(surface: &SolidSurface, impulse: &[[f64; 3]], mut f: impl FnMut(usize, f64)) {
    let nodes = surface.nodes();
    let mut all = |node: u32, impulse: [f64; 3]| {
        let first = 3 * nodes[node as usize] as usize;
        (0..3).for_each(|d| f(first + d, impulse[d]));
    };
    match surface.spread() {
        None => impulse.iter().zip(0..).for_each(|(impulse, node)| all(node, *impulse)),
        Some(spread) => spread.distribute(impulse, all),
    }
}

fn norm(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}
