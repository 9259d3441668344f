//! The place in a shared library where its start values stand. A packing program writes them into
//! the library's file, and the library reads them when it makes its first instance.
//!
//! The place is one piece of constant data: the mark, then numbers of eight bytes in
//! little-endian order. The numbers are the format, the number of slots, a checksum of the rest,
//! and the start value of each slot.

use std::ptr;

use crate::CallError;

/// Beginning of the place, by which a packing program finds it.
const SECTION_MARK: [u8; 16] = *b"moris-start-here";
/// To be raised whenever the layout changes.
const LAYOUT_VERSION: u64 = 1;
/// In place of a value: the model's own. As a value it would be no number.
const MODEL_START_VALUE: u64 = u64::MAX;
/// Size of what precedes the values \[bytes\].
const HEADER_SIZE: usize = SECTION_MARK.len() + 3 * size_of::<u64>();

/// Start values by slot, each a slot and its value.
pub type Overrides = Vec<(usize, f64)>;

/// The place in a library whose model has `N` slots. The export macros make one static of it.
#[repr(C)]
pub struct StartSection<const N: usize> {
    mark: [u8; 16],
    format: u64,
    slots: u64,
    checksum: u64,
    values: [u64; N],
}

impl<const N: usize> StartSection<N> {
    /// The model's own start values.
    pub const fn own() -> Self {
        let values = [MODEL_START_VALUE; N];
        let (format, slots) = (LAYOUT_VERSION.to_le(), (N as u64).to_le());
        StartSection { mark: SECTION_MARK, format, slots, checksum: word_checksum(&values).to_le(), values }
    }

    /// The values in place of the model's own, as they are in the library's file.
    ///
    /// # Errors
    /// The values are damaged.
    pub(crate) fn read(&self) -> Result<Overrides, CallError> {
        // SAFETY: a reference is valid for reads. The read is volatile, because the compiler must not take the
        // values for those with which it compiled the library.
        let word = |word: &u64| u64::from_le(unsafe { ptr::read_volatile(word) });
        let values = self.values.each_ref().map(word);
        if word(&self.checksum) != word_checksum(&values) {
            return Err(CallError::error(
                "the start values in the shared library are damaged; unpack the FMU again, or pack it again",
            ));
        }
        Ok(section_overrides(values))
    }
}

/// Errors of the start values in a library's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectionError {
    /// The library has no place for start values.
    Missing,
    /// The library is of another version of this program, or of a model with other variables.
    Version,
    /// The values do not have their checksum.
    Damaged,
}

/// The start values in a library's file, in place of those of its model, which has this many slots.
///
/// # Errors
/// The library has no place for them, one of another version, or damaged values.
pub fn embedded(library: &[u8], slots: usize) -> Result<Overrides, SectionError> {
    let first = *section_places(library, slots)?.first().ok_or(SectionError::Missing)?;
    let words = &library[first + HEADER_SIZE..][..slots * size_of::<u64>()];
    let values: Vec<u64> = words.as_chunks().0.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect();
    let stated =
        library[first + HEADER_SIZE - size_of::<u64>()..].first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    if stated == Some(word_checksum(&values)) { Ok(section_overrides(values)) } else { Err(SectionError::Damaged) }
}

/// Writes start values into a library's file, in place of those that are there.
///
/// # Errors
/// As [`embedded`], but for damaged values, which are replaced.
///
/// # Panics
/// A value is of no slot.
pub fn embed(library: &mut [u8], slots: usize, start: &[(usize, f64)]) -> Result<(), SectionError> {
    let mut values = vec![MODEL_START_VALUE; slots];
    for &(slot, value) in start {
        values[slot] = value.to_bits();
    }
    let words: Vec<u8> = [word_checksum(&values)].iter().chain(&values).flat_map(|word| word.to_le_bytes()).collect();
    // One for each version of FMI that the library exports.
    for place in section_places(library, slots)? {
        let from = place + HEADER_SIZE - size_of::<u64>();
        library[from..from + words.len()].copy_from_slice(&words);
    }
    Ok(())
}

