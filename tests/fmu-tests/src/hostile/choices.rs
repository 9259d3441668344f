//! Where a hostile host's decisions come from: a seed, or the bytes of a fuzzer.

/// A source of decisions.
pub enum Choices<'a> {
    /// SplitMix64 with this state: without end, and the same on every machine.
    Seed(u64),
    /// A fuzzer's bytes; when they are used up, every decision is the first one.
    Bytes(&'a [u8]),
}

impl Choices<'_> {
    /// True if the choices are used up.
    pub fn are_over(&self) -> bool {
        matches!(self, Choices::Bytes([]))
    }

    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        match self {
            Choices::Seed(state) => {
                *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                z ^ (z >> 31)
            }
            Choices::Bytes(_) => (0..8).fold(0, |bits, _| bits << 8 | u64::from(self.byte())),
        }
    }

    /// One of the numbers below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        match self {
            Choices::Seed(_) => (self.bits() % count as u64) as usize,
            Choices::Bytes(_) if count <= 256 => usize::from(self.byte()) % count,
            Choices::Bytes(_) => (usize::from(self.byte()) << 8 | usize::from(self.byte())) % count,
        }
    }

    /// True once in `count` times.
    pub fn once_in(&mut self, count: usize) -> bool {
        self.below(count) == count - 1
    }

    /// One of the options.
    pub fn of<T: Copy>(&mut self, options: &[T]) -> T {
        options[self.below(options.len())]
    }

    /// A number from 0 to 1.
    pub fn fraction(&mut self) -> f64 {
        self.below(65536) as f64 / 65535.0
    }

    fn byte(&mut self) -> u8 {
        let Choices::Bytes(bytes) = self else { return self.bits() as u8 };
        let Some((first, rest)) = bytes.split_first() else { return 0 };
        *bytes = rest;
        *first
    }
}
