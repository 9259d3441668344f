//! `cargo first-ride`: builds the FMU and simulates a ride through town with it. A picture shows
//! what the rider feels.

use std::fs;

use anyhow::{Context, Result};
use moris_build_fmu::workspace;
use moris_paper_runs::figures::write_ride;
use moris_paper_runs::fmu::built;
use moris_paper_runs::parameter_set::RIDE_SET;
use moris_paper_runs::simulate::simulate;
use moris_paper_runs::table::{force_table, platform_table};
use moris_simulation::drives::runs::TOWN_RUN;

fn main() -> Result<()> {
    // Communication step [s].
    const COMMUNICATION_STEP: f64 = 0.001;
    let ride = [simulate(&built()?, &TOWN_RUN, &RIDE_SET, COMMUNICATION_STEP)?];
    println!("{}", force_table(&ride));
    println!("{}", platform_table(&ride));
    let directory = workspace::target_directory().join("first-ride");
    fs::create_dir_all(&directory).with_context(|| format!("cannot make {}", directory.display()))?;
    let file = directory.join("ride.svg");
    write_ride(&file, &ride)?;
    println!("{}", file.display());
    Ok(())
}
