//! The sending thread, judged by what a device receives and the loop is told.

use std::net::UdpSocket;

use moris_live::frame::{self, Encoder};
use moris_washout::Rig;
use rtrb::RingBuffer;

use super::*;

/// Packets that the device receives, up to the stop string.
fn until_stop(device: &UdpSocket) -> Vec<String> {
    device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let mut received: Vec<String> = Vec::new();
    while received.last().is_none_or(|line| line != "stop\n") {
        let mut packet = [0; 1000];
        let length = device.recv(&mut packet).unwrap();
        received.push(String::from_utf8(packet[..length].to_vec()).unwrap());
    }
    received
}

#[test]
fn a_loop_that_panics_leaves_a_platform_at_rest_and_the_stop_string() {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
    let encoder =
        Encoder::new(&moris_live::shipped(frame::SHIPPED_FRAMES, "csv").unwrap().parse().unwrap(), &Rig::default())
            .unwrap();
    let (mut ring, messages) = RingBuffer::new(8);
    let (orders, _) = RingBuffer::new(4);
    let sender = std::thread::spawn(move || {
        let device = Device::of_template(encoder);
        Sender::new(
            messages,
            device,
            sink,
            orders,
            (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
            &Shared::default(),
        )
        .run()
    });
    let panicking = std::thread::spawn(move || {
        let moving = Values { length: [1.3; 6], velocity: [0.4; 6], ..Values::default() };
        for message in [Message::Start, Message::Frame] {
            ring.push(Sending { message, values: moving, arrival: None, made: loop_clock::now() }).unwrap();
        }
        panic!("deliberate");
    });
    assert!(panicking.join().is_err());
    let received = until_stop(&device);
    assert_eq!(sender.join().unwrap().sent, received.len() as u64);
    assert_eq!(received[0], "start\n");
    let frames = &received[1..received.len() - 1];
    let length = |line: &String| line.split(',').nth(1).unwrap().parse::<f64>().unwrap();
    let speeds: Vec<f64> = frames.windows(2).map(|pair| (length(&pair[1]) - length(&pair[0])) / 0.01).collect();
    // From 0.4 m/s to rest, at 0.4 / 0.15 m/s2 at most.
    assert!(speeds[0] > 0.3 && speeds.last().unwrap().abs() < 1e-3, "{speeds:?}");
    assert!(speeds.windows(2).all(|pair| (-1e-3..0.03).contains(&(pair[0] - pair[1]))), "{speeds:?}");
}

/// The frames that a device receives until the stop string, with a pause before each message.
fn received(messages: &[(Message, Values)], pause: Duration) -> Vec<String> {
    received_until(messages, pause, |_| ())
}

/// The same where something happens before the loop ends.
fn received_until(messages: &[(Message, Values)], pause: Duration, end: impl FnOnce(&Signals)) -> Vec<String> {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
    let (mut ring, to_send) = RingBuffer::new(8);
    let (orders, _) = RingBuffer::new(4);
    let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
    let signals = Signals::default();
    let of_sender = signals.clone();
    let sender = std::thread::spawn(move || {
        let shared = Shared::default();
        let mut sender = Sender::new(to_send, csv(), sink, orders, (0.01, actuators), &shared);
        sender.signals = of_sender;
        sender.run();
    });
    for (message, values) in messages {
        std::thread::sleep(pause);
        ring.push(Sending { message: *message, values: *values, arrival: None, made: loop_clock::now() }).unwrap();
        sender.thread().unpark();
    }
    end(&signals);
    drop(ring);
    let received = until_stop(&device);
    sender.join().unwrap();
    received
}

/// Frames were held up while the loop came down, so that its last one is 20 mm ahead.
#[test]
fn late_frames_arrive_before_the_park_string() {
    let at = |time: f64, length: f64| Values { time, length: [length; 6], ..Values::default() };
    let down = [
        (Message::Start, at(0.0, 1.1)),
        (Message::Frame, at(0.01, 1.1)),
        (Message::Frame, at(0.02, 1.08)),
        (Message::Park, at(0.02, 1.08)),
        (Message::Stop, at(0.03, 1.08)),
    ];
    // Longer than actuators are taken to go on without a frame.
    let received = received(&down, Duration::from_millis(80));
    assert_eq!(received[received.len() - 2..], ["park\n", "stop\n"]);
    let length = |line: &String| line.split(',').nth(1).and_then(|length| length.parse::<f64>().ok());
    let lengths: Vec<f64> = received.iter().filter_map(length).collect();
    let ways: Vec<f64> = lengths.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    assert!((lengths.last().unwrap() - 1.08).abs() < 1.1e-4, "{lengths:?}");
    assert!(ways.iter().all(|way| *way < 1.1e-3) && *ways.last().unwrap() < 2e-5, "{ways:?}");
}

/// The way to the lowest pose takes more than a second from here.
#[test]
fn a_person_who_stops_while_frames_arrive_ends_them_at_once() {
    let at = |time: f64, length: f64| Values { time, length: [length; 6], ..Values::default() };
    let down = [(Message::Start, at(0.0, 1.5)), (Message::Frame, at(0.01, 1.5)), (Message::Park, at(0.02, 1.0))];
    let stop = [down.as_slice(), &[(Message::Stop, at(0.03, 1.0))]].concat();
    let pause = Duration::from_millis(80);
    let wait = || std::thread::sleep(Duration::from_millis(200));
    let by_stop = received_until(&stop, pause, |_| wait());
    let by_interrupt = received_until(&down, pause, |signals| {
        wait();
        signals.interrupt.store(true, Ordering::Relaxed);
    });
    for received in [by_stop, by_interrupt] {
        let lengths = received.iter().filter_map(|line| line.split(',').nth(1)?.parse::<f64>().ok());
        assert!(lengths.fold(f64::NAN, f64::min) > 1.1, "{received:?}");
        assert_eq!(received.last().unwrap(), "stop\n");
    }
}

/// The loop is busy, and a report waits for it.
#[test]
fn a_loss_that_the_loop_has_no_room_for_is_reported_later() {
    let (mut orders, mut reported) = RingBuffer::new(1);
    orders.push(Order::Report([1.3; 6])).unwrap();
    let shared = Shared::default();
    let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
    let (ring, messages) = RingBuffer::new(1);
    let mut sender =
        Sender::new(messages, Device::moog(&Rig::default()), Sink::Dry, orders, (0.01, actuators), &shared);
    sender.report(Loss::Device);
    drop(ring);
    assert!(matches!(reported.pop(), Ok(Order::Report(_))));
    sender.run();
    assert!(matches!(reported.pop(), Ok(Order::Lost(Loss::Device))));
}

/// A sender to the controller's socket that never ends.
#[test]
fn a_flood_of_answers_delays_no_frame() {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
    sink.listen().unwrap();
    let Sink::Udp(socket) = &sink else { unreachable!() };
    let address = format!("127.0.0.1:{}", socket.local_addr().unwrap().port());
    (0..200).for_each(|_| _ = device.send_to(b"legs,1.3,1.3,1.3,1.3,1.3,1.3\n", &address).unwrap());
    let encoder =
        Encoder::new(&moris_live::shipped(frame::SHIPPED_FRAMES, "csv").unwrap().parse().unwrap(), &Rig::default())
            .unwrap();
    let (orders, mut reported) = RingBuffer::new(64);
    let shared = Shared::default();
    let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
    let device_of = Device::of_template(encoder);
    let mut sender = Sender::new(RingBuffer::new(1).1, device_of, sink, orders, (0.01, actuators), &shared);
    let mut packet = [0; 256];
    sender.ask(&mut packet);
    // One report of many, and most of the flood is left for later.
    assert!(reported.pop().is_ok() && reported.pop().is_err());
    let left = (0..200).take_while(|_| sender.sink.receive(&mut packet).is_some()).count();
    assert!(left >= 100, "{left}");
}

/// The sender's counts and what it reports, after so many frames to this sink.
fn sent_to(sink: Sink, device: Device, frames: u32, shared: &Shared) -> (Sent, Vec<Order>) {
    let (mut ring, messages) = RingBuffer::new(256);
    let (orders, mut reported) = RingBuffer::new(64);
    let sent = std::thread::scope(|scope| {
        let sender = scope.spawn(move || {
            Sender::new(
                messages,
                device,
                sink,
                orders,
                (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                shared,
            )
            .run()
        });
        let send = |ring: &mut Producer<Sending>, message| {
            ring.push(Sending { message, values: Values::default(), arrival: None, made: loop_clock::now() }).unwrap();
            sender.thread().unpark();
            std::thread::sleep(Duration::from_millis(10));
            // On a busy computer a frame that waits would be skipped for the next.
            while ring.slots() < 256 {
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        send(&mut ring, Message::Start);
        (0..frames).for_each(|_| send(&mut ring, Message::Frame));
        send(&mut ring, Message::Stop);
        drop(ring);
        sender.join().unwrap()
    });
    (sent, std::iter::from_fn(|| reported.pop().ok()).collect())
}

fn csv() -> Device {
    Device::of_template(
        Encoder::new(&moris_live::shipped(frame::SHIPPED_FRAMES, "csv").unwrap().parse().unwrap(), &Rig::default())
            .unwrap(),
    )
}

#[test]
fn an_error_while_sending_costs_a_frame_and_fails_the_session() {
    for device in [csv(), Device::moog(&Rig::default())] {
        let shared = Shared::default();
        let (sent, _) = sent_to(Sink::Panicking(std::cell::Cell::new(0)), device, 20, &shared);
        assert!(shared.failed.has(Part::Frames));
        assert!((19..=22).contains(&sent.sent), "{}", sent.sent);
    }
}

#[test]
fn a_sender_that_fails_on_and_on_ends_after_its_tenth_error() {
    let (mut ring, messages) = RingBuffer::new(16);
    let (orders, _) = RingBuffer::new(4);
    for _ in 0..15 {
        let values = Values::default();
        ring.push(Sending { message: Message::Start, values, arrival: None, made: loop_clock::now() }).unwrap();
    }
    let (sink, shared) = (Sink::Panicking(std::cell::Cell::new(1000)), Shared::default());
    let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
    let sent = Sender::new(messages, csv(), sink, orders, (0.01, actuators), &shared).run();
    assert!(shared.failed.has(Part::Frames));
    assert_eq!((sent.sent, ring.slots()), (0, 1 + 10), "messages left in the ring");
}

#[test]
fn a_controller_that_is_gone_is_reported_once() {
    let gone = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let sink = Sink::open(&format!("udp:{gone}")).unwrap();
    let (sent, reported) = sent_to(sink, csv(), 40, &Shared::default());
    assert_eq!(reported, [Order::Lost(Loss::Refused(ErrorKind::ConnectionRefused))]);
    assert!(sent.sent < 10, "frames go on to a controller that is lost: {}", sent.sent);
}

#[test]
fn a_gap_on_the_wire_is_reported_from_the_time_out_of_the_controller_on() {
    for (pause, is_fault) in [(20, false), (250, true)] {
        let device = UdpSocket::bind("127.0.0.1:0").unwrap();
        let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
        let (mut ring, messages) = RingBuffer::new(256);
        let (orders, mut reported) = RingBuffer::new(64);
        let shared = Shared::default();
        let mut sender = Sender::new(
            messages,
            csv(),
            sink,
            orders,
            (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
            &shared,
        );
        sender.time_out = Some(Duration::from_millis(200));
        let sent = std::thread::scope(|scope| {
            let sender = scope.spawn(move || sender.run());
            for (message, wait) in [(Message::Start, 1), (Message::Frame, pause), (Message::Frame, 1)] {
                let made = loop_clock::now();
                ring.push(Sending { message, values: Values::default(), arrival: None, made }).unwrap();
                sender.thread().unpark();
                std::thread::sleep(Duration::from_millis(wait));
            }
            ring.push(Sending {
                message: Message::Stop,
                values: Values::default(),
                arrival: None,
                made: loop_clock::now(),
            })
            .unwrap();
            drop(ring);
            sender.join().unwrap()
        });
        let orders: Vec<Order> = std::iter::from_fn(|| reported.pop().ok()).collect();
        if is_fault {
            assert!(matches!(orders[..], [Order::Lost(Loss::Gap(gap))] if gap >= 0.2), "{orders:?}");
            assert!(sent.gap >= Duration::from_millis(200));
        } else if sent.gap < Duration::from_millis(200) {
            // Unless the computer itself made the gap.
            assert!(orders.is_empty(), "{orders:?}");
        }
    }
}

#[test]
fn the_controller_is_asked_where_the_legs_are_while_that_is_unknown() {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
    sink.listen().unwrap();
    let (ring, messages) = RingBuffer::new(256);
    let (orders, mut reported) = RingBuffer::new(64);
    let shared = Shared::default();
    shared.asks.store(true, Ordering::Relaxed);
    std::thread::scope(|scope| {
        let shared = &shared;
        let sender = scope.spawn(move || {
            Sender::new(
                messages,
                csv(),
                sink,
                orders,
                (0.01, Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] }),
                shared,
            )
            .run()
        });
        let mut packet = [0; 100];
        let (length, from) = device.recv_from(&mut packet).unwrap();
        assert_eq!(&packet[..length], b"legs?\n");
        device.send_to(b"what?\n", from).unwrap();
        device.send_to(b"legs,1.1,1.2,1.3,1.4,1.5,1.6\n", from).unwrap();
        let begin = loop_clock::now();
        let order = loop {
            if let Ok(order) = reported.pop() {
                break order;
            }
            assert!(loop_clock::now() - begin < Duration::from_secs(10));
            std::thread::sleep(Duration::from_millis(5));
        };
        assert_eq!(order, Order::Report([1.1, 1.2, 1.3, 1.4, 1.5, 1.6]));
        shared.asks.store(false, Ordering::Relaxed);
        drop(ring);
        sender.join().unwrap();
    });
}

/// As after the computer's sleep: the legs may be anywhere, and no frame follows by itself.
#[test]
fn after_a_gap_of_two_seconds_no_frame_leaves_before_a_start() {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    device.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let sink = Sink::open(&format!("udp:{}", device.local_addr().unwrap())).unwrap();
    let (orders, mut reported) = RingBuffer::new(8);
    let shared = Shared::default();
    let actuators = Actuators { speed: 1.0, acceleration: 15.0, stroke: [1.0, 1.6] };
    let mut sender = Sender::new(RingBuffer::new(1).1, csv(), sink, orders, (0.01, actuators), &shared);
    let at = |length: f64| Values { length: [length; 6], ..Values::default() };
    sender.take(Message::Start, &at(1.2));
    sender.take(Message::Frame, &at(1.2));
    std::thread::sleep(Duration::from_millis(2_050));
    sender.take(Message::Frame, &at(1.5));
    sender.take(Message::Frame, &at(1.5));
    assert!(matches!(reported.pop(), Ok(Order::Lost(Loss::LongGap(gap))) if gap >= 2.0));
    assert!(reported.pop().is_err(), "a loss is reported once");
    // The operator starts again: from the last frame on, slowly.
    sender.take(Message::Start, &at(1.5));
    sender.take(Message::Frame, &at(1.5));
    sender.take(Message::Stop, &at(1.5));
    let received = until_stop(&device);
    let words: Vec<&str> = received.iter().map(|line| line.split([',', '\n']).next().unwrap()).collect();
    assert_eq!(words, ["start", "0.000", "start", "0.000", "stop"], "{received:?}");
    let length = |line: &String| line.split(',').nth(1).unwrap().parse::<f64>().unwrap();
    assert!((length(&received[3]) - 1.2).abs() < 1e-3, "{received:?}");
}
