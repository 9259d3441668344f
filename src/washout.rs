//! The whole washout, the paper's Fig. 4: an input, an output, one step.

use moris_interface::{Group, MOST_INTERNAL_STEPS, ParameterError, SHORTEST_STEP};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::cueing::angular::AngularChannel;
use crate::cueing::automatic_scale::FittingScale;
use crate::cueing::compensation::{compensated, tangential};
use crate::cueing::conditioning::{
    ConditioningGlide, Cue, InputFilter, cue_force, forward_acceleration, gliding, scaled_cue, scaled_force,
    with_gliding,
};
use crate::cueing::direct_linear::DirectLinearMotion;
use crate::cueing::evaluator::{Felt, felt};
use crate::cueing::gravitational::Tilt;
use crate::cueing::preaction::StopPreaction;
use crate::cueing::soft_limits::SoftLimits;
use crate::cueing::soft_limits::glide::SoftLimitGlide;
use crate::cueing::strategy::Strategy;
use crate::cueing::strategy::law::StepContext;
use crate::cueing::strategy::predictive::preview::PreviewedCue;
use crate::interface::{
    ConditioningParameters, Input, Output, Parameters, Preaction, Preview, Reconstruction, StructureParameters,
};
use crate::motion::min_max::{max, min};
use crate::motion::orientation::RotationalMotion;
use crate::platform::{
    ActuatorGuard, Cranks, Legs, LocationFrame, PlatformCoordinates, PlatformMotion, PlatformState, joint_distances,
    leg_accelerations,
};
use crate::validate::{check, check_change};

/// The washout filter with its platform.
///
/// ```
/// use moris_washout::{Input, Parameters, Washout};
///
/// let mut washout = Washout::new(&Parameters::default())?;
/// let mut input = Input::default();
/// input.specific_force.x = 1.0; // m/s2: the vehicle accelerates
/// for _ in 0..10_000 {
///     washout.step(&input, 0.001);
/// }
/// let output = washout.output();
/// assert!((output.felt_specific_force.x - 1.0).abs() < 0.01); // ... and the rider feels it,
/// assert!(output.orientation.pitch < 0.0); // nose up,
/// assert!(output.length.iter().all(|length| (1.0..1.6).contains(length))); // within the stroke
/// # Ok::<(), moris_washout::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Washout {
    /// As set; some glide to these values.
    parameters: Parameters,
    /// The conditioning in force.
    conditioning: ConditioningParameters,
    conditioning_glide: ConditioningGlide,
    /// Parameters of the soft limits in force.
    soft_limit_glide: SoftLimitGlide,
    /// Fraction of the time to engage that has passed, 1: engaged, 0: disengaged, and its rate
    /// \[1/s\].
    engaging: f64,
    engaging_rate: f64,
    /// The input at the end of the last step, and its cue.
    last_input: CuedInput,
    scale: FittingScale,
    input_filter: InputFilter,
    preaction: StopPreaction,
    strategy: Strategy,
    angular: AngularChannel,
    direct_linear: DirectLinearMotion,
    soft_limits: SoftLimits,
    /// Time for which the input has been at rest \[s\].
    time_at_rest: f64,
    guard: ActuatorGuard,
    felt: Felt,
    limited_by: LimitedBy,
    /// Outputs without an exact derivative, one internal step ago.
    previous_step: PreviousStep,
}

/// The input's course over a step.
#[derive(Clone, Copy, Debug)]
pub enum InputCourse<'a> {
    /// The same all the time (zero-order hold).
    Held(&'a Input),
    /// Linear from the last step's to this one, which engages or disengages from the start on.
    Ramp(&'a Input),
    /// Linear from one to the other (first-order hold). The result is engaged if the first is.
    Between(&'a Input, &'a Input),
}

/// An input, the head with its lean, and the cue there before its limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct CuedInput {
    input: Input,
    head: LocationFrame,
    cue: Cue,
}

impl CuedInput {
    #[inline(always)]
    fn new(input: Input, conditioning: &ConditioningParameters, structure: &StructureParameters) -> Self {
        let head = LocationFrame::new(structure, input.lean);
        CuedInput { input, head, cue: scaled_cue(&input, conditioning, structure.gravity, head.lean) }
    }
}