/// Where in the file the places begin.
fn section_places(library: &[u8], slots: usize) -> Result<Vec<usize>, SectionError> {
    let is_mark = |&place: &usize| library[place..].starts_with(&SECTION_MARK);
    let places: Vec<usize> = (0..library.len()).filter(is_mark).collect();
    if places.is_empty() {
        return Err(SectionError::Missing);
    }
    let head: Vec<u8> =
        [SECTION_MARK.to_vec(), LAYOUT_VERSION.to_le_bytes().to_vec(), (slots as u64).to_le_bytes().to_vec()].concat();
    let is_whole = |&place: &usize| {
        library[place..].starts_with(&head) && library.len() - place >= HEADER_SIZE + slots * size_of::<u64>()
    };
    if places.iter().all(is_whole) { Ok(places) } else { Err(SectionError::Version) }
}

/// The values that are not the model's own.
fn section_overrides(values: impl IntoIterator<Item = u64>) -> Overrides {
    let of_slot = |(slot, value)| (value != MODEL_START_VALUE).then_some((slot, f64::from_bits(value)));
    values.into_iter().enumerate().filter_map(of_slot).collect()
}

/// FNV-1a in 64 bits, word by word. Each word's step is one-to-one, so that no change of a
/// single word goes unnoticed.
const fn word_checksum(values: &[u64]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut slot = 0;
    while slot < values.len() {
        hash = (hash ^ values[slot]).wrapping_mul(0x0000_0100_0000_01b3);
        slot += 1;
    }
    hash
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLOTS: usize = 5;
    static SECTION: StartSection<SLOTS> = StartSection::own();

    /// A library that is nothing but the place, with something around it.
    fn library() -> Vec<u8> {
        let words = [LAYOUT_VERSION, SLOTS as u64, word_checksum(&[MODEL_START_VALUE; SLOTS])]
            .into_iter()
            .chain([MODEL_START_VALUE; SLOTS]);
        let place: Vec<u8> = SECTION_MARK.into_iter().chain(words.flat_map(u64::to_le_bytes)).collect();
        [b"before".to_vec(), place, b"after".to_vec()].concat()
    }

    #[test]
    fn values_survive_to_the_bit() {
        let values = vec![(0, 0.1 + 0.2), (2, -0.0), (3, 5e-324), (4, f64::MAX)];
        let mut library = library();
        assert_eq!(embedded(&library, SLOTS), Ok(vec![]));
        embed(&mut library, SLOTS, &values).unwrap();
        let read = embedded(&library, SLOTS).unwrap();
        let bits = |values: &Overrides| values.iter().map(|&(slot, value)| (slot, value.to_bits())).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&values));
        assert!(library.starts_with(b"before") && library.ends_with(b"after"));
        // Values are replaced, not added.
        embed(&mut library, SLOTS, &[]).unwrap();
        assert_eq!(library, self::library());
    }

    #[test]
    fn the_compiled_place_is_as_a_packing_program_reads_it() {
        assert_eq!(SECTION.read(), Ok(vec![]));
        assert_eq!(size_of_val(&SECTION), HEADER_SIZE + SLOTS * size_of::<u64>());
        let damaged = StartSection::<SLOTS> { checksum: 1, ..StartSection::own() };
        assert!(damaged.read().unwrap_err().text.contains("damaged"));
    }

    #[test]
    fn what_is_no_such_place_is_refused() {
        let mut library = library();
        assert_eq!(embedded(b"no library", SLOTS), Err(SectionError::Missing));
        assert_eq!(embedded(&library, SLOTS + 1), Err(SectionError::Version));
        assert_eq!(embedded(&library[..library.len() - 6], SLOTS), Err(SectionError::Version));
        for byte in 6 + HEADER_SIZE..library.len() - 5 {
            library[byte] ^= 0x10;
            assert_eq!(embedded(&library, SLOTS), Err(SectionError::Damaged), "{byte}");
            library[byte] ^= 0x10;
        }
        library[6 + SECTION_MARK.len()] = 2;
        assert_eq!(embedded(&library, SLOTS), Err(SectionError::Version));
    }
}
