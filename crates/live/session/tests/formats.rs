//! Packets written out by hand from each layout, and any bytes at all.

use std::fs;
use std::path::Path;

use moris_live::format::{Dropped, Format, SHIPPED_FORMATS};
use moris_live::{Motion, Sample, shipped};
use nalgebra::Vector3;
use proptest::prelude::*;

const G: f64 = 9.80665;

/// The bytes of hexadecimal digits; what follows # on a line is a comment.
fn hex(text: &str) -> Vec<u8> {
    let code = text.lines().map(|line| line.split('#').next().unwrap_or_default());
    let digits: String = code.flat_map(str::chars).filter(char::is_ascii_hexdigit).collect();
    (0..digits.len()).step_by(2).map(|k| u8::from_str_radix(&digits[k..k + 2], 16).unwrap()).collect()
}

fn format(name: &str) -> Format {
    shipped(SHIPPED_FORMATS, name).unwrap().parse().unwrap()
}

fn decoded(name: &str, packet: &[u8]) -> Sample {
    format(name).decode(packet).unwrap()
}

fn assert_motion(motion: &Motion, force: [f64; 3], rates: [f64; 3], angles: [f64; 3], speed: f64) {
    let near = |found: Vector3<f64>, expected: [f64; 3], what: &str| {
        assert!((found - Vector3::from(expected)).amax() < 1e-6, "{what}: {found:?}, not {expected:?}");
    };
    near(motion.force(), force, "force");
    near(motion.rates(), rates, "rates");
    near(motion.angles().to_vector(), angles, "angles");
    assert!((motion.speed() - speed).abs() < 1e-6, "speed {}", motion.speed());
}

