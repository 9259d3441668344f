//! The forms in which loggers, spreadsheets and scripts write the same ride: each is read right, or
//! refused with the reason and the remedy.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use moris::recording::conventions::{
    AngleUnit, EmptyFields, ForceUnit, Format, Gravity, Mounting, Quantity, RateUnit, TimeUnit,
};
use moris::recording::{ConventionOptions, Recording};
use moris::words;

const GRAVITY: f64 = 9.80665;
const HEADER: [&str; 8] = ["time", "ax", "ay", "az", "wx", "wy", "wz", "speed"];
/// Samples of a ride of 30 s.
const COUNT: usize = 1501;

/// A car at a sample of 50 a second: time, specific force, angular velocity, speed.
fn car(k: usize) -> [f64; 8] {
    let t = 0.02 * k as f64;
    let speed = 9.0 - 5.0 * (TAU / 15.0 * t).cos();
    let yaw_rate = 0.15 * (TAU * 0.08 * t).sin();
    let heave = 0.3 * (TAU * 1.3 * t).sin();
    [t, 5.0 * TAU / 15.0 * (TAU / 15.0 * t).sin(), speed * yaw_rate, GRAVITY + heave, 0.0, 0.0, yaw_rate, speed]
}

/// The ride with a separator, its fields written by a function of column and value.
fn table(header: &str, separator: &str, write: impl Fn(usize, f64) -> String) -> String {
    let mut text = format!("{header}\n");
    for k in 0..COUNT {
        let fields: Vec<String> = car(k).into_iter().enumerate().map(|(column, value)| write(column, value)).collect();
        writeln!(text, "{}", fields.join(separator)).unwrap();
    }
    text
}

fn digits(_: usize, value: f64) -> String {
    format!("{value:.6}")
}

/// The ride whose times are written by a function.
fn with_times(write: impl Fn(f64) -> String) -> String {
    table(&HEADER.join(","), ",", |column, value| if column == 0 { write(value) } else { digits(column, value) })
}

fn read(text: &str, options: &ConventionOptions) -> Result<Recording, String> {
    read_as("drive.csv", text.as_bytes(), options)
}

fn read_as(name: &str, text: &[u8], options: &ConventionOptions) -> Result<Recording, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join(name);
    fs::write(&file, text).unwrap();
    let conventions = options.load().map_err(|error| words::error(&error))?;
    Recording::read(&file, &conventions).map_err(|error| words::error(&error))
}

fn assert_is_the_car(recording: Result<Recording, String>, name: &str) -> Vec<String> {
    let recording = recording.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!((1490..=1501).contains(&recording.inputs().len()), "{name}: {}", recording.inputs().len());
    assert!((recording.step() - 0.02).abs() < 1e-6, "{name}: {}", recording.step());
    for (k, input) in recording.inputs().iter().enumerate() {
        let [_, fx, fy, fz, _, _, wz, speed] = car(k);
        let found = [input.specific_force.x, input.specific_force.y, input.specific_force.z, input.angular_velocity.z];
        let off = found.iter().zip([fx, fy, fz, wz]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.02, "{name}: sample {k} is off by {off}");
        assert!(input.speed == 0.0 || (input.speed - speed).abs() < 0.02, "{name}: {}", input.speed);
    }
    words::warnings(&recording)
}

fn plain() -> ConventionOptions {
    ConventionOptions::default()
}

fn columns(pairs: &[(Quantity, &str)]) -> ConventionOptions {
    ConventionOptions { columns: pairs.iter().map(|(key, name)| (*key, (*name).to_owned())).collect(), ..plain() }
}

