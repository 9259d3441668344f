//! Forged serialized states. Each is refused with a reason, or does no harm.

use moris_fmu_host::{Instance, Status};
use moris_fmu_tests::hostile::Choices;

use crate::fixture::*;

/// Offsets of the parts of a serialized state after its mark: format, GUID, length, checksum, body.
const FORMAT: usize = 8;
const GUID: usize = 12;
const LENGTH: usize = 50;
const CHECKSUM: usize = 58;
const BODY: usize = 66;

/// Makes length and checksum (FNV-1a in 64 bits) those of the body.
fn seal(state: &mut [u8]) {
    let (head, body) = state.split_at_mut(BODY);
    let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let checksum = body.iter().fold(0xcbf2_9ce4_8422_2325, step);
    head[LENGTH..CHECKSUM].copy_from_slice(&(body.len() as u64).to_le_bytes());
    head[CHECKSUM..].copy_from_slice(&checksum.to_le_bytes());
}

fn instance_in_motion() -> (Instance, Vec<u8>) {
    let mut instance = initialized(&[]);
    ride(&mut instance, 0, 100);
    let bytes = bytes(&mut instance);
    (instance, bytes)
}

#[test]
fn a_state_that_is_sealed_again_is_taken() {
    let (mut instance, good) = instance_in_motion();
    let mut bytes = good.clone();
    bytes[LENGTH..BODY].fill(0);
    seal(&mut bytes);
    assert!(bytes == good, "this test knows the format");
    let state = instance.deserialize(&bytes).unwrap();
    assert_eq!(instance.free_state(state), Status::Ok);
}

#[test]
fn a_state_of_another_kind_is_refused_with_the_reason() {
    let (mut instance, good) = instance_in_motion();
    let before = bytes(&mut instance);
    let mut refuse = |bytes: &[u8], reason: &str| {
        assert!(instance.deserialize(bytes).is_err());
        let message = instance.take_messages().pop().unwrap();
        assert_eq!((message.status, message.category.as_str()), (Status::Error, "logStatusError"));
        assert!(message.text.contains(reason), "'{reason}' is not in '{}'", message.text);
    };
    let changed = |at: usize, change: u8| {
        let mut bytes = good.clone();
        bytes[at] ^= change;
        bytes
    };
    refuse(&[], "truncated");
    refuse(&changed(0, 1), "not the state of an instance");
    refuse(&changed(FORMAT, 1), "another version");
    refuse(&changed(GUID + 5, 1), "another model");
    refuse(&changed(LENGTH, 1), "length");
    refuse(&changed(BODY + 100, 1), "damaged");
    for length in [1, FORMAT, GUID, LENGTH, CHECKSUM - 1] {
        refuse(&good[..length], "truncated");
    }
    refuse(&good[..BODY - 1], "length");
    for length in [BODY, BODY + 1, good.len() / 2, good.len() - 1] {
        let mut bytes = good[..length].to_vec();
        refuse(&bytes, "length");
        seal(&mut bytes);
        refuse(&bytes, "inconsistent");
    }
    let mut longer = [&good[..], &[0]].concat();
    seal(&mut longer);
    refuse(&longer, "inconsistent");
    assert!(bytes(&mut instance) == before);
}

/// States of arbitrary bytes with a correct checksum. The instance still returns from every call,
/// and works again after a reset.
#[test]
fn a_forged_state_does_no_harm() {
    let (mut instance, good) = instance_in_motion();
    let mut choices = Choices::Seed(5);
    let mut taken = 0;
    for _ in 0..crate::cases::cases(10_000, 3_000) {
        let mut bytes = good.clone();
        for _ in 0..=choices.below(3) {
            let at = BODY + choices.below(bytes.len() - BODY);
            let any = choices.bits() as u8;
            bytes[at] = choices.of(&[0, 1, 0x7f, 0x80, 0xf0, 0xff, any]);
        }
        seal(&mut bytes);
        let Ok(state) = instance.deserialize(&bytes) else { continue };
        taken += 1;
        assert_eq!(instance.set_state(&state), Status::Ok);
        // The results of these calls depend on the forged bytes. The test is that they return.
        let time = instance.get("time").unwrap_or(0.0);
        instance.do_step(time, 1e-6);
        instance.set("tilt.rateLimit", 0.1).ok();
        instance.exit_initialization_mode();
        instance.get_real_output_derivatives(&[reference("platform.position.x")], &mut [0.0]);
        instance.take_messages();
        assert_eq!(instance.free_state(state), Status::Ok);
    }
    assert!(taken > crate::cases::cases(500, 150), "{taken}");
    assert_eq!(instance.reset(), Status::Ok);
    instance.initialize(&[], None).unwrap();
    ride(&mut instance, 0, 100);
    assert!(self::bytes(&mut instance) == good);
}
