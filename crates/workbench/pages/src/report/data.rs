//! Plain data of a report.
//!
//! All quantities are in SI units and in the frames of the washout: x forward, y left, z up;
//! positive pitch is nose down. Every series of a [`Run`] has one value for each of its times.

use moris_simulation::measures::Row;
use moris_simulation::{Finding, Limits, TiltFlags};
use moris_washout::Parameters;
use serde::Serialize;

use crate::report::encode::{curve, curves, flags, times};
use crate::report::simulator::Simulator;

/// Data of a report's page.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// The heading, for instance the recording's name.
    pub title: String,
    /// One line below the heading: which recording, on which rig, with which parameters.
    pub subtitle: String,
    /// Findings that hold for every run, below those of the run.
    pub findings: Vec<Finding>,
    /// Facts for the foot of the page as name and value: files, versions, step.
    pub provenance: Vec<(String, String)>,
    pub rig: Rig,
    /// The drawing on the platform.
    pub vehicle: Vehicle,
    /// The runs, for instance with the default parameters and with tuned ones. At least one.
    pub runs: Vec<Run>,
    /// Which of the runs the platform shows first.
    pub selected: usize,
    /// The simulation of the recording with other parameters; none for a page that only shows.
    pub simulator: Option<Simulator>,
    /// Why a page of a recording cannot simulate, in the place of its sliders.
    pub no_simulator_because: Option<&'static str>,
}

/// The mock-up on the platform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Vehicle {
    #[default]
    Motorcycle,
    Car,
}

/// The Stewart platform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Rig {
    /// Joints on the base in the base frame, leg by leg \[m\].
    pub base: [[f64; 3]; 6],
    /// Joints on the platform in the platform frame \[m\].
    pub platform: [[f64; 3]; 6],
    /// Height of the platform frame's origin in the base frame at neutral \[m\].
    pub neutral_height: f64,
    /// Shortest and longest length of a leg, or lowest and highest arc of a crank's arm \[m\].
    pub stroke: [f64; 2],
    /// The cranks in the place of legs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cranks: Option<Cranks>,
    /// Height of the upright rider's head above the platform frame's origin \[m\].
    pub head_height: f64,
    /// Length of the torso, about whose lower end the rider leans \[m\].
    pub torso_length: f64,
}

/// Arms of cranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cranks {
    /// Length of an arm \[m\].
    pub arm: f64,
    /// Headings of the level arms, from x towards y \[rad\].
    pub heading: [f64; 6],
}

impl From<&Parameters> for Rig {
    fn from(parameters: &Parameters) -> Self {
        let Parameters { structure, rig, .. } = parameters;
        Rig {
            base: rig.base.map(Into::into),
            platform: rig.platform.map(Into::into),
            neutral_height: rig.neutral_height,
            stroke: rig.stroke(),
            cranks: rig.has_cranks().then_some(Cranks { arm: rig.crank_arm, heading: rig.crank_heading }),
            head_height: structure.head_height,
            torso_length: structure.torso_length,
        }
    }
}

/// One recording with one set of parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Run {
    /// Short name for legends, such as `default` or `tuned`.
    pub name: String,
    /// The verdict with what to change, in a sentence or two; empty without one.
    pub verdict: Finding,
    /// Findings, in order of importance.
    pub findings: Vec<Finding>,
    /// Factor on surge, sway and the rates with which the recording is felt the right way round.
    /// None where it is already, and where no factor was searched for or found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fitting_scale: Option<f64>,
    /// Times of the samples \[s\], ascending.
    #[serde(serialize_with = "times")]
    pub times: Vec<f64>,
    /// Desired: motion at the head of the vehicle's rider.
    pub desired: Cues,
    /// Felt: motion at the head of the rider on the platform.
    pub felt: Cues,
    /// Position of the platform frame's origin in the base frame: x, y, z \[m\].
    #[serde(serialize_with = "curves")]
    pub position: [Vec<f64>; 3],
    /// Orientation of the platform: roll, pitch, yaw \[rad\].
    #[serde(serialize_with = "curves")]
    pub orientation: [Vec<f64>; 3],
    /// The legs' lengths, or the arcs of the cranks' arms \[m\].
    #[serde(serialize_with = "curves")]
    pub legs: [Vec<f64>; 6],
    /// Tilt coordination's part of roll and pitch \[rad\].
    #[serde(serialize_with = "curves")]
    pub tilt: [Vec<f64>; 2],
    /// Rates of that part \[rad/s\].
    #[serde(serialize_with = "curves")]
    pub tilt_rate: [Vec<f64>; 2],
    /// The rider's lean, positive to the right \[rad\]; empty for a rider without lean.
    #[serde(serialize_with = "curve")]
    pub lean: Vec<f64>,
    pub limited: LimitHistory,
    pub limits: Limits,
    /// The table's rows for this run. Rows of several runs with the same group and name
    /// are shown side by side.
    pub measures: Vec<Row>,
    /// Further charts, below the others; a chart of the same title in another run joins it.
    pub charts: Vec<Chart>,
}

/// Specific force and angular velocity at the rider's head, in head axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cues {
    /// x, y, z \[m/s2\]; (0, 0, 9.81) at rest.
    #[serde(serialize_with = "curves")]
    pub specific_force: [Vec<f64>; 3],
    /// x, y, z \[rad/s\].
    #[serde(serialize_with = "curves")]
    pub angular_velocity: [Vec<f64>; 3],
}

/// Limits active during the step before each sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LimitHistory {
    /// A limit held tilt coordination back from its target: any of `tilt_by`.
    #[serde(serialize_with = "flags")]
    pub tilt: Vec<bool>,
    /// Which limit, of roll and of pitch.
    #[serde(skip)]
    pub tilt_by: TiltFlags,
    /// The soft limits changed the motion ahead of a hard limit.
    #[serde(serialize_with = "flags")]
    pub soft: Vec<bool>,
    /// A safety unit limited the platform.
    #[serde(serialize_with = "flags")]
    pub safety: Vec<bool>,
    /// True while the actuator guard limits a leg.
    #[serde(serialize_with = "flags")]
    pub actuator: Vec<bool>,
}

/// A further chart over time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Chart {
    pub title: String,
    /// Label of the vertical axis, with its unit.
    pub quantity: String,
    /// Times of the lines' values \[s\]; empty: the run's.
    #[serde(serialize_with = "times")]
    pub times: Vec<f64>,
    pub lines: Vec<Line>,
    /// Values drawn as dashed lines across the chart.
    pub limits: Vec<f64>,
}

/// A curve of a [`Chart`].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Line {
    pub label: String,
    /// One value for each time; a value that is not a number is a gap.
    #[serde(serialize_with = "curve")]
    pub values: Vec<f64>,
}
