"""The Stewart platform with dynamics, against Newton's and Euler's equations written here once more, against energy, statics,
and the closed form of its actuators' response."""

import os
import shutil

import numpy as np
import pytest
from conftest import ANGLES, AXES, TARGET
from conftest import Washout as Instance
from fmpy import extract, read_model_description
from scipy.spatial.transform import Rotation

LEGS = range(1, 7)
STEP = 1e-3
VECTORS = [
    "platform.position", "platform.velocity", "platform.acceleration", "platform.angularVelocity",
    "platform.angularAcceleration", "rider.specificForce", "rider.angularVelocity",
]  # fmt: skip
PER_LEG = ["length", "velocity", "acceleration", "force", "stopForce"]
OUTPUTS = (
    [f"{vector}.{axis}" for vector in VECTORS for axis in AXES]
    + [f"platform.orientation.{angle}" for angle in ANGLES]
    + [f"actuator[{i}].{quantity}" for quantity in PER_LEG for i in LEGS]
    + ["actuator.totalPower"]
)


@pytest.fixture(scope="module")
def fmu():
    path = TARGET / "fmu" / "StewartPlatform.fmu"
    path = os.environ.get("MORIS_STEWART_PLATFORM_FMU", path)
    assert os.path.exists(path), f"{path} is missing: run `cargo build-fmu`"
    return path


@pytest.fixture(scope="module")
def made(fmu):
    """Makes initialised instances: made(parameters) -> Instance."""
    description, directory, instances = read_model_description(fmu), extract(fmu), []

    def make(parameters=None):
        instances.append(Instance(description, directory, parameters))
        return instances[-1]

    yield make
    for instance in instances:
        instance.slave.freeInstance()
    shutil.rmtree(directory, ignore_errors=True)


class Motion:
    """What an instance did: the columns of its outputs by name, a row a time."""

    def __init__(self, rows, times):
        self.times = times
        self.columns = dict(zip(OUTPUTS, rows.T))
        self.rotation = Rotation.from_euler("ZYX", np.stack([self[f"platform.orientation.{a}"] for a in ANGLES[::-1]], 1))

    def __getitem__(self, name):
        return self.columns[name]

    def vector(self, name):
        return np.stack([self[f"{name}.{axis}"] for axis in AXES], axis=1)

    def legs(self, quantity):
        return np.stack([self[f"actuator[{i}].{quantity}"] for i in LEGS], axis=1)


class Rig:
    """An instance's joints, masses and gravity, read from it."""

    def __init__(self, instance):
        self.base, self.platform = (
            np.array([instance.vector(f"rig.{part}[{i}]") for i in LEGS]) for part in ("base", "platform")
        )
        self.gravity = np.array([0, 0, -instance.get("gravity")[0]])
        self.head = np.array([0, 0, instance.get("head.height")[0]])
        bodies = [(*self.body(instance, name), self.inertia(instance, name)) for name in ("platform", "rider")]
        bodies.append((*self.body(instance, "payload"), np.zeros((3, 3))))
        self.mass = sum(mass for mass, _, _ in bodies)
        self.centre = sum(mass * centre for mass, centre, _ in bodies) / self.mass
        # About the common centre of mass.
        self.moments = sum(
            inertia + mass * (np.dot(d, d) * np.eye(3) - np.outer(d, d))
            for mass, centre, inertia in bodies
            for d in [centre - self.centre]
        )

    @staticmethod
    def body(instance, name):
        return instance.get(f"{name}.mass")[0], instance.vector(f"{name}.centreOfMass")

    @staticmethod
    def inertia(instance, name):
        xx, yy, zz, xy, xz, yz = instance.get(*(f"{name}.inertia.{c}" for c in ("xx", "yy", "zz", "xy", "xz", "yz")))
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def ride(instance, commands, rates=None, count=None, step=STEP):
    """Steps through commanded lengths, a row a step, with their rates where they are given."""
    inputs = {f"command[{i}].length": commands[:, i - 1] for i in LEGS}
    if rates is not None:
        inputs |= {f"command[{i}].velocity": rates[:, i - 1] for i in LEGS}
    begin = instance.time
    rows = instance.run(step, inputs, OUTPUTS)
    return Motion(rows, begin + step * np.arange(1, len(rows) + 1))


