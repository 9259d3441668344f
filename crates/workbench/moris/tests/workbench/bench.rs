//! The bench of washouts.

use std::fs;
use std::path::Path;
use std::process::Command;

fn bench(directory: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output =
        Command::new(env!("CARGO_BIN_EXE_moris")).arg("bench").args(arguments).current_dir(directory).output().unwrap();
    (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
}

/// The rows of a table, field by field.
fn rows(file: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(file).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

const SHORT: [&str; 6] = ["--drive", "lane-change,paper-b", "--rig", "default", "--strategy", "classical,optimal"];
const WITH_CRANKS: [&str; 6] =
    ["--drive", "lane-change", "--rig", "default,crank-person", "--strategy", "classical,optimal"];

#[test]
fn the_bench_writes_the_same_bytes_twice_and_at_rest_has_the_desired_error() {
    let directory = tempfile::tempdir().unwrap();
    let (code, printed, error) = bench(directory.path(), &WITH_CRANKS);
    assert_eq!(code, Some(0), "{error}");
    assert!(printed.contains("moris bench 3: 1 drives on 2 rigs") && printed.contains("optimal, fit"), "{printed}");
    let file = directory.path().join("moris-report/bench.csv");
    let first = fs::read(&file).unwrap();
    assert_eq!(bench(directory.path(), &WITH_CRANKS).0, Some(0));
    assert_eq!(first, fs::read(&file).unwrap());

    let rows = rows(&file);
    // On legs and on cranks: at rest, and two strategies at three scales.
    assert_eq!(rows.len(), 1 + 2 * 7);
    let page = fs::read_to_string(directory.path().join("moris-report/bench.html")).unwrap();
    for text in
        ["<th scope=\"row\">bound</th>", "best attained", "optimal, automatic", "Errors by drive", "crank-person"]
    {
        assert!(page.contains(text), "{text}");
    }
    // The least of the drive, and of each rig.
    assert_eq!(page.matches("font-weight: bold").count(), 3, "{page}");
    assert!(printed.contains("best attained") && printed.contains("error/best"), "{printed}");
    let place = |name: &str| rows[0].iter().position(|head| head == name).unwrap();
    for row in &rows[1..] {
        assert_eq!(row[0], "3");
        let number = |name: &str| row[place(name)].parse::<f64>().unwrap();
        let [desired, error, bound] = ["desired y [m/s2]", "RMS error y [m/s2]", "bound y [m/s2]"].map(number);
        assert!(bound <= error && bound <= desired, "{row:?}");
        assert!(number("best y [m/s2]") <= error && (row[4] != "automatic" || number("factor") <= 1.0), "{row:?}");
        if row[3] == "at rest" {
            assert!((desired - error).abs() < 1e-3 && number("stroke used [%]") == 0.0, "{row:?}");
        }
    }
}

#[test]
fn another_washout_has_a_row_beside_ours() {
    let directory = tempfile::tempdir().unwrap();
    let (code, printed, _) = bench(directory.path(), &["--write-drives", "drives"]);
    assert_eq!(code, Some(0));
    assert!(printed.contains("lane-change.csv: car: double lane change at 80 km/h"), "{printed}");
    // A platform that does not move, as the first row is.
    let ride = rows(&directory.path().join("drives/lane-change.csv"));
    let still = |row: &Vec<String>| format!("{},0,0,1.091,0,0,0\n", row[0]);
    let text = "time,x,y,z,roll,pitch,yaw\n".to_owned() + &ride[1..].iter().map(still).collect::<String>();
    fs::create_dir_all(directory.path().join("mine")).unwrap();
    fs::write(directory.path().join("mine/lane-change.csv"), text).unwrap();
    let (code, printed, error) = bench(directory.path(), &[&SHORT[..], &["--felt", "mine"]].concat());
    assert_eq!(code, Some(0), "{error}");
    assert!(printed.contains("mine, own scale"), "{printed}");
    let rows = rows(&directory.path().join("moris-report/bench.csv"));
    let of =
        |washout: &str| rows.iter().find(|row| row[1] == "lane-change" && row[3] == washout).unwrap()[7..].to_vec();
    assert_eq!(of("mine"), of("at rest"));
    // A quarter of the samples: it is said.
    let coarse = ride[1..].iter().step_by(4).map(still).collect::<String>();
    fs::create_dir_all(directory.path().join("coarse")).unwrap();
    let file = directory.path().join("coarse/lane-change.csv");
    fs::write(&file, "time,x,y,z,roll,pitch,yaw\n".to_owned() + &coarse).unwrap();
    let (code, printed, _) = bench(directory.path(), &[&SHORT[..], &["--felt", "coarse"]].concat());
    assert!(code == Some(0) && printed.contains("coarse, lane-change on default: pose has 25"), "{printed}");
    fs::write(&file, "time,x [in],y,z,roll,pitch,yaw\n".to_owned() + &coarse).unwrap();
    let (code, _, error) = bench(directory.path(), &[&SHORT[..], &["--felt", "coarse"]].concat());
    assert!(
        code == Some(1) && error.contains("lane-change on default: coarse/lane-change.csv: column x [in]"),
        "{error}"
    );
    fs::create_dir_all(directory.path().join("none")).unwrap();
    let (code, _, error) = bench(directory.path(), &[&SHORT[..], &["--felt", "none"]].concat());
    assert!(code == Some(1) && error.contains("no file DRIVE.csv or RIG/DRIVE.csv"), "{error}");
}