#[test]
fn separators_and_headers_in_any_form_are_read() {
    let names = HEADER.join(" ");
    let bars = format!("| {} |", HEADER.join(" | "));
    let padded = |_: usize, value: f64| format!(" {value:>12.6} ");
    let comma = table(&HEADER.join(","), ",", digits);
    let (first, rest) = comma.split_once('\n').unwrap();
    let body: Vec<&str> = rest.lines().collect();
    let ruled = table(&format!("{bars}\n|---|---|---|---|---|---|---|---|"), "|", padded);
    let ruled = ruled.lines().map(|line| if line.starts_with('|') { line.to_owned() } else { format!("|{line}|") });
    for (name, text) in [
        ("blanks", table(&names, " ", digits)),
        ("aligned blanks", table(&format!("   {names}"), "  ", padded)),
        ("savetxt", table(&format!("# {names}"), " ", |_, value| format!("{value:.18e}"))),
        ("savetxt with commas in the header", table(&format!("# {}", HEADER.join(",")), " ", digits)),
        ("header behind %", table(&format!("% {}", HEADER.join(",")), ",", digits)),
        ("header behind # without a blank", table(&format!("#{}", HEADER.join(",")), ",", digits)),
        ("header behind a comment", table(&format!("# made by a script\n# {}", HEADER.join(",")), ",", digits)),
        ("bars", table(&HEADER.join(" | "), "|", padded)),
        ("a table in a text", ruled.collect::<Vec<_>>().join("\n")),
        ("padded by a spreadsheet", format!("{comma},,,,,,,\n,,,,,,,\n")),
        ("padded preamble", format!("Made by,a logger,,,,,,\n,,,,,,,\n{comma}")),
        ("header again", format!("{first}\n{}\n{first}\n{}\n", body[..700].join("\n"), body[700..].join("\n"))),
        ("ends of lines of old Macs", comma.replace('\n', "\r")),
        ("zeros behind a power cut", format!("{comma}{}", "\0".repeat(100_000))),
    ] {
        assert_is_the_car(read(&text, &plain()), name);
    }
    // R names the rows, but not their column.
    let quoted: Vec<String> = HEADER.iter().map(|name| format!("\"{name}\"")).collect();
    let mut rows = format!("{}\n", quoted.join(" "));
    body.iter().enumerate().for_each(|(k, line)| writeln!(rows, "\"{}\" {}", k + 1, line.replace(',', " ")).unwrap());
    assert_is_the_car(read(&rows, &plain()), "R");
    let mut rows = format!("{first}\n");
    body.iter().enumerate().for_each(|(k, line)| writeln!(rows, "{},{line}", k + 1).unwrap());
    assert_is_the_car(read(&rows, &plain()), "R with commas");
    let message = read(&body.join("\n"), &plain()).unwrap_err();
    assert!(message.contains("begins with numbers"), "{message}");
}

/// The same ride in the texts of spreadsheets, consoles and measuring programs.
#[test]
fn texts_of_consoles_and_measuring_programs_are_read() {
    let comma = table(&HEADER.join(","), ",", digits);
    let names = HEADER.join("\t");
    let quoted: Vec<String> = comma.lines().map(|line| format!("\"{line}\"")).collect();
    let labelled = |mark: char, separator: &'static str| {
        let text = table("", separator, |column, value| format!("{}{mark}{value:.6}", HEADER[column]));
        text.trim_start().to_owned()
    };
    let monitor: Vec<String> = comma.lines().map(|line| format!("12:30:00.250 -> {line}")).collect();
    let units = "s,m/s2,m/s2,m/s2,rad/s,rad/s,rad/s,m/s";
    let (first, rest) = comma.split_once('\n').unwrap();
    let with_units = |column: usize, value: f64| match column {
        0 => format!("{value:.2} sec"),
        _ => digits(column, value),
    };
    let fortran = |_: usize, value: f64| format!("{value:.12E}").replace('E', "D");
    let utf16 = |text: &str, mark: bool, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        mark.then_some(0xfeff).into_iter().chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    for (name, text) in [
        ("lines in quotation marks", quoted.join("\n")),
        ("tabulators beside commas", table(&HEADER.join(",\t"), ",\t", digits)),
        ("names before values", labelled(':', ",")),
        ("names and signs of equality", labelled('=', " ")),
        ("a serial monitor's clock", monitor.join("\n")),
        ("units above the names", format!("{units}\n{comma}")),
        (
            "descriptions above the units",
            format!("{first}\nclock,surge,sway,heave,roll,pitch,yaw,pace\n{units}\n{rest}"),
        ),
        ("a padded end of a preamble", format!("***End***{}\n{}", "\t".repeat(8), table(&names, "\t", digits))),
        ("durations of MATLAB", table(&HEADER.join(","), ",", with_units)),
        ("Fortran", table(&HEADER.join(" "), " ", fortran)),
    ] {
        assert_is_the_car(read(&text, &plain()), name);
    }
    for (mark, bytes) in
        [(true, u16::to_le_bytes as fn(u16) -> [u8; 2]), (true, u16::to_be_bytes), (false, u16::to_le_bytes)]
    {
        assert_is_the_car(read_as("drive.csv", &utf16(&comma, mark, bytes), &plain()), "UTF-16");
    }
}