def rough(seconds, amplitude, seed, neutral, step=STEP):
    """Sums of sines about neutral, beginning gently: lengths, and the rates that lead from each to the next."""
    rng = np.random.default_rng(seed)
    t = step * np.arange(round(seconds / step) + 1)[:, None]
    lengths = np.zeros((len(t), 6))
    for _ in range(3):
        omega, phase = rng.uniform(1.0, 9.0, 6), rng.uniform(0, 2 * np.pi, 6)
        lengths += amplitude * rng.uniform(0.2, 1.0, 6) / omega * np.sin(omega * t + phase)
    lengths = neutral + (1 - np.exp(-(t**2))) * lengths
    return lengths[:-1], np.diff(lengths, axis=0) / step


def neutral(instance):
    return instance.get(*(f"actuator[{i}].length" for i in LEGS))


def newton_euler(rig, motion):
    """The residual force [N] and moment about the centre of mass [N m] that the legs' forces leave."""
    arms = motion.rotation.apply(rig.centre)
    omega, alpha = motion.vector("platform.angularVelocity"), motion.vector("platform.angularAcceleration")
    acceleration = motion.vector("platform.acceleration") + np.cross(alpha, arms) + np.cross(omega, np.cross(omega, arms))
    matrices = motion.rotation.as_matrix()
    moments = matrices @ rig.moments @ np.transpose(matrices, (0, 2, 1))
    spin = np.einsum("nij,nj->ni", moments, omega)
    force_needed = rig.mass * (acceleration - rig.gravity)
    moment_needed = np.einsum("nij,nj->ni", moments, alpha) + np.cross(omega, spin)
    carried = motion.legs("force") + motion.legs("stopForce")
    for i in range(6):
        joint = motion.rotation.apply(rig.platform[i])
        leg = motion.vector("platform.position") + joint - rig.base[i]
        along = carried[:, i, None] * leg / np.linalg.norm(leg, axis=1)[:, None]
        force_needed = force_needed - along
        moment_needed = moment_needed - np.cross(joint - arms, along)
    return force_needed, moment_needed


def energy(rig, motion):
    """Kinetic and potential energy of the moving body [J]."""
    arms = motion.rotation.apply(rig.centre)
    omega = motion.vector("platform.angularVelocity")
    velocity = motion.vector("platform.velocity") + np.cross(omega, arms)
    own = motion.rotation.inv().apply(omega)
    kinetic = 0.5 * rig.mass * np.sum(velocity**2, axis=1) + 0.5 * np.einsum("ni,ij,nj->n", own, rig.moments, own)
    return kinetic - rig.mass * (motion.vector("platform.position") + arms) @ rig.gravity


SKEW = {
    "payload.mass": 60.0, "payload.centreOfMass.x": 0.4, "payload.centreOfMass.y": -0.3, "payload.centreOfMass.z": 0.2,
    "platform.inertia.xy": 7.0, "platform.inertia.xz": -11.0, "rider.inertia.yz": 0.5, "actuator.forceLimit": 20e3,
}  # fmt: skip


@pytest.mark.parametrize("parameters", [{}, SKEW], ids=["default", "skew"])
def test_the_forces_are_those_of_newton_and_euler(made, parameters):
    instance = made(parameters)
    motion = ride(instance, *rough(20.0, 0.3, 5, neutral(instance)))
    force, moment = newton_euler(Rig(instance), motion)
    assert np.max(np.abs(motion.legs("force"))) > 1500.0, "the ride must be rough enough"
    assert np.max(np.abs(motion.vector("platform.angularVelocity"))) > 0.5
    assert np.max(np.abs(force)) < 1e-9 and np.max(np.abs(moment)) < 1e-9


