//! What can be read off a state.