#[test]
fn units_in_names_and_words_are_read() {
    let degrees = |column: usize, value: f64| match column {
        0 => format!("{:.0}", 1e3 * value),
        1..4 => format!("{:.7}", value / GRAVITY),
        4..7 => format!("{:.6}", value.to_degrees()),
        _ => format!("{:.5}", 3.6 * value),
    };
    let columns_of = |names: [&str; 8]| {
        let keys = Quantity::all().filter(|key| HEADER.contains(&key.key())).zip(names);
        columns(&keys.collect::<Vec<_>>())
    };
    for names in [
        ["time_ms", "ax_g", "ay_g", "az_g", "wx_dps", "wy_deg_s", "wz_deg_per_s", "speed_kmh"],
        ["TimestampMS", "ax G", "ay g", "az.g", "GYRO_X_DPS", "GYRO_Y_DPS", "GYRO_Z_DPS", "SPEED_KPH"],
    ] {
        assert_is_the_car(read(&table(&names.join(","), ",", degrees), &columns_of(names)), names[0]);
    }
    for header in [
        "time/ms,ax/g,ay/g,az/g,wx/(deg/s),wy/(deg/s),wz/(deg/s),speed/(km/h)",
        "time in ms,ax in g,ay in g,az in g,wx in deg/s,wy in deg/s,wz in deg/s,speed in km/h",
        "time <ms>,ax {g},ay {g},az {g},wx {°/s},wy {Â°/s},wz {?/s},speed (kilometers per hour)",
    ] {
        assert_is_the_car(read(&table(header, ",", degrees), &plain()), header);
    }
    // An option overrides the end of a name, which may mean something else.
    let text = table("time,ax_g,ay_g,az_g,wx,wy,wz,speed", ",", digits);
    let mut options =
        columns(&[(Quantity::Force(0), "ax_g"), (Quantity::Force(1), "ay_g"), (Quantity::Force(2), "az_g")]);
    let message = read(&text, &options).unwrap_err();
    assert!(message.contains("use --force-unit m/s2"), "{message}");
    options.force_unit = Some(ForceUnit::MetrePerSecondSquared);
    assert_is_the_car(read(&text, &options), "an option");
}

#[test]
fn times_in_two_columns_in_ticks_and_of_counters_are_read() {
    let time = |name: &str| columns(&[(Quantity::Time, name)]);
    let rest = HEADER[1..].join(",");
    let written = |header: &str, write: &dyn Fn(f64) -> String| {
        let text = with_times(write);
        format!("{header},{rest}\n{}", text.split_once('\n').unwrap().1)
    };
    let parts = |t: f64| (t.floor(), (t.fract() * 1e3).round());
    for (name, text, options) in [
        ("milliseconds", written("time,ms", &|t| format!("12:30:{:02},{}", parts(t).0, parts(t).1)), time("time + ms")),
        ("a date", written("date,clock", &|t| format!("01.05.2026,12:30:{t:05.2}")), time("date + clock")),
        ("ticks", written("ticks", &|t| format!("{:.0}", 6.385e17 + 1e7 * t)), time("ticks / 10000000")),
        ("a counter", written("n", &|t| format!("{}", (50.0 * t).round() as u64 % 256)), time("n / 50")),
        ("ISO durations", written("time", &|t| format!("PT{t:.2}S")), plain()),
    ] {
        assert_is_the_car(read(&text, &options), name);
    }
    let ticks = written("ticks", &|t| format!("{:.0}", 6.385e17 + 1e7 * t));
    let message = read(&ticks, &time("ticks")).unwrap_err();
    assert!(message.contains("use --columns \"time=ticks / 10000000\""), "{message}");
    let unread = read(&with_times(|t| format!("12:30:{:.0}:{:.0}", parts(t).0, parts(t).1)), &plain()).unwrap_err();
    assert!(unread.contains("which is no time") && unread.contains("--rate HERTZ"), "{unread}");
}

#[test]
fn words_for_missing_values_are_gaps() {
    for word in ["", "-", "--", "NA", "N/A", "#N/A", "null", "None", "NaN", "-nan(ind)", "1.#QNAN", "?", "n.a.", "\\N"]
    {
        let text = table(&HEADER.join(","), ",", |column, value| {
            let is_gap = column == 7 && !((value * 1e6) as u64).is_multiple_of(5);
            if is_gap { word.to_owned() } else { digits(column, value) }
        });
        let gaps = ConventionOptions { empty_fields: Some(EmptyFields::Interpolate), ..plain() };
        let recording = read(&text, &gaps).unwrap_or_else(|error| panic!("{word}: {error}"));
        let middle = recording.inputs()[700];
        let sample = 700 + (recording.start * 50.0).round() as usize;
        assert!((middle.specific_force.y - car(sample)[2]).abs() < 1e-3, "{word}");
        assert!(read(&text, &plain()).unwrap_err().contains("use --empty-fields interpolate"), "{word}");
    }
    let word = read(&with_times(|t| format!("{t:.2}")).replacen("9.806650", "abc", 1), &plain()).unwrap_err();
    assert!(word.contains("which is not a number"), "{word}");
}