/// Limits active in any internal step of the last communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct LimitedBy {
    tilt: bool,
    soft: bool,
    safety: bool,
    actuator: bool,
}

/// The last internal step and what was felt at its beginning.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct PreviousStep {
    step: f64,
    acceleration: Vector3<f64>,
    felt: Felt,
}

/// Least and longest time over which the cue fades in or out when the washout is engaged or
/// disengaged \[s\].
const ENGAGEMENT_TIMES: [f64; 2] = [4.0, 10.0];

/// Time in which a fade turns round after `engaged` has changed on its way \[s\].
const ENGAGEMENT_TURN_TIME: f64 = 1.0;

/// Change of the cue's horizontal force per second above which it fades more slowly \[m/s3\]: what
/// tilt at 3 degrees a second takes over. A faster fade would take the stroke.
const MAX_ENGAGEMENT_SLOPE: f64 = 0.5;

/// Time for which the soft limits act once the input rests \[s\]. A filter that they hold does not
/// unwind, and may push against them for ever. Without them it returns in its time constants.
const SOFT_LIMITS_REST_TIME: f64 = 30.0;

/// Fraction of their pace at which gentler soft limits must be able to stop the platform before
/// they come into force. The platform may come to rest anywhere below the speed \[m/s\].
const GENTLER_PACE_FRACTION: f64 = 0.8;
const GENTLE_SPEED: f64 = 0.01;

