//! A step of 1 m/s² in surge: the washout's commands, and the specific force that the rider feels.
//!
//!     cargo run --example 01_step
//!
//! The platform moves forward at once, then returns while it tilts: the tilt's gravity replaces the
//! acceleration, which no travel can hold. Draws `target/examples/01_step.svg`.

use std::error::Error;
use std::ops::Range;

use moris_washout::{Input, Parameters, Washout};
use plotters::coord::Shift;
use plotters::prelude::*;

const STEP: f64 = 0.001; // s

fn main() -> Result<(), Box<dyn Error>> {
    let mut washout = Washout::new(&Parameters::default())?;
    let mut input = Input::default();
    let (mut desired, mut felt, mut surge, mut pitch) = (vec![], vec![], vec![], vec![]);
    for k in 0..15_000 {
        let t = f64::from(k) * STEP;
        input.specific_force.x = if t < 1.0 { 0.0 } else { 1.0 };
        washout.step(&input, STEP);
        if k % 25 == 24 {
            let output = washout.output();
            desired.push((t, input.specific_force.x));
            felt.push((t, output.felt_specific_force.x));
            surge.push((t, output.position.x));
            pitch.push((t, -output.orientation.pitch.to_degrees()));
        }
    }
    let lengths = washout.output().length.map(|length| format!("{length:.3}")).join(", ");
    println!("actuator lengths after 15 s: {lengths} m");

    std::fs::create_dir_all("target/examples")?;
    // The backend's coordinates are whole pixels: a large canvas, shown small, has smooth curves.
    let picture = SVGBackend::new("target/examples/01_step.svg", (1600, 1200)).into_drawing_area();
    picture.fill(&WHITE)?;
    let panels = picture.split_evenly((3, 1));
    let (grey, blue) = (RGBColor(150, 150, 150), RGBColor(31, 119, 180));
    draw(&panels[0], "felt surge, desired grey [m/s²]", -0.4..1.6, &[(grey, &desired), (blue, &felt)])?;
    draw(&panels[1], "platform's position, x [m]", -0.02..0.05, &[(blue, &surge)])?;
    draw(&panels[2], "platform's pitch, nose up [°]", -1.0..7.0, &[(blue, &pitch)])?;
    picture.present()?;
    println!("wrote target/examples/01_step.svg");
    Ok(())
}

/// Draws curves over time from 0 to 15 s.
fn draw<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    quantity: &str,
    range: Range<f64>,
    curves: &[(RGBColor, &[(f64, f64)])],
) -> Result<(), Box<dyn Error>>
where
    B::ErrorType: 'static,
{
    let font = ("sans-serif", 26);
    let chart = &mut ChartBuilder::on(area);
    let chart = chart.margin(24).x_label_area_size(60).y_label_area_size(110);
    let mut chart = chart.build_cartesian_2d(0.0..15.0, range)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("time [s]").y_desc(quantity).label_style(font).light_line_style(TRANSPARENT).y_labels(6).draw()?;
    for &(colour, points) in curves {
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(4)))?;
    }
    Ok(())
}