def energy_error(made, parameters, step):
    """By how much the work of the drives differs from the change of the body's energy, as a fraction of the latter [1]."""
    instance = made(parameters | {"solver.maxStep": step})
    motion = ride(instance, *rough(6.0, 0.3, 5, neutral(instance), step), step=step)
    assert not np.any(motion.legs("stopForce"))
    power, change = motion["actuator.totalPower"], energy(Rig(instance), motion)
    work = np.concatenate([[0.0], np.cumsum(0.5 * step * (power[1:] + power[:-1]))])
    return np.max(np.abs(work - (change - change[0]))) / np.ptp(change)


@pytest.mark.parametrize("parameters", [{}, SKEW], ids=["default", "skew"])
def test_the_work_of_the_drives_is_the_change_of_energy(made, parameters):
    coarse, fine = (energy_error(made, parameters, step) for step in (1e-3, 2e-4))
    assert fine < 2e-5
    assert coarse / fine > 20.0, "the error must be that of the sum, of the second order in the step"


def test_the_work_of_saturated_drives_is_the_change_of_energy_too(made):
    # Forces that jump make the sum one of the first order.
    coarse, fine = (energy_error(made, {"actuator.forceLimit": 1500.0}, step) for step in (1e-3, 1e-4))
    assert coarse < 3e-3 and fine < 3e-4


def test_the_legs_the_pose_and_what_is_felt_belong_together(made):
    instance = made()
    rig = Rig(instance)
    motion = ride(instance, *rough(10.0, 0.15, 11, neutral(instance)))
    position = motion.vector("platform.position")
    for i in range(6):
        leg = position + motion.rotation.apply(rig.platform[i]) - rig.base[i]
        assert np.max(np.abs(np.linalg.norm(leg, axis=1) - motion.legs("length")[:, i])) < 1e-12
    # Central differences, of the fourth order, of the output that is the integral.
    inner = slice(2, -2)
    def slope(series):
        return (series[:-4] - 8 * series[1:-3] + 8 * series[3:-1] - series[4:]) / (12 * STEP)
    assert np.max(np.abs(slope(position) - motion.vector("platform.velocity")[inner])) < 1e-6
    for quantity, rate in (("length", "velocity"), ("velocity", "acceleration")):
        assert np.max(np.abs(slope(motion.legs(quantity)) - motion.legs(rate)[inner])) < 2e-3
    # What the head feels: its position twice differentiated, less gravity, in its axes.
    head = position + motion.rotation.apply(rig.head)
    acceleration = (-head[:-4] + 16 * head[1:-3] - 30 * head[2:-2] + 16 * head[3:-1] - head[4:]) / (12 * STEP**2)
    felt = motion.rotation[2:-2].inv().apply(acceleration - rig.gravity)
    difference = np.abs(felt - motion.vector("rider.specificForce")[inner])
    assert np.sqrt(np.mean(difference**2)) < 2e-3 and np.ptp(felt[:, 0]) > 1.0
    turning = (motion.rotation[:-1].inv() * motion.rotation[1:]).as_rotvec() / STEP
    between = 0.5 * (motion.vector("rider.angularVelocity")[1:] + motion.vector("rider.angularVelocity")[:-1])
    assert np.max(np.abs(turning - between)) < 1e-4


