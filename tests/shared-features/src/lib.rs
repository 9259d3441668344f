//! No code: only dependencies, for their features.
