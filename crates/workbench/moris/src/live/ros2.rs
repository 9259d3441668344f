//! Telemetry from a topic of ROS 2 with messages `sensor_msgs/Imu`, by DDS.
//!
//! Their axes and units are ours: x forward, y left, z up, m/s2 with gravity, rad/s. They have no
//! speed.

use std::env;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::task::{Wake, Waker};
use std::thread::{self, Thread};

use anyhow::{Context, Result, ensure};
use moris_live::{Motion, Sample};
use moris_washout::interface::RollPitchYaw;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rtrb::Producer;
use rustdds::no_key::SimpleDataReader;
use rustdds::policy::{History, Reliability};
use rustdds::{CDRDeserializerAdapter, DomainParticipant, DomainParticipantBuilder, QosPolicyBuilder, TopicKind};
use serde::Deserialize;

use super::telemetry::{PATIENCE, Received};
use super::{Shared, pace};

/// Name of the messages' type in DDS.
const TYPE: &str = "sensor_msgs::msg::dds_::Imu_";
/// Domains whose ports exist.
const DOMAINS: u16 = 233;
/// Messages that are kept until they are taken.
const KEPT: i32 = 16;

/// `sensor_msgs/Imu`.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
pub struct Imu {
    header: Header,
    /// x, y, z, w.
    orientation: [f64; 4],
    orientation_covariance: [f64; 9],
    angular_velocity: [f64; 3],
    angular_velocity_covariance: [f64; 9],
    linear_acceleration: [f64; 3],
    linear_acceleration_covariance: [f64; 9],
}

#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(serde::Serialize))]
struct Header {
    seconds: i32,
    nanoseconds: u32,
    /// Not used, but the numbers begin behind it.
    _frame: String,
}

impl Imu {
    /// The motion; none without an acceleration. Numbers in it may be infinite or no numbers.
    fn sample(&self) -> Option<Sample> {
        // A driver says by this number that it measures no such thing.
        let has = |covariance: &[f64; 9]| covariance[0] != -1.0;
        let [x, y, z, w] = self.orientation;
        let has_angles = has(&self.orientation_covariance) && self.orientation != [0.0; 4];
        let (roll, pitch, yaw) = match has_angles {
            true => UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).euler_angles(),
            false => (0.0, 0.0, 0.0),
        };
        let rates = if has(&self.angular_velocity_covariance) { self.angular_velocity } else { [0.0; 3] };
        let Header { seconds, nanoseconds, .. } = self.header;
        let motion = Motion::new(
            self.linear_acceleration.into(),
            Vector3::from(rates),
            RollPitchYaw::new(roll, pitch, yaw),
            0.0,
        );
        has(&self.linear_acceleration_covariance).then_some(Sample {
            time: (seconds != 0 || nanoseconds != 0).then(|| f64::from(seconds) + 1e-9 * f64::from(nanoseconds)),
            motion,
            position: None,
            paused: false,
            has_angles,
        })
    }
}

/// A subscription to a topic.
pub struct Subscription {
    reader: SimpleDataReader<Imu, CDRDeserializerAdapter<Imu>>,
    _participant: DomainParticipant,
}

impl Subscription {
    /// A subscription in the domain of `ROS_DOMAIN_ID`; with nodes of this machine alone, or with
    /// others.
    ///
    /// # Errors
    /// The name or the domain cannot be used, or there is no socket.
    pub fn open(topic: &str, listen: bool) -> Result<Self> {
        let domain = env::var("ROS_DOMAIN_ID").unwrap_or_default();
        let domain = if domain.is_empty() { Ok(0) } else { domain.parse() };
        Self::in_domain(domain.context("ROS_DOMAIN_ID")?, topic, listen)
    }