/// Thousands as 1,234.5, 1.234,5, 1'234.5 and 1 234,5, also of whole numbers.
#[test]
fn thousands_are_grouped() {
    let group = |text: String, sign: &str, mark: &str| {
        let (minus, text) = text.strip_prefix('-').map_or(("", text.as_str()), |text| ("-", text));
        let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
        let mut grouped = String::new();
        for (k, c) in whole.chars().enumerate() {
            if k > 0 && (whole.len() - k) % 3 == 0 {
                grouped += sign;
            }
            grouped.push(c);
        }
        let decimals = if decimals.is_empty() { String::new() } else { format!("{mark}{decimals}") };
        format!("{minus}{grouped}{decimals}")
    };
    let header = "time [ms];ax [mg];ay [mg];az [mg];wx [deg/s];wy [deg/s];wz [deg/s];speed";
    for (sign, mark) in [(",", "."), (".", ","), ("'", "."), ("\u{a0}", ","), (" ", ",")] {
        for decimals in [0, 2] {
            let text = table(header, ";", |column, value| {
                let (factor, decimals) = match column {
                    0 => (1e3, 0),
                    1..=3 => (1e3 / GRAVITY, decimals),
                    4..=6 => (1f64.to_degrees(), 4),
                    _ => (1.0, 3),
                };
                group(format!("{:.decimals$}", factor * value), sign, mark)
            });
            assert_is_the_car(read(&text, &plain()), &format!("{sign} {mark} {decimals}"));
        }
    }
}

#[test]
fn times_in_any_form_are_read() {
    // From 12:59:45 on, so that a minute and an hour are passed.
    let clock = |t: f64| {
        let ms = ((45.0 + t) * 1e3).round() as u64 + 59 * 60_000 + 12 * 3_600_000;
        [ms / 3_600_000, ms / 60_000 % 60, ms / 1000 % 60, ms % 1000]
    };
    let hms = |t: f64| {
        let [h, m, s, ms] = clock(t);
        format!("{h:02}:{m:02}:{s:02}.{ms:03}")
    };
    let half = |t: f64| {
        let [h, m, s, ms] = clock(t);
        format!("{:02}:{m:02}:{s:02}.{ms:03}", (h + 11) % 12 + 1)
    };
    let joined = |t: f64, sign: &str| {
        let [h, m, s, ms] = clock(t);
        format!("{h:02}{m:02}{s:02}{sign}{ms:03}")
    };
    let forms: [(&str, &dyn Fn(f64) -> String); 14] = [
        ("month", &|t| format!("01-May-2026 {}", hms(t))),
        ("month in Spanish", &|t| format!("01-may.-2026 {}", hms(t))),
        ("AM/PM", &|t| format!("05/01/2026 {} PM", half(t))),
        ("AM/PM alone", &|t| format!("{} p.m.", half(t))),
        ("twelve hours", &|t| half(t)),
        ("minutes", &|t| hms(t)[3..].to_owned()),
        ("compact", &|t| format!("20260501_{}", joined(t, ""))),
        ("colon", &|t| hms(t).replace('.', ":")),
        ("GMT", &|t| format!("Fri May 01 {} GMT+01:00 2026", hms(t))),
        ("HHMMSS", &|t| joined(t, ".")),
        ("YYYYMMDDHHMMSS", &|t| format!("20260501{}", joined(t, "."))),
        ("spreadsheet", &|t| format!("{:.10}", 46_143.54 + t / 86_400.0)),
        ("days since 1970", &|t| format!("{:.10}", 20_574.54 + t / 86_400.0)),
        ("MATLAB", &|t| format!("{:.9}", 740_102.54 + t / 86_400.0)),
    ];
    for (name, write) in forms {
        assert_is_the_car(read(&with_times(write), &plain()), name);
    }
    let minutes = with_times(|t| format!("{:.7}", t / 60.0)).replacen("time", "time [min]", 1);
    assert_is_the_car(read(&minutes, &plain()), "minutes by the header");
    let counter =
        with_times(|t| format!("{}", (4_294_967_296 - 12_000_000 + (t * 1e6).round() as u64) % 4_294_967_296));
    let micros = ConventionOptions { time_unit: Some(TimeUnit::Microsecond), ..plain() };
    let warnings = assert_is_the_car(read(&counter, &micros), "32-bit microseconds");
    assert!(warnings.iter().any(|warning| warning.contains("clock begins again")), "{warnings:?}");
    assert_is_the_car(read(&with_times(|t| format!("{:.2}", (604_788.0 + t) % 604_800.0)), &plain()), "week");
    let split = |t: f64| format!("{},{}", 1_700_000_000 + t as u64, ((t % 1.0) * 1e9).round() as u64 % 1_000_000_000);
    let text = with_times(split).replacen("time", "stamp.sec,stamp.nanosec", 1);
    let sum = columns(&[(Quantity::Time, "stamp.sec + stamp.nanosec")]);
    assert_is_the_car(read(&text, &sum), "sec + nanosec");
}

