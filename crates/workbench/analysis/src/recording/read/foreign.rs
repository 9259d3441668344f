//! Files that are no CSV, by their first bytes.

/// Part of a file in which a zero byte shows that it is no text \[bytes\].
pub const HEAD: usize = 4096;

const ZIP: &[u8] = b"PK\x03\x04";

/// First bytes of formats, and what to do with their files.
const FORMATS: &[(&[&[u8]], &str)] = &[
    (&[b"\xd0\xcf\x11\xe0"], "is an old Excel workbook; save the sheet as CSV"),
    (
        &[b"PAR1"],
        "is a Parquet file; convert it to CSV, in Python: pandas.read_parquet(FILE).to_csv(\"ride.csv\", index=False)",
    ),
    (
        &[b"MATLAB"],
        "is a MATLAB file; write its signals as CSV, in MATLAB: writetable(table(time, ax, ay, az, wx, wy, wz), 'ride.csv')",
    ),
    (&[b"\x89HDF"], "is an HDF5 file; write its signals as CSV, in Python with h5py"),
    (
        &[b"MDF     ", b"UnFinMF "],
        "is an MDF measurement (MF4); export it as CSV, in Python: asammdf.MDF(FILE).export(\"csv\", \"ride\")",
    ),
    (
        &[b"#ROSBAG V"],
        "is a ROS bag; write the topics of the IMU and the odometry as CSV, in Python: rosbags.rosbag1.Reader(FILE)",
    ),
    (
        &[b"ULog\x01\x12\x35"],
        "is a ULog of PX4; convert it to CSV with ulog2csv of the Python package pyulog, and read sensor_combined with the format px4",
    ),
    (&[b"\x89MCAP0"], "is an MCAP log; write its topics as CSV, in Python with mcap or rosbags"),
    (
        &[b"\x93NUMPY"],
        "is a NumPy array; write it as CSV with a line of names, in Python: numpy.savetxt(\"ride.csv\", array, delimiter=\",\", header=\"time,ax,ay,az,wx,wy,wz\", comments=\"\")",
    ),
    (&[b"SQLite format 3"], "is an SQLite database; export the table as CSV"),
    (
        &[b"\x28\xb5\x2f\xfd", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf"],
        "is compressed; unpack it first, or compress it with gzip, which is read as it is",
    ),
];

/// Names in archives by which their programs are known, and what to do with their files; any other
/// archive last.
const ARCHIVES: &[(&[&[u8]], &str)] = &[
    (
        &[b"[Content_Types].xml", b"xl/", b"docProps/", b"_rels/.rels"],
        "is an Excel workbook; save the sheet as CSV, in Python: pandas.read_excel(FILE).to_csv(\"ride.csv\", index=False)",
    ),
    (&[b"application/vnd.oasis.opendocument"], "is an OpenDocument spreadsheet; save the sheet as CSV"),
    (
        &[b".npy"],
        "is a NumPy archive (npz); write its arrays as CSV, in Python: pandas.DataFrame(dict(numpy.load(FILE))).to_csv(\"ride.csv\", index=False)",
    ),
    (&[b""], "is a zip archive; unpack it and pass the CSV file in it"),
];

/// The remedy for a file that its first bytes show not to be CSV.
pub fn remedy(bytes: &[u8]) -> Option<&'static str> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let contains = |part: &[u8]| head.windows(part.len()).any(|window| window == part);
    let text = head.trim_ascii_start();
    if head.starts_with(ZIP) {
        let is_of = |(names, _): &&(&[&[u8]], _)| names.iter().any(|name| name.is_empty() || contains(name));
        ARCHIVES.iter().find(is_of).map(|(_, remedy)| *remedy)
    } else if let Some((_, remedy)) = FORMATS.iter().find(|(first, _)| first.iter().any(|f| head.starts_with(f))) {
        Some(remedy)
    } else if head.contains(&0) && utf_16(head).is_none() {
        Some("is no text but a binary file; export the recording as CSV from the program that wrote it")
    } else if text.starts_with(b"date ") && contains(b"base ") || text.starts_with(b"(") && contains(b") can") {
        Some(
            "is a log of CAN frames, which hold no signals by name; export the signals as CSV, in Python with cantools",
        )
    } else if text.starts_with(b"$GP") || text.starts_with(b"$GN") {
        Some("is a log of NMEA sentences, which have no accelerations; export the accelerometer's samples as CSV")
    } else if text.starts_with(b"<") {
        Some("is XML or HTML; export the recording as CSV")
    } else if text.starts_with(b"{") || text.starts_with(b"[{") {
        Some("is JSON; export the recording as CSV")
    } else {
        None
    }
}

/// The order of the bytes of text in UTF-16, by its mark, or as every other byte of ASCII is zero.
pub fn utf_16(bytes: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let head = &bytes[..bytes.len().min(HEAD) & !1];
    let zeros = |odd: usize| head.iter().skip(odd).step_by(2).filter(|&&byte| byte == 0).count();
    let is_zero = |many: usize, none: usize| head.len() >= 8 && none == 0 && many * 10 >= head.len() / 2 * 9;
    if head.starts_with(b"\xff\xfe") || is_zero(zeros(1), zeros(0)) {
        Some(u16::from_le_bytes)
    } else if head.starts_with(b"\xfe\xff") || is_zero(zeros(0), zeros(1)) {
        Some(u16::from_be_bytes)
    } else {
        None
    }
}
