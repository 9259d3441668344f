//! The signature of a library for macOS. The linker signs a library for Apple silicon "ad
//! hoc": the signature is a list of hashes of the file's pages. The system loads no
//! library with a wrong hash.

use sha2::{Digest, Sha256};

/// First bytes of a 64-bit Mach-O file.
const MACH_O: u32 = 0xfeed_facf;
/// The load command that says where the signature is.
const CODE_SIGNATURE: u32 = 0x1d;
/// The part of a signature that has the hashes.
const CODE_DIRECTORY: u32 = 0xfade_0c02;
const SHA_256: u8 = 2;

/// Renews the hashes of the pages after a change of the library; does nothing with a
/// library that has none.
pub fn renew(library: &mut [u8]) {
    for directory in code_directories(library).unwrap_or_default() {
        for page in 0..directory.pages {
            let hash = directory.hash(library, page);
            library[directory.hashes + page * 32..][..32].copy_from_slice(&hash);
        }
    }
}

/// Where the hashes are, and of what.
struct Directory {
    /// Place of the first hash.
    hashes: usize,
    pages: usize,
    page_size: usize,
    /// The end of the pages.
    limit: usize,
}

impl Directory {
    fn hash(&self, library: &[u8], page: usize) -> [u8; 32] {
        let from = page * self.page_size;
        Sha256::digest(&library[from..self.limit.min(from + self.page_size)]).into()
    }
}

/// The directories of a signed library; none of any other file, or of one that ends too early.
fn code_directories(library: &[u8]) -> Option<Vec<Directory>> {
    // Size of the file's header, after which the load commands stand [bytes].
    const HEADER_SIZE: usize = 32;
    let little = |place: usize| library.get(place..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    // A signature's numbers are in the other byte order.
    let big = |place: usize| Some(u32::from_be_bytes(*library.get(place..)?.first_chunk()?) as usize);
    if little(0)? != MACH_O {
        return None;
    }
    let mut command = HEADER_SIZE;
    let mut signature = None;
    for _ in 0..little(16)? {
        if little(command)? == CODE_SIGNATURE {
            signature = Some(little(command + 8)? as usize);
        }
        command += little(command + 4)? as usize;
    }
    let signature = signature?;
    let mut found = Vec::new();
    for part in 0..big(signature + 8)? {
        let place = signature + big(signature + 12 + 8 * part + 4)?;
        if big(place)? != CODE_DIRECTORY as usize {
            continue;
        }
        let directory = Directory {
            hashes: place + big(place + 16)?,
            pages: big(place + 28)?,
            page_size: 1_usize.checked_shl(u32::from(*library.get(place + 39)?))?,
            limit: big(place + 32)?,
        };
        let kind = *library.get(place + 37)?;
        let is_whole = directory.hashes + directory.pages * 32 <= library.len()
            && directory.limit <= library.len()
            && directory.pages == directory.limit.div_ceil(directory.page_size);
        if kind == SHA_256 && is_whole {
            found.push(directory);
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of two and a half pages of 64 bytes with a signature by itself: the layout as
    /// Apple's `cs_blobs.h` has it.
    fn signed() -> Vec<u8> {
        let mut file = vec![7; 160];
        let mut put = |place: usize, bytes: &[u8]| {
            file.resize(file.len().max(place + bytes.len()), 0);
            file[place..place + bytes.len()].copy_from_slice(bytes);
        };
        put(0, &MACH_O.to_le_bytes());
        put(16, &2_u32.to_le_bytes());
        // Another command, then the signature's.
        for (place, word) in [(32, 0x19), (36, 16), (48, CODE_SIGNATURE), (52, 16), (56, 160), (60, 180)] {
            put(place, &u32::to_le_bytes(word));
        }
        // The signature with one part, which begins after 20 bytes: flags, hashes after 44 bytes, three pages, their end.
        let words = [0xfade_0cc0, 180, 1, 0, 20, CODE_DIRECTORY, 160, 0x2_0400, 2, 44, 0, 0, 3, 160];
        words.iter().enumerate().for_each(|(n, word)| put(160 + 4 * n, &u32::to_be_bytes(*word)));
        put(160 + 56, &[32, SHA_256, 0, 6]);
        put(160 + 20 + 44, &[0; 96]);
        file
    }

    #[test]
    fn every_page_has_its_hash() {
        let mut file = signed();
        renew(&mut file);
        let before = file.clone();
        for (page, range) in [0..64, 64..128, 128..160].into_iter().enumerate() {
            assert_eq!(before[224 + 32 * page..][..32], *Sha256::digest(&before[range]));
        }
        file[100] ^= 1;
        renew(&mut file);
        let changed: Vec<usize> = (0..file.len()).filter(|&place| file[place] != before[place]).collect();
        assert!(changed.contains(&100) && changed.len() > 20);
        assert!(changed.iter().all(|place| *place == 100 || (256..288).contains(place)), "{changed:?}");
    }

    #[test]
    fn other_files_stay_as_they_are() {
        for end in [0, 3, 40, 60, 170, 200, 250] {
            let mut file = signed()[..end].to_vec();
            renew(&mut file);
            assert_eq!(file, signed()[..end]);
        }
        let mut library = b"\x7fELF and so on".to_vec();
        renew(&mut library);
        assert_eq!(library, b"\x7fELF and so on");
    }
}
