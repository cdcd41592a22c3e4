//! Pre-integrated tables of a transfer function (Röttger, Kraus & Ertl 2000; Engel, Kraus & Ertl 2001): the colour of a ray segment by the
//! scalar at its front, the scalar at its back and its length, where the scalar is linear along the segment.
//!
//! Input: the texels of a transfer function, and settings. Output: a table of three dimensions. The first and the last texel along each
//! axis are the ends of its range: scalars from 0 to 1, lengths from 0 to that of the settings.

/// What a table is computed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    /// Texels along both axes of scalars.
    scalars: u32,
    /// Texels along the axis of lengths.
    lengths: u32,
    /// The greatest length, in units of the scene.
    length: f32,
    /// The extinction per unit of length where the transfer function has the alpha 1.
    extinction: f32,
}

/// The steps of the numerical integral of a segment.
const STEPS: u32 = 64;

/// The most texels along an axis.
const MOST: u32 = 256;

/// What precedes the name of a transfer function of the program.
const BUILTIN: &str = "builtin:";

/// The colours of `shells`, at equal distances of the scalar, and the scalars of its shells.
const COLORS: [[f64; 3]; 4] = [[0.05, 0.1, 0.5], [0.1, 0.55, 0.6], [0.95, 0.6, 0.1], [1.0, 0.15, 0.05]];
const SHELLS: [f64; 4] = [0.12, 0.35, 0.6, 0.85];

/// The texels of `shells`, and the width of a shell.
const TEXELS: u32 = 256;
const WIDTH: f64 = 0.025;

/// Returns a transfer function of the program; `None`: the path of an image.
pub(super) fn builtin(path: &str) -> Option<Result<Vec<[f32; 4]>, String>> {
    match path.strip_prefix(BUILTIN)? {
        "shells" => Some(Ok(shells())),
        other => Some(Err(format!("no transfer function is `{BUILTIN}{other}`: it is `{BUILTIN}shells`"))),
    }
}

/// Returns thin layers of several colours in a faint mist, as 256 texels.
fn shells() -> Vec<[f32; 4]> {
    let colors = COLORS.map(|[red, green, blue]| [red as f32, green as f32, blue as f32, 1.0]);
    let texel = |index: u32| {
        let scalar = f64::from(index) / f64::from(TEXELS - 1);
        let shell = |at: &f64| (-((scalar - at) / WIDTH).powi(2)).exp();
        let [red, green, blue, _] = value(&colors, scalar).map(|channel| channel as f32);
        [red, green, blue, (0.01 + 0.99 * SHELLS.iter().map(shell).sum::<f64>()).min(1.0) as f32]
    };
    (0..TEXELS).map(texel).collect()
}

impl Settings {
    /// Reads options.
    pub(super) fn parse(options: &[(&str, &str)]) -> Result<Self, String> {
        let mut settings = Settings { scalars: 64, lengths: 32, length: 1.0, extinction: 1.0 };
        for (name, value) in options {
            let texels = || {
                let number = value.parse().ok().filter(|number| (2..=MOST).contains(number));
                number.ok_or(format!("`{name}` takes a whole number from 2 to {MOST}"))
            };
            let positive = || {
                let number = value.parse().ok().filter(|number: &f32| number.is_finite() && *number > 0.0);
                number.ok_or(format!("`{name}` takes a number above 0"))
            };
            match *name {
                "scalars" => settings.scalars = texels()?,
                "lengths" => settings.lengths = texels()?,
                "length" => settings.length = positive()?,
                "extinction" => settings.extinction = positive()?,
                _ => {
                    return Err(format!(
                        "a pre-integrated table has no option `{name}`: it has scalars, lengths, length and extinction"
                    ));
                }
            }
        }
        Ok(settings)
    }

    /// Returns the bytes of the table.
    pub(super) fn bytes(&self) -> u64 {
        u64::from(self.scalars) * u64::from(self.scalars) * u64::from(self.lengths) * size_of::<[f32; 4]>() as u64
    }
}

/// Returns the size and the texels of the table: premultiplied colours.
pub(super) fn table(transfer: &[[f32; 4]], settings: &Settings) -> ([u32; 3], Vec<[f32; 4]>) {
    let Settings { scalars, lengths, length, extinction } = *settings;
    let share = |index: u32| f64::from(index) / f64::from(scalars.max(2) - 1);
    let shortest = f64::from(length * extinction) / f64::from(lengths.max(2) - 1);
    let area = (scalars * scalars) as usize;
    let mut texels = vec![[0.0; 4]; area * lengths as usize];
    for (place, pair) in (0..scalars).flat_map(|row| (0..scalars).map(move |column| (column, row))).enumerate() {
        let mut segment = Segment::new(transfer, (share(pair.0), share(pair.1)), shortest);
        for texel in texels.iter_mut().skip(place).step_by(area) {
            *texel = segment.color();
            segment.lengthen();
        }
    }
    ([scalars, scalars, lengths], texels)
}