#[test]
fn recordings_without_a_clock_have_a_rate() {
    let text = with_times(|_| "x".to_owned()).replace("time,", "note,");
    let message = read(&text, &plain()).unwrap_err();
    assert!(message.contains("no column time") && message.contains("use --rate HERTZ"), "{message}");
    assert_is_the_car(read(&text, &ConventionOptions { rate: Some(50.0), ..plain() }), "a rate");
    // The rate takes the place of times that do not go on.
    let stuck = with_times(|_| "7".to_owned());
    assert_is_the_car(read(&stuck, &ConventionOptions { rate: Some(50.0), ..plain() }), "a clock that stands");
}

#[test]
fn counts_are_read_with_a_scale_and_refused_without() {
    let text = table("time,cx,cy,cz,wx,wy,wz,speed", ",", |column, value| match column {
        1..=3 => format!("{:.0}", value / GRAVITY * 16_384.0),
        _ => digits(column, value),
    });
    let names = [(Quantity::Force(0), "cx"), (Quantity::Force(1), "cy"), (Quantity::Force(2), "cz")];
    let message = read(&text, &columns(&names)).unwrap_err();
    assert!(message.contains("scale factor is about 16") && message.contains("--force-unit g"), "{message}");
    let scaled = names.map(|(quantity, name)| (quantity, format!("{name} / 16384")));
    let options = ConventionOptions { columns: scaled.into(), force_unit: Some(ForceUnit::Gravity), ..plain() };
    assert_is_the_car(read(&text, &options), "counts");
    let feet =
        table(&HEADER.join(",").replace("ax,ay,az", "ax (ft/s^2),ay (ft/s^2),az (ft/s^2)"), ",", |column, value| {
            digits(column, if (1..=3).contains(&column) { value / 0.3048 } else { value })
        });
    assert_is_the_car(read(&feet, &plain()), "feet");
}

/// FlySight's and ArduPilot's lines begin with their kind.
#[test]
fn lines_of_several_kinds_are_read() {
    let degrees = |column: usize, value: f64| match column {
        1..=3 => format!("{:.7}", value / GRAVITY),
        4..=6 => format!("{:.6}", value.to_degrees()),
        _ => format!("{value:.3}"),
    };
    let rows = |tag: &str, between: &str, write: &dyn Fn(usize, f64) -> String| {
        let line = |k: usize| {
            let fields: Vec<String> =
                car(k).into_iter().enumerate().map(|(column, value)| write(column, value)).collect();
            format!("{tag}{}\n{between}", fields.join(","))
        };
        (0..COUNT).map(line).collect::<String>()
    };
    let fly = "$FLYS,1\n$VAR,FIRMWARE_VER,v1\n$COL,BARO,time,pressure\n$UNIT,BARO,s,Pa\n\
        $COL,IMU,time,ax,ay,az,wx,wy,wz,speed\n$UNIT,IMU,s,g,g,g,deg/s,deg/s,deg/s,m/s\n$DATA\n";
    assert_is_the_car(read(&format!("{fly}{}", rows("$IMU,", "$BARO,0.001,1013\n", &degrees)), &plain()), "FlySight");
    let fmt = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n\
        FMT, 150, 43, IMU, QBffffff, time,ax,ay,az,wx,wy,wz,speed,I\nPARM, 1, X, 2\n";
    let mut text = fmt.to_owned();
    for line in rows("IMU, ", "", &digits).lines() {
        writeln!(text, "{line}, 0\nBAT, 12\nIMU, 0,0,0,0,0,0,0,0, 1").unwrap();
    }
    assert_is_the_car(read(&text, &plain()), "ArduPilot");
    let long = "timestamp,lap,telemetry_name,telemetry_value\n2026-05-01T12:00:00Z,1,accx,0.1\n";
    let message = read(long, &plain()).unwrap_err();
    assert!(message.contains("a line for each value of a channel") && message.contains("pivot"), "{message}");
}

