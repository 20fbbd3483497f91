//! Failures within a block that end a run.

use super::error::Partner;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Failure {
    Overlap { body: u32, partner: Partner, overlap: f64, bound: f64 },
    Speed { body: u32, speed: f64, bound: f64 },
    Wall { wall: u32, speed: f64, bound: f64 },
    Meeting { walls: [u32; 2] },
    Walls { walls: [u32; 2], overlap: f64, bound: f64 },
}