/// A segment between two scalars, in steps of equal lengths, each with the transfer function at its middle.
struct Segment {
    steps: Vec<Step>,
}

/// A step of a segment.
struct Step {
    color: [f64; 3],
    /// The light that passes the step, of the segment of the present length, and of the shortest one.
    passes: f64,
    shortest: f64,
}

impl Segment {
    /// Returns the segment of length 0. `shortest`: the length of the next one, in units of the extinction.
    fn new(transfer: &[[f32; 4]], (front, back): (f64, f64), shortest: f64) -> Self {
        let step = |index: u32| {
            let along = (f64::from(index) + 0.5) / f64::from(STEPS);
            let [red, green, blue, alpha] = value(transfer, front + (back - front) * along);
            let shortest = (-alpha * shortest / f64::from(STEPS)).exp();
            Step { color: [red, green, blue], passes: 1.0, shortest }
        };
        Segment { steps: (0..STEPS).map(step).collect() }
    }

    /// Adds the shortest length: light that passes two lengths passes one after the other.
    fn lengthen(&mut self) {
        self.steps.iter_mut().for_each(|step| step.passes *= step.shortest);
    }

    /// Integrates emission and absorption front to back.
    fn color(&self) -> [f32; 4] {
        let (mut sum, mut transmittance) = ([0.0_f64; 3], 1.0_f64);
        for Step { color: [red, green, blue], passes, .. } in &self.steps {
            let share = transmittance * (1.0 - passes);
            sum = [sum[0] + share * red, sum[1] + share * green, sum[2] + share * blue];
            transmittance *= passes;
        }
        let [red, green, blue] = sum.map(|channel| channel as f32);
        [red, green, blue, (1.0 - transmittance) as f32]
    }
}

/// Returns the transfer function at a scalar from 0 to 1, linear between texels.
fn value(transfer: &[[f32; 4]], scalar: f64) -> [f64; 4] {
    let last = transfer.len().saturating_sub(1);
    let place = scalar.clamp(0.0, 1.0) * last as f64;
    let first = place.floor() as usize;
    let texel = |index: usize| transfer.get(index.min(last)).copied().unwrap_or_default().map(f64::from);
    let (near, far) = (texel(first), texel(first + 1));
    std::array::from_fn(|channel| near[channel] + (far[channel] - near[channel]) * (place - first as f64))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::{SHELLS, Settings, builtin, table, value};

    /// The opacity is greatest at each shell, and small between them.
    #[test]
    fn shells_are_thin() {
        let transfer = builtin("builtin:shells").unwrap().unwrap();
        for at in SHELLS {
            assert!(value(&transfer, at)[3] > 0.9 && value(&transfer, at + 0.1)[3] < 0.05, "{at}");
        }
        assert!(builtin("builtin:other").unwrap().is_err() && builtin("shells.png").is_none());
    }

    /// Where the transfer function is constant, a segment has the opacity 1 - exp(-τ d) (Beer–Lambert).
    #[test]
    fn a_constant_medium_absorbs_by_beer_and_lambert() {
        let settings = Settings::parse(&[("scalars", "2"), ("lengths", "3"), ("length", "2"), ("extinction", "3")]);
        let settings = settings.unwrap();
        let ([width, height, slices], texels) = table(&[[0.5, 0.25, 1.0, 0.5]], &settings);
        assert_eq!((width, height, slices, texels.len()), (2, 2, 3, 12));
        for (index, texel) in texels.iter().enumerate() {
            let depth = 0.5 * 3.0 * (index / 4) as f32;
            let opacity = 1.0 - (-depth).exp();
            let expected = [0.5 * opacity, 0.25 * opacity, opacity, opacity];
            assert!(texel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-6), "{texel:?} {expected:?}");
        }
    }

    /// The nearer half of a segment hides the farther one: swapped scalars give other colours and the same opacity.
    #[test]
    fn the_order_along_the_ray_counts() {
        let transfer = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
        let (_, texels) = table(&transfer, &Settings::parse(&[("scalars", "2"), ("length", "4")]).unwrap());
        let last = &texels[texels.len() - 4..];
        let (green_first, red_first) = (last[1], last[2]);
        assert!(red_first[0] > red_first[1] + 0.2 && green_first[1] > green_first[0] + 0.2);
        assert!((red_first[3] - green_first[3]).abs() < 1.0e-6);
    }
}