#[test]
fn racebox_and_racechrono_with_a_pause_are_read() {
    let g = |column: usize, value: f64| match column {
        0 => {
            let s = 41_541.0 + value;
            format!("{:02}{:02}{:05.2}", s as u32 / 3600, s as u32 % 3600 / 60, s % 60.0)
        }
        1..=3 => format!("{:+.6}", value / GRAVITY),
        4..=6 => format!("{:+.5}", value.to_degrees()),
        _ => format!("{:07.3}", 3.6 * value),
    };
    let text = table(
        "File created on 01/05/2026 @ 11:32\n\n[header]\ntime\nLongAcc\nLatAcc\nVertAcc\nx-rotation-gyroscope\n\
         y-rotation-gyroscope\nz-rotation-gyroscope\nvelocity kmh\n\n[column names]\ntime LongAcc LatAcc VertAcc \
         x-rotation-gyroscope y-rotation-gyroscope z-rotation-gyroscope velocity\n\n[data]",
        " ",
        g,
    );
    let vbox = ConventionOptions { format: Some(Format::Vbox), ..plain() };
    assert_is_the_car(read_as("drive.vbo", text.as_bytes(), &vbox), "RaceBox");
    let body = table(
        "timestamp,fragment_id,elapsed_time,speed,x_acc,y_acc,z_acc,x_rate_of_rotation,y_rate_of_rotation,\
         z_rate_of_rotation\nunix time,,s,m/s,G,G,G,deg/s,deg/s,deg/s",
        ",",
        |column, value| match column {
            0 => {
                let fragment = u32::from(value >= 15.0);
                let speed = car((value * 50.0).round() as usize)[7];
                format!("{:.3},{fragment},{:.3},{speed}", 1.78e9 + value, value - 15.0 * f64::from(fragment))
            }
            7 => String::new(),
            1..=3 => format!("{:.7}", value / GRAVITY),
            _ => format!("{:.6}", value.to_degrees()),
        },
    );
    let chrono = ConventionOptions {
        format: Some(Format::RaceChrono),
        mounting: Some(Mounting::parse("0,0,0").unwrap()),
        ..plain()
    };
    assert_is_the_car(read(&body, &chrono), "RaceChrono");
}

/// The warnings or the error of the ride with columns that a function changes.
fn judged(options: &ConventionOptions, change: impl Fn([f64; 8]) -> [f64; 8]) -> String {
    let mut text = format!("{}\n", HEADER.join(","));
    for k in 0..COUNT {
        let fields: Vec<String> = change(car(k)).iter().map(|value| format!("{value:.7}")).collect();
        writeln!(text, "{}", fields.join(",")).unwrap();
    }
    read(&text, options).map_or_else(|error| error, |recording| words::warnings(&recording).join(" "))
}

#[test]
fn a_right_ride_is_not_accused() {
    assert_eq!(judged(&plain(), |s| s), "");
}

#[test]
fn channels_that_stand_still_are_named() {
    let surge = judged(&plain(), |s| [s[0], 0.0, s[2], s[3], s[4], s[5], s[6], s[7]]);
    assert!(surge.contains("Column ax is constant, 0, while the speed changes"), "{surge}");
    let sway = judged(&plain(), |s| [s[0], s[1], 0.0, s[3], s[4], s[5], s[6], s[7]]);
    assert!(sway.contains("Column ay is constant, 0, while the vehicle drives bends"), "{sway}");
    let yaw = judged(&plain(), |s| [s[0], s[1], s[2], s[3], s[4], s[5], 0.0, s[7]]);
    assert!(yaw.contains("Column wz is constant, 0, while the lateral force is that of bends"), "{yaw}");
    // Beside a column that moves.
    let text =
        table("Time,InlineAcc,LateralAcc,VerticalAcc,RollRate,PitchRate,YawRate,GPS LonAcc", ",", |column, value| {
            match column {
                1 => "0".to_owned(),
                2 | 3 => format!("{:.6}", value / GRAVITY),
                _ => digits(column, value),
            }
        });
    let aim = ConventionOptions { format: Some(Format::Aim), force_unit: Some(ForceUnit::Gravity), ..plain() };
    let warnings = words::warnings(&read(&text, &aim).unwrap()).join(" ");
    assert!(warnings.contains("Column InlineAcc is constant, 0, while GPS LonAcc changes"), "{warnings}");
    assert!(warnings.contains("\"ax=GPS LonAcc\""), "{warnings}");
}

#[test]
fn a_wrong_scale_of_time_is_named() {
    let scaled = |scale: f64| judged(&plain(), move |s| [s[0] / scale, s[1], s[2], s[3], s[4], s[5], s[6], s[7]]);
    assert!(scaled(1000.0).contains("50000 samples a second are more than any recording has"), "{}", scaled(1000.0));
    assert!(scaled(60.0).contains("the time seems to be in min, not in s: use --time-unit min"), "{}", scaled(60.0));
    assert!(scaled(10.0).contains("the time seems to run 10.0 times too fast"), "{}", scaled(10.0));
    assert!(scaled(0.001).contains("--time-unit"), "{}", scaled(0.001));
}

