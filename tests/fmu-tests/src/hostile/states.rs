//! Saving, restoring, exchanging and damaging states.

use std::ptr::null_mut;

use moris_fmu_host::api::FmuState;

use super::expected::{ERROR, Expected, OK};
use super::functions::Functions;
use super::player::Player;
use super::world::World;

/// A saved state, and what an instance has to be once it is restored.
pub struct Saved {
    pub pointer: FmuState,
    pub expected: Expected,
}

/// A serialized state.
pub struct Bytes {
    bytes: Vec<u8>,
    expected: Expected,
}

/// Number of serialized states that are kept.
const KEPT: usize = 4;

/// One call, or a few, of the functions for states.
pub fn any(world: &mut World, who: usize) -> i32 {
    let some = !world.states.is_empty();
    match world.choices.below(12) {
        0..3 => get(world, who),
        3..6 if some => set(world, who),
        6 if some => free(world, who),
        7..9 if some => serialize(world, who),
        9 if some => too_little_room(world, who),
        10 if !world.bytes.is_empty() => deserialize(world, who),
        11 => wrong_pointers(world, who),
        _ => damaged_bytes(world, who),
    }
}

/// Saving, into a new state or over one that is there.
fn get(world: &mut World, who: usize) -> i32 {
    let over = !world.states.is_empty() && (!world.has_room_for_states() || world.choices.once_in(2));
    if !over {
        world.states.push(Saved { pointer: null_mut(), expected: Expected::fresh() });
    }
    let which = if over { world.choices.below(world.states.len()) } else { world.states.len() - 1 };
    let saved = &mut world.states[which];
    saved.expected = world.players[who].expected.clone();
    // SAFETY: the instance is alive, and so is the state, or it is null.
    let answer = unsafe { world.functions.get_fmu_state(world.players[who].component, &mut saved.pointer) };
    assert!(!saved.pointer.is_null());
    world.accept(who, answer, &[OK])
}

/// Restoring any instance's state; the instance is then to the bit what the other was.
fn set(world: &mut World, who: usize) -> i32 {
    let which = world.choices.below(world.states.len());
    let saved = &world.states[which];
    let player = &mut world.players[who];
    // SAFETY: the instance and the state are alive.
    let answer = unsafe { world.functions.set_fmu_state(player.component, saved.pointer) };
    player.expected = saved.expected.clone();
    if world.choices.once_in(8) {
        let expected = bytes_of(player, world.functions, saved.pointer);
        assert!(player.bytes(world.functions) == expected, "a restored state is another");
    }
    world.accept(who, answer, &[OK])
}

/// Freeing a state.
pub fn free(world: &mut World, who: usize) -> i32 {
    let which = world.choices.below(world.states.len());
    let mut saved = world.states.swap_remove(which);
    // SAFETY: the instance and the state are alive, and nobody uses the state from here on.
    let answer = unsafe { world.functions.free_fmu_state(world.players[who].component, &mut saved.pointer) };
    assert!(saved.pointer.is_null());
    world.accept(who, answer, &[OK])
}

/// A state's bytes, by any instance.
pub fn bytes_of(player: &Player, functions: &Functions, state: FmuState) -> Vec<u8> {
    let mut size = 0;
    // SAFETY: the instance and the state are alive, and there is room for `size` bytes.
    unsafe {
        assert_eq!(functions.serialized_fmu_state_size(player.component, state, &mut size).1, OK);
        let mut bytes = vec![0; size];
        assert_eq!(functions.serialize_fmu_state(player.component, state, bytes.as_mut_ptr(), size).1, OK);
        bytes
    }
}

/// Serialization of a state.
fn serialize(world: &mut World, who: usize) -> i32 {
    let which = world.choices.below(world.states.len());
    let (component, state) = (world.players[who].component, world.states[which].pointer);
    let mut size = 0;
    // SAFETY: the instance and the state are alive.
    let answer = unsafe { world.functions.serialized_fmu_state_size(component, state, &mut size) };
    world.accept(who, answer, &[OK]);
    let mut bytes = vec![0; size];
    // SAFETY: the instance and the state are alive, and there is room for `size` bytes.
    let answer = unsafe { world.functions.serialize_fmu_state(component, state, bytes.as_mut_ptr(), size) };
    if world.bytes.len() == KEPT {
        let oldest = world.choices.below(KEPT);
        world.bytes.swap_remove(oldest);
    }
    world.bytes.push(Bytes { bytes, expected: world.states[which].expected.clone() });
    world.accept(who, answer, &[OK])
}

