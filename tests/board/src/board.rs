//! The emulated board: start, semihosting, counts of instructions, and depths of the stack.

use alloc::format;
use alloc::vec::Vec;
use core::arch::asm;
use core::cell::UnsafeCell;
use core::ptr::{addr_of, addr_of_mut};
use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering::Relaxed};

use moris_board::{BUFFER_SIZE, arena};
use moris_washout::Washout;

use crate::ride::{COLUMNS, Drive, ride_all};

unsafe extern "C" {
    /// The stack's first and last address, from the linker script.
    static mut __stack_bottom: u32;
    static mut __stack_top: u32;
}

#[repr(C)]
struct Vectors {
    stack: *const u32,
    reset: extern "C" fn() -> !,
    faults: [extern "C" fn() -> !; 14],
}

// SAFETY: nothing writes it.
unsafe impl Sync for Vectors {}

#[unsafe(link_section = ".vectors")]
#[used]
static VECTORS: Vectors = Vectors { stack: addr_of!(__stack_top), reset, faults: [fault; 14] };

/// Rows that fit.
const MAX_ROWS: usize = 8000;

/// Memory that one thread uses.
struct Memory<T>(UnsafeCell<T>);

// SAFETY: there is one thread.
unsafe impl<T> Sync for Memory<T> {}

static NUMBERS: Memory<[f64; 1 + MAX_ROWS * COLUMNS]> = Memory(UnsafeCell::new([0.0; 1 + MAX_ROWS * COLUMNS]));
const HEAP: usize = 1 << 20;
static HEAP_MEMORY: Memory<[u64; HEAP / 8]> = Memory(UnsafeCell::new([0; HEAP / 8]));
static BUFFER: Memory<[u64; BUFFER_SIZE / 8]> = Memory(UnsafeCell::new([0; BUFFER_SIZE / 8]));

/// Word that the unused stack and the unused buffer are filled with.
const UNUSED: u32 = 0x5afe_57ac;
const SYSTICK_CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
const SYSTICK_RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
const SYSTICK_NOW: *mut u32 = 0xe000_e018 as *mut u32;
const COPROCESSOR_ACCESS: *mut u32 = 0xe000_ed88 as *mut u32;
/// Instructions to a tick of 25 MHz, where an instruction takes 1 ns.
const INSTRUCTIONS_PER_TICK: u32 = 40;
const TICKS: u32 = 0x00ff_ffff;

extern "C" fn reset() -> ! {
    // SAFETY: the registers are the processor's, and the stack below this function is unused.
    unsafe {
        COPROCESSOR_ACCESS.write_volatile(COPROCESSOR_ACCESS.read_volatile() | 0xf << 20);
        asm!("dsb", "isb");
        SYSTICK_RELOAD.write_volatile(TICKS);
        SYSTICK_NOW.write_volatile(0);
        SYSTICK_CONTROL.write_volatile(5);
    }
    start()
}

#[inline(never)]
fn start() -> ! {
    ride_all(&read_drive());
    exit(true)
}

extern "C" fn fault() -> ! {
    print("fault\n");
    exit(false)
}

fn semihost(operation: usize, argument: *const usize) -> usize {
    let result;
    // SAFETY: the emulator answers, and writes only where the argument says.
    unsafe { asm!("bkpt 0xab", inlateout("r0") operation => result, in("r1") argument) };
    result
}

fn exit(well: bool) -> ! {
    semihost(0x18, (if well { 0x20026_usize } else { 0x20023 }) as *const usize);
    loop {
        core::hint::spin_loop();
    }
}

pub fn print(text: &str) {
    let text = format!("{text}\0");
    semihost(0x04, text.as_ptr().cast());
}

fn read_drive() -> Drive {
    let name = c"drive.bin";
    let file = semihost(0x01, [name.as_ptr() as usize, 1, name.count_bytes()].as_ptr());
    let numbers = NUMBERS.0.get();
    let size = size_of_val(&NUMBERS);
    let left = semihost(0x06, [file, numbers as usize, size].as_ptr());
    let rows = (size - left) / 8 / COLUMNS;
    // SAFETY: nothing else uses the numbers.
    let numbers: &'static [f64] = unsafe { &*numbers };
    Drive { step: numbers[0], rows: numbers[1..].as_chunks().0.split_at(rows).0 }
}