def test_at_rest_the_legs_carry_the_weight_wherever_it_is(made):
    for parameters in ({}, SKEW, {"payload.mass": 300.0, "payload.centreOfMass.x": -0.6}):
        instance = made(parameters)
        rig = Rig(instance)
        goal = neutral(instance) + [0.05, -0.04, 0.1, 0.02, -0.1, 0.03]
        motion = ride(instance, np.tile(goal, (3000, 1)))
        assert np.max(np.abs(motion.legs("length")[-1] - goal)) < 1e-9
        force, moment = newton_euler(rig, motion)
        assert np.max(np.abs(force)) < 1e-8 and np.max(np.abs(moment)) < 1e-8
        upwards, about_centre = np.zeros(3), np.zeros(3)
        for i in range(6):
            joint = motion.rotation[-1].apply(rig.platform[i])
            leg = motion.vector("platform.position")[-1] + joint - rig.base[i]
            along = motion.legs("force")[-1, i] * leg / np.linalg.norm(leg)
            upwards += along
            about_centre += np.cross(joint - motion.rotation[-1].apply(rig.centre), along)
        assert np.allclose(upwards, -rig.mass * rig.gravity, rtol=0, atol=1e-6)
        assert np.allclose(about_centre, 0, rtol=0, atol=1e-6)


@pytest.mark.parametrize("damping", [0.2, np.sqrt(0.5), 1.0, 1.6])
@pytest.mark.parametrize("communication_step, dead_time", [(1e-3, 4e-3), (1e-3, 0.0), (7e-3, 12.3e-3), (0.05, 0.01)])
def test_the_step_response_is_that_of_the_second_order_after_the_dead_time(made, damping, communication_step, dead_time):
    omega = 40.0
    instance = made({"actuator.bandwidth": omega, "actuator.damping": damping, "actuator.deadTime": dead_time})
    start = neutral(instance)
    jump = np.array([4e-3, -3e-3, 2e-3, 1e-3, -4e-3, 5e-3])
    motion = ride(instance, np.tile(start + jump, (round(0.6 / communication_step), 1)), step=communication_step)
    t = np.maximum(motion.times - dead_time, 0.0)
    if damping == 1.0:
        response = 1 - np.exp(-omega * t) * (1 + omega * t)
    else:
        damped = omega * np.sqrt(np.abs(1 - damping**2))
        even, odd = (np.cos, np.sin) if damping < 1 else (np.cosh, np.sinh)
        decay = np.exp(-damping * omega * t)
        response = 1 - decay * (even(damped * t) + damping * omega / damped * odd(damped * t))
    expected = start + response[:, None] * jump
    assert np.max(np.abs(motion.legs("length") - expected)) < 1e-11
    assert t[-1] > 0 and np.max(np.abs(expected - start)) > 3e-3


def test_commands_at_known_rates_are_followed_as_ramps(made):
    instance = made()
    start, omega, damping, dead_time = neutral(instance), 62.831853071795862, np.sqrt(0.5), 0.004
    rate = 0.1
    times = 0.02 * np.arange(25)
    commands = start + rate * times[:, None] * np.ones(6)
    motion = ride(instance, commands, np.full_like(commands, rate), step=0.02)
    # Far into a ramp a second-order system is behind it by 2 zeta / omega, and the dead time.
    late = motion.times[-5:] - 2 * damping / omega - dead_time
    assert np.max(np.abs(motion.legs("length")[-5:] - (start + rate * late[:, None]))) < 1e-9


def test_drives_without_the_force_fall_behind_and_never_exceed_it(made):
    limit = 900.0
    instance = made({"actuator.forceLimit": limit})
    commands = rough(20.0, 0.3, 5, neutral(instance))
    motion = ride(instance, *commands)
    drives, stops, lengths = motion.legs("force"), motion.legs("stopForce"), motion.legs("length")
    assert np.max(np.abs(drives)) == limit
    force, moment = newton_euler(Rig(instance), motion)
    assert np.max(np.abs(force)) < 1e-6 and np.max(np.abs(moment)) < 1e-6
    assert np.all(lengths >= 1.0) and np.all(lengths <= 1.6)
    at_stop = stops != 0
    assert np.any(at_stop), "the ride must be too rough"
    # A stop at the short end pushes, one at the long end pulls.
    assert np.all(lengths[stops > 0] == 1.0) and np.all(lengths[stops < 0] == 1.6)
    strong = ride(made(), *commands)
    assert not np.any(np.abs(strong.legs("force")) >= 4000.0)
    assert np.max(np.abs(strong.legs("length") - lengths)) > 0.1
