//! Lets the linkers of macOS leave Python's symbols open, so that cargo alone can
//! build the module there.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
