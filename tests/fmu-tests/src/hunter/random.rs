//! Random numbers from a seed, the same on every machine.

/// Sebastiano Vigna's SplitMix64.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Begins the sequence of this seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// The sequence number `index` of a family of sequences.
    pub fn numbered(seed: u64, index: u64) -> Self {
        Random(mixed(mixed(seed) ^ index.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mixed(self.0)
    }

    /// Uniform from 0 to 1, without 1.
    pub fn fraction(&mut self) -> f64 {
        fraction(self.bits())
    }

    /// Uniform from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    /// Log-uniform from `low` to `high`, both positive.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.fraction())
    }

    /// Log-uniform with tails: from `low` to `high` mostly, from `lowest` to
    /// `highest` in one of six cases.
    pub fn log_with_tails(&mut self, [lowest, low, high, highest]: [f64; 4]) -> f64 {
        if self.chance(1.0 / 6.0) { self.log_between(lowest, highest) } else { self.log_between(low, high) }
    }

    /// Uniform from 0 to `count` - 1.
    pub fn below(&mut self, count: usize) -> usize {
        (self.fraction() * count as f64) as usize
    }

    /// Uniform from `low` to `high`, both included.
    pub fn integer(&mut self, low: usize, high: usize) -> usize {
        low + self.below(high - low + 1)
    }

    /// One of these.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// True in this fraction of the cases.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.fraction() < probability
    }

    /// A seed that a TOML file can hold.
    pub fn seed(&mut self) -> u32 {
        (self.bits() >> 32) as u32
    }
}

/// Random bits for step number `index` of a sequence, in no order.
pub fn bits_at(seed: u32, index: usize) -> u64 {
    mixed(mixed(u64::from(seed) + 0x51) ^ (index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// Uniform from 0 to 1, without 1, for step number `index` of a sequence.
pub fn fraction_at(seed: u32, index: usize) -> f64 {
    fraction(bits_at(seed, index))
}

fn fraction(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

fn mixed(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