#[test]
fn g_and_degrees_are_named_by_the_ratios_of_channels() {
    let removed = ConventionOptions { gravity: Some(Gravity::Removed), ..plain() };
    let g = judged(&removed, |s| [s[0], s[1] / GRAVITY, s[2] / GRAVITY, s[3] / GRAVITY - 1.0, s[4], s[5], s[6], s[7]]);
    assert!(g.contains("the specific force seems to be in g, not in m/s2: use --force-unit g"), "{g}");
    // A roll of 5 degrees, and its rate.
    let mut text = "time,ax,ay,az,wx,wy,wz,roll,pitch\n".to_owned();
    for k in 0..COUNT {
        let t = 0.02 * k as f64;
        let roll = 2.5 * (TAU * 0.3 * t).sin();
        let rate = (2.5 * TAU * 0.3 * (TAU * 0.3 * t).cos()).to_radians();
        writeln!(text, "{t:.2},0,0,0,{rate},0,0,{roll},0").unwrap();
    }
    let message = read(&text, &removed).unwrap_err();
    assert!(message.contains("roll changes 57 times as fast as its rate: these are degrees"), "{message}");
    assert!(message.contains("use --angle-unit deg (or --angle-unit rad, if they are)"), "{message}");
    let degrees = ConventionOptions { angle_unit: Some(AngleUnit::Degree), ..removed.clone() };
    assert!(read(&text, &degrees).is_ok());
    let still: String = text.lines().enumerate().fold(String::new(), |mut all, (k, line)| {
        let fields: Vec<&str> = line.split(',').collect();
        let rate = if k == 0 { fields[4] } else { "0" };
        writeln!(all, "{},{rate},{}", fields[..4].join(","), fields[5..].join(",")).unwrap();
        all
    });
    let message = read(&still, &removed).unwrap_err();
    assert!(message.contains("roll reaches 2.5: these are degrees"), "{message}");
}

#[test]
fn slopes_and_reversing_are_no_wrong_signs() {
    // Uphill the engine gives half of what gravity takes: the speed falls while the force is forward.
    let mut text = "time,ax,ay,az,wx,wy,wz,speed\n".to_owned();
    let (mut speed, step) = (15.0, 0.02);
    for k in 0..3000 {
        let t = step * f64::from(k);
        let slope = 0.12 * (0.25 * t).sin();
        let force = 0.5 * GRAVITY * slope.sin();
        speed += step * (force - GRAVITY * slope.sin());
        writeln!(text, "{t:.2},{force},0,{},0,{},0,{speed}", GRAVITY * slope.cos(), -0.03 * (0.25 * t).cos()).unwrap();
    }
    let warnings = words::warnings(&read(&text, &plain()).unwrap()).join(" ");
    assert!(!warnings.contains("integral of the force along x"), "{warnings}");
    // Out of a garage in reverse, then forward; the speed has no sign.
    let velocity = |t: f64| {
        let part = |from: f64, to: f64| {
            ((t - from) / (to - from) * TAU / 2.0).sin().powi(2) * f64::from((from..to).contains(&t))
        };
        -3.0 * part(2.0, 10.0) + 8.0 * part(12.0, 28.0)
    };
    let mut text = "time,ax,ay,az,wx,wy,wz,speed\n".to_owned();
    for k in 0..1500 {
        let t = step * f64::from(k);
        let (v, yaw_rate) = (velocity(t), 0.3 * f64::from((4.0..8.0).contains(&t)));
        let force = (velocity(t + 1e-4) - velocity(t - 1e-4)) / 2e-4;
        writeln!(text, "{t:.2},{force},{},{GRAVITY},0,0,{yaw_rate},{}", v * yaw_rate, v.abs()).unwrap();
    }
    let warnings = words::warnings(&read(&text, &plain()).unwrap()).join(" ");
    assert!(warnings.contains("seems to reverse from 2.") && !warnings.contains("wrong sign"), "{warnings}");
}

