//! Frames written out by hand from each device's layout.

use std::fs;
use std::path::Path;

use moris_live::frame::{Encoder, Frames, Message, SHIPPED_FRAMES, Values};
use moris_live::{Session, Settings, shipped};
use moris_washout::interface::RollPitchYaw;
use moris_washout::motion::orientation::Orientation;
use moris_washout::{Parameters, Rig};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Legs at 0, 1/4, 1/2, 3/4 and 1 of a stroke. One is beyond it.
const LENGTH: [f64; 6] = [1.0, 1.15, 1.3, 1.45, 1.6, 9.0];

fn frame(text: &str) -> Vec<u8> {
    let encoder = Encoder::new(&text.parse::<Frames>().unwrap(), &Rig::default()).unwrap();
    let mut out = vec![1, 2, 3];
    encoder.write(Message::Frame, &Values { length: LENGTH, ..Values::default() }, &mut out);
    out
}

#[test]
fn amc_aasd15a() {
    // 16 bits, big-endian: 0, 16384 (of 16383.75), 32768 (of 32767.5), 49151, 65535, 65535.
    let expected =
        [0xFF, 0xFF, 0x00, 0x00, 0x40, 0x00, 0x80, 0x00, 0xBF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0x0A, 0x0D];
    assert_eq!(frame(shipped(SHIPPED_FRAMES, "amc-aasd15a").unwrap()), expected);
}

#[test]
fn motion4sim() {
    let expected = [
        0xFF, 0xFF, 0x00, 0x00, 0x00, 0x40, 0x00, 0x00, 0x80, 0x00, 0x00, 0xBF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,
        0xFF, 0xFF, 0, 0, 0, 0x0A, 0x0D,
    ];
    assert_eq!(frame(shipped(SHIPPED_FRAMES, "motion4sim").unwrap()), expected);
}

#[test]
fn bff() {
    let expected = [b'B', b'C', 0, 0x00, 0x40, 0x80, 0xBF, 0xFF, 0xFF, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0x0D];
    assert_eq!(frame(shipped(SHIPPED_FRAMES, "bff").unwrap()), expected);
}

#[test]
fn simtools() {
    assert_eq!(frame(shipped(SHIPPED_FRAMES, "simtools").unwrap()), b"0,16384,32768,49151,65535,65535X");
}

