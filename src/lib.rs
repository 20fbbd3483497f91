//! trackbed: coupled DEM–FEM solver for ballasted railway track.