impl Washout {
    /// The washout at rest at neutral. [`warnings`](crate::warnings) has doubts that refuse
    /// nothing, such as a value in degrees, and [`input_warnings`](crate::input_warnings)
    /// those of the first input.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        check(parameters)?;
        let Parameters { splitter, angular, structure, rig, .. } = parameters;
        // The strategy, preaction and the washout location read the others.
        #[rustfmt::skip]
        let StructureParameters {
            gravity, splitter_order, angular_order, max_step, low_pass: _, strategy: _, preaction: _,
            head_height: _, torso_length: _, washout_location: _, washout_point: _,
        } = *structure;
        let guard = ActuatorGuard::new(rig, max_step);
        let strategy = Strategy::new(parameters)?;
        let soft_limits = SoftLimits::new(parameters, strategy.largest_heave());
        let last_input = CuedInput::new(Input::default(), &parameters.conditioning, structure);
        let at_rest = felt(&guard.commanded().motion, &last_input.head, gravity);
        Ok(Washout {
            parameters: *parameters,
            conditioning: parameters.conditioning,
            conditioning_glide: ConditioningGlide::default(),
            soft_limit_glide: SoftLimitGlide::at(parameters),
            engaging: 1.0,
            engaging_rate: 0.0,
            last_input,
            scale: FittingScale::new(parameters)?,
            input_filter: InputFilter::default(),
            preaction: StopPreaction::new(max_step),
            strategy,
            angular: AngularChannel::new(angular, angular_order, max_step),
            direct_linear: DirectLinearMotion::new(splitter, splitter_order, max_step),
            soft_limits,
            time_at_rest: 0.0,
            guard,
            felt: at_rest,
            limited_by: LimitedBy::default(),
            previous_step: PreviousStep { step: 0.0, acceleration: Vector3::zeros(), felt: at_rest },
        })
    }

    /// The washout at rest at neutral before its first step, with this input. The washout is
    /// disengaged if the input is, and the head is where the rider's lean puts it.
    pub fn starting_with(mut self, input: &Input) -> Self {
        self.last_input = self.cued(input.sanitized());
        self.engaging = f64::from(input.engaged);
        self.felt = felt(self.motion(), &self.last_input.head, self.parameters.structure.gravity);
        self.previous_step.felt = self.felt;
        self
    }

    /// Sets the specific force that is to come, as of the next step's start. Element k is the force
    /// that the input will have k times [`Preview::step`] later, k from 1. Only the predictive
    /// strategy uses it. A preview holds until the next one, and ends with its last element.
    ///
    /// Any preview is safe. A wrong one reduces fidelity until its errors show, but breaks no
    /// limit.
    ///
    /// ```
    /// use moris_washout::{Input, Parameters, Preview, Washout};
    ///
    /// let mut washout = Washout::new(&Parameters::default())?;
    /// // Braking at 3 m/s2 begins in 1 s.
    /// let surge = std::array::from_fn(|k| if k < 5 { 0.0 } else { -3.0 });
    /// for _ in 0..50 {
    ///     washout.preview(&Preview { count: 20, surge, ..Preview::default() });
    ///     washout.step(&Input::default(), 0.01);
    /// }
    /// assert!(washout.output().tilt_pitch > 0.01); // The nose goes down ahead of it.
    /// # Ok::<(), moris_washout::ParameterError>(())
    /// ```
    #[inline]
    pub fn preview(&mut self, preview: &Preview) {
        let (conditioning, structure) = (&self.conditioning, &self.parameters.structure);
        let CuedInput { input, head, .. } = &self.last_input;
        let (engagement, factor) = (self.engagement(), self.scale.factor());
        let Some(law) = self.strategy.as_previewing() else { return };
        let force = |[surge, sway]: [f64; 2]| Vector3::new(surge, sway, input.specific_force.z);
        law.preview(&PreviewedCue::of(preview, |forces| {
            let cue = cue_force(force(forces), input, conditioning, structure.gravity, head.lean, factor);
            [engagement * cue.x, engagement * cue.y]
        }));
        if self.scale.is_automatic() {
            self.scale.preview(&PreviewedCue::of(preview, |forces| {
                let cue = scaled_force(force(forces), input, conditioning, structure.gravity, head.lean);
                [engagement * cue.x, engagement * cue.y]
            }));
        }
    }

    /// Advances by `step` seconds with this input, of which no slopes are known.
    ///
    /// Any input is safe: components that are not a number count as at rest. A step shorter
    /// than [`SHORTEST_STEP`] does nothing. A step longer than [`MOST_INTERNAL_STEPS`] internal
    /// steps is cut off there.
    pub fn step(&mut self, input: &Input, step: f64) {
        self.follow(self.reconstructed(input), step, |_| ());
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    pub fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        self.follow(InputCourse::Between(start, end), step, |_| ());
    }

    /// The course of an input of which no slopes are known, as the parameter
    /// `input.reconstruction` says.
    pub fn reconstructed<'a>(&self, input: &'a Input) -> InputCourse<'a> {
        match self.parameters.conditioning.reconstruction {
            Reconstruction::Hold => InputCourse::Held(input),
            Reconstruction::Ramp => InputCourse::Ramp(input),
        }
    }

    /// Advances by `step` seconds with the input on this course, in internal steps. `observe`
    /// receives the felt specific force after each.
    pub fn follow(&mut self, course: InputCourse, step: f64, mut observe: impl FnMut(&Vector3<f64>)) {
        if step < SHORTEST_STEP || step.is_nan() {
            return;
        }
        let end = match course {
            InputCourse::Held(input) => {
                self.last_input = self.cued(input.sanitized());
                None
            }
            InputCourse::Ramp(end) => {
                let end = end.sanitized();
                self.last_input.input.engaged = end.engaged;
                if let Some(law) = self.strategy.as_previewing() {
                    law.delay_preview(step);
                    self.scale.delay_preview(step);
                }
                Some(end)
            }
            InputCourse::Between(start, end) => {
                self.last_input = self.cued(start.sanitized());
                Some(end.sanitized())
            }
        };
        let start = self.last_input.input;
        let count = self.internal_steps(step);
        let internal_step = min(step / count, self.parameters.structure.max_step);
        self.limited_by = LimitedBy::default();
        let mut done = 0.0;
        while done < count {
            done += 1.0;
            if !self.soft_limit_glide.is_at(&self.parameters) {
                self.glide_soft_limits(internal_step);
            }
            let glides = !self.conditioning_glide.is_over();
            if glides {
                self.conditioning_glide.advance(internal_step);
                self.conditioning = self.conditioning_glide.in_force(&self.parameters.conditioning);
            }
            let next = match &end {
                Some(end) => self.cued(start.towards(end, done / count)),
                None if glides => self.cued(start),
                None => self.last_input,
            };
            self.internal_step(&next, internal_step);
            self.last_input = next;
            observe(&self.felt.specific_force);
        }
    }

    /// The input with its cue by the conditioning in force.
    #[inline(always)]
    fn cued(&self, input: Input) -> CuedInput {
        CuedInput::new(input, &self.conditioning, &self.parameters.structure)
    }

    /// Number of internal steps in a step. A step a rounding error longer than the
    /// longest is not divided.
    fn internal_steps(&self, step: f64) -> f64 {
        const ROUNDING: f64 = 1e-9;
        let longest = self.parameters.structure.max_step;
        if step <= longest {
            1.0
        } else {
            libm::ceil(step / longest * (1.0 - ROUNDING)).clamp(1.0, MOST_INTERNAL_STEPS)
        }
    }

    /// One step of Fig. 4, from left to right. The cue goes linearly from the last sample to `end`.
    fn internal_step(&mut self, end: &CuedInput, step: f64) {
        let head_at_end = &end.head;
        // (1) Strategy splitter: scale, limits and low-pass of the cue. Its high- and low-pass are in
        // the strategy and in the chain of (3).
        let engagement_before = self.engagement();
        let (cue_start, cue_end) = self.limited_cues(end, engagement_before, step);
        self.engage(self.last_input.input.engaged, &cue_end.force, step);
        let engagement = self.engagement();
        let (cue_start, cue_end) = (cue_start.scaled(engagement_before), cue_end.scaled(engagement));
        let (mut cue_start, mut cue_end) = self.input_filter.advance(cue_start, cue_end, &self.conditioning, step);
        self.preact(&mut cue_start, &mut cue_end, &end.input, step);

        let rotation_at_end = self.motion().rotation_after(step);
        let force_start = self.motion().orientation.rotation * self.last_input.head.to_platform_axes(cue_start.force);
        let force_end = rotation_at_end * head_at_end.to_platform_axes(cue_end.force);
        let Parameters { conditioning, safety, structure, rig, .. } = &self.parameters;
        // (5), (6) Angular channel.
        let channel_angles = self.angular.advance(cue_start.rates, cue_end.rates, step);
        // (2) Gravitational strategy: tilt. Disengaged, the platform does not make up for the rider's
        // lean either.
        let lean = head_at_end.lean * engagement;
        let context = StepContext {
            parameters: &self.parameters,
            guard: &self.guard,
            head: head_at_end,
            force: cue_end.force,
            angles: &channel_angles,
            lean,
            engagement,
            time_to_stop: self.preaction.time_left(),
        };
        self.strategy.advance_tilt([force_start, force_end], &rotation_at_end, &context, step);
        let [tilt_roll, tilt_pitch] = self.strategy.tilt();
        let mut angles = channel_angles;
        angles.add_to_axis(0, &tilt_roll);
        angles.add_to_axis(1, &tilt_pitch);
        // (4) Compensation of spurious accelerations.
        let turning = RotationalMotion::new(&angles);
        let arm = turning.orientation.rotation * head_at_end.point;
        let tilt = Tilt { roll: tilt_roll.position, pitch: tilt_pitch.position };
        let spurious = compensated(conditioning.compensation, &turning, arm, &tilt, structure.gravity);
        // (3) Direct linear motion, with its safety units below.
        let filtered = self.direct_linear.advance_filters([force_start - spurious, force_end - spurious], step);
        let linear = self.strategy.demand(filtered, self.preaction.surge(), &context, &turning, step);
        let coordinates = PlatformCoordinates { linear, angles };
        let mut demand = PlatformState::turning(coordinates, &turning, self.guard.geometry(), rig.neutral_height);
        // Soft limits, safety units and actuator guard: each may change the demand.
        let at_rest = cue_end.asks_for_no_motion() && lean == 0.0;
        self.time_at_rest = if at_rest { self.time_at_rest + step } else { 0.0 };
        let soft = self.soft_limits.enabled() && self.time_at_rest <= SOFT_LIMITS_REST_TIME;
        let tilt_compensation = if self.strategy.allows_tilt_overshoot(conditioning.compensation) {
            let tilting = Vector3::new(tilt_roll.acceleration, tilt_pitch.acceleration, 0.0);
            -tangential(tilting, arm).component_mul(&Vector3::new(1.0, 1.0, 0.0))
        } else {
            Vector3::zeros()
        };
        if !soft {
            self.soft_limits.release();
        } else if let Some(limited) = self.soft_limits.apply(&demand, self.guard.commanded(), &tilt_compensation, step)
        {
            demand = self.guard.state(limited);
            self.limited_by.soft = true;
        }
        let linear = *self.direct_linear.advance_within_limits(&demand.coordinates.linear, safety, step);
        if self.direct_linear.deviates() {
            demand = self.guard.state(PlatformCoordinates { linear, ..demand.coordinates });
        }
        self.previous_step = PreviousStep { step, acceleration: self.motion().acceleration, felt: self.felt };
        self.guard.advance(&demand, safety, at_rest, step);
        self.felt = felt(self.motion(), head_at_end, structure.gravity);
        self.limited_by.tilt |= self.strategy.tilt_limited();
        self.limited_by.safety |= self.direct_linear.limited();
        self.limited_by.actuator |= self.guard.limited();
        if soft {
            if self.soft_limits.limited() || self.direct_linear.deviates() || self.guard.limited() {
                self.continue_from_real(cue_end.rates);
            }
        } else if self.guard.limited() {
            let real = &self.guard.commanded().coordinates.linear;
            self.strategy.resume(&mut self.direct_linear, &self.parameters, real);
        }
    }

    /// Brings the soft limits nearer to their parameters, as far as the platform keeps them.
    #[cold]
    fn glide_soft_limits(&mut self, step: f64) {
        let heave = self.strategy.largest_heave();
        let idle = !self.soft_limits.limited();
        let next = self.soft_limit_glide.after(&self.parameters, idle, step);
        let limits = SoftLimits::new(&next.in_force(&self.parameters), heave);
        if !next.is_gentler_than(&self.soft_limit_glide)
            || limits.stops_in_time(self.guard.commanded(), GENTLER_PACE_FRACTION, GENTLE_SPEED)
        {
            self.soft_limit_glide = next;
            self.soft_limits.retune(&next.in_force(&self.parameters), heave);
        }
    }

    /// Continues the filters from the motion that the platform really makes, where a limit has
    /// changed it. `rates` are those at the step's end.
    #[cold]
    fn continue_from_real(&mut self, rates: Vector3<f64>) {
        let PlatformCoordinates { linear, angles } = &self.guard.commanded().coordinates;
        if self.guard.limited() || self.direct_linear.deviates() {
            self.direct_linear.continue_from(linear);
        }
        let mut linear = *linear;
        if self.strategy.takes_preaction() {
            let surge = self.preaction.surge();
            linear.position.x -= surge.position;
            linear.velocity.x -= surge.velocity;
        }
        self.direct_linear.continue_filters_from(&linear);
        let (mut angle, mut rate) = (angles.position, angles.velocity);
        for (k, tilt) in self.strategy.tilt().iter().enumerate() {
            angle[k] -= tilt.position;
            rate[k] -= tilt.velocity;
        }
        self.angular.continue_from(&angle, &rate, rates);
    }

    /// The cue at the step's start and end, times the automatic scale there, and limited.
    fn limited_cues(&mut self, end: &CuedInput, engagement: f64, step: f64) -> (Cue, Cue) {
        let before = self.scale.factor();
        // Disengaged, there is nothing to choose a scale by.
        if engagement > 0.0 {
            let references = [engagement * end.cue.force.x, engagement * end.cue.force.y];
            self.scale.advance(references, &self.parameters, step);
        }
        let start = self.last_input.cue.limited(before, &self.conditioning);
        let end = end.cue.limited(self.scale.factor(), &self.conditioning);
        if self.conditioning_glide.is_over() {
            (start, end)
        } else {
            (self.conditioning_glide.corrected(start), self.conditioning_glide.corrected(end))
        }
    }

    /// Advances the fraction of the time to engage on the way to `engaged`, under a cue with this
    /// force. Where the way turns round, it does so gradually.
    fn engage(&mut self, engaged: bool, force: &Vector3<f64>, step: f64) {
        let end = f64::from(engaged);
        if self.engaging == end {
            self.engaging_rate = 0.0;
            return;
        }
        let [least, longest] = ENGAGEMENT_TIMES;
        let pace = 1.0 / (force.xy().norm() / MAX_ENGAGEMENT_SLOPE).clamp(least, longest);
        let rate = if engaged { pace } else { -pace };
        let change = 2.0 * pace * step / ENGAGEMENT_TURN_TIME;
        let before = self.engaging_rate;
        self.engaging_rate = if before == 0.0 { rate } else { max(min(rate, before + change), before - change) };
        self.engaging = min(max(self.engaging + self.engaging_rate * step, 0.0), 1.0);
    }

    /// Changes the cue ahead of a stop, with `preaction` on.
    fn preact(&mut self, start: &mut Cue, end: &mut Cue, input: &Input, step: f64) {
        let Parameters { conditioning, tilt, safety, structure, .. } = &self.parameters;
        if structure.preaction == Preaction::On {
            let acceleration = self.engagement() * forward_acceleration(input, conditioning, structure.gravity);
            let braking = [end.force.x, acceleration, input.speed];
            self.preaction.advance(braking, structure.gravity, tilt, safety, step);
            if self.strategy.takes_preaction() {
                start.force.x = self.preaction.tilted_force(start.force.x);
                end.force.x = self.preaction.tilted_force(end.force.x);
            }
        }
    }

    /// Fraction of the cue in force: 1 engaged, 0 disengaged, between while it fades.
    pub fn engagement(&self) -> f64 {
        // Without a kink at either end.
        self.engaging * self.engaging * (3.0 - 2.0 * self.engaging)
    }

    /// Changes the tunable parameters. Position, velocity, angles and rates of the platform stay
    /// what they are, and so does the felt force. Both fade to those of the new parameters within
    /// 2 s.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why. Fixed parameters cannot be changed.
    /// Nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        check_change(&self.parameters, parameters)?;
        let nothing_cued =
            self.last_input.cue.force.xy() == Vector2::zeros() && self.last_input.cue.rates == Vector3::zeros();
        let mut scale = self.scale;
        scale.retune(parameters, nothing_cued)?;
        self.strategy.retune(parameters)?;
        // From here on nothing fails.
        self.scale = scale;
        let spurious_before = self.spurious();
        let before = core::mem::replace(&mut self.parameters, *parameters);
        self.soft_limit_glide.tighten(&parameters.safety);
        if nothing_cued && self.motion().velocity == Vector3::zeros() {
            self.soft_limit_glide = SoftLimitGlide::at(parameters);
        }
        self.soft_limits.retune(&self.soft_limit_glide.in_force(parameters), self.strategy.largest_heave());
        let Parameters { conditioning, splitter, angular, structure, .. } = parameters;
        if before.conditioning != *conditioning {
            let numbers = gliding(if nothing_cued { conditioning } else { &self.conditioning });
            let cue_by_choices_of = |choices: &ConditioningParameters| {
                let parameters = with_gliding(choices, numbers);
                let cue = CuedInput::new(self.last_input.input, &parameters, structure).cue;
                cue.limited(self.scale.factor(), &parameters)
            };
            let jump = cue_by_choices_of(&before.conditioning).less(&cue_by_choices_of(conditioning));
            self.conditioning_glide.begin(&before.conditioning, conditioning, &jump);
            if nothing_cued {
                self.conditioning_glide.end();
            }
            self.conditioning = self.conditioning_glide.in_force(conditioning);
            self.last_input = self.cued(self.last_input.input);
        }
        let jump = self.spurious() - spurious_before;
        self.direct_linear.retune(splitter, structure.splitter_order, jump);
        self.angular.retune(angular, structure.angular_order);
        Ok(())
    }

    /// Acceleration that is compensated now, in the base frame \[m/s2\].
    fn spurious(&self) -> Vector3<f64> {
        let Parameters { conditioning, structure, .. } = &self.parameters;
        let turning = RotationalMotion::new(&self.guard.demand().angles);
        let arm = turning.orientation.rotation * self.last_input.head.point;
        let [roll, pitch] = self.strategy.tilt().map(|tilt| tilt.position);
        compensated(conditioning.compensation, &turning, arm, &Tilt { roll, pitch }, structure.gravity)
    }

    /// The parameters, as last set.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The platform's motion as commanded, with its accelerations.
    pub fn motion(&self) -> &PlatformMotion {
        &self.guard.commanded().motion
    }

    /// The output now.
    pub fn output(&self) -> Output {
        let PlatformState { motion, legs, .. } = self.guard.commanded();
        let [tilt_roll, tilt_pitch] = self.strategy.tilt();
        let (plan_kept, plan_age, plan_iterations) = match self.strategy.plan() {
            Some(plan) => (plan.kept, plan.age, plan.iterations as i32),
            None => (false, 0.0, 0),
        };
        // References, so that each value is copied once.
        let of_cranks;
        let (legs, [angle, angular_rate]) = match &self.guard.geometry().cranks {
            None => (legs, &[[0.0; 6]; 2]),
            Some(cranks) => {
                of_cranks = self.crank_outputs(cranks);
                (&of_cranks.0, &of_cranks.1)
            }
        };
        Output {
            position: motion.position,
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            orientation: motion.orientation.angles,
            angular_velocity: motion.angular_velocity,
            length: legs.position,
            leg_velocity: legs.velocity,
            felt_specific_force: self.felt.specific_force,
            felt_angular_velocity: self.felt.angular_velocity,
            tilt_roll: tilt_roll.position,
            tilt_pitch: tilt_pitch.position,
            tilt_roll_rate: tilt_roll.velocity,
            tilt_pitch_rate: tilt_pitch.velocity,
            tilt_limited: self.limited_by.tilt,
            safety_active: self.limited_by.safety,
            actuator_limited: self.limited_by.actuator,
            stroke_margin: self.guard.actuator_clearance(),
            plan_kept,
            plan_age,
            plan_iterations,
            soft_limited: self.limited_by.soft,
            scale_factor: self.scale.factor(),
            angle: *angle,
            angular_rate: *angular_rate,
        }
    }

    /// Distances of the cranks' joints and their rates, angles of the arms and their rates.
    #[inline(never)]
    fn crank_outputs(&self, cranks: &Cranks) -> (Legs, [[f64; 6]; 2]) {
        let PlatformState { motion, legs, .. } = self.guard.commanded();
        let angles = [legs.position, legs.velocity].map(|values| values.map(|value| value / cranks.arm));
        (joint_distances(self.guard.geometry(), motion), angles)
    }

    /// The time derivative of the output now; the flags in it have no meaning.
    ///
    /// The derivative is exact but for the platform's acceleration and for what the rider feels:
    /// those are means over the last internal step, zero before the first.
    pub fn output_derivative(&self) -> Output {
        let PlatformState { motion, legs, .. } = self.guard.commanded();
        let accelerations = self.guard.leg_accelerations();
        let (leg_rates, leg_velocity, angle, angular_rate) = match &self.guard.geometry().cranks {
            None => (legs.velocity, accelerations, [0.0; 6], [0.0; 6]),
            Some(cranks) => {
                let legs_between = self.guard.geometry().with_legs();
                let [rates, accelerations] =
                    [legs.velocity, accelerations].map(|values| values.map(|value| value / cranks.arm));
                let distances = joint_distances(&legs_between, motion);
                (distances.velocity, leg_accelerations(&legs_between, motion), rates, accelerations)
            }
        };
        let [tilt_roll, tilt_pitch] = self.strategy.tilt();
        let per_step = if self.previous_step.step > 0.0 { 1.0 / self.previous_step.step } else { 0.0 };
        Output {
            position: motion.velocity,
            velocity: motion.acceleration,
            acceleration: (motion.acceleration - self.previous_step.acceleration) * per_step,
            orientation: motion.orientation.rates(motion.angular_velocity),
            angular_velocity: motion.angular_acceleration,
            length: leg_rates,
            leg_velocity,
            angle,
            angular_rate,
            felt_specific_force: (self.felt.specific_force - self.previous_step.felt.specific_force) * per_step,
            felt_angular_velocity: (self.felt.angular_velocity - self.previous_step.felt.angular_velocity) * per_step,
            tilt_roll: tilt_roll.velocity,
            tilt_pitch: tilt_pitch.velocity,
            tilt_roll_rate: tilt_roll.acceleration,
            tilt_pitch_rate: tilt_pitch.acceleration,
            stroke_margin: self.guard.actuator_clearance_rate(),
            plan_age: f64::from(self.strategy.plan().is_some()),
            scale_factor: self.scale.factor_rate(),
            tilt_limited: false,
            safety_active: false,
            actuator_limited: false,
            plan_kept: false,
            plan_iterations: 0,
            soft_limited: false,
        }
    }
}