    fn in_domain(domain: u16, topic: &str, listen: bool) -> Result<Self> {
        ensure!(domain < DOMAINS, "ROS_DOMAIN_ID must be below {DOMAINS}");
        let is_name =
            |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let name = topic.strip_prefix('/').filter(|name| name.split('/').all(is_name));
        let name = name.context("a topic is named like /imu/data")?;
        let builder = DomainParticipantBuilder::new(domain);
        let builder = if listen { builder } else { builder.with_only_networks([Ipv4Addr::LOCALHOST]) };
        let participant = builder.build()?;
        let qos = QosPolicyBuilder::new()
            .reliability(Reliability::BestEffort)
            .history(History::KeepLast { depth: KEPT })
            .build();
        let topic = participant.create_topic(format!("rt/{name}"), TYPE.to_owned(), &qos, TopicKind::NoKey)?;
        let reader = participant.create_subscriber(&qos)?.create_simple_datareader_no_key(&topic, None)?;
        Ok(Subscription { reader, _participant: participant })
    }

    /// Passes samples on until all has ended.
    pub fn run(self, mut samples: Producer<Received>, shared: &Shared) {
        let waker = Waker::from(Arc::new(Unpark(thread::current())));
        while !shared.done.load(Ordering::Relaxed) {
            self.reader.set_waker(Some(waker.clone()));
            self.reader.drain_read_notifications();
            loop {
                let taken = self.reader.try_take_one();
                if matches!(taken, Ok(None)) {
                    break;
                }
                let arrival = pace::now();
                match taken.ok().flatten().and_then(|change| change.into_value().sample()) {
                    // A loop that is so late that the ring is full has no use for it.
                    Some(sample) => drop(samples.push(Received { arrival, sample })),
                    None => {
                        shared.dropped.fetch_add(1, Ordering::Relaxed);
                    }
                }
            }
            thread::park_timeout(PATIENCE);
        }
    }
}

/// Wakes a thread.
struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }
}

#[cfg(test)]
mod tests {
    use std::process;
    use std::time::{Duration, Instant};

    use proptest::prelude::*;
    use rtrb::RingBuffer;
    use rustdds::RepresentationIdentifier;
    use rustdds::no_key::DeserializerAdapter;

    use super::*;

    /// A message as the Python package rosbags 0.11 writes it.
    fn golden() -> Vec<u8> {
        let mut bytes = vec![0; 320];
        let mut write = |at: usize, numbers: &[u8]| bytes[at..at + numbers.len()].copy_from_slice(numbers);
        write(0, &[0x00, 0xF1, 0x53, 0x65]); // 1,700,000,000 s
        write(4, &[0x80, 0xB2, 0xE6, 0x0E]); // 250,000,000 ns
        write(8, b"\x09\0\0\0imu_link\0");
        write(40, &[0x33, 0x33, 0x33, 0x33, 0x33, 0x33, 0xE3, 0x3F]); // z 0.6
        write(48, &[0x9A, 0x99, 0x99, 0x99, 0x99, 0x99, 0xE9, 0x3F]); // w 0.8
        write(134, &[0xD0, 0x3F]); // angular velocity 0.25,
        write(142, &[0xE0, 0xBF]); // -0.5,
        write(150, &[0xF0, 0x3F]); // 1
        write(231, &[0xC0]); // acceleration -2,
        write(238, &[0xE0, 0x3F]); // 0.5,
        write(246, &[0x24, 0x40]); // 10
        bytes
    }

    fn decoded(bytes: &[u8]) -> Option<Imu> {
        CDRDeserializerAdapter::<Imu>::from_bytes(bytes, RepresentationIdentifier::CDR_LE).ok()
    }

    #[test]
    fn a_message_of_ros_2() {
        let sample = decoded(&golden()).unwrap().sample().unwrap();
        assert_eq!((sample.time, sample.has_angles, sample.paused), (Some(1_700_000_000.25), true, false));
        let motion = sample.motion;
        assert_eq!(motion.force(), Vector3::new(-2.0, 0.5, 10.0));
        assert_eq!(motion.rates(), Vector3::new(0.25, -0.5, 1.0));
        let left = 2.0 * 0.6_f64.atan2(0.8);
        assert!((motion.angles().to_vector() - Vector3::new(0.0, 0.0, left)).amax() < 1e-12, "{motion:?}");
        assert_eq!(motion.speed(), 0.0);
    }

