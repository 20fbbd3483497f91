//! Wall–wall contact pairs: triangulated bodies, rounded, against all walls.
//!
//! Not supported: two round bodies, immovable pairs, scarred ground.

use super::enclosed::enclosed;
use super::input::WallInput;
use super::set::Walls;
use super::triangulated::welded;
use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::spatial::round::Round;
use crate::spatial::shell::Shell;

/// Default rounding radius over the smallest side of the bounds.
const ROUNDING: f64 = 0.02;

/// Most halvings of a radius too large for the surface.
const HALVED: i32 = 6;

#[derive(Clone, Debug)]
pub(crate) enum Form {
    Shell(Box<Shell>),
    Rounds(Vec<Round>),
    Untouched,
}

/// Pairs ascend; triangulated body first, of two the lower index.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shells {
    pub forms: Vec<Form>,
    pub pairs: Vec<[u32; 2]>,
}

impl Shells {
    /// `input`: original walls.
    ///
    /// # Errors
    /// Rounding radius that does not fit.
    pub fn new(input: &[WallInput], walls: &Walls) -> Result<Shells, ModelError> {
        let free = |k: usize| walls.walls[k].body.as_ref().is_some_and(|b| b.inverse_mass > 0.0);
        let shell = |k: usize| input[k].shape.triangulated().is_some();
        let presses = |k: usize| shell(k) && input[k].body.is_some();
        let mut pairs = Vec::new();
        for a in (0..input.len()).filter(|a| presses(*a)) {
            for b in (0..input.len()).filter(|b| *b != a && !(*b < a && presses(*b))) {
                if (free(a) || free(b)) && input[b].scarring.is_none() {
                    pairs.push([a as u32, b as u32]);
                }
            }
        }
        let mut touched = vec![false; input.len()];
        pairs.iter().flatten().for_each(|k| touched[*k as usize] = true);
        let form = |k: usize| match input[k].shape.triangulated() {
            _ if !touched[k] => Ok(Form::Untouched),
            Some((vertices, triangles)) => {
                let shell = match &input[k].body {
                    None => Shell::sharp(vertices, triangles, &welded(vertices)),
                    Some(body) => rounded(vertices, triangles, body.rounding)
                        .map_err(|problem| ModelError::Wall { wall: walls.name(k), problem })?,
                };
                Ok(Form::Shell(Box::new(shell)))
            }
            None => Ok(Form::Rounds(input[k].shape.rounds())),
        };
        let forms = if pairs.is_empty() {
            Vec::new()
        } else {
            (0..input.len()).map(form).collect::<Result<_, _>>()?
        };
        Ok(Shells { forms, pairs })
    }

    pub fn shell(&self, wall: u32) -> Option<&Shell> {
        match self.forms.get(wall as usize) {
            Some(Form::Shell(shell)) => Some(shell),
            _ => None,
        }
    }

    /// Corners and edge lengths [m] in contact, of ground and body.
    pub fn flattest(&self, [a, b]: [u32; 2], reach: f64) -> [f64; 2] {
        let own = self.shell(a).map_or([0.0; 2], |s| s.flattest(reach));
        let other = match self.forms.get(b as usize) {
            Some(Form::Shell(shell)) if shell.radius > 0.0 => shell.flattest(reach),
            Some(Form::Shell(_)) => own,
            Some(Form::Rounds(rounds)) => {
                rounds.iter().map(Round::flattest).fold([0.0_f64; 2], |a, b| [a[0] + b[0], a[1].max(b[1])])
            }
            _ => [0.0; 2],
        };
        [own[0] + other[0], own[1] + other[1]]
    }

    pub fn radius(&self, wall: u32) -> f64 {
        self.shell(wall).map_or(0.0, |s| s.radius)
    }
}

fn rounded(vertices: &[Vec3], triangles: &[[u32; 3]], given: Option<f64>) -> Result<Shell, &'static str> {
    let same = welded(vertices);
    // An open surface has no inside.
    let faces = enclosed(vertices, triangles).map(|e| e.faces);
    let round = |radius: f64| match &faces {
        Some(faces) => Shell::rounded(vertices, faces, &same, radius),
        None => Some(Shell { radius, ..Shell::sharp(vertices, triangles, &same) }),
    };
    if let Some(radius) = given {
        return round(radius).ok_or("`rounding` is too large for its surface: a triangle would collapse");
    }
    let used = || triangles.iter().flatten().map(|v| vertices[*v as usize]);
    let high = used().fold(Vec3::repeat(f64::NEG_INFINITY), |h, v| h.sup(&v));
    let low = used().fold(Vec3::repeat(f64::INFINITY), |l, v| l.inf(&v));
    let smallest = (high - low).min();
    (0..=HALVED)
        .map(|k| ROUNDING * smallest * 0.5_f64.powi(k))
        .filter(|radius| *radius > 0.0)
        .find_map(round)
        .ok_or("its corners and edges cannot be rounded by a fraction of its smallest side: give `rounding`")
}