#[test]
fn ours() {
    let sample =
        decoded("json", br#"{"time":1.5,"ax":-2,"ay":0.5,"az":9.7,"wz":0.1,"speed":12,"paused":true,"gear":3}"#);
    assert_eq!((sample.time, sample.paused, sample.has_angles), (Some(1.5), true, false));
    assert_motion(&sample.motion, [-2.0, 0.5, 9.7], [0.0, 0.0, 0.1], [0.0; 3], 12.0);

    let sample = decoded("csv", b"1.5,-2,0.5,9.7,0.01,0.02,0.1,0.3,0.2,0.1,12,0\n");
    assert_eq!((sample.time, sample.paused, sample.has_angles), (Some(1.5), false, true));
    assert_motion(&sample.motion, [-2.0, 0.5, 9.7], [0.01, 0.02, 0.1], [0.3, 0.2, 0.1], 12.0);
    assert_motion(&decoded("csv", b"0,1,2").motion, [1.0, 2.0, G], [0.0; 3], [0.0; 3], 0.0);
    let placed = decoded("csv", b"1.5,-2,0.5,9.7,,,,,,,12,0,30,-40\n");
    assert_eq!((sample.position, placed.position), (None, Some(Vector3::new(30.0, -40.0, 0.0))));
    let placed = decoded("json", br#"{"ax":-2,"ay":0.5,"x":30,"y":-40,"z":5}"#);
    assert_eq!(placed.position, Some(Vector3::new(30.0, -40.0, 5.0)));

    let packet = hex("
        00 00 00 00 00 00 F8 3F  # time 1.5
        00 00 00 00 00 00 00 C0  # ax -2
        00 00 00 00 00 00 E0 3F  # ay 0.5
        00 00 00 00 00 00 24 40  # az 10
        00 00 00 00 00 00 D0 3F  # wx 0.25
        00 00 00 00 00 00 E0 BF  # wy -0.5
        00 00 00 00 00 00 F0 3F  # wz 1
        00 00 00 00 00 00 C0 3F  # roll 0.125
        00 00 00 00 00 00 D0 BF  # pitch -0.25
        00 00 00 00 00 00 08 40  # yaw 3
        00 00 00 00 00 00 28 40  # speed 12
        00 00 00 00 00 00 F0 3F  # paused 1");
    let sample = decoded("packed", &packet);
    assert_eq!((sample.time, sample.paused), (Some(1.5), true));
    assert_motion(&sample.motion, [-2.0, 0.5, 10.0], [0.25, -0.5, 1.0], [0.125, -0.25, 3.0], 12.0);
    let place = [30.0_f64, -40.0, 5.0];
    let placed = decoded("packed", &[&packet[..], &place.map(f64::to_le_bytes).concat()].concat());
    assert_eq!((sample.position, placed.position), (None, Some(Vector3::from(place))));
}

/// All samples of a packet.
fn all(format: &Format, packet: &[u8]) -> Vec<Sample> {
    let mut samples = Vec::new();
    format.decode_all(packet, |sample| samples.push(sample)).unwrap();
    samples
}

#[test]
fn text_with_other_separators_titles_and_keys() {
    let expected = decoded("csv", b"1.5,-2,0.5,9.7,0.01,0.02,0.1,0.3,0.2,0.1,12,0");
    for text in [
        "1.5;-2;0.5;9.7;0.01;0.02;0.1;0.3;0.2;0.1;12;0",
        "1,5;-2,0;0,5;9,7;0,01;0,02;0,1;0,3;0,2;0,1;12;0",
        "1.5\t-2\t0.5\t9.7\t0.01\t0.02\t0.1\t0.3\t0.2\t0.1\t12\t0\r\n",
        "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed,paused\n1.5,-2,0.5,9.7,0.01,0.02,0.1,0.3,0.2,0.1,12,0",
        "time=1.5\r\nax=-2\r\nay=0.5\r\naz=9.7\r\nrollrate=0.01\r\npitchrate=0.02\r\nyawrate=0.1\r\n\
         bank=0.3\r\npitch=0.2\r\nyaw=0.1\r\nairspeed=12\r\n",
    ] {
        assert_eq!(decoded("csv", text.as_bytes()), expected, "{text}");
    }
    // Titles alone are no sample.
    assert!(format("csv").decode(b"time,ax,ay\n").is_err() && all(&format("csv"), b"time,ax,ay\n").is_empty());
    let own: Format = "name = \"own\"\nabout = \"own\"\nnote = \"own\"\nlayout = \"csv\"\ngravity = \"included\"\n\
        [fields]\nax = { at = \"Surge\", unit = \"g\" }\nay = { at = \"Sway\", unit = \"g\" }"
        .parse()
        .unwrap();
    for text in ["Sway;Heave;Surge\n0,25;1;0,5", "Surge=0.5&Sway=0.25"] {
        assert_motion(&own.decode(text.as_bytes()).unwrap().motion, [0.5 * G, 0.25 * G, G], [0.0; 3], [0.0; 3], 0.0);
    }
}

#[test]
fn several_samples_in_a_packet() {
    let times = |samples: Vec<Sample>| samples.iter().map(|sample| sample.time.unwrap()).collect::<Vec<_>>();
    assert_eq!(times(all(&format("csv"), b"1,0,0\n1.1,0,0\n\n1.2,0,0\n")), [1.0, 1.1, 1.2]);
    let objects = br#"{"time":1,"ax":0,"ay":0} {"time":2,"ax":0,"ay":0}"#;
    assert_eq!(times(all(&format("json"), objects)), [1.0, 2.0]);
    let packet =
        |time: f64| [time, 0.0, 0.0, G].into_iter().chain([0.0; 8]).flat_map(f64::to_le_bytes).collect::<Vec<u8>>();
    assert_eq!(times(all(&format("packed"), &[packet(1.0), packet(2.0)].concat())), [1.0, 2.0]);
    // Five short ones are four long ones: neither is known.
    assert!(format("packed").decode(&[0; 480]).is_err() && format("packed").decode(&[0; 100]).is_err());
}

#[test]
fn an_attitude_as_a_quaternion() {
    let table = "name = \"own\"\nabout = \"own\"\nnote = \"own\"\nlayout = \"json\"\ngravity = \"removed\"\n[fields]\n\
        ax = { at = \"a.0\" }\nay = { at = \"a.1\" }\nqw = { at = \"q.0\" }\nqx = { at = \"q.1\" }\n\
        qy = { at = \"q.2\" }\nqz = { at = \"q.3\" }";
    let own: Format = table.parse().unwrap();
    // Turned to the left by 90 degrees, then the nose down by 30: products of two quaternions by hand,
    // as numbers of 16 bits.
    let [half, quarter] = [30_f64, 90.0].map(|degrees| (0.5 * degrees).to_radians());
    let q = [
        quarter.cos() * half.cos(),
        -quarter.sin() * half.sin(),
        quarter.cos() * half.sin(),
        quarter.sin() * half.cos(),
    ]
    .map(|part| 32767.0 * part);
    let sample = own.decode(format!("{{\"a\":[1,2],\"q\":{q:?}}}").as_bytes()).unwrap();
    assert!(sample.has_angles);
    let angles = [0.0, 30_f64.to_radians(), 90_f64.to_radians()];
    // Nose down, gravity's reaction is backward.
    let force = [1.0 - G * 0.5, 2.0, G * 30_f64.to_radians().cos()];
    assert_motion(&sample.motion, force, [0.0; 3], angles, 0.0);
    assert!(!own.decode(br#"{"a":[1,2],"q":[0,0,0,0]}"#).unwrap().is_plausible());
    let lacking = table.replace("\nqz = { at = \"q.3\" }", "");
    assert!(lacking.parse::<Format>().unwrap_err().to_string().contains("qw, qx, qy and qz"));
}

#[test]
fn the_player_in_a_list_of_cars() {
    let head = "name = \"own\"\nabout = \"own\"\nnote = \"own\"\ngravity = \"included\"\n";
    let binary: Format = format!(
        "{head}layout = \"binary\"\nplayer = {{ at = 1, stride = 8 }}\n[fields]\ntime = {{ at = 0, type = \"u8\" }}\n\
         ax = {{ at = 2, of-player = true }}\nay = {{ at = 6, of-player = true }}"
    )
    .parse()
    .unwrap();
    let cars: Vec<u8> = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0].into_iter().flat_map(f32::to_le_bytes).collect();
    for (player, force) in [(0, [1.0, 2.0, G]), (2, [5.0, 6.0, G])] {
        let sample = binary.decode(&[&[7, player][..], &cars].concat()).unwrap();
        assert_eq!((sample.time, sample.motion.force()), (Some(7.0), Vector3::from(force)));
    }
    assert!(binary.decode(&[&[7, 3][..], &cars].concat()).is_err());
    let json: Format = format!(
        "{head}layout = \"json\"\nplayer = {{ at = \"me\" }}\n[fields]\n\
         ax = {{ at = \"cars.{{player}}.a\", of-player = true }}\nay = {{ at = \"cars.{{player}}.b\", of-player = true }}"
    )
    .parse()
    .unwrap();
    let packet = br#"{"me":1,"cars":[{"a":1,"b":2},{"a":3,"b":4}]}"#;
    assert_eq!(json.decode(packet).unwrap().motion.force(), Vector3::new(3.0, 4.0, G));
    assert!(json.decode(br#"{"cars":[{"a":1,"b":2}]}"#).is_err());
    // Places that count from the first car, which longer packets have elsewhere.
    let relative: Format = format!(
        "{head}layout = \"binary\"\nlengths = [10, 12]\nplayer = {{ at = 0, first = 2, stride = 4 }}\n[fields]\n\
         ax = {{ at = 0, type = \"u16\", of-player = true }}\nay = {{ at = 2, type = \"u16\", of-player = true }}\n\
         [[variants]]\nlengths = [12]\nplayer = {{ at = 1, first = 4, stride = 4 }}\nfields = {{}}"
    )
    .parse()
    .unwrap();
    let short = [1_u8, 9, 1, 0, 2, 0, 3, 0, 4, 0];
    let long = [9_u8, 0, 9, 9, 5, 0, 6, 0, 7, 0, 8, 0];
    for (packet, force) in [(&short[..], [3.0, 4.0, G]), (&long, [5.0, 6.0, G])] {
        assert_eq!(relative.decode(packet).unwrap().motion.force(), Vector3::from(force));
    }
    let wide = "[[of-lengths]]\nlengths = [12]\nplayer = { at = 0, first = 4096, stride = 4 }\nfields = {}\n";
    let wide = format!("{head}layout = \"binary\"\n[fields]\nax = {{ at = 0 }}\nay = {{ at = 4 }}\n{wide}");
    assert!(wide.parse::<Format>().unwrap_err().to_string().contains("`first` and `stride` below 4096"));
    let without = format!("{head}layout = \"csv\"\n[fields]\nax = {{ at = 0, of-player = true }}\nay = {{ at = 1 }}");
    assert!(without.parse::<Format>().unwrap_err().to_string().contains("needs a line `player`"));
}

#[test]
fn outsim() {
    // Heading north (+Y), level; 8 m/s forward, braking with 4 m/s2, turning left with 0.5 rad/s.
    let packet = hex("
        E8 03 00 00              # 1000 ms
        00 00 00 00  00 00 00 00  00 00 00 3F  # angular velocity X, Y, Z 0.5
        00 00 00 00  00 00 00 00  00 00 00 00  # heading, pitch, roll
        00 00 80 C0  00 00 80 C0  00 00 00 00  # acceleration X -4 (left), Y -4, Z
        00 00 00 00  00 00 00 41  00 00 00 00  # velocity X, Y 8, Z
        00 00 01 00  00 00 02 00  00 00 FF FF  # position X 1 m, Y 2 m, Z -1 m");
    let sample = decoded("outsim", &packet);
    assert_eq!((sample.time, sample.position), (Some(1.0), Some(Vector3::new(2.0, -1.0, -1.0))));
    assert_motion(&sample.motion, [-4.0, 4.0, G], [0.0, 0.0, 0.5], [0.0; 3], 8.0);

    // Heading west, a quarter turn to the left: forward is -X of the world. Pitched nose up by 0.25.
    let mut turned = packet.clone();
    turned[16..20].copy_from_slice(&hex("DB 0F C9 3F")); // pi/2
    turned[20..24].copy_from_slice(&hex("00 00 80 3E"));
    turned[28..32].copy_from_slice(&hex("00 00 80 C0")); // X -4: forward
    turned[32..36].copy_from_slice(&hex("00 00 00 00"));
    let sample = decoded("outsim", &turned);
    let (sin, cos) = 0.25_f64.sin_cos();
    // Gravity's reaction has a part forward when the nose is up.
    let force = [4.0 * cos + G * sin, 0.0, -4.0 * sin + G * cos];
    assert_motion(
        &sample.motion,
        force,
        [0.5 * sin, 0.0, 0.5 * cos],
        [0.0, -0.25, std::f32::consts::FRAC_PI_2.into()],
        8.0,
    );
    // With the identifier.
    let mut longer = packet;
    longer.extend([1, 0, 0, 0]);
    assert!(format("outsim").decode(&longer).is_ok());
    assert!(format("outsim").decode(&longer[..66]).is_err());
}

#[test]
fn motionsim() {
    let packet = hex("
        42 4E 47 31                            # BNG1
        00 00 80 3F  00 00 00 40  00 00 40 40  # position 1, 2, 3
        00 00 40 40  00 00 80 C0  00 00 00 00  # velocity 3, -4, 0
        00 00 80 3F  00 00 80 40  00 00 00 3F  # acceleration: left 1, backward 4, up 0.5
        00 00 00 00  00 00 00 00  00 00 80 3F  # up vector
        00 00 00 00  00 00 00 00  00 00 40 40  # roll, pitch, yaw 3
        00 00 80 3E  00 00 00 3F  00 00 80 BF  # rates 0.25, 0.5, -1
        00 00 00 00  00 00 00 00  00 00 00 00  # their accelerations");
    let sample = decoded("motionsim", &packet);
    assert_eq!((sample.time, sample.position), (None, Some(Vector3::new(1.0, 2.0, 3.0))));
    assert_motion(&sample.motion, [-4.0, 1.0, G + 0.5], [0.25, 0.5, -1.0], [0.0, 0.0, 3.0], 5.0);
    let mut other = packet.clone();
    other[3] = b'2';
    assert!(format("motionsim").decode(&other).is_err());
}

#[test]
fn forza() {
    let mut packet = hex("
        01 00 00 00  D0 07 00 00               # running, 2000 ms
        00 00 00 00  00 00 00 00  00 00 00 00  # engine
        00 00 00 C0  00 00 00 3F  00 00 80 C0  # acceleration: right -2, up 0.5, forward -4
        00 00 00 00  00 00 00 00  00 00 20 41  # velocity: forward 10
        00 00 80 3E  00 00 00 3F  00 00 80 BF  # rates: pitch 0.25, yaw 0.5, roll -1
        00 00 00 00  00 00 00 00  00 00 00 00  # yaw, pitch, roll");
    packet.resize(311, 0);
    let sample = decoded("forza", &packet);
    assert_eq!((sample.time, sample.paused), (Some(2.0), false));
    assert_motion(&sample.motion, [-4.0, 2.0, G + 0.5], [1.0, 0.25, -0.5], [0.0; 3], 10.0);
    packet[0] = 0;
    assert!(decoded("forza", &packet).paused);
    // Position: right 1, up 2, forward 3; 12 bytes later in Horizon.
    for (length, at) in [(232, None), (311, Some(232)), (331, Some(232)), (324, Some(244))] {
        let mut packet = packet.clone();
        packet.resize(length, 0);
        if let Some(at) = at {
            packet[at..at + 12].copy_from_slice(&hex("00 00 80 3F  00 00 00 40  00 00 40 40"));
        }
        assert_eq!(decoded("forza", &packet).position, at.map(|_| Vector3::new(1.0, 3.0, 2.0)), "{length}");
    }
}

#[test]
fn codemasters() {
    let mut packet = vec![0; 264];
    packet[0..4].copy_from_slice(&hex("00 00 20 41")); // 10 s
    packet[16..28].copy_from_slice(&hex("00 00 80 3F  00 00 00 40  00 00 40 40")); // left, up, forward
    packet[28..32].copy_from_slice(&hex("00 00 00 41")); // 8 m/s
    packet[136..140].copy_from_slice(&hex("00 00 80 3E")); // lateral 0.25 g
    packet[140..144].copy_from_slice(&hex("00 00 00 BF")); // longitudinal -0.5 g
    let sample = decoded("codemasters", &packet);
    assert_eq!((sample.time, sample.position), (Some(10.0), Some(Vector3::new(3.0, 1.0, 2.0))));
    assert_motion(&sample.motion, [-0.5 * G, 0.25 * G, G], [0.0; 3], [0.0; 3], 8.0);
}

/// Numbers of 32 bits as a packet has them.
fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A header of F1 with the year, the packet's number, the time and the player's number, field by
/// field of each specification.
fn f1_header(year: u16, packet: u8, time: f32, player: u8) -> Vec<u8> {
    let versions: &[u8] = match year {
        2018 => &[1],
        2019..=2022 => &[1, 3, 1],
        _ => &[23, 1, 3, 1],
    };
    let frames = if year < 2023 { 1 } else { 2 };
    let second_player: &[u8] = if year < 2020 { &[] } else { &[255] };
    let (year, session) = (year.to_le_bytes(), 7_u64.to_le_bytes());
    let frame = 600_u32.to_le_bytes().repeat(frames);
    [&year, versions, &[packet], &session, &time.to_le_bytes(), &frame, &[player], second_player].concat()
}

/// A motion packet of F1 in which the third car is the player's.
fn f1_motion(year: u16) -> Vec<u8> {
    let other = [0xEE; 60].to_vec();
    let directions = [0_i16, -655, 32760, -32760, -3275, 0].map(i16::to_le_bytes).concat();
    let car = [
        floats(&[1.0, 2.0, 3.0]),     // position: left, up, forward
        floats(&[0.0, 0.0, 8.0]),     // velocity
        directions,                   // forward, 655/32767 downward; right, down
        floats(&[0.25, -0.5, 0.125]), // g-forces: lateral, longitudinal, vertical
        floats(&[0.5, 9.0, 0.125]),   // yaw, pitch (not the car's before 2022), roll
    ]
    .concat();
    let cars = if year < 2020 { 20 } else { 22 };
    let list: Vec<Vec<u8>> = (0..cars).map(|k| if k == 2 { car.clone() } else { other.clone() }).collect();
    // Position, velocity, acceleration of the suspension, speed and slip of the wheels; local
    // velocity; angular velocity; angular acceleration, angle of the wheels.
    let own = [vec![0; 5 * 16], floats(&[0.0; 3]), floats(&[9.0, 0.375, 9.0]), floats(&[9.0; 4])].concat();
    let own = if year < 2023 { own } else { Vec::new() };
    [f1_header(year, 0, 1.5, 2), list.concat(), own].concat()
}

#[test]
fn f1() {
    let pitch = 655.0 / 32767.0_f64;
    let (roll, yaw) = (0.125_f64, 0.5);
    // Braking is backward and a left turn leftward; to these gravity's reaction is added, of a nose
    // that is down and a right side that is down.
    let force =
        [-0.5 * G - G * pitch.sin(), 0.25 * G + G * pitch.cos() * roll.sin(), 0.125 * G + G * pitch.cos() * roll.cos()];
    for (year, length) in
        [(2018, 1341), (2019, 1343), (2020, 1464), (2021, 1464), (2022, 1464), (2023, 1349), (2024, 1349), (2025, 1349)]
    {
        let packet = f1_motion(year);
        assert_eq!(packet.len(), length, "the size that the specification of {year} states");
        let sample = decoded("f1", &packet);
        let place = Some(Vector3::new(3.0, 1.0, 2.0));
        assert_eq!((sample.time, sample.position, sample.has_angles), (Some(1.5), place, true), "{year}");
        let rate = if year < 2023 { 0.375 } else { 0.0 };
        assert_motion(&sample.motion, force, [0.0, 0.0, rate], [roll, pitch, yaw], 8.0);
    }
    // Packets of another kind are no samples, and those of another program are told.
    let laps = [f1_header(2025, 2, 1.5, 2), vec![0; 1256]].concat();
    assert!(all(&format("f1"), &laps).is_empty());
    assert!(!format("f1").explain(&laps, 20777).contains("f1 fits"));
    assert_eq!(format("f1").decode_all(&[1; 1285], |_| ()), Err(Dropped::Length(1285)));
    // The number of the player may be beyond the list.
    let mut beyond = f1_motion(2025);
    beyond[27] = 255;
    assert!(format("f1").decode(&beyond).is_err());
}

#[test]
fn assetto_corsa() {
    // A handshake and a subscription: device, version, operation.
    let request = |operation: i32| [1, 1, operation].map(i32::to_le_bytes).concat();
    assert_eq!(format("assetto-corsa").subscriptions(), [request(0), request(1)]);
    let names = [0; 100];
    let reply = [&names[..], &names, &4242_i32.to_le_bytes(), &1_i32.to_le_bytes(), &names, &names].concat();
    assert!(reply.len() == 408 && all(&format("assetto-corsa"), &reply).is_empty());

    let packet = [
        b"a\0\0\0".to_vec(),            // identifier, padding
        328_i32.to_le_bytes().to_vec(), // size
        floats(&[28.8, 17.9, 8.0]),     // speed in km/h, mph, m/s
        vec![0; 6 + 2],                 // ABS, traction control, pit, limiter; padding
        floats(&[0.25, 9.0, -0.5]),     // g-forces: lateral, vertical, frontal
        vec![0; 4 * 4],                 // laps
        floats(&[0.0; 5]),              // pedals, engine, steering wheel
        vec![0; 4],                     // gear
        floats(&[0.5]),                 // height of the centre of gravity
        floats(&[9.0; 4]).repeat(14),   // wheels
        floats(&[0.5, 0.0]),            // place on the lap, slope
        floats(&[1.0, 2.0, 3.0]),       // coordinates: left, up, forward
    ]
    .concat();
    let sample = decoded("assetto-corsa", &packet);
    assert_eq!((packet.len(), sample.time, sample.position), (328, None, Some(Vector3::new(3.0, 1.0, 2.0))));
    assert_motion(&sample.motion, [-0.5 * G, 0.25 * G, G], [0.0; 3], [0.0; 3], 8.0);
}

#[test]
fn project_cars_2() {
    let base = |kind: u8, version: u8| [vec![0; 4 + 4 + 2], vec![kind, version]].concat();
    let packet = [
        base(0, 2),
        vec![9; 1 + 4 + 1],             // participant, pedals, flags
        vec![9; 5 * 2 + 4],             // oil, water, fuel; pedals
        floats(&[0.5, 8.0]),            // fuel, speed
        vec![9; 2 + 2 + 4],             // engine, steering, gear, boost, crash
        floats(&[100.0]),               // odometer
        floats(&[9.0; 3]),              // orientation
        floats(&[9.0; 3]),              // local velocity
        floats(&[9.0; 3]),              // world velocity
        floats(&[9.0, 0.375, 9.0]),     // angular velocity: left turns in the middle
        floats(&[2.0, 0.5, 4.0]),       // local acceleration: left, up, backward
        floats(&[9.0; 6]),              // world acceleration, extents
        vec![9; 4 + 4],                 // flags, terrain
        floats(&[9.0; 8]),              // tyres
        vec![9; 4],                     // temperature
        floats(&[9.0; 4]),              // height above the ground
        vec![9; 3 * 4],                 // wear, damage
        vec![9; 9 * 8],                 // temperatures
        floats(&[9.0; 16]),             // wheels, ride, suspension
        vec![9; 8 + 8],                 // ride, pressure
        floats(&[9.0; 2]),              // engine
        vec![9; 2 + 1 + 1 + 1 + 4 + 1], // wings, brake, damage, joypad
        vec![0; 4 * 40],                // compounds
        floats(&[9.0; 4]),              // boost, position
        vec![9; 1 + 4],                 // bias, ticks
    ]
    .concat();
    let sample = decoded("project-cars-2", &packet);
    assert_eq!((packet.len(), sample.time, sample.position), (559, None, None));
    assert_motion(&sample.motion, [-4.0, 2.0, G + 0.5], [0.0, 0.0, 0.375], [0.0; 3], 8.0);
    let timings = [base(3, 3), vec![0; 1051]].concat();
    assert!(all(&format("project-cars-2"), &timings).is_empty());
    assert!(format("project-cars-2").decode_all(&vec![0; 1063], |_| ()).is_err());
}

#[test]
fn rfactor() {
    let packet = [
        vec![0; 4 + 4 + 4 + 64 + 64],   // time, lap; names
        floats(&[1.0, 2.0, -3.0]),      // position: left, up, backward
        floats(&[0.0, 0.0, -8.0]),      // local velocity
        floats(&[2.0, 0.5, 4.0]),       // local acceleration
        floats(&[9.0; 3]),              // orientation: rows of world X,
        floats(&[0.0, 1.0, 0.0]),       // world Y,
        floats(&[9.0; 3]),              // world Z
        floats(&[0.125, -0.375, 0.25]), // rotation: nose up, to the right, right side down
        vec![0; 780 - 140 - 7 * 12],
    ]
    .concat();
    let sample = decoded("rfactor", &packet);
    assert_eq!((packet.len(), sample.position), (780, Some(Vector3::new(3.0, 1.0, 2.0))));
    assert_motion(&sample.motion, [-4.0, 2.0, G + 0.5], [0.25, -0.125, 0.375], [0.0; 3], 8.0);
    // Nose down by 30 degrees, the car's Z, which is backward, points up by its sine; right side down
    // by 0.25, its X, which is left, points up.
    for (row, angles) in [([0.0, 0.75_f32.sqrt(), 0.5], [0.0, 0.5]), ([0.25, 0.97, 0.0], [0.25, 0.0])] {
        let mut turned = packet.clone();
        turned[188..200].copy_from_slice(&floats(&row));
        let found = decoded("rfactor", &turned).motion.angles();
        assert_eq!([found.roll, found.pitch], angles);
    }
}

#[test]
fn iracing() {
    let packet = br#"{"meta":{"timestamp":"2026-02-20T21:46:10Z","game":"iRacing","tick":90},
        "motion":{"acceleration":{"x":2.0,"y":9.5,"z":-4.0},"g_force":{"x":0.2,"y":0.97,"z":-0.4},"position":null,
        "rotation":{"x":9.0,"y":9.0,"z":9.0},"pitch_rate":9.0,"yaw_rate":22.5,"roll_rate":9.0},
        "vehicle":{"speed":8.0,"on_track":true},"session":{"session_time":1.5}}"#;
    let sample = decoded("iracing", packet);
    assert_eq!((sample.time, sample.paused, sample.has_angles), (Some(1.5), false, false));
    assert_motion(&sample.motion, [-4.0, 2.0, 9.5], [0.0, 0.0, 22.5_f64.to_radians()], [0.0; 3], 8.0);
    let text = String::from_utf8(packet.to_vec()).unwrap();
    assert!(decoded("iracing", text.replace("true", "false").as_bytes()).paused);
    assert!(format("iracing").decode(text.replace("\"acceleration\":{", "\"other\":{").as_bytes()).is_err());
}

#[test]
fn piboso() {
    let packet = |state: i32| {
        [
            b"data\0".to_vec(),
            state.to_le_bytes().to_vec(),
            1500_i32.to_le_bytes().to_vec(),
            vec![0; 4 + 4 + 4 + 4 + 4],    // engine, temperatures, gear, fuel
            floats(&[9.0]),                // speedometer
            floats(&[-1.0, 2.0, 3.0]),     // position: east, up, north
            floats(&[0.0, 0.0, 8.0]),      // velocity
            floats(&[-0.25, 1.5, -0.5]),   // acceleration: right, up, forward, in 9.81 m/s2
            floats(&[9.0; 9]),             // rotation matrix
            floats(&[-90.0, 5.0, 30.0]),   // yaw clockwise, pitch nose down, roll to the left
            floats(&[-22.5, 11.25, 45.0]), // their velocities
            vec![9; 60],                   // what follows is different in each game
        ]
        .concat()
    };
    let sample = decoded("piboso", &packet(2));
    let position = Some(Vector3::new(3.0, 1.0, 2.0));
    assert_eq!((sample.time, sample.position, sample.paused), (Some(1.5), position, false));
    let rates = [-45_f64, 11.25, 22.5].map(f64::to_radians);
    let angles = [-30_f64, 5.0, 90.0].map(f64::to_radians);
    assert_motion(&sample.motion, [-0.5 * 9.81, 0.25 * 9.81, 1.5 * 9.81], rates, angles, 8.0);
    assert!(decoded("piboso", &packet(0)).paused);
    assert!(format("piboso").decode(&[&b"evnt\0"[..], &packet(2)[5..]].concat()).is_err());
}

#[test]
fn x_plane() {
    let requests = format("x-plane").subscriptions();
    assert_eq!(requests.len(), 12);
    let mut expected = b"RREF\0\x64\0\0\0\x02\0\0\0sim/flightmodel/forces/g_axil".to_vec();
    expected.resize(413, 0);
    assert!(requests.contains(&expected));
    let mut packet = b"RREF,".to_vec();
    // Number and value, in any order: g_nrml 1, g_axil 0.5, Q 1, paused 0, and the rest.
    packet.extend(hex(
        "04 00 00 00 00 00 80 3F  02 00 00 00 00 00 00 3F  06 00 00 00 00 00 80 3F  0C 00 00 00 00 00 00 00",
    ));
    assert!(format("x-plane").decode(&packet).is_err(), "fields are missing");
    packet.extend(hex(
        "01 00 00 00 00 00 20 41  03 00 00 00 00 00 00 00  05 00 00 00 00 00 00 00  07 00 00 00 00 00 00 00",
    ));
    packet.extend(hex(
        "08 00 00 00 00 00 00 00  09 00 00 00 00 00 00 00  0A 00 00 00 00 00 00 00  0B 00 00 00 00 00 00 41",
    ));
    let sample = decoded("x-plane", &packet);
    assert_eq!((sample.time, sample.paused), (Some(10.0), false));
    assert_motion(&sample.motion, [-0.5 * G, 0.0, G], [0.0, -1.0_f64.to_radians(), 0.0], [0.0; 3], 8.0);
}

#[test]
fn every_table_is_shipped_says_what_it_is_and_is_listed_in_the_page() {
    let page = include_str!("../../../../docs/live.md");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/format/tables");
    assert_eq!(fs::read_dir(folder).unwrap().count(), SHIPPED_FORMATS.len());
    for &(name, text) in SHIPPED_FORMATS {
        let format: Format = text.parse().unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(format.name, name);
        assert!(page.lines().any(|line| line == format!("{name:<14} {}", format.about)), "{name}");
        assert!(
            !format.about.is_empty() && (format.note.starts_with("Ours.") || format.note.contains("No real packet"))
        );
    }
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    let table = shipped(SHIPPED_FORMATS, "packed").unwrap();
    for (from, to, reason) in [
        ("at = 8,", "at = 4096,", "below 4096"),
        ("at = 8,", "at = \"ax\",", "below 4096"),
        ("at = 8,", "at = 8, scale = 0,", "other than zero"),
        ("at = 8,", "at = 8, unit = 'deg',", "field ax: `deg` is not a unit of a specific force: write `m/s2` or `g`"),
        ("at = 8,", "at = 8, unit = \"furlong\",", "unknown variant"),
        ("ax = ", "bx = ", "unknown variant"),
        ("ax = { at = 8, type = \"f64\" }\n", "", "ax and ay are needed"),
        ("gravity = \"included\"", "", "missing field"),
        ("name = ", "Name = ", "unknown field"),
        ("gravity = \"included\"\n", "gravity = \"included\"\nforce-axes = \"world\"\n", ""),
        ("layout = \"binary\"", "layout = \"pairs\"\nothers = { at = 0, values = [1] }", "for the layout binary"),
    ] {
        let text = table.replacen(from, to, 1);
        assert_ne!(text, table);
        match text.parse::<Format>() {
            Err(error) => assert!(error.to_string().contains(reason) && !reason.is_empty(), "{error}"),
            Ok(_) => assert!(reason.is_empty(), "{to}"),
        }
    }
}

#[test]
fn a_field_takes_units_of_its_quantity_alone() {
    let fields = [
        ("time", "s ms"),
        ("az", "m/s2 g"),
        ("wz", "rad/s deg/s"),
        ("roll", "rad deg"),
        ("z", "m"),
        ("vx", "m/s km/h mph"),
        ("speed", "m/s km/h mph"),
        ("running", ""),
        ("qw", ""),
    ];
    for (field, units) in fields {
        for unit in "m/s2 g rad/s deg/s rad deg m/s km/h mph m s ms".split(' ') {
            let text = format!(
                "name = 'own'\nabout = 'own'\nnote = 'own'\nlayout = 'binary'\ngravity = 'included'\n\
                 [fields]\nax = {{ at = 0 }}\nay = {{ at = 4 }}\n{field} = {{ at = 8, unit = '{unit}' }}"
            );
            let refusal = text.parse::<Format>().err().map(|error| error.to_string());
            let is_refused = refusal.is_some_and(|text| text.starts_with(&format!("field {field}: `{unit}` is not")));
            assert_eq!(is_refused, !units.split(' ').any(|allowed| allowed == unit), "{field} in {unit}");
        }
    }
}

proptest! {
    #[test]
    fn any_bytes_are_decoded_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..600), kind in 0..SHIPPED_FORMATS.len()) {
        let format: Format = SHIPPED_FORMATS[kind].1.parse().unwrap();
        let _ = format.decode(&bytes);
        // Of a length and with a head that are right.
        let length = format.lengths.first().copied().unwrap_or(bytes.len().max(8));
        let mut packet = format.head.clone().into_bytes();
        packet.extend(bytes);
        packet.resize(length, 7);
        let _ = format.decode(&packet).map(|sample| sample.is_plausible());
    }

    #[test]
    fn any_text_is_decoded_without_a_panic(text in "[-0-9.eE,:{}\\[\\]\"a-z \n]*") {
        for name in ["json", "csv"] {
            let _ = format(name).decode(text.as_bytes());
        }
        let _ = text.parse::<Format>();
    }
}

#[test]
fn keys_may_stand_in_keys_and_lists() {
    let table = |at: &str| {
        let head = "name = 'own'\nabout = ''\nnote = ''\nlayout = 'json'\ngravity = 'included'\n[fields]\nax = { at = ";
        format!("{head}'{at}' }}\nay = {{ at = 'ay' }}\n").parse::<Format>().unwrap()
    };
    let packet = br#"{"ay": 2.0, "a.b": 3.0, "a": {"b": 4.0, "c": {"d": [5.0, {"e": 6.0}]}}}"#;
    for (at, expected) in [("a.b", 3.0), ("a.c.d.0", 5.0), ("a.c.d.1.e", 6.0)] {
        assert_eq!(table(at).decode(packet).unwrap().motion.force().x, expected, "{at}");
    }
    for missing in ["a.x", "a.c.d.7", "a.c.d.e", "a.b.c", ""] {
        assert!(table(missing).decode(packet).is_err(), "{missing}");
    }
}

#[test]
fn packets_of_another_format_are_explained() {
    let outsim: Format = shipped(SHIPPED_FORMATS, "outsim").unwrap().parse().unwrap();
    let mut motionsim = vec![0; 88];
    motionsim[..4].copy_from_slice(b"BNG1");
    assert_eq!(
        outsim.explain(&motionsim, 4444),
        "88-byte packets arrive on 4444; outsim has 64 or 68: motionsim fits: --format motionsim"
    );
    let unknown = outsim.explain(&[7; 33], 4444);
    assert!(unknown.contains("33-byte packets") && unknown.contains("no format of moris-live fits"), "{unknown}");
    let csv: Format = shipped(SHIPPED_FORMATS, "csv").unwrap().parse().unwrap();
    let object = csv.explain(br#"{"ax": 1.0, "ay": 2.0, "az": 9.8}"#, 4444);
    assert!(object.contains("json fits"), "{object}");
}