/// The pose that OpenXR-MotionCompensation makes of a frame, in the axes x forward, y left, z up.
/// The displacement is turned by yaw, pitch and roll, in this order.
fn seen(frame: &[u8]) -> Isometry3<f64> {
    let numbers: Vec<f64> = frame.chunks(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
    let [sway, surge, heave, yaw, roll, pitch] = numbers[..] else { panic!("{numbers:?}") };
    // Sway to the right, pitch with the nose up.
    let own = Vector3::new(surge, -sway, heave) * 1e-3;
    let about = |axis, degrees: f64| UnitQuaternion::from_axis_angle(&axis, degrees.to_radians());
    let rotation = about(Vector3::z_axis(), yaw) * about(Vector3::y_axis(), -pitch) * about(Vector3::x_axis(), roll);
    Isometry3::from_parts((rotation * own).into(), rotation)
}

#[test]
fn vr_pose_gives_the_headset_the_pose_of_the_platform() {
    let encoder = Encoder::new(&shipped(SHIPPED_FRAMES, "vr-pose").unwrap().parse().unwrap(), &Rig::default()).unwrap();
    let mut session = Session::new(&Parameters::default(), &Settings::default()).unwrap();
    let neutral = session.washout().parameters().rig.neutral_height;
    let mut commands = *session.step();
    let mut out = Vec::new();
    for (position, angles) in [
        ([0.1, -0.2, 0.03], [0.0, 0.0, 0.0]),
        ([0.1, -0.2, 0.03], [0.3, -0.25, 0.125]),
        ([-0.05, 0.02, -0.1], [-0.1, 0.4, 1.2]),
    ] {
        let [roll, pitch, yaw] = angles;
        let place = Vector3::from(position);
        commands.pose.position = place + Vector3::z() * neutral;
        commands.pose.orientation = Orientation::new(RollPitchYaw::new(roll, pitch, yaw));
        commands.heave = place.z;
        encoder.write(Message::Frame, &Values::from(&commands), &mut out);
        assert_eq!(out.len(), 48);
        let platform = Isometry3::from_parts(place.into(), UnitQuaternion::from_euler_angles(roll, pitch, yaw));
        // A point of the world, seen from the platform, and back through what the headset receives.
        for point in [Point3::new(0.0, 0.0, 1.2), Point3::new(30.0, -4.0, 1.0)] {
            let view = platform.inverse_transform_point(&point);
            assert!((seen(&out).transform_point(&view) - point).norm() < 1e-9, "{position:?} {angles:?}");
        }
    }
    // The signs by themselves: to the left is a negative sway, nose down a negative pitch.
    let values = Values { own: [0.1, 0.2, 0.03], pose: [0.0, 0.0, 0.0, 0.1, 0.2, 0.3], ..Values::default() };
    encoder.write(Message::Frame, &values, &mut out);
    let numbers: Vec<f64> = out.chunks(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
    for (found, expected) in numbers.iter().zip([-200.0, 100.0, 30.0, 17.188_734, 5.729_578, -11.459_156]) {
        assert!((found - expected).abs() < 1e-5, "{numbers:?}");
    }
}

#[test]
fn numbers_of_a_template_have_their_width_and_order() {
    let encoder = |frame: &str| Encoder::new(&format!("{TEMPLATE}frame = '{frame}'").parse().unwrap(), &Rig::default());
    let mut out = Vec::new();
    encoder("x:f32 x:f32le*2 x:f64*-0.5").unwrap().write(
        Message::Frame,
        &Values { pose: [1.0; 6], ..Values::default() },
        &mut out,
    );
    assert_eq!(out, [0x3F, 0x80, 0, 0, 0, 0, 0, 0x40, 0xBF, 0xE0, 0, 0, 0, 0, 0, 0]);
    for wrong in ["x:f16", "x:f64*inf", "x:f64*", "leg1:f64", "x:f64be"] {
        assert!(format!("{TEMPLATE}frame = '{wrong}'").parse::<Frames>().is_err(), "{wrong}");
    }
}

/// Arms of 0.1 m: 30 and -45 degrees, level, 12, -6 and 60 degrees.
#[test]
fn angles_of_cranks_have_zeros_directions_and_units() {
    let arms = [30.0, -45.0, 0.0, 12.0, -6.0, 60.0_f64];
    let rig = Rig { crank_arm: 0.1, ..Rig::default() };
    let values = Values { length: arms.map(|degrees| 0.1 * degrees.to_radians()), ..Values::default() };
    let scales =
        "zero-degrees = [0, 90, 90, 0, 2.5, 0]\nreversed = [2, 4]\npulse-per-degree = 10\nsteps-per-turn = 7200\n";
    let template = |frame: &str| format!("{TEMPLATE}{scales}frame = \"{frame}\"").parse::<Frames>().unwrap();
    let sent = |frame: &str| {
        let mut out = Vec::new();
        Encoder::new(&template(frame), &rig).unwrap().write(Message::Frame, &values, &mut out);
        out
    };
    let line = |unit: &str, form: &str| {
        let fields: Vec<String> = (1..=6).map(|crank| format!("{unit}{crank}:{form}")).collect();
        String::from_utf8(sent(&fields.join(" ',' "))).unwrap()
    };
    // The motor's angle: 0 + 30, 90 + 45, 90 + 0, 0 - 12, 2.5 - 6, 0 + 60.
    assert_eq!(line("degrees", "1"), "30.0,135.0,90.0,-12.0,-3.5,60.0");
    assert_eq!(line("radians", "4"), "0.5236,2.3562,1.5708,-0.2094,-0.0611,1.0472");
    assert_eq!(line("pulse", "0"), "1800,2850,2400,1380,1465,2100");
    // Twenty steps a degree.
    assert_eq!(line("steps", "0"), "600,2700,1800,-240,-70,1200");
    // A quarter of a microsecond, and signed steps.
    assert_eq!(sent("pulse1:u16*4 steps5:i16le"), [0x1C, 0x20, 0xBA, 0xFF]);
    let encoder = Encoder::new(&template("degrees1:1"), &rig).unwrap();
    assert!(encoder.moves_actuators());
    for report in [
        "degrees,30,135,90,-12,-3.5,60",
        "pulse,1800,2850,2400,1380,1465,2100",
        "{\"steps\":[600,2700,1800,-240,-70,1200]}",
    ] {
        let arcs = encoder.reported(report.as_bytes()).unwrap();
        assert!((0..6).all(|k| (arcs[k] - values.length[k]).abs() < 1e-12), "{report}: {arcs:?}");
    }
    assert_eq!(encoder.reported(b"legs,0.01,0.02,0,0,0,0"), Some([0.01, 0.02, 0.0, 0.0, 0.0, 0.0]));
    let refused = |template: &Frames, rig: &Rig| Encoder::new(template, rig).unwrap_err().to_string();
    assert!(refused(&template("degrees1:1"), &Rig::default()).contains("use length1 or leg1"));
    for (token, key) in [("pulse3:0", "pulse-per-degree"), ("steps3:0", "steps-per-turn")] {
        let reason = format!("{TEMPLATE}frame = '{token}'").parse::<Frames>().unwrap_err().to_string();
        assert!(reason.contains(key), "{reason}");
    }
    for wrong in ["degrees7:1", "degrees0:1", "degrees:1", "pulse1:dec"] {
        assert!(format!("{TEMPLATE}{scales}frame = '{wrong}'").parse::<Frames>().is_err(), "{wrong}");
    }
}

#[test]
fn text() {
    let line = String::from_utf8(frame(shipped(SHIPPED_FRAMES, "csv").unwrap())).unwrap();
    assert!(line.starts_with("0.000,1.000000,1.150000,") && line.ends_with(",0.000000\n"), "{line}");
    assert_eq!(line.split(',').count(), 22);
    let object: serde_json::Value = serde_json::from_slice(&frame(shipped(SHIPPED_FRAMES, "json").unwrap())).unwrap();
    assert_eq!(object["length"][1], 1.15);
    assert_eq!(object["force"].as_array().unwrap().len(), 3);
}

const TEMPLATE: &str = "name = 'own'\nabout = ''\nnote = ''\n";

#[test]
fn reversed_legs_and_other_ranges() {
    let own = |rest: &str| frame(&format!("{TEMPLATE}{rest}"));
    assert_eq!(
        own("range = [1000, 2000]\nreversed = [2]\nframe = 'leg1:dec leg2:dec leg3:u16le 0A'"),
        b"10001750\xDC\x05\n"
    );
    assert_eq!(own("range = [255, 0]\nframe = 'leg1:u8 leg4:u8 leg5:u8'"), [255, 64, 0]);
    assert_eq!(own("frame = 'leg4:u32'\nrange = [0, 4294967295]"), [0xBF, 0xFF, 0xFF, 0xFF]);
    assert_eq!(own("frame = \"'a b'FF'c'\""), b"a b\xFFc");
}

#[test]
fn templates_that_make_no_sense_are_refused() {
    for (rest, reason) in [
        ("frame = 'leg7:u16'", "leg7:u16"),
        ("frame = 'leg1:u17'", "leg1:u17"),
        ("frame = 'F'", "the token F"),
        ("frame = 'FFF'", "the token FFF"),
        ("frame = 'length1:99'", "length1:99"),
        ("frame = \"'open\"", "'open"),
        ("frame = ''\nstop = 'rest:1'", "rest:1"),
        ("frame = ''\ninterval = 0", "interval"),
        ("frame = ''\ntime-out = 11", "time-out"),
        ("frame = ''\nslow-start = 2", "slow-start"),
        ("frame = ''\nask = 'legs:1'", "legs:1"),
        ("frame = ''\nreversed = [0]", "reversed"),
        ("frame = ''\nrange = [0, 9000000000000]", "range"),
    ] {
        let error = format!("{TEMPLATE}{rest}").parse::<Frames>().unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}

/// A rig for the frames of this name: those of servos have angles of cranks.
fn rig_for(name: &str) -> Rig {
    Rig { crank_arm: if name == "servos" { 0.1 } else { 0.0 }, ..Rig::default() }
}

#[test]
fn every_template_is_listed_and_says_whether_it_moves_actuators_and_how_a_controller_is_asked() {
    let page = include_str!("../../../../docs/live-reference.md");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/frame/tables");
    assert_eq!(fs::read_dir(folder).unwrap().count(), SHIPPED_FRAMES.len());
    for &(name, text) in SHIPPED_FRAMES {
        let frames: Frames = text.parse().unwrap();
        assert!(page.lines().any(|line| line == format!("{name:<14} {}", frames.about)), "{name}");
        let encoder = Encoder::new(&frames, &rig_for(name)).unwrap();
        assert_eq!(encoder.moves_actuators(), name != "vr-pose", "{name}");
        assert_eq!(encoder.asks(), ["csv", "json"].contains(&name), "{name}");
        assert_eq!(frames.slow_start.is_some(), ["csv", "json"].contains(&name), "{name}");
    }
    let encoder = Encoder::new(&shipped(SHIPPED_FRAMES, "csv").unwrap().parse().unwrap(), &Rig::default()).unwrap();
    let mut out = Vec::new();
    encoder.write(Message::Ask, &Values::default(), &mut out);
    assert_eq!(out, b"legs?\n");
}

proptest! {
    #[test]
    fn any_values_are_encoded_without_a_panic(length in prop::array::uniform6(any::<f64>()), time in any::<f64>()) {
        for &(name, text) in SHIPPED_FRAMES {
            let frames: Frames = text.parse().unwrap();
            assert_eq!(frames.name, name);
            let encoder = Encoder::new(&frames, &rig_for(name)).unwrap();
            let mut out = Vec::new();
            encoder.write(Message::Frame, &Values { length, time, ..Values::default() }, &mut out);
            prop_assert!(!out.is_empty());
        }
    }

    #[test]
    fn any_template_is_read_without_a_panic(text in "[0-9A-Fa-f':a-z ]*") {
        let _ = format!("{TEMPLATE}frame = \"{text}\"").parse::<Frames>();
    }
}

/// Bytes of a frame of these tokens, with the default range of numbers.
fn of_tokens(tokens: &str, values: &Values) -> Vec<u8> {
    let text = format!("name = \"own\"\nabout = \"own\"\nnote = \"own\"\nframe = \"{tokens}\"");
    let mut out = Vec::new();
    Encoder::new(&text.parse().unwrap(), &Rig::default()).unwrap().write(Message::Frame, values, &mut out);
    out
}

#[test]
fn signed_and_scaled_numbers() {
    // A quarter of the stroke from -32768 to 32767 is -16384 (of -16384.25).
    let values = Values {
        length: LENGTH,
        own: [0.0123, -0.0456, 0.0],
        pose: [0.0, 0.0, 0.0, 0.5, 0.0, 0.0],
        heave: 40.0,
        ..Values::default()
    };
    assert_eq!(of_tokens("leg1:i16 leg2:i16 leg5:i16le", &values), [0x80, 0x00, 0xC0, 0x00, 0xFF, 0x7F]);
    // 12.3, -45.6 and 40,000 mm: rounded, and the nearest number at the end.
    assert_eq!(
        of_tokens("own_x:i16le*1000 own_y:i16*1000 heave:i16*1000 heave:u16*1000 own_y:u8*1000", &values),
        [12, 0, 0xFF, 0xD2, 0x7F, 0xFF, 0x9C, 0x40, 0]
    );
    assert_eq!(of_tokens("'P' own_x:1*1000 ',' own_y:1*1000 ',' roll:2*57.29578 0A", &values), b"P12.3,-45.6,28.65\n");
    let ranged =
        "name = \"own\"\nabout = \"own\"\nnote = \"own\"\nrange = [-1000, 1000]\nframe = \"leg1:i16 leg5:i16\"";
    assert_eq!(frame(ranged), [0xFC, 0x18, 0x03, 0xE8]);
}

#[test]
fn counters_and_checksums() {
    let values = |count| Values { length: LENGTH, count, ..Values::default() };
    assert_eq!(of_tokens("FF count:u8 count:u16le", &values(0x1234)), [0xFF, 0x34, 0x34, 0x12]);
    // 0xFF + 1 + 0x40 + 0 = 0x140, and 0xFF ^ 1 ^ 0x40 = 0xBE; from the third byte on, of 0x40 and 0.
    assert_eq!(of_tokens("FF 01 leg2:u16 sum:u8", &values(0)), [0xFF, 0x01, 0x40, 0x00, 0x40]);
    assert_eq!(of_tokens("FF 01 leg2:u16 sum:u16", &values(0)), [0xFF, 0x01, 0x40, 0x00, 0x01, 0x40]);
    assert_eq!(of_tokens("FF 01 leg2:u16 xor:u8", &values(0)), [0xFF, 0x01, 0x40, 0x00, 0xBE]);
    assert_eq!(of_tokens("FF 01 leg2:u16 xor@2:u8", &values(0)), [0xFF, 0x01, 0x40, 0x00, 0x40]);
    for wrong in ["count:i8", "sum:dec", "sum@x:u8", "leg1:i12", "x:i16*nan", "count@1:u8", "leg7:i16"] {
        let text = format!("name = \"own\"\nabout = \"own\"\nnote = \"own\"\nframe = \"{wrong}\"");
        assert!(text.parse::<Frames>().is_err(), "{wrong}");
    }
}