#[test]
fn means_and_flat_tops_are_not_blamed_on_the_sensor() {
    // Bends to the left at a constant speed.
    let bends = judged(&plain(), |s| {
        let yaw_rate = 0.1 + 0.1 * (TAU * 0.1 * s[0]).sin();
        [s[0], 0.0, 10.0 * yaw_rate, s[3], 0.0, 0.0, yaw_rate, 10.0]
    });
    assert!(bends.contains("along y is 1.00 m/s2 on average: the bends are mostly to one side"), "{bends}");
    assert!(!bends.contains("uphill") && !bends.contains("end of its range"), "{bends}");
    // A computed drive that brakes and bends evenly, and stands still between; at any rate.
    for every in [1, 5] {
        let rise = |t: f64, from: f64| {
            let u = ((t - from) / 1.2).clamp(0.0, 1.0);
            u * u * (3.0 - 2.0 * u)
        };
        let even = |t: f64| rise(t, 2.0) - rise(t, 6.0);
        let text: String = (0..3000)
            .step_by(every)
            .map(|k| {
                let t = 0.01 * f64::from(k);
                let yaw_rate = 0.3 * even(t);
                format!("{t},{},{},{GRAVITY},0,0,{yaw_rate}\n", -3.0 * even(t - 12.0), 10.0 * yaw_rate)
            })
            .collect();
        let text = format!("time,ax,ay,az,wx,wy,wz\n{text}");
        let warnings = words::warnings(&read(&text, &plain()).unwrap()).join(" ");
        assert!(!warnings.contains("end of its range"), "{warnings}");
    }
}

/// A roll that passes half a turn is interpolated the short way.
#[test]
fn angles_are_interpolated_on_the_circle() {
    let mut text = "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw\n".to_owned();
    let mut time = 0.0;
    for k in 0..600 {
        let roll = (0.5 * (time - 6.0f64)).clamp(0.0, TAU);
        let shown = roll.sin().atan2(roll.cos());
        let rate = if roll > 0.0 && roll < TAU { 0.5 } else { 0.0 };
        writeln!(text, "{time:.3},0,0,0,{rate},0,0,{shown},0,0").unwrap();
        time += if k % 2 == 0 { 0.045 } else { 0.055 };
    }
    let options = ConventionOptions { gravity: Some(Gravity::Removed), resample: Some(100.0), ..plain() };
    let recording = read(&text, &options).unwrap();
    for (t, input) in recording.times().zip(recording.inputs()) {
        let roll = (0.5 * (t - 6.0)).clamp(0.0, TAU);
        let expected = [GRAVITY * roll.sin(), GRAVITY * roll.cos()];
        let off = (input.specific_force.y - expected[0]).hypot(input.specific_force.z - expected[1]);
        assert!(off < 0.2, "{t}: {off}");
    }
}

/// Damaged files are read or refused, and quickly.
#[test]
fn damaged_recordings_are_no_panic() {
    let seeds = [
        table(&HEADER.join(","), ",", digits).into_bytes(),
        table(&format!("# {}", HEADER.join(" ")), " ", digits).into_bytes(),
        with_times(|t| format!("12:59:{:06.3} PM", 20.0 + t)).into_bytes(),
        b"$COL,IMU,time,ax,ay,az,wx,wy,wz\n$UNIT,IMU,s,g,g,g,deg/s,deg/s,deg/s\n$IMU,0,0,0,1,0,0,0\n$IMU,1,0,0,1,0,0,0\n".to_vec(),
    ];
    let mut state = 88_172_645_463_325_252u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    let words: [&[u8]; 14] =
        [b"\n", b",", b"\"", b"#", b"|", b":", b"-", b"1e308", b"NaN", b"\0", b"\xff", b"time", b"9,999.9", b" / "];
    let options = [
        plain(),
        ConventionOptions {
            resample: Some(100.0),
            empty_fields: Some(EmptyFields::Interpolate),
            rate_unit: Some(RateUnit::RadianPerSecond),
            repair: true,
            ..plain()
        },
    ];
    for round in 0..160 {
        let mut text = seeds[round % seeds.len()].clone();
        for _ in 0..=random(6) {
            let reach = if random(2) == 0 { 200.min(text.len()) } else { text.len() };
            let place = random(reach);
            match random(4) {
                0 => {
                    let word = words[random(words.len())];
                    text.splice(place..place, word.iter().copied());
                }
                1 => {
                    let end = (place + random(40)).min(text.len());
                    text.drain(place..end);
                }
                2 => text.truncate(place),
                _ => {
                    if let Some(byte) = text.get_mut(place) {
                        *byte = random(256) as u8;
                    }
                }
            }
        }
        let begin = std::time::Instant::now();
        let _ = read_as("drive.csv", &text, &options[round % 2]);
        assert!(begin.elapsed().as_secs() < 20, "{round}");
    }
}

#[test]
fn files_without_an_end_are_refused() {
    let zero = Path::new("/dev/zero");
    if zero.exists() {
        let message = words::error(&Recording::read(zero, &plain().load().unwrap()).unwrap_err());
        assert!(message.contains("is no text but a binary file"), "{message}");
        let options = ConventionOptions { conventions: Some(zero.to_owned()), ..plain() };
        let message = words::error(&options.load().unwrap_err());
        assert!(message.contains("it has zero bytes"), "{message}");
    }
}
