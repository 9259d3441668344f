use moris_motorcycle::*;
#[test]
fn poles() {
    let m = Motorcycle::new(&Parameters::default(), &Input::default()).unwrap();
    for k in 0..40 {
        let v = 0.25 * k as f64 * if k > 16 { 0.1 * (k - 6) as f64 } else { 1.0 };
        let e = m.rider().closed_loop(m.lateral(), v).complex_eigenvalues();
        let o = m.lateral().state_matrix(v, 0.0).complex_eigenvalues();
        let mut l: Vec<_> = e.iter().map(|x| format!("{:.1}{:+.1}i", x.re, x.im)).collect();
        l.sort();
        let mut lo: Vec<_> = o.iter().map(|x| format!("{:.1}{:+.1}i", x.re, x.im)).collect();
        lo.sort();
        println!("{v:.2} {}\n      open {}", l.join(" "), lo.join(" "));
        let s = m.rider().skill(v);
        println!("      turn d {:.3} r {:.3} T {:.2}", s.turn[5], s.turn[1], s.turn_torque);
    }
}