/// Serialization into less room than it takes.
fn too_little_room(world: &mut World, who: usize) -> i32 {
    let state = world.states[0].pointer;
    let size = bytes_of(&world.players[who], world.functions, state).len();
    let size = world.choices.of(&[0, 1, size / 2, size - 1]);
    // One byte more than none, so that there is a pointer.
    let mut room = vec![0xaa; size + 1];
    // SAFETY: the instance and the state are alive, and there is room for `size` bytes.
    let answer =
        unsafe { world.functions.serialize_fmu_state(world.players[who].component, state, room.as_mut_ptr(), size) };
    assert!(room.iter().all(|&byte| byte == 0xaa), "a refused state was written");
    world.accept(who, answer, &[ERROR])
}

/// Deserialization, into a new state or over one that is there.
fn deserialize(world: &mut World, who: usize) -> i32 {
    let which = world.choices.below(world.bytes.len());
    if world.has_room_for_states() {
        world.states.push(Saved { pointer: null_mut(), expected: Expected::fresh() });
    }
    let (Bytes { bytes, expected }, last) = (&world.bytes[which], world.states.len() - 1);
    let saved = &mut world.states[last];
    saved.expected = expected.clone();
    let (pointer, component) = (&mut saved.pointer, world.players[who].component);
    // SAFETY: the instance is alive, the bytes are as many as given, and the state is alive or null.
    let answer = unsafe { world.functions.deserialize_fmu_state(component, bytes.as_ptr(), bytes.len(), pointer) };
    assert!(bytes_of(&world.players[who], world.functions, *pointer) == *bytes);
    world.accept(who, answer, &[OK])
}

/// Deserialization of bytes that are no state.
fn damaged_bytes(world: &mut World, who: usize) -> i32 {
    let mut bytes = match world.bytes.len() {
        0 => b"FMI-RUN\n".to_vec(),
        count => world.bytes[world.choices.below(count)].bytes.clone(),
    };
    match world.choices.below(4) {
        0 => bytes.truncate(world.choices.below(bytes.len())),
        1 => bytes.push(world.choices.bits() as u8),
        2 => bytes.extend_from_within(..),
        _ => {
            let position = world.choices.below(bytes.len());
            bytes[position] ^= 1 << world.choices.below(8);
        }
    }
    let (mut state, component) = (null_mut(), world.players[who].component);
    // SAFETY: the instance is alive, and the bytes are as many as given.
    let answer = unsafe { world.functions.deserialize_fmu_state(component, bytes.as_ptr(), bytes.len(), &mut state) };
    assert!(state.is_null());
    world.accept(who, answer, &[ERROR])
}

/// Null, and memory that is no state.
fn wrong_pointers(world: &mut World, who: usize) -> i32 {
    let mut no_state = [0x5555_5555_5555_5555u64; 512];
    let null = world.choices.once_in(2);
    let mut pointer: FmuState = if null { null_mut() } else { no_state.as_mut_ptr().cast() };
    let (c, functions, mut size) = (world.players[who].component, world.functions, 0);
    let mut room = [0; 64];
    let function = world.choices.below(6);
    // SAFETY: the instance is alive, and the pointers are null or lead to more memory than a look takes.
    let (answer, right) = unsafe {
        match function {
            0 => (functions.set_fmu_state(c, pointer), ERROR),
            1 => (functions.free_fmu_state(c, &mut pointer), if null { OK } else { ERROR }),
            2 => (functions.serialized_fmu_state_size(c, pointer, &mut size), ERROR),
            3 => (functions.serialize_fmu_state(c, pointer, room.as_mut_ptr(), 64), ERROR),
            4 => (functions.deserialize_fmu_state(c, room.as_ptr(), 64, &mut pointer), ERROR),
            _ => (functions.get_fmu_state(c, null_mut()), ERROR),
        }
    };
    world.accept(who, answer, &[right])
}