    #[test]
    fn a_turn_about_each_axis_has_the_sign_of_the_washout() {
        let (sin, cos) = 0.15_f64.sin_cos();
        for axis in 0..3 {
            let mut imu = decoded(&golden()).unwrap();
            imu.orientation = [0.0, 0.0, 0.0, cos];
            imu.orientation[axis] = sin;
            let mut expected = Vector3::zeros();
            expected[axis] = 0.3;
            let angles = imu.sample().unwrap().motion.angles();
            assert!((angles.to_vector() - expected).amax() < 1e-12, "{angles:?}");
        }
    }

    #[test]
    fn what_a_driver_does_not_measure_is_left_out() {
        let imu = decoded(&golden()).unwrap();
        let mut blind = Imu { orientation: [0.0; 4], angular_velocity: [f64::NAN; 3], ..imu.clone() };
        blind.angular_velocity_covariance[0] = -1.0;
        (blind.header.seconds, blind.header.nanoseconds) = (0, 0);
        let sample = blind.sample().unwrap();
        assert_eq!((sample.time, sample.has_angles), (None, false));
        assert_eq!((sample.motion.rates(), sample.motion.angles()), (Vector3::zeros(), RollPitchYaw::default()));
        let broken = Imu { orientation: [f64::NAN; 4], ..imu.clone() };
        assert!(!broken.sample().unwrap().is_plausible());
        let mut still = imu;
        still.linear_acceleration_covariance[0] = -1.0;
        assert!(still.sample().is_none());
    }

    proptest! {
        #[test]
        fn any_bytes_are_decoded_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), cut in 0..320_usize) {
            let _ = decoded(&bytes);
            // A message whose end is replaced.
            let mut message = golden();
            message.truncate(cut);
            message.extend(bytes);
            let _ = decoded(&message).and_then(|imu| imu.sample()).map(|sample| sample.is_plausible());
        }
    }

    /// A publisher and a subscription of this process, which find each other on the loopback alone.
    #[test]
    fn messages_of_a_publisher_arrive_as_samples() {
        let domain = 100 + (process::id() % 100) as u16;
        let topic = format!("/test/imu_{}", process::id());
        let (samples, mut received) = RingBuffer::new(256);
        let shared = Shared::default();
        let subscription = Subscription::in_domain(domain, &topic, false).unwrap();
        let builder = DomainParticipantBuilder::new(domain).with_only_networks([Ipv4Addr::LOCALHOST]);
        let participant = builder.build().unwrap();
        let qos = QosPolicyBuilder::new().reliability(Reliability::BestEffort).build();
        let topic = participant.create_topic(format!("rt{topic}"), TYPE.to_owned(), &qos, TopicKind::NoKey).unwrap();
        let publisher = participant.create_publisher(&qos).unwrap();
        let writer = publisher.create_datawriter_no_key_cdr::<Imu>(&topic, None).unwrap();
        let sample = thread::scope(|scope| {
            scope.spawn(|| subscription.run(samples, &shared));
            let end = Instant::now() + Duration::from_secs(60);
            let mut sample = None;
            while sample.is_none() && Instant::now() < end {
                writer.write(decoded(&golden()).unwrap(), None).unwrap();
                thread::sleep(Duration::from_millis(10));
                sample = received.pop().ok();
            }
            shared.done.store(true, Ordering::Relaxed);
            sample
        });
        let Received { sample, .. } = sample.expect("no message has arrived within a minute");
        assert_eq!(sample, decoded(&golden()).unwrap().sample().unwrap());
        assert_eq!(shared.dropped.load(Ordering::Relaxed), 0);
    }

    #[test]
    fn a_name_that_is_none_is_refused() {
        for topic in ["", "/", "imu", "/imu//data", "/imu/data/", "/imu data", "/imu/\u{e4}"] {
            assert!(Subscription::in_domain(99, topic, false).is_err(), "{topic:?}");
        }
        assert!(Subscription::in_domain(DOMAINS, "/imu", false).is_err());
    }
}
