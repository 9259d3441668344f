//! The GUID by which a host matches a model description and a binary.

use alloc::{format, string::String};

use crate::{Causality, Identity, Kind, Model, start_values};

/// The GUID of a model with its own start values.
pub fn guid<M: Model>() -> String {
    guid_of::<M>(&start_values::<M>(&[]))
}

/// The GUID of a model with these start values, one for each slot.
///
/// The GUID is a hash of the model's name, version, variables and the start values that a host can
/// set. A binary refuses a model description if its own interface differs in any of these.
///
/// The outputs' start values are not part of it. Such values are computed, and depend on the host's
/// rounding mode and flushing of small numbers.
pub fn guid_of<M: Model>(start: &[f64]) -> String {
    let identity = M::IDENTITY;
    let mut hash = Fnv::new();
    hash_identity(&mut hash, &identity);
    for (slot, value) in start.iter().enumerate() {
        if matches!(identity.row(slot).causality, Causality::Input | Causality::Parameter) {
            hash.write(&value.to_bits().to_le_bytes());
        }
    }
    let hex = format!("{:032x}", hash.0);
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

fn hash_identity(hash: &mut Fnv, identity: &Identity) {
    hash.write(identity.name.as_bytes());
    hash.write(identity.version.as_bytes());
    for row in identity.rows {
        hash.write(row.name.as_bytes());
        hash.write(&[row.causality as u8, row.variability as u8, row.count as u8]);
        match row.kind {
            Kind::Real(unit) => hash.write(unit.name.as_bytes()),
            Kind::Integer => hash.write(b"Integer"),
            Kind::Boolean => hash.write(b"Boolean"),
            Kind::Enumeration(enumeration) => {
                hash.write(enumeration.name.as_bytes());
                enumeration.items.iter().for_each(|item| hash.write(item.name.as_bytes()));
            }
        }
        if let Some((min, max)) = row.range {
            hash.write(&min.to_bits().to_le_bytes());
            hash.write(&max.to_bits().to_le_bytes());
        }
    }
}

/// The hash function FNV-1a in 128 bits: short, and the same on every platform.
struct Fnv(u128);

impl Fnv {
    fn new() -> Self {
        Fnv(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}
