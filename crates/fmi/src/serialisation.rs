//! A run as bytes that another process can restore: no pointers in them, and nothing
//! in them taken on trust.

use moris_interface::Model;

use crate::{CallError, Guid, InstanceState, Mode, Tables};

/// Marks bytes as a run.
const FORMAT_MARK: [u8; 8] = *b"FMI-RUN\n";
/// To be raised whenever [`InstanceState`] changes.
const FORMAT_VERSION: u32 = 3;

impl<M: Model> InstanceState<M> {
    /// The run as bytes: mark, format, the model's GUID, length and checksum of
    /// the rest, and the rest.
    ///
    /// # Errors
    /// The model cannot be written as bytes.
    pub fn to_bytes(&self, guid: &Guid) -> Result<Vec<u8>, CallError> {
        let body = postcard::to_allocvec(self)
            .map_err(|error| CallError::error(format!("the state cannot be serialized: {error}")))?;
        let length = (body.len() as u64).to_le_bytes();
        let checksum = byte_checksum(&body).to_le_bytes();
        let parts: [&[u8]; 6] = [&FORMAT_MARK, &FORMAT_VERSION.to_le_bytes(), guid, &length, &checksum, &body];
        Ok(parts.concat())
    }

    /// The run that these bytes are, of the model to which the tables belong.
    ///
    /// # Errors
    /// The bytes are anything but what [`InstanceState::to_bytes`] of this very model gave.
    pub fn from_bytes(mut bytes: &[u8], tables: &Tables) -> Result<Self, CallError> {
        let refuse = |why: &str| {
            CallError::error(format!(
                "the serialized state is rejected: {why}; pass bytes from the serialization function of the same FMU"
            ))
        };
        let truncated = || refuse("it is truncated");
        if take_bytes(&mut bytes).ok_or_else(truncated)? != FORMAT_MARK {
            return Err(refuse("it is not the state of an instance"));
        }
        if u32::from_le_bytes(take_bytes(&mut bytes).ok_or_else(truncated)?) != FORMAT_VERSION {
            return Err(refuse("it comes from another version of this FMU"));
        }
        if take_bytes(&mut bytes).ok_or_else(truncated)? != *tables.guid {
            return Err(refuse("it comes from another model, or another version of this one"));
        }
        if u64::from_le_bytes(take_bytes(&mut bytes).ok_or_else(truncated)?) != bytes.len().saturating_sub(8) as u64 {
            return Err(refuse("its length is wrong"));
        }
        if u64::from_le_bytes(take_bytes(&mut bytes).ok_or_else(truncated)?) != byte_checksum(bytes) {
            return Err(refuse("it is damaged"));
        }
        match postcard::take_from_bytes::<Self>(bytes) {
            Ok((run, [])) if run.is_coherent(tables) => Ok(run),
            _ => Err(refuse("its contents are inconsistent")),
        }
    }

    /// Checks that the run can belong to the model of these tables.
    fn is_coherent(&self, tables: &Tables) -> bool {
        let initialized = matches!(self.mode, Mode::StepComplete | Mode::Terminated);
        let slots = tables.start.len();
        self.values.len() == slots
            && self.derivatives.len() == slots
            && (self.model.is_some() || !initialized)
            && self.time.is_finite()
            && self.derivatives.iter().all(|derivative| derivative.is_finite())
            && tables.infos.iter().zip(&self.values).all(|(info, &value)| info.accepts(value))
    }
}

/// The first `N` bytes, which are then gone from `bytes`.
fn take_bytes<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

/// FNV-1a in 64 bits. Each byte's step is one-to-one, so that no change of a
/// single byte goes unnoticed.
fn byte_checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
