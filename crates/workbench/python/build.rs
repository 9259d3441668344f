//! Lets the linker on macOS leave Python's symbols undefined. Cargo can then
//! build the module there.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
