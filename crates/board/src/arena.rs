//! The memory that a washout is made in: a piece of the caller's, handed out from its start on.
//!
//! A washout allocates only while it is made. Copying the piece copies the whole state.

use core::alloc::{GlobalAlloc, Layout};
use core::ptr;
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Addresses of the free part: its start and its end, equal where there is none.
struct Arena {
    start: AtomicUsize,
    end: AtomicUsize,
}

#[global_allocator]
static ARENA: Arena = Arena { start: AtomicUsize::new(0), end: AtomicUsize::new(0) };

/// Takes allocations from this piece of memory.
///
/// # Safety
/// The piece has as many bytes, nothing else uses it, and no interrupt allocates.
pub unsafe fn open_memory(piece: *mut u8, size: usize) {
    let start = piece.expose_provenance();
    ARENA.start.store(start, Relaxed);
    ARENA.end.store(start + size, Relaxed);
}

/// Refuses further allocations.
pub fn close_memory() {
    ARENA.end.store(ARENA.start.load(Relaxed), Relaxed);
}

// SAFETY: each allocation is a part of the piece of its own, aligned as asked.
unsafe impl GlobalAlloc for Arena {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let begin = self.start.load(Relaxed).next_multiple_of(layout.align());
        let (Some(after), end) = (begin.checked_add(layout.size()), self.end.load(Relaxed)) else {
            return ptr::null_mut();
        };
        if after > end {
            return ptr::null_mut();
        }
        self.start.store(after, Relaxed);
        ptr::with_exposed_provenance_mut(begin)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // The latest allocation alone can be given back.
        let begin = block.addr();
        if begin + layout.size() == self.start.load(Relaxed) {
            self.start.store(begin, Relaxed);
        }
    }
}