static FILLED_FROM: AtomicUsize = AtomicUsize::new(0);
static STACK_OF_CREATION: AtomicUsize = AtomicUsize::new(0);
static BUFFER_USED: AtomicUsize = AtomicUsize::new(0);
static SUM: AtomicU32 = AtomicU32::new(0);
static MOST: AtomicU32 = AtomicU32::new(0);
static COUNT: AtomicU32 = AtomicU32::new(0);

/// Fills the unused stack, from which on its depth counts.
#[inline(never)]
pub fn fill_stack() {
    let end: *mut u32;
    // SAFETY: it reads the stack pointer.
    unsafe { asm!("mov {}, sp", out(reg) end) };
    FILLED_FROM.store(end.addr(), Relaxed);
    let mut word = addr_of_mut!(__stack_bottom);
    while word < end {
        // SAFETY: the stack is unused so far below.
        unsafe { word.write_volatile(UNUSED) };
        word = word.wrapping_add(1);
    }
}

/// Bytes of the stack that have been used at its deepest since it was filled.
fn stack_depth() -> usize {
    let (mut word, top) = (addr_of!(__stack_bottom), addr_of!(__stack_top));
    // SAFETY: the words are the stack's.
    while word < top && unsafe { word.read_volatile() } == UNUSED {
        word = word.wrapping_add(1);
    }
    FILLED_FROM.load(Relaxed).saturating_sub(word.addr())
}

/// Empties the heap of this program: what was in it is gone.
pub fn open_heap() {
    // SAFETY: nothing else uses the memory.
    unsafe { arena::open_memory(HEAP_MEMORY.0.get().cast(), HEAP) };
}

/// Makes a washout in the buffer, and notes how much of the buffer and of the stack that took.
pub fn create(make: impl FnOnce(*mut u8, usize) -> *mut Washout) -> *mut Washout {
    for count in [&SUM, &MOST, &COUNT] {
        count.store(0, Relaxed);
    }
    let words: *mut u32 = BUFFER.0.get().cast();
    // SAFETY: the words are the buffer's, which no washout uses any more.
    (0..BUFFER_SIZE / 4).for_each(|k| unsafe { words.add(k).write_volatile(UNUSED) });
    fill_stack();
    let washout = make(words.cast(), BUFFER_SIZE);
    STACK_OF_CREATION.store(stack_depth(), Relaxed);
    // SAFETY: as above.
    let used = (0..BUFFER_SIZE / 4).rfind(|&k| unsafe { words.add(k).read_volatile() } != UNUSED);
    BUFFER_USED.store(used.map_or(0, |last| 4 * (last + 1)), Relaxed);
    washout
}

/// A copy of the buffer: the state of its washout.
pub fn saved_buffer() -> Vec<u64> {
    // SAFETY: the buffer is not written meanwhile.
    unsafe { (*BUFFER.0.get()).to_vec() }
}

/// Writes a copy back into the buffer.
pub fn restore_buffer(saved: &[u64]) {
    // SAFETY: nothing refers into the buffer meanwhile.
    unsafe { (*BUFFER.0.get()).copy_from_slice(saved) };
}

fn ticks() -> u32 {
    // SAFETY: the register is the processor's.
    unsafe { SYSTICK_NOW.read_volatile() }
}

/// Counts the instructions of a step.
#[inline(never)]
pub fn measured(step: impl FnOnce()) {
    let before = ticks();
    step();
    let taken = before.wrapping_sub(ticks()) & TICKS;
    SUM.store(SUM.load(Relaxed) + taken, Relaxed);
    MOST.store(MOST.load(Relaxed).max(taken), Relaxed);
    COUNT.store(COUNT.load(Relaxed) + 1, Relaxed);
}

pub fn report(name: &str) {
    let [sum, most, count] = [&SUM, &MOST, &COUNT].map(|count| count.load(Relaxed));
    let mean = u64::from(sum) * u64::from(INSTRUCTIONS_PER_TICK) / u64::from(count.max(1));
    let stacks = [STACK_OF_CREATION.load(Relaxed), stack_depth()];
    let buffer = BUFFER_USED.load(Relaxed);
    print(&format!(
        "# {name}: instructions a step {mean} mean {} most, buffer {buffer} B, stack {} B to make {} B to step\n",
        most * INSTRUCTIONS_PER_TICK,
        stacks[0],
        stacks[1],
    ));
}
