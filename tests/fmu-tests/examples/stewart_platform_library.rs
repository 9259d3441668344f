//! The model's functions by FMI 2.0 and by FMI 3.0 in one library.

moris_fmi::export_fmi2!(moris_stewart_platform::StewartPlatform);
moris_fmi::export_fmi3!(moris_stewart_platform::StewartPlatform);
