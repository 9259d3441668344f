//! Lines in bytes that come in parts.

/// The beginning of a line whose end has not come yet.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    begun: Vec<u8>,
    is_too_long: bool,
}

impl Lines {
    /// Takes some bytes, and gives the lines that end with them.
    pub fn take(&mut self, bytes: &[u8], mut line: impl FnMut(&[u8])) {
        // Longest line [bytes]; a longer one is dropped.
        const MAX_LINE_LENGTH: usize = 512;
        for byte in bytes {
            if matches!(byte, b'\n' | b'\r') {
                if !self.is_too_long && !self.begun.is_empty() {
                    line(&self.begun);
                }
                self.begun.clear();
                self.is_too_long = false;
            } else if self.begun.len() < MAX_LINE_LENGTH {
                self.begun.push(*byte);
            } else {
                self.is_too_long = true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_whole_however_they_come() {
        let text = [b"\xFFlegs,1\r\n\nlegs,2\n", &[b'x'; 600][..], b"\nlegs,3\nlegs"].concat();
        for part in [1, 2, 7, 1000] {
            let mut lines = Lines::default();
            let mut found: Vec<Vec<u8>> = Vec::new();
            text.chunks(part).for_each(|bytes| lines.take(bytes, |line| found.push(line.to_vec())));
            assert_eq!(found, [&b"\xFFlegs,1"[..], b"legs,2", b"legs,3"], "{part}");
        }
    }
}
