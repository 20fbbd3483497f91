//! Explicit discrete elements for ballasted track: spheres, rigid clumps, walls.
