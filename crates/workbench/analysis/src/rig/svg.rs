//! Drawing primitives for the pictures of a rig.

/// Room for a panel on the page \[px\].
pub const PANEL_SIZE: [f64; 2] = [520.0, 470.0];

/// A rectangle of a plane, in metres, shown in a panel at one scale for both axes.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    low: [f64; 2],
    high: [f64; 2],
}

/// Room in a panel for title, numbers and names of the axes: left, top, right, bottom \[px\].
const PANEL_MARGINS: [f64; 4] = [64.0, 44.0, 16.0, 52.0];

impl Window {
    /// Shows everything from `low` to `high` and as much around it as the panel has room for.
    pub fn around(low: [f64; 2], high: [f64; 2]) -> Self {
        let [width, height] = panel_room();
        let scale = (width / (high[0] - low[0])).min(height / (high[1] - low[1]));
        let (half_width, half_height) = (0.5 * width / scale, 0.5 * height / scale);
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        Window {
            low: [middle[0] - half_width, middle[1] - half_height],
            high: [middle[0] + half_width, middle[1] + half_height],
        }
    }

    /// The lower left and the upper right corner.
    pub fn corners(&self) -> [[f64; 2]; 2] {
        [self.low, self.high]
    }

    /// Scale of both axes \[px/m\].
    pub fn scale(&self) -> f64 {
        panel_room()[0] / (self.high[0] - self.low[0])
    }

    /// Where a point is in the panel \[px\].
    pub fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [PANEL_MARGINS[0] + (x - self.low[0]) * self.scale(), PANEL_MARGINS[1] + (self.high[1] - y) * self.scale()]
    }

    /// The drawing area as attributes of a rectangle.
    pub fn area(&self) -> String {
        let [width, height] = panel_room();
        format!(r#"x="{}" y="{}" width="{width}" height="{height}""#, PANEL_MARGINS[0], PANEL_MARGINS[1])
    }

    /// The frame with numbers and names of the axes.
    pub fn axes(&self, names: [&str; 2]) -> String {
        let mut text = format!(r#"<rect {} class="frame"/>"#, self.area());
        let [width, height] = panel_room();
        let bottom = PANEL_MARGINS[1] + height;
        for x in axis_ticks(self.low[0], self.high[0]) {
            let [px, _] = self.pixel([x, 0.0]);
            text += &format!(r#"<path d="M{px:.1} {bottom}v5" class="frame"/>"#);
            text +=
                &format!(r#"<text x="{px:.1}" y="{:.1}" text-anchor="middle">{}</text>"#, bottom + 20.0, tick_label(x));
        }
        for y in axis_ticks(self.low[1], self.high[1]) {
            let [_, py] = self.pixel([0.0, y]);
            text += &format!(r#"<path d="M{} {py:.1}h-5" class="frame"/>"#, PANEL_MARGINS[0]);
            text += &format!(
                r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#,
                PANEL_MARGINS[0] - 8.0,
                py + 4.0,
                tick_label(y)
            );
        }
        let (middle_x, middle_y) = (PANEL_MARGINS[0] + 0.5 * width, PANEL_MARGINS[1] + 0.5 * height);
        text +=
            &format!(r#"<text x="{middle_x}" y="{:.1}" text-anchor="middle">{} [m]</text>"#, bottom + 40.0, names[0]);
        text += &format!(
            r#"<text transform="translate(16 {middle_y}) rotate(-90)" text-anchor="middle">{} [m]</text>"#,
            names[1]
        );
        text
    }
}

/// Width and height of a panel's drawing area \[px\].
fn panel_room() -> [f64; 2] {
    [PANEL_SIZE[0] - PANEL_MARGINS[0] - PANEL_MARGINS[2], PANEL_SIZE[1] - PANEL_MARGINS[1] - PANEL_MARGINS[3]]
}

/// Round numbers between two, about six of them.
fn axis_ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 6.0;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A tick's number, without a minus before zero and without more zeros than it needs.
fn tick_label(value: f64) -> String {
    let text = format!("{:.3}", value + 0.0);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// A text's characters that mean something in XML, written so that they do not.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let near = |a: Vec<f64>, b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(axis_ticks(-0.55, 0.52), &[-0.4, -0.2, 0.0, 0.2, 0.4]));
        assert!(near(axis_ticks(0.9, 3.1), &[1.0, 1.5, 2.0, 2.5, 3.0]));
    }

    #[test]
    fn numbers_have_no_idle_zeros() {
        assert_eq!([0.0, -0.0, 0.5, -0.25, 10.0].map(tick_label), ["0", "0", "0.5", "−0.25", "10"]);
    }

    #[test]
    fn the_window_shows_both_axes_at_one_scale() {
        let window = Window::around([-1.0, 0.0], [1.0, 0.5]);
        let [x0, y0] = window.pixel([-1.0, 0.0]);
        let [x1, y1] = window.pixel([1.0, 0.5]);
        assert!(((x1 - x0) / 2.0 - (y0 - y1) / 0.5).abs() < 1e-9);
    }
}
